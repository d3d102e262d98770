# SPDX-License-Identifier: GPL-3.0-or-later
"""The sidebar of the 3D view, tab "Ukemi"."""

import bpy

from . import operators, settings

# Settings that the first panel shows; the others stand below, under the program's own headings.
FIRST = ["hit", "preset", "strength", "behaviour", "get-up", "duration"]


def _draw_setting(layout, group, setting):
    name = settings.attribute(setting["name"])
    row = layout.row(align=True)
    given = group.is_property_set(name)
    if setting["type"] == "number" and setting["default"] is None and not given:
        row.active = False
    row.prop(group, name)
    if given:
        row.operator("ukemi.reset", text="", icon="X").name = name


class _Panel:
    bl_space_type, bl_region_type, bl_category = "VIEW_3D", "UI", "Ukemi"


class UKEMI_PT_main(_Panel, bpy.types.Panel):
    bl_idname, bl_label = "UKEMI_PT_main", "Hit Reaction"

    def draw(self, context):
        layout, group = self.layout, context.scene.ukemi
        layout.use_property_split, layout.use_property_decorate = True, False
        if settings.Described.problem:
            _draw_problem(layout, settings.Described.problem)
            return
        if operators._running:
            layout.label(text=f"Baking: {operators._running[0].progress()}", icon="SORTTIME")
            layout.label(text="Esc stops it")
            return
        self._draw_blow(layout, group)
        layout.prop(group, "start")
        layout.prop(group, "result")
        row = layout.row()
        row.scale_y = 1.5
        row.operator("ukemi.bake", icon="PLAY")
        row = layout.row(align=True)
        row.operator("ukemi.bake_variations", text="Variations")
        row.prop(group, "variations", text="")
        if group.last_action:
            _draw_last(layout, group)

    @staticmethod
    def _draw_blow(layout, group):
        for name in FIRST:
            setting = settings.Described.named(name)
            if setting is None:
                continue
            _draw_setting(layout, group, setting)
            if name == "hit":
                layout.operator("ukemi.pick", icon="EYEDROPPER", text="Pick on the Mesh")
                row = layout.row()
                row.prop(group, "dial", text="")
                _draw_setting(row.column(), group, settings.Described.named("from"))


def _draw_problem(layout, problem):
    column = layout.column()
    column.label(text="No program:", icon="ERROR")
    words, line = problem.split(), ""
    for word in words:
        if len(line) + len(word) > 38:
            column.label(text=line)
            line = ""
        line = f"{line} {word}".strip()
    column.label(text=line)
    column.operator("ukemi.find_program", icon="FILE_REFRESH")


def _draw_last(layout, group):
    box = layout.box()
    box.label(text=group.last_action.split("\n")[0], icon="ACTION")
    row = box.row(align=True)
    row.operator("ukemi.keep", icon="CHECKMARK")
    row.operator("ukemi.discard", icon="TRASH")
    box.operator("ukemi.again", icon="FILE_REFRESH")


class UKEMI_PT_variations(_Panel, bpy.types.Panel):
    bl_idname, bl_label, bl_parent_id, bl_options = "UKEMI_PT_variations", "Variations", "UKEMI_PT_main", {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, group = self.layout, context.scene.ukemi
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in ("vary_direction", "vary_point", "vary_strength", "seed"):
            layout.prop(group, name)


class UKEMI_PT_settings(_Panel, bpy.types.Panel):
    bl_idname, bl_label, bl_parent_id, bl_options = "UKEMI_PT_settings", "All Settings", "UKEMI_PT_main", {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, _context):
        return not settings.Described.problem

    def draw(self, context):
        layout, group = self.layout, context.scene.ukemi
        layout.use_property_split, layout.use_property_decorate = True, False
        row = layout.row(align=True)
        row.operator("ukemi.load_recipe")
        row.operator("ukemi.save_recipe")
        heading, box = None, layout
        for setting in settings.Described.settings:
            if setting["name"] in FIRST or setting["name"] == "from":
                continue
            if setting["group"] != heading:
                heading = setting["group"]
                box = layout.box().column()
                box.label(text=heading.capitalize())
            _draw_setting(box, group, setting)
        layout.operator("ukemi.help", icon="HELP")


CLASSES = [UKEMI_PT_main, UKEMI_PT_variations, UKEMI_PT_settings]
