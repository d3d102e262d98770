"""In Blender, LIST.json: what play_fbx.mjs does in three.js, through Blender's importer of FBX.

Two of the files made by others stop that importer at a property of their own; they are left out.
"""

import json
import pathlib
import sys

import bpy

UNREADABLE = "AssertionError"


def places():
    """Where every bone and object is, metres, y up."""
    found = {}
    for thing in bpy.data.objects:
        if thing.type == "ARMATURE":
            for bone in thing.pose.bones:
                found[bone.name] = (thing.matrix_world @ bone.matrix).translation
        found.setdefault(thing.name, thing.matrix_world.translation)
    return {name: (at.x, at.z, -at.y) for name, at in found.items()}


def play(animation):
    """Gives every object its action of the take: "OBJECT|TAKE" or "OBJECT|TAKE|LAYER"."""
    for thing in bpy.data.objects:
        if thing.animation_data:
            thing.animation_data.action = None
        for action in bpy.data.actions:
            if action.name.split("|")[:2] == [thing.name, animation]:
                thing.animation_data_create().action = action


def show(time):
    render = bpy.context.scene.render
    frame = 1 + time * render.fps / render.fps_base  # the importer lets actions start at 1
    whole = int(frame + 1e-6)
    bpy.context.scene.frame_set(whole, subframe=min(max(frame - whole, 0.0), 0.999999))


def check(item):
    """Prints the largest distance; whether it is small enough."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    try:
        bpy.ops.import_scene.fbx(filepath=item["file"])
    except RuntimeError as error:
        if UNREADABLE not in str(error):
            raise
        print(f"{item['name']}: Blender's importer stops at the source's own properties")
        return None
    play(item["animation"])
    largest, joints = 0.0, 0
    for step, time in enumerate(item["times"]):
        show(time)
        found = places()
        joints = sum(name in found for name in item["positions"])
        for name, positions in item["positions"].items():
            if name in found:
                off = sum((a - b) ** 2 for a, b in zip(found[name], positions[step])) ** 0.5
                largest = max(largest, off)
    good = joints >= 15 and len(item["times"]) >= 5 and largest <= item["tolerance"]
    print(
        f"{item['name']}: {joints} joints, largest distance {largest:.2e} (at most {item['tolerance']:.2e})"
        f"{'' if good else '  FAILED'}"
    )
    return good


items = json.loads(pathlib.Path(sys.argv[-1]).read_text())
results = [check(item) for item in items]
played = [result for result in results if result is not None]
print(f"{len(played)} takes played, {played.count(False)} wrong")
sys.exit(0 if played and all(played) and results.count(None) <= 2 else 1)
