"""What the tests in Blender share: the add-on, a rig from a file, and what the program itself wrote."""

import json
import math
import pathlib
import shutil
import struct
import sys

import bpy
from mathutils import Matrix, Quaternion, Vector

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "tools" / "blender"))
import shims  # noqa: E402


def arguments():
    return sys.argv[sys.argv.index("--") + 1 :]


def begin():
    """An empty scene with the add-on, as a user has it who installed it."""
    shims.install()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="ukemi")


def load(path):
    """Imports a file as its menu does. Returns its armature, which is active then."""
    path = str(path)
    before = set(bpy.data.objects)
    if path.endswith(".fbx"):
        bpy.ops.import_scene.fbx(filepath=path)
    elif path.endswith(".bvh"):
        bpy.ops.import_anim.bvh(filepath=path)
    else:
        bpy.ops.import_scene.gltf(filepath=path)
    armature = next(o for o in bpy.data.objects if o not in before and o.type == "ARMATURE")
    bpy.context.view_layer.objects.active = armature
    return armature


def keep_files(folder):
    """Lets the add-on's next bakes leave their files in `folder`: rig.glb, hit.glb, hit.json."""
    from ukemi import operators

    if hasattr(operators.Job, "keeps"):
        return
    operators.Job.keeps = True
    close = operators.Job.close

    def close_and_keep(job):
        shutil.rmtree(folder, ignore_errors=True)
        shutil.copytree(job.folder, folder)
        close(job)

    operators.Job.close = close_and_keep


class Played:
    """A clip of a glTF, evaluated as the glTF specification says: slerp between keys."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        length = struct.unpack_from("<I", data, 12)[0]
        self.json = json.loads(data[20 : 20 + length])
        self.binary = data[28 + length :]
        self.nodes = self.json["nodes"]
        self.parent = {child: i for i, node in enumerate(self.nodes) for child in node.get("children", [])}
        animation = self.json["animations"][-1]
        self.channels = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            times = [t[0] for t in self.numbers(sampler["input"])]
            key = channel["target"]["node"], channel["target"]["path"]
            self.channels[key] = times, self.numbers(sampler["output"])
        self.duration = max(times[-1] for times, _ in self.channels.values())

    def numbers(self, index):
        accessor = self.json["accessors"][index]
        assert accessor["componentType"] == 5126
        view = self.json["bufferViews"][accessor["bufferView"]]
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[accessor["type"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", width * 4)
        return [struct.unpack_from(f"<{width}f", self.binary, start + i * stride) for i in range(accessor["count"])]

    def at(self, node, path, time):
        if (node, path) not in self.channels:
            rest = {"translation": (0, 0, 0), "rotation": (0, 0, 0, 1), "scale": (1, 1, 1)}[path]
            return tuple(self.nodes[node].get(path, rest))
        times, values = self.channels[node, path]
        after = next((i for i, t in enumerate(times) if t >= time), len(times) - 1)
        before = max(0, after - 1)
        span = times[after] - times[before]
        share = min(1.0, max(0.0, (time - times[before]) / span)) if span > 0 else 1.0
        a, b = values[before], values[after]
        if path != "rotation":
            return tuple(x + share * (y - x) for x, y in zip(a, b))
        q = Quaternion((a[3], *a[:3])).slerp(Quaternion((b[3], *b[:3])), share)
        return q.x, q.y, q.z, q.w

    def world(self, node, time):
        x, y, z, w = self.at(node, "rotation", time)
        own = Matrix.LocRotScale(Vector(self.at(node, "translation", time)), Quaternion((w, x, y, z)), Vector(self.at(node, "scale", time)))
        return self.world(self.parent[node], time) @ own if node in self.parent else own

    def place(self, name, time):
        """Where the node of that name is, in Blender's world."""
        node = next(i for i, n in enumerate(self.nodes) if n.get("name") == name and (i > 0 or len(self.nodes) == 1))
        x, y, z = self.world(node, time).translation
        return Vector((x, -z, y))


def bone_places(armature, names, frame):
    """Where the heads of bones are at a frame, in the world."""
    scene = bpy.context.scene
    scene.frame_set(math.floor(frame), subframe=frame - math.floor(frame))
    evaluated = armature.evaluated_get(bpy.context.evaluated_depsgraph_get())
    return [evaluated.matrix_world @ evaluated.pose.bones[name].head for name in names]


def largest_distance(armature, played, first_frame, names, times):
    """The farthest that a bone is from where the program put it, metres, and which."""
    fps = bpy.context.scene.render.fps / bpy.context.scene.render.fps_base
    worst = (0.0, "", 0.0)
    for time in times:
        for name, place in zip(names, bone_places(armature, names, first_frame + time * fps)):
            worst = max(worst, ((place - played.place(name, time)).length, name, time))
    return worst
