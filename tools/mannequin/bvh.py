"""A clip of the figure's skeleton as BVH, in centimetres and degrees."""

import math

from mannequin.maths import scale
from mannequin.skeleton import CHILDREN, OFFSET

ROTATIONS = "Zrotation Xrotation Yrotation"


def _numbers(values):
    return " ".join(f"{value + 0.0:.6f}" for value in values)


def _is_end(name):
    return name.endswith("_End")


def _joint(name, depth, order):
    order.append(name)
    pad, inner = "\t" * depth, "\t" * (depth + 1)
    root = depth == 0
    offset = (0.0, 0.0, 0.0) if root else scale(OFFSET[name], 100.0)
    channels = f"6 Xposition Yposition Zposition {ROTATIONS}" if root else f"3 {ROTATIONS}"
    lines = [f"{pad}{'ROOT' if root else 'JOINT'} {name}", pad + "{"]
    lines += [f"{inner}OFFSET {_numbers(offset)}", f"{inner}CHANNELS {channels}"]
    children = CHILDREN[name]
    for child in children:
        lines += _end_site(scale(OFFSET[child], 100.0), inner) if _is_end(child) else _joint(child, depth + 1, order)
    if not children:
        lines += _end_site(_fingertip(name), inner)
    return [*lines, pad + "}"]


def _end_site(offset, pad):
    return [f"{pad}End Site", pad + "{", f"{pad}\tOFFSET {_numbers(offset)}", pad + "}"]


def _fingertip(name):
    """Tip of a finger, centimetres from its base."""
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
