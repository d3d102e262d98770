"""A clip of the figure's skeleton as BVH, in centimetres and degrees."""

import math

from mannequin.maths import scale
from mannequin.skeleton import CHILDREN, OFFSET

ROTATIONS = "Zrotation Xrotation Yrotation"


def _numbers(values):
    return " ".join(f"{value + 0.0:.6f}" for value in values)


def _joint(name, depth, order):
    order.append(name)
    pad, inner = "\t" * depth, "\t" * (depth + 1)
    root = depth == 0
    offset = (0.0, 0.0, 0.0) if root else scale(OFFSET[name], 100.0)
    channels = f"6 Xposition Yposition Zposition {ROTATIONS}" if root else f"3 {ROTATIONS}"
    lines = [f"{pad}{'ROOT' if root else 'JOINT'} {name}", pad + "{"]
    lines += [f"{inner}OFFSET {_numbers(offset)}", f"{inner}CHANNELS {channels}"]
    for child in CHILDREN[name]:
        lines += _joint(child, depth + 1, order)
    if not CHILDREN[name]:
        lines += [f"{inner}End Site", inner + "{", f"{inner}\tOFFSET {_numbers(_tip(name))}", inner + "}"]
    return [*lines, pad + "}"]


def _tip(name):
    """End of a last joint, centimetres from it."""
    if name == "HeadTop_End":
        return (0.0, 1.0, 0.0)
    if name.endswith("Toe_End"):
        return (0.0, 0.0, 1.0)
    side = 1.0 if name.startswith("Left") else -1.0
    if name.endswith("Thumb1"):
        return (4.5 * side, -2.0, 4.0)
    return ((6.0 if name.endswith("Pinky1") else 8.0) * side, -1.0, 0.0)


def _euler_zxy(q):
    """Degrees about z, x and y with rotation = Rz Rx Ry."""
    x, y, z, w = q
    sine = min(max(2 * (y * z + w * x), -1.0), 1.0)
    about_z = math.atan2(2 * (w * z - x * y), 1 - 2 * (x * x + z * z))
    about_y = math.atan2(2 * (w * y - x * z), 1 - 2 * (x * x + y * y))
    return [math.degrees(angle) for angle in (about_z, math.asin(sine), about_y)]


def bvh(clip):
    order = []
    lines = ["HIERARCHY", *_joint("Hips", 0, order), "MOTION"]
    lines += [f"Frames: {len(clip.poses)}", f"Frame Time: {1.0 / clip.fps:.8f}"]
    for pose in clip.poses:
        row = list(scale(pose["translation"], 100.0))
        for name in order:
            row += _euler_zxy(pose.get(name, (0.0, 0.0, 0.0, 1.0)))
        lines.append(_numbers(row))
    return "\n".join(lines) + "\n"
