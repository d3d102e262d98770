# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs whose deform bones follow controls: what the program simulates are the deform bones, what gets the keys are
the FK controls."""

import bpy

_SIDES = (("l", "L"), ("r", "R"))


def _rigify():
    controls = [
        ("torso", "DEF-spine"),
        ("spine_fk", "DEF-spine"),
        ("spine_fk.001", "DEF-spine.001"),
        ("spine_fk.002", "DEF-spine.002"),
        ("spine_fk.003", "DEF-spine.003"),
        ("neck", "DEF-spine.004"),
        ("head", "DEF-spine.006"),
    ]
    switches = []
    for _, side in _SIDES:
        controls += [
            (f"shoulder.{side}", f"DEF-shoulder.{side}"),
            (f"upper_arm_fk.{side}", f"DEF-upper_arm.{side}"),
            (f"forearm_fk.{side}", f"DEF-forearm.{side}"),
            (f"hand_fk.{side}", f"DEF-hand.{side}"),
            (f"thigh_fk.{side}", f"DEF-thigh.{side}"),
            (f"shin_fk.{side}", f"DEF-shin.{side}"),
            (f"foot_fk.{side}", f"DEF-foot.{side}"),
            (f"toe_fk.{side}", f"DEF-toe.{side}"),
            (f"toe.{side}", f"DEF-toe.{side}"),  # before 3.2
        ]
        switches += [(f"upper_arm_parent.{side}", "IK_FK", 1.0), (f"thigh_parent.{side}", "IK_FK", 1.0)]
    return controls, switches


def _auto_rig_pro():  # from its documentation, not tried
    controls = [
        ("c_root_master.x", "root.x"),
        ("c_root.x", "root.x"),
        ("c_spine_01.x", "spine_01.x"),
        ("c_spine_02.x", "spine_02.x"),
        ("c_spine_03.x", "spine_03.x"),
        ("c_neck.x", "neck.x"),
        ("c_head.x", "head.x"),
    ]
    switches = []
    for side, _ in _SIDES:
        controls += [
            (f"c_shoulder.{side}", f"shoulder.{side}"),
            (f"c_arm_fk.{side}", f"arm_stretch.{side}"),
            (f"c_forearm_fk.{side}", f"forearm_stretch.{side}"),
            (f"c_hand_fk.{side}", f"hand.{side}"),
            (f"c_thigh_fk.{side}", f"thigh_stretch.{side}"),
            (f"c_leg_fk.{side}", f"leg_stretch.{side}"),
            (f"c_foot_fk.{side}", f"foot.{side}"),
            (f"c_toes_fk.{side}", f"toes_01.{side}"),
        ]
        switches += [(f"c_hand_ik.{side}", "ik_fk_switch", 1.0), (f"c_foot_ik.{side}", "ik_fk_switch", 1.0)]
    return controls, switches


# By family: (control, deform bone that it carries), parents first; (bone, property, value) that switches to FK.
TABLES = {"rigify": _rigify(), "auto-rig-pro": _auto_rig_pro()}


def family_of(armature):
    """"rigify", "auto-rig-pro" or None."""
    if "rig_id" in armature.data:
        return "rigify"
    if {"c_root_master.x", "c_traj"} <= set(armature.data.bones.keys()):
        return "auto-rig-pro"
    return None


def deform_bones(armature):
    """The bones that the program gets of a control rig; None for a plain rig."""
    if family_of(armature) is None:
        return None
    return [bone for bone in armature.data.bones if bone.use_deform]


def deform_parents(armature, bones):
    """By name, the nearest bone of the list above each bone, or None. Where a deform bone hangs on a mechanism (ORG-
    bones of Rigify), the deform bone that the mechanism stands for counts."""
    names = {bone.name for bone in bones}
    parents = {}
    for bone in bones:
        above = bone.parent
        while above is not None and above.name not in names:
            stand_in = "DEF-" + above.name[4:] if above.name.startswith("ORG-") else None
            if stand_in in names and stand_in != bone.name:
                above = armature.data.bones[stand_in]
                break
            above = above.parent
        parents[bone.name] = above.name if above is not None else None
    return parents


def constrained(armature, bones):
    """The first of the named bones with a constraint that is in force, or None."""
    for name in bones:
        for constraint in armature.pose.bones[name].constraints:
            if not constraint.mute and constraint.influence > 0.0:
                return name
    return None


def controls_of(armature, moved):
    """The controls that this rig has, with the deform bones that they carry, of those that moved."""
    have, moved = armature.pose.bones, set(moved)
    return [(control, bone) for control, bone in TABLES[family_of(armature)][0] if control in have and bone in moved]


def switches_of(armature):
    """(pose bone, property, value) of the switches to FK that this rig has."""
    have = armature.pose.bones
    return [(have[bone], name, value) for bone, name, value in TABLES[family_of(armature)][1] if bone in have and name in have[bone]]


class Followers:
    """Constraints that hold the controls where the deform bones want them, for as long as the block runs."""

    def __init__(self, context, armature, controls):
        self._scene, self._armature = context.scene, armature
        self._held = []
        for control, bone in controls:
            target = bpy.data.objects.new("ukemi target", None)
            self._scene.collection.objects.link(target)
            constraint = armature.pose.bones[control].constraints.new("COPY_TRANSFORMS")
            constraint.target = target
            rest = armature.data.bones
            offset = rest[bone].matrix_local.inverted_safe() @ rest[control].matrix_local
            self._held.append((control, bone, offset, target, constraint))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for control, _bone, _offset, target, constraint in self._held:
            self._armature.pose.bones[control].constraints.remove(constraint)
            bpy.data.objects.remove(target)

    def hold(self, of_object, matrices):
        """Moves the controls to where the deform bones stand. `matrices`: by name, in the armature's space."""
        for _control, bone, offset, target, _constraint in self._held:
            target.matrix_world = of_object @ matrices[bone] @ offset
