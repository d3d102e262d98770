# SPDX-License-Identifier: GPL-3.0-or-later
"""An armature as the program reads it: a glTF whose nodes stand in a pose of the scene.

The file is written here and not by Blender's exporter, because the nodes must be the bones in the armature's own
order, standing as they stand in the scene, and because an exporter changes with every version. Node 0 is the armature
object, node i + 1 its bone i.
"""

import math

from mathutils import Matrix, Quaternion

from . import control_rigs, glb

# Blender is z up, glTF y up.
GLTF_FROM_WORLD = Matrix.Rotation(-math.pi / 2, 4, "X")

MOST_TRIANGLES = 30000  # of all meshes together: the program looks at the body's extent only


class RigError(Exception):
    """`str()`: why this armature cannot be served, for the artist."""


class Skeleton:
    """The bones that the program gets, parents before children, and the parent of each among them (or None)."""

    def __init__(self, armature):
        self.bones = control_rigs.deform_bones(armature) or list(armature.data.bones)
        self.parents = control_rigs.deform_parents(armature, self.bones)
        self.names = [bone.name for bone in self.bones]


def check(armature):
    """Raises RigError where the armature cannot be baked."""
    if armature is None or armature.type != "ARMATURE":
        raise RigError("select an armature: its pose is where the reaction starts")
    if armature.library is not None and armature.override_library is None:
        raise RigError(f"'{armature.name}' is linked from another file: make a library override of it first")
    if armature.data.pose_position == "REST":
        raise RigError(f"'{armature.name}' shows its rest position: set Pose Position in the armature's properties")
    if not armature.data.bones:
        raise RigError(f"'{armature.name}' has no bones")
    scale = armature.matrix_world.to_scale()
    if min(abs(s) for s in scale) < 1e-9:
        raise RigError(f"'{armature.name}' has a scale of 0")
    if max(scale) - min(scale) > 1e-4 * max(abs(s) for s in scale):
        raise RigError(f"'{armature.name}' has a scale that is not the same along all axes: apply it (Ctrl A)")
    if armature.matrix_world.determinant() < 0:
        raise RigError(f"'{armature.name}' is mirrored: apply its scale (Ctrl A)")


class Pose:
    """Where the object and its bones stand at one frame: world matrices of glTF and local ones."""

    def __init__(self, armature, depsgraph):
        evaluated = armature.evaluated_get(depsgraph)
        self.object = GLTF_FROM_WORLD @ evaluated.matrix_world
        self.bones = {bone.name: bone.matrix.copy() for bone in evaluated.pose.bones}

    def locals(self, skeleton):
        """The local transforms of node 0 and the bones: (translation, rotation, scale)."""
        yield self.object.decompose()
        for name in skeleton.names:
            matrix, parent = self.bones[name], skeleton.parents[name]
            yield (self.bones[parent].inverted_safe() @ matrix if parent else matrix).decompose()


def _xyzw(rotation):
    return [rotation.x, rotation.y, rotation.z, rotation.w]


def _columns(matrix):
    return [matrix[row][column] for column in range(4) for row in range(4)]


def _add_nodes(document, armature, skeleton, pose):
    index = {name: i + 1 for i, name in enumerate(skeleton.names)}
    children = {}
    for name, parent in skeleton.parents.items():
        children.setdefault(index[parent] if parent else 0, []).append(index[name])
    names = [armature.name, *skeleton.names]
    for i, (translation, rotation, scale) in enumerate(pose.locals(skeleton)):
        node = {"name": names[i], "translation": list(translation), "rotation": _xyzw(rotation), "scale": list(scale)}
        if i in children:
            node["children"] = children[i]
        document.add("nodes", node)
    document.json["scenes"][0]["nodes"].append(0)
    # The bind pose, in the armature's space: Blender's rest pose.
    inverse = [value for bone in skeleton.bones for value in _columns(bone.matrix_local.inverted_safe())]
    document.add("skins", {"joints": list(index.values()), "inverseBindMatrices": document.add_accessor(inverse, "MAT4")})


def meshes_of(armature, objects):
    """The mesh objects among `objects` that move with the armature: (object, bone that carries it whole or None)."""
    found = []
    for thing in objects:
        if thing.type != "MESH" or not thing.data.vertices:
            continue
        deforms = any(m.type == "ARMATURE" and m.object == armature and m.show_viewport for m in thing.modifiers)
        if deforms or (thing.parent == armature and thing.parent_type == "ARMATURE"):
            found.append((thing, None))
        elif thing.parent == armature and thing.parent_type == "BONE" and thing.parent_bone in armature.data.bones:
            found.append((thing, thing.parent_bone))
    return found


def _influences(vertex, joints, fallback):
    """Four joints and weights of a vertex that sum to 1."""
    weights = sorted(((g.weight, joints[g.group]) for g in vertex.groups if g.group in joints and g.weight > 0), reverse=True)[:4]
    total = sum(weight for weight, _ in weights)
    if total <= 0:
        return (None, None) if fallback is None else ((fallback, 0, 0, 0), (1.0, 0.0, 0.0, 0.0))
    padding = [0] * (4 - len(weights))
    return tuple([joint for _, joint in weights] + padding), tuple([weight / total for weight, _ in weights] + padding)


def _rest_from_object(armature, thing, carrier):
    """Takes a mesh's vertices into the armature's rest pose."""
    to_armature = armature.matrix_world.inverted() @ thing.matrix_world
    if carrier is None:
        return to_armature
    return armature.data.bones[carrier].matrix_local @ armature.pose.bones[carrier].matrix.inverted_safe() @ to_armature


def _mirrors(thing):
    """Reflections (object space) that Mirror modifiers add to a mesh."""
    reflections = [Matrix.Identity(4)]
    for modifier in thing.modifiers:
        if modifier.type != "MIRROR" or not modifier.show_viewport:
            continue
        frame = thing.matrix_world.inverted() @ modifier.mirror_object.matrix_world if modifier.mirror_object else Matrix.Identity(4)
        for axis in range(3):
            if modifier.use_axis[axis]:
                flip = frame @ Matrix.Scale(-1.0, 4, [float(i == axis) for i in range(3)]) @ frame.inverted()
                reflections += [flip @ other for other in reflections]
    return reflections


def _other_side(name):
    """The name of the bone on the other side."""
    for left, right in ((".L", ".R"), (".l", ".r"), ("_L", "_R"), ("_l", "_r"), ("Left", "Right"), ("left", "right")):
        for a, b in ((left, right), (right, left)):
            if name.endswith(a) or (len(a) > 2 and name.startswith(a)):
                return name[: -len(a)] + b if name.endswith(a) else b + name[len(a) :]
    return name


def _add_mesh(document, armature, skeleton, thing, carrier, every):
    joint = {name: i for i, name in enumerate(skeleton.names)}
    if carrier is not None and carrier not in joint:
        return
    groups = {g.index: joint[g.name] for g in thing.vertex_groups if g.name in joint}
    other = {g.index: joint.get(_other_side(g.name), joint[g.name]) for g in thing.vertex_groups if g.name in joint}
    rest = _rest_from_object(armature, thing, carrier)
    fallback = joint[carrier] if carrier else None
    positions, joints, weights, indices = [], [], [], []
    mesh = thing.data
    mesh.calc_loop_triangles()
    triangles = [tuple(t.vertices) for t in list(mesh.loop_triangles)[::every]]
    for reflection in _mirrors(thing):
        place = rest @ reflection
        groups_here = groups if reflection.determinant() > 0 else other
        where = {}
        for triangle in triangles:
            corners = []
            for v in triangle:
                if v not in where:
                    own_joints, own_weights = _influences(mesh.vertices[v], groups_here, fallback)
                    where[v] = None if own_joints is None else len(positions) // 3
                    if own_joints is not None:
                        positions.extend(place @ mesh.vertices[v].co)
                        joints.extend(own_joints)
                        weights.extend(own_weights)
                corners.append(where[v])
            if None not in corners:
                indices.extend(corners)
    if not indices:
        return
    attributes = {
        "POSITION": document.add_accessor(positions, "VEC3", bounds=True),
        "JOINTS_0": document.add_accessor(joints, "VEC4", glb.USHORT),
        "WEIGHTS_0": document.add_accessor(weights, "VEC4"),
    }
    primitive = {"attributes": attributes, "indices": document.add_accessor(indices, "SCALAR", glb.UINT)}
    mesh_index = document.add("meshes", {"name": thing.name, "primitives": [primitive]})
    node = document.add("nodes", {"name": thing.name, "mesh": mesh_index, "skin": 0})
    document.json["scenes"][0]["nodes"].append(node)


def _add_motion(document, skeleton, poses, fps):
    """The poses as a clip named "scene", one key each."""
    frames = [list(pose.locals(skeleton)) for pose in poses]
    times = document.add_accessor([i / fps for i in range(len(frames))], "SCALAR", bounds=True)
    samplers, channels = [], []
    for node in range(len(skeleton.names) + 1):
        last = Quaternion()
        rotations = []
        for frame in frames:
            rotation = frame[node][1]
            if last.dot(rotation) < 0:
                rotation = -rotation
            last = rotation
            rotations.extend(_xyzw(rotation))
        for path, values, kind in (
            ("translation", [v for frame in frames for v in frame[node][0]], "VEC3"),
            ("rotation", rotations, "VEC4"),
        ):
            samplers.append({"input": times, "output": document.add_accessor(values, kind)})
            channels.append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})
    document.add("animations", {"name": "scene", "samplers": samplers, "channels": channels})


def write(path, armature, pose, objects, motion=(), fps=60.0):
    """Writes the armature, standing in `pose`, with the meshes among `objects` that move with it. `motion`: poses of
    frames in a row, as a clip."""
    skeleton = Skeleton(armature)
    document = glb.Document()
    _add_nodes(document, armature, skeleton, pose)
    meshes = meshes_of(armature, objects)
    triangles = sum(len(thing.data.polygons) * 2 for thing, _ in meshes)
    for thing, carrier in meshes:
        _add_mesh(document, armature, skeleton, thing, carrier, max(1, math.ceil(triangles / MOST_TRIANGLES)))
    if motion:
        _add_motion(document, skeleton, motion, fps)
    document.write(path)
