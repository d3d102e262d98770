"""play_in_blender.py LIST.json, in Blender: what play.mjs does in three.js. Loads every item of the list (.glb or
.bvh), sets the times and compares the world position of every named bone with ours."""

import json
import pathlib
import sys

import bpy

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "blender"))
import shims  # noqa: E402

shims.install()


def load(item):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.fps = 30
    if item["file"].endswith(".bvh"):
        bpy.ops.import_anim.bvh(filepath=item["file"], use_fps_scale=False, update_scene_fps=True, frame_start=0,
                                axis_forward="-Z", axis_up="Y")
    else:
        bpy.ops.import_scene.gltf(filepath=item["file"], guess_original_bind_pose=False)
        for thing in bpy.data.objects:
            if thing.animation_data is None:
                continue
            for track in thing.animation_data.nla_tracks:
                track.mute = True
            wanted = [a for a in bpy.data.actions if a.name.startswith(item["animation"])]
            if wanted:
                mine = [a for a in wanted if a.name.endswith(thing.name)]
                thing.animation_data.action = (mine or wanted)[0]
    return scene


def world_position(name):
    """Of a bone's head or an object, y up."""
    for thing in bpy.data.objects:
        if thing.type == "ARMATURE" and name in thing.pose.bones:
            at = thing.matrix_world @ thing.pose.bones[name].head
            return (at.x, at.z, -at.y)
    if name in bpy.data.objects:
        at = bpy.data.objects[name].matrix_world.translation
        return (at.x, at.z, -at.y)
    return None


def largest_distance(item):
    scene = load(item)
    rate = scene.render.fps / scene.render.fps_base
    largest, compared = 0.0, 0
    for time, positions in zip(item["times"], item["positions"]):
        frame = time * rate
        scene.frame_set(int(frame), subframe=frame - int(frame))
        bpy.context.view_layer.update()
        for name, wanted in zip(item["names"], positions):
            found = world_position(name)
            if found is None:
                continue
            distance = sum((a - b) ** 2 for a, b in zip(found, wanted)) ** 0.5
            largest = max(largest, distance)
            compared += 1
    return largest, compared


def main():
    items = json.loads(pathlib.Path(sys.argv[-1]).read_text())
    failures = 0
    for item in items:
        distance, compared = largest_distance(item)
        good = compared > 0 and distance <= item["tolerance"]
        print(f"{item['name']}: {compared} positions, largest distance {distance:.3g} of {item['tolerance']:.3g}")
        failures += 0 if good else 1
    print(f"{len(items)} files played in Blender, {failures} that differ")
    sys.exit(0 if items and failures == 0 else 1)


main()
