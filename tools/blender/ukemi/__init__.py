# SPDX-License-Identifier: GPL-3.0-or-later
"""Hit reactions by the program ukemi, baked onto the armature that is selected."""

import bpy

from . import operators, panel, settings

bl_info = {
    "name": "Ukemi",
    "description": "Bakes hit reactions whose joints stay human",
    "author": "The ukemi project",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Ukemi",
    "category": "Animation",
}

_group = None


def _register_group(preference):
    """scene.ukemi, from what the program says of its settings."""
    global _group
    _unregister_group()
    _group = settings.make_group(preference)
    bpy.utils.register_class(_group)
    bpy.types.Scene.ukemi = bpy.props.PointerProperty(type=_group)


def _unregister_group():
    global _group
    if _group is not None:
        del bpy.types.Scene.ukemi
        bpy.utils.unregister_class(_group)
        _group = None


def _program_changed(self, _context):
    _register_group(self.program)


class UkemiPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__
    program: bpy.props.StringProperty(
        name="Program",
        description="The program ukemi; empty: UKEMI in the environment, the path, or bin/ in this add-on",
        subtype="FILE_PATH",
        update=_program_changed,
    )

    def draw(self, _context):
        self.layout.prop(self, "program")
        problem = settings.Described.problem
        self.layout.label(text=problem or "The program is found.", icon="ERROR" if problem else "CHECKMARK")


class UKEMI_OT_find_program(bpy.types.Operator):
    """Looks for the program again"""

    bl_idname, bl_label = "ukemi.find_program", "Look Again"

    def execute(self, context):
        _register_group(operators.preference(context))
        if settings.Described.problem:
            self.report({"ERROR"}, settings.Described.problem)
            return {"CANCELLED"}
        return {"FINISHED"}


_CLASSES = [UkemiPreferences, UKEMI_OT_find_program, *operators.CLASSES, *panel.CLASSES]


def register():
    for entry in _CLASSES:
        bpy.utils.register_class(entry)
    _register_group(operators.preference(bpy.context))


def unregister():
    _unregister_group()
    for entry in reversed(_CLASSES):
        bpy.utils.unregister_class(entry)
