# SPDX-License-Identifier: GPL-3.0-or-later
"""A baked clip on the armature that it was baked for."""

import math

from mathutils import Matrix, Quaternion, Vector

from . import control_rigs
from .rig import GLTF_FROM_WORLD, Skeleton


class Track:
    """What one bone (or the object, with `bone` None) does: for every frame, what Blender's channels hold."""

    def __init__(self, bone):
        self.bone = bone
        self.locations, self.rotations = [], []


def _parents(clip):
    return {child: index for index, node in enumerate(clip.nodes) for child in node.get("children", [])}


def _local(clip, index, frame=None):
    """A node's transform at a frame, or as it stands in the file."""
    node, moving = clip.nodes[index], clip.channels.get(index, {}) if frame is not None else {}
    place = moving["translation"][frame] if "translation" in moving else node.get("translation", (0, 0, 0))
    x, y, z, w = moving["rotation"][frame] if "rotation" in moving else node.get("rotation", (0, 0, 0, 1))
    scale = moving["scale"][frame] if "scale" in moving else node.get("scale", (1, 1, 1))
    return Matrix.LocRotScale(Vector(place), Quaternion((w, x, y, z)), Vector(scale))


def _worlds(clip, wanted, frame=None):
    """World matrices of glTF of the nodes wanted, by index."""
    parents, found = _parents(clip), {}

    def world(index):
        if index not in found:
            own = _local(clip, index, frame)
            found[index] = world(parents[index]) @ own if index in parents else own
        return found[index]

    return {index: world(index) for index in wanted}


def _carrier(armature, clip):
    """The node that the program added to carry the root motion, between the armature and its bones, or 0."""
    bones = len(Skeleton(armature).names)
    parents = _parents(clip)
    return next((parents[i] for i in range(1, bones + 1) if parents.get(i, 0) > bones), 0)


def poses_of(armature, clip):
    """For each frame of the clip: the object's world matrix, and the bones' matrices in the armature's space by name."""
    names = Skeleton(armature).names
    world_from_gltf, carrier = GLTF_FROM_WORLD.inverted(), _carrier(armature, clip)
    wanted = [0, carrier, *range(1, len(names) + 1)]
    still = _worlds(clip, [0, carrier])
    object_from_carrier = still[carrier].inverted() @ still[0]
    for frame in range(len(clip.times)):
        world = _worlds(clip, wanted, frame)
        of_object = world[carrier] @ object_from_carrier
        inverse = of_object.inverted()
        yield world_from_gltf @ of_object, {name: inverse @ world[i + 1] for i, name in enumerate(names)}


def moved_bones(armature, clip):
    """Names of the bones that the clip moves."""
    return [name for i, name in enumerate(Skeleton(armature).names) if i + 1 in clip.channels]


def moves_object(armature, clip):
    return _carrier(armature, clip) in clip.channels


def tracks_of(armature, clip):
    """The clip as Blender's channels of a rig whose bones have no constraints."""
    moved = [armature.data.bones[name] for name in moved_bones(armature, clip)]
    tracks = {bone.name: Track(bone.name) for bone in moved}
    whole = Track(None)
    for of_object, matrices in poses_of(armature, clip):
        _add_object(whole, armature, of_object)
        for bone in moved:
            parent = bone.parent
            above = {"parent_matrix": matrices[parent.name], "parent_matrix_local": parent.matrix_local} if parent else {}
            basis = bone.convert_local_to_pose(matrices[bone.name], bone.matrix_local, invert=True, **above)
            _add(tracks[bone.name], basis)
    return ([whole] if moves_object(armature, clip) else []) + list(tracks.values())


def control_tracks(context, armature, clip):
    """The clip as channels of a control rig's FK controls: each frame the controls are held where the deform bones
    are to be, and what their own channels must be for that is read back."""
    controls = control_rigs.controls_of(armature, moved_bones(armature, clip))
    tracks = {control: Track(control) for control, _ in controls}
    whole = Track(None)
    with control_rigs.Followers(context, armature, controls) as followers:
        for of_object, matrices in poses_of(armature, clip):
            _add_object(whole, armature, of_object)
            followers.hold(armature.matrix_world, matrices)
            context.view_layer.update()
            evaluated = armature.evaluated_get(context.evaluated_depsgraph_get()).pose.bones
            for control, track in tracks.items():
                _add(track, _basis(armature.data.bones[control], evaluated))
    return ([whole] if moves_object(armature, clip) else []) + list(tracks.values())


def _basis(bone, posed):
    """What the bone's channels must be for its matrix in `posed`, below the matrix that its parent has there."""
    parent = bone.parent
    above = {"parent_matrix": posed[parent.name].matrix, "parent_matrix_local": parent.matrix_local} if parent else {}
    return bone.convert_local_to_pose(posed[bone.name].matrix, bone.matrix_local, invert=True, **above)


def _add(track, basis):
    rotation = basis.to_quaternion()
    if track.rotations and track.rotations[-1].dot(rotation) < 0:
        rotation.negate()
    track.rotations.append(rotation)
    track.locations.append(basis.to_translation())


def _add_object(track, armature, world):
    """The object's own channels, below its parent and its delta transforms."""
    above = armature.matrix_world @ armature.matrix_basis.inverted_safe()
    _add(track, above.inverted_safe() @ world)


class Curves:
    """The curves of an action for one object, whatever this Blender's actions are made of."""

    def __init__(self, action, owner):
        self.action, self.slot = action, None
        if hasattr(action, "slots"):  # since 4.4
            self.slot = next((s for s in action.slots if s.target_id_type in ("OBJECT", "UNSPECIFIED")), None)
            if self.slot is None:
                self.slot = action.slots.new(id_type="OBJECT", name=owner.name)
            layer = action.layers[0] if action.layers else action.layers.new("Layer")
            strip = layer.strips[0] if layer.strips else layer.strips.new(type="KEYFRAME")
            self._bag = strip.channelbag(self.slot, ensure=True)
            self._curves = self._bag.fcurves
        else:
            self._curves = action.fcurves

    def find(self, path, index):
        return self._curves.find(path, index=index)

    def new(self, path, index, group):
        if self.slot is None:
            return self._curves.new(path, index=index, action_group=group)
        try:
            return self._curves.new(path, index=index, group_name=group)
        except TypeError:  # before 5.0
            curve = self._curves.new(path, index=index)
            curve.group = self._bag.groups.get(group) or self._bag.groups.new(group)
            return curve

    def assign(self, animation):
        animation.action = self.action
        if self.slot is not None:
            animation.action_slot = self.slot


def _rotation_channels(target, track):
    """The property that the target's rotation mode reads, and its values."""
    mode = target.rotation_mode
    if mode == "QUATERNION":
        return "rotation_quaternion", [tuple(q) for q in track.rotations]
    if mode == "AXIS_ANGLE":
        pairs = [q.to_axis_angle() for q in track.rotations]
        return "rotation_axis_angle", [(angle, *axis) for axis, angle in pairs]
    values, last = [], None
    for q in track.rotations:
        euler = q.to_euler(mode, last) if last else q.to_euler(mode, target.rotation_euler)
        values.append(tuple(euler))
        last = euler
    return "rotation_euler", values


_SHAPE = ("interpolation", "easing", "back", "amplitude", "period")


def _write_curve(curves, path, index, group, frames, values):
    """Keys the frames. Before the first of them the curve stays what it was, at every whole frame."""
    curve = curves.find(path, index)
    if curve is None:
        curve = curves.new(path, index, group)
    points = curve.keyframe_points
    kept = [p for p in points if p.co[0] < frames[0] - 1e-3]
    shapes = [{name: getattr(p, name) for name in _SHAPE} for p in kept]
    handles = [(tuple(p.co), tuple(p.handle_left), tuple(p.handle_right)) for p in kept]
    first = math.floor(kept[-1].co[0]) + 1 if kept else frames[0]
    between = range(first, math.ceil(frames[0] - 1e-3)) if kept else ()
    keys = [co for co, _, _ in handles] + [(frame, curve.evaluate(frame)) for frame in between] + list(zip(frames, values))
    while len(points):
        points.remove(points[-1], fast=True)
    points.add(len(keys))
    points.foreach_set("co", [number for key in keys for number in key])
    for point in points:
        point.interpolation = "LINEAR"
    for point, shape, (_, left, right) in zip(points, shapes, handles):
        for name, value in shape.items():
            setattr(point, name, value)
        point.handle_left_type = point.handle_right_type = "FREE"
        point.handle_left, point.handle_right = left, right
    if kept:
        points[len(kept) - 1].interpolation = "LINEAR"
    curve.update()


def _still(values, tolerance):
    return all(abs(a - b) <= tolerance for value in values for a, b in zip(value, values[0]))


def write(curves, armature, tracks, first_frame):
    """Keys every frame of the tracks, in place of what the curves held from there on."""
    for track in tracks:
        target = armature if track.bone is None else armature.pose.bones[track.bone]
        prefix = "" if track.bone is None else target.path_from_id() + "."
        group = "Object Transforms" if track.bone is None else track.bone
        frames = [first_frame + i for i in range(len(track.rotations))]
        path, values = _rotation_channels(target, track)
        for index in range(len(values[0])):
            _write_curve(curves, prefix + path, index, group, frames, [value[index] for value in values])
        places = [tuple(place) for place in track.locations]
        held = tuple(target.location)
        moves = not _still([held, *places], 1e-6 * max(1.0, *map(abs, held)))
        if track.bone is not None and target.bone.use_connect and target.parent:
            continue  # has no location of its own
        if moves or curves.find(prefix + "location", 0) is not None:
            for index in range(3):
                _write_curve(curves, prefix + "location", index, group, frames, [place[index] for place in places])


def switch(curves, switches, first_frame):
    """Keys the switches of a control rig, and sets them."""
    for bone, name, value in switches:
        bone[name] = value
        _write_curve(curves, f'{bone.path_from_id()}["{name}"]', 0, bone.name, [first_frame], [value])


def mark(action, marks, first_frame, fps):
    """Pose markers at the clip's moments: {name: seconds}."""
    for name, seconds in marks.items():
        if seconds is None or name == "start":
            continue
        marker = action.pose_markers.new(name.replace("_", " "))
        marker.frame = round(first_frame + seconds * fps)


def push(armature, curves, name, first_frame, muted=False):
    """The action as a strip of a new NLA track, on top of the others."""
    animation = armature.animation_data
    track = animation.nla_tracks.new()
    track.name = name
    strip = track.strips.new(name, int(first_frame), curves.action)
    if curves.slot is not None:
        strip.action_slot = curves.slot
    strip.extrapolation = "HOLD_FORWARD"
    track.mute = muted
    return track
