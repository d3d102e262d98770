"""The figure's joints: a man of 1.78 m in T-pose, facing +z, left = +x, palms down.

Segment lengths are those of de Leva 1996 (men) scaled to 1.78 m: upper arm 0.288, forearm 0.275, hand 0.192, trunk 0.606
(hips to the base of the neck), foot 0.264. Thigh and shank are 0.420 and 0.436: 2 % less than scaled, so that the parts
add up to the height. Knees and elbows are bent by 3 degrees, the way they go.
"""

from mannequin.maths import add, mirror, multiply, rotate, sub

HEIGHT_M = 1.78

# name: (parent, position in the world at rest, metres); all local rotations are the identity at rest
_CENTRE = {
    "Hips": (None, (0.0, 0.985, 0.0)),
    "Spine": ("Hips", (0.0, 1.075, -0.012)),
    "Spine1": ("Spine", (0.0, 1.180, -0.012)),
    "Spine2": ("Spine1", (0.0, 1.285, -0.016)),
    "Neck": ("Spine2", (0.0, 1.515, -0.030)),
    "Head": ("Neck", (0.0, 1.600, -0.005)),
    "HeadTop_End": ("Head", (0.0, 1.780, 0.0)),
}
_SIDE = {
    "Shoulder": ("Spine2", (0.035, 1.460, -0.010)),
    "Arm": ("Shoulder", (0.178, 1.440, -0.020)),
    "ForeArm": ("Arm", (0.466, 1.440, -0.026)),
    "Hand": ("ForeArm", (0.741, 1.440, -0.020)),
    "HandThumb1": ("Hand", (0.765, 1.430, 0.012)),
    "HandIndex1": ("Hand", (0.834, 1.440, 0.008)),
    "HandMiddle1": ("Hand", (0.838, 1.441, -0.015)),
    "HandRing1": ("Hand", (0.832, 1.440, -0.037)),
    "HandPinky1": ("Hand", (0.820, 1.437, -0.057)),
    "UpLeg": ("Hips", (0.092, 0.926, 0.0)),
    "Leg": ("UpLeg", (0.092, 0.506, 0.004)),
    "Foot": ("Leg", (0.092, 0.070, -0.014)),
    "ToeBase": ("Foot", (0.096, 0.020, 0.115)),
    "Toe_End": ("ToeBase", (0.097, 0.012, 0.190)),
}


def _joints():
    joints = dict(_CENTRE)
    for side, place in (("Left", lambda p: p), ("Right", mirror)):
        for name, (parent, position) in _SIDE.items():
            joints[side + name] = (parent if parent in _CENTRE else side + parent, place(position))
    return joints


def _depth_first(joints, root):
    names = [root]
    for name, (parent, _) in joints.items():
        if parent == root:
            names += _depth_first(joints, name)
    return names


_JOINTS = _joints()
NAMES = _depth_first(_JOINTS, "Hips")
PARENT = {name: _JOINTS[name][0] for name in NAMES}
REST = {name: _JOINTS[name][1] for name in NAMES}
OFFSET = {name: sub(REST[name], REST[PARENT[name]]) if PARENT[name] else REST[name] for name in NAMES}
CHILDREN = {name: [child for child in NAMES if PARENT[child] == name] for name in NAMES}


def world(pose):
    """Position and rotation of every joint. `pose`: {"translation": of the hips, joint name: local rotation}."""
    placed = {}
    for name in NAMES:
        local = pose.get(name, (0.0, 0.0, 0.0, 1.0))
        if PARENT[name] is None:
            placed[name] = (pose["translation"], local)
        else:
            position, rotation = placed[PARENT[name]]
            placed[name] = (add(position, rotate(rotation, OFFSET[name])), multiply(rotation, local))
    return placed
