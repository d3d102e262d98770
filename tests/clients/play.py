"""In Blender, LIST.json: what play.mjs does in three.js.

Imports every {name, file, animation, times, nodes, positions, tolerance} of the list (.glb or .bvh) as its menu does,
plays it at the times and compares the head of every bone, or the place of every object, with ours: a node is a glTF
index or a place among the joints of a BVH.
"""

import json
import pathlib
import sys

import bpy
from mathutils import Vector

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "tools" / "blender"))
import shims  # noqa: E402

shims.install()
from io_scene_gltf2.blender.imp.gltf2_blender_gltf import BlenderGlTF  # noqa: E402


def import_glb(item):
    """Where each node is, and the frame at which time starts.

    The file's other clips are left out: what an action does not key, Blender leaves as the one before it did, and
    which one that is has to do with the order of clicks. Nodes that hold a skinned mesh are left out too: they have
    no place of their own in glTF, and Blender puts them below the armature.
    """
    imported = []
    create = BlenderGlTF.create

    def create_with_one_clip(gltf):
        gltf.data.animations = [clip for clip in gltf.data.animations if clip.name == item["animation"]]
        imported.append(gltf)
        create(gltf)

    BlenderGlTF.create = staticmethod(create_with_one_clip)
    bpy.ops.import_scene.gltf(filepath=item["file"])
    BlenderGlTF.create = create
    gltf = imported[0]
    if len(gltf.data.animations) != 1:
        return {}, 0

    def place_of(vnode):
        if getattr(vnode, "blender_bone_name", None) is None:
            return lambda: vnode.blender_object.matrix_world.translation
        armature = gltf.vnodes[vnode.bone_arma].blender_object
        bone = armature.pose.bones[vnode.blender_bone_name]
        return lambda: armature.matrix_world @ bone.head

    return {node: place_of(gltf.vnodes[node]) for node in item["nodes"] if gltf.data.nodes[node].skin is None}, 0


def import_bvh(item):
    """Where each joint is, and the frame at which time starts."""
    bpy.ops.import_anim.bvh(filepath=item["file"], update_scene_fps=True)
    armature = bpy.context.object
    lines = [line.split(maxsplit=1) for line in pathlib.Path(item["file"]).read_text().splitlines()]
    names = [line[1].strip() for line in lines if line[:1] in (["ROOT"], ["JOINT"])]

    def place_of(name):
        bone = armature.pose.bones[name]
        return lambda: armature.matrix_world @ bone.head

    return {node: place_of(names[node]) for node in item["nodes"]}, 1


def show(time, first_frame):
    render = bpy.context.scene.render
    frame = first_frame + time * render.fps / render.fps_base
    whole = int(frame + 1e-6)
    bpy.context.scene.frame_set(whole, subframe=max(frame - whole, 0.0))


def check(item):
    """Prints the largest distance; whether it is small enough."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    places, first_frame = (import_bvh if item["file"].endswith(".bvh") else import_glb)(item)
    largest, worst = 0.0, "none"
    for time, positions in zip(item["times"], item["positions"]):
        show(time, first_frame)
        for node, (x, y, z) in zip(item["nodes"], positions):
            if node not in places:
                continue
            distance = (places[node]() - Vector((x, -z, y))).length
            if not distance <= largest:
                largest, worst = distance, f"node {node} at {time:.3f} s"
    good = len(places) >= 15 and len(item["times"]) >= 10 and largest <= item["tolerance"]
    print(
        f"{item['name']}: {len(places)} nodes, largest distance {largest:.2e}, {worst}"
        f" (at most {item['tolerance']:.2e}){'' if good else '  FAILED'}"
    )
    return good


items = json.loads(pathlib.Path(sys.argv[-1]).read_text())
failures = [item["name"] for item in items if not check(item)]
print(f"{len(items)} clips played, {len(failures)} wrong")
sys.exit(1 if failures or not items else 0)
