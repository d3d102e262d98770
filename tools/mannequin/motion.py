"""The figure's clips: standing idle, and a walk whose feet stay where they are put.

The walk follows the course of gait analysis (knee: 5 degrees at heel strike, 15 while loading, 5 before the heel rises,
60 in swing). The hips' height is fitted to the knee of the standing leg; both legs are then solved for the ankles.
A phase is a fraction of the cycle, 0 at the heel strike of the leg in question.
"""

import math

from mannequin.figure import left_foot
from mannequin.maths import (add, cross, dot, from_axes, inverse, length, mirror, monotone, multiply, periodic, product,
                             rotate, scale, sub, turn, unit)
from mannequin.skeleton import OFFSET, REST

FPS = 60.0
THIGH, SHANK = OFFSET["LeftLeg"], OFFSET["LeftFoot"]


class Clip:
    def __init__(self, name, poses):
        self.name = name
        self.fps = FPS
        self.poses = poses


def mirror_rotation(q):
    return (q[0], -q[1], -q[2], q[3])


def set_both(pose, name, left, right):
    """`left` and `right` are both given for the left side; the right one is mirrored."""
    pose["Left" + name] = left
    pose["Right" + name] = mirror_rotation(right)


# --- legs -------------------------------------------------------------------------------------------------------------


def leg_line(bend):
    """Hip to ankle of a leg bent by `bend` degrees more than at rest, in the thigh's frame."""
    return add(THIGH, rotate(turn("x", bend), SHANK))


REST_BEND = math.degrees(math.acos(dot(unit(THIGH), unit(SHANK))))


def leg_reach(knee):
    """Hip to ankle distance at a knee flexion of `knee` degrees."""
    return length(leg_line(knee - REST_BEND))


def solve_leg(hip, ankle, forward):
    """World rotation of the thigh and bend of the knee beyond rest, degrees, that bring the ankle to its place."""
    to_ankle = sub(ankle, hip)
    wanted = length(to_ankle)
    low, high = -REST_BEND, 150.0
    if wanted > length(leg_line(low)):
        raise ValueError(f"the leg is {wanted - length(leg_line(low)):.4f} m too short")
    for _ in range(60):
        middle = (low + high) / 2.0
        low, high = (middle, high) if length(leg_line(middle)) > wanted else (low, middle)
    line = unit(leg_line(low))
    axis = (1.0, 0.0, 0.0)
    source = from_axes(axis, line, cross(axis, line))
    hinge = unit(cross(forward, scale(to_ankle, -1.0)))
    hinge = scale(hinge, -1.0)
    down = unit(to_ankle)
    target = from_axes(hinge, down, cross(hinge, down))
    return multiply(target, inverse(source)), low


def pose_leg(pose, side, pelvis, ankle, foot, toe_bend):
    """Sets one leg: `pelvis` (position, rotation), `ankle` and the foot's rotation in the world."""
    position, rotation = pelvis
    hip = add(position, rotate(rotation, OFFSET[side + "UpLeg"]))
    forward = rotate(foot, (0.0, 0.0, 1.0))
    flat = unit((forward[0], 0.0, forward[2]))
    thigh, bend = solve_leg(hip, ankle, flat)
    pose[side + "UpLeg"] = multiply(inverse(rotation), thigh)
    pose[side + "Leg"] = turn("x", bend)
    pose[side + "Foot"] = multiply(inverse(multiply(thigh, turn("x", bend))), foot)
    pose[side + "ToeBase"] = turn("x", -toe_bend)
    return bend + REST_BEND


# --- upper body -------------------------------------------------------------------------------------------------------


def hanging_arm(flexion, abduction, elbow, pronation):
    """Left arm from the T-pose: shoulder joint, forearm and hand, degrees."""
    shoulder = turn("z", -6.0)
    arm = product(inverse(shoulder), turn("x", -flexion), turn("z", abduction - 90.0))
    return {"Shoulder": shoulder, "Arm": arm, "ForeArm": product(turn("y", -elbow), turn("x", pronation))}


def relaxed_hand():
    """Fingers curled a little, more towards the small one."""
    curls = {"HandIndex1": 16.0, "HandMiddle1": 22.0, "HandRing1": 27.0, "HandPinky1": 31.0}
    hand = {"Hand": turn("z", -4.0), "HandThumb1": product(turn("y", 12.0), turn("x", 10.0))}
    return hand | {name: turn("z", -curl) for name, curl in curls.items()}


# --- idle -------------------------------------------------------------------------------------------------------------


def idle_pose(phase):
    wave, late = math.sin(2 * math.pi * phase), math.sin(2 * math.pi * phase - 0.8)
    pose = {"translation": (0.003 * wave, REST["Hips"][1] - 0.004, 0.002 * late), "Hips": turn("z", 0.25 * wave)}
    pelvis = (pose["translation"], pose["Hips"])
    for side, place in (("Left", lambda p: p), ("Right", mirror)):
        yaw = turn("y", 9.0 if side == "Left" else -9.0)
        pose_leg(pose, side, pelvis, place((0.098, REST["LeftFoot"][1], -0.012)), yaw, 0.0)
    pose["Spine"] = product(turn("x", 1.0), turn("z", -0.15 * wave))
    pose["Spine1"] = product(turn("x", 1.0 - 0.35 * late), turn("z", -0.10 * wave))
    pose["Spine2"] = turn("x", -1.5 - 0.45 * late)
    pose["Neck"] = turn("x", 1.5 + 0.4 * late)
    pose["Head"] = turn("x", -2.0 + 0.4 * late)
    arm = hanging_arm(-2.0 + 0.5 * late, 7.0 + 0.5 * late, 14.0 + 0.6 * late, 14.0) | relaxed_hand()
    arm["Shoulder"] = multiply(turn("z", 0.5 * late), arm["Shoulder"])
    for name, rotation in arm.items():
        set_both(pose, name, rotation, rotation)
    return pose


def idle():
    frames = int(FPS)
    return Clip("idle", [idle_pose(i / frames) for i in range(frames + 1)])


# --- walk -------------------------------------------------------------------------------------------------------------

CYCLE_S = 64.0 / 60.0
SPEED_M_S = 1.25
STRIDE_M = CYCLE_S * SPEED_M_S
REACH_M = 0.315  # hip joints behind the flat foot's ankle at heel strike
HALF_STEP_WIDTH_M = 0.058
TOE_OUT_DEG = 6.0
FLAT_AT, HEEL_OFF_AT, TOE_OFF_AT = 0.09, 0.36, 0.60

STANCE_KNEE = monotone([0.0, 0.05, 0.10, 0.15, 0.22, 0.30, 0.38, 0.44, 0.50, 0.56, 0.60],
                       [9.0, 13.0, 16.5, 16.5, 13.5, 9.0, 6.0, 7.0, 11.0, 20.0, 32.0])
HEEL_PITCH = monotone([0.0, 0.03, FLAT_AT], [18.0, 11.0, 0.0])  # degrees, toes up
SWING = [(0.69, 13.0, 59.0, -46.0), (0.77, 23.5, 57.0, -27.0), (0.84, 28.5, 40.0, -3.0), (0.91, 29.0, 19.0, 13.0),
         (0.96, 26.5, 8.5, 19.0)]  # phase, thigh and knee flexion, pitch of the foot

ANKLE_M = REST["LeftFoot"][1]
HEEL = (0.0, -ANKLE_M, -0.036)  # from the ankle; where the heel meets the floor
BALL = sub(REST["LeftToeBase"], REST["LeftFoot"])
FOOT_POINTS = [sub(p, REST["LeftFoot"]) for part in left_foot() if part.bones == "LeftFoot" for p in part.piece.positions]


def pitched(pitch, point):
    return rotate(turn("x", -pitch), point)


def heel_rocker(pitch):
    """Ankle (y, z) over a heel on the floor, z from the flat foot's ankle."""
    lowest = min(pitched(pitch, p)[1] for p in FOOT_POINTS)
    return -lowest, HEEL[2] - pitched(pitch, HEEL)[2]


def ball_rocker(pitch):
    """Ankle (y, z) over the ball of the foot and flat toes, z from the flat foot's ankle."""
    raised = pitched(pitch, BALL)
    return ANKLE_M + BALL[1] - raised[1], BALL[2] - raised[2]


def pelvis_rotation(phase):
    """Of the leg at `phase` as if it were the left one: it comes forward with its hip, the free side sinks."""
    a = 2 * math.pi * phase
    return product(turn("y", -5.0 * math.cos(a)), turn("z", 2.5 * math.sin(a + 0.7)), turn("x", 2.0))


def hip_joint(phase):
    """The leg's hip joint from the middle between both, and from the body's track sideways (left leg)."""
    half = scale(sub(OFFSET["LeftUpLeg"], OFFSET["RightUpLeg"]), 0.5)
    return add(rotate(pelvis_rotation(phase), half), (0.016 * math.cos(2 * math.pi * phase - 1.9), 0.0, 0.0))


def drop_to_ankle(phase, knee, ankle_ahead):
    """Height of the hips' middle over the ankle of a leg whose knee is bent by `knee` degrees."""
    x, y, z = hip_joint(phase)
    across = ankle_ahead - hips_ahead(phase) - z
    return math.sqrt(leg_reach(knee) ** 2 - across**2 - (x - HALF_STEP_WIDTH_M) ** 2) - y


def hips_ahead(phase):
    """Hip joints in front of the flat foot's ankle, metres."""
    return phase * STRIDE_M - REACH_M


def fit_hip_height():
    """Height of the hip joints over a step: mean and two harmonics, least squares on the standing leg's knee."""
    rows, heights = [], []
    for i in range(21):
        phase = 0.42 * i / 20
        y, z = heel_rocker(HEEL_PITCH(phase))
        heights.append(y + drop_to_ankle(phase, STANCE_KNEE(phase), z))
        rows.append(harmonics(phase))
    return solve_least_squares(rows, heights)


def harmonics(phase):
    a = 4 * math.pi * phase
    return [1.0, math.cos(a), math.sin(a), math.cos(2 * a), math.sin(2 * a)]


def solve_least_squares(rows, values):
    n = len(rows[0])
    matrix = [[sum(r[i] * r[j] for r in rows) for j in range(n)] + [sum(r[i] * v for r, v in zip(rows, values))]
              for i in range(n)]
    for i in range(n):
        pivot = matrix[i][i]
        matrix[i] = [value / pivot for value in matrix[i]]
        for k in range(n):
            if k != i:
                matrix[k] = [a - matrix[k][i] * b for a, b in zip(matrix[k], matrix[i])]
    return [row[n] for row in matrix]


HIP_HEIGHT = fit_hip_height()


def hip_height(phase):
    return sum(a * b for a, b in zip(HIP_HEIGHT, harmonics(phase)))


def push_off_pitch(phase):
    """Pitch of a foot on its ball that leaves the knee as STANCE_KNEE asks."""
    low, high = -70.0, 0.0
    for _ in range(50):
        pitch = (low + high) / 2.0
        y, z = ball_rocker(pitch)
        too_short = y + drop_to_ankle(phase, STANCE_KNEE(phase), z) > hip_height(phase)
        low, high = (pitch, high) if too_short else (low, pitch)
    return pitch


def stance_foot(phase):
    """Ankle height, ankle ahead of the flat foot's place, pitch (degrees, toes up) of a foot on the floor."""
    if phase <= FLAT_AT:
        pitch = HEEL_PITCH(phase)
        return (*heel_rocker(pitch), pitch)
    if phase < HEEL_OFF_AT:
        return ANKLE_M, 0.0, 0.0
    pitch = push_off_pitch(phase)
    return (*ball_rocker(pitch), pitch)


def swing_curves():
    """Ankle height, ankle ahead of the hips, pitch and roll through the cycle: the swing between what the stance gives.

    The roll is how far the ankle went ahead of the flat foot's place while the foot stood.
    """
    keys, rolls = [], []
    for phase in (0.0, 0.02, 0.04, 0.09, 0.2, 0.3, 0.4, 0.46, 0.50, 0.54, 0.57, TOE_OFF_AT):
        y, z, pitch = stance_foot(phase)
        keys.append((phase, y, z - hips_ahead(phase), pitch))
        rolls.append(z)
    for phase, thigh, knee, pitch in SWING:
        leg = rotate(turn("x", -thigh), leg_line(knee - REST_BEND))
        x, y, z = hip_joint(phase)
        keys.append((phase, hip_height(phase) + y + leg[1], z + leg[2], pitch))
    phases = [key[0] for key in keys]
    curves = [periodic(phases, [key[k] for key in keys]) for k in (1, 2, 3)]
    return [*curves, periodic(phases[: len(rolls)], rolls)]


SWING_CURVES = swing_curves()

def foot_at(phase):
    """Ankle height, ankle ahead of the place of the last heel strike, roll of that, pitch, bend of the toes."""
    phase %= 1.0
    if phase <= TOE_OFF_AT:
        y, z, pitch = stance_foot(phase)
        return y, z, z, pitch, max(0.0, -pitch) if phase >= HEEL_OFF_AT else 0.0
    y, ahead, pitch, roll = (curve(phase) for curve in SWING_CURVES)
    last = -stance_foot(TOE_OFF_AT)[2]
    fade = min((phase - TOE_OFF_AT) / 0.14, 1.0)
    return y, ahead + hips_ahead(phase), roll, pitch, last * (1 - fade * fade * (3 - 2 * fade))


def walk_pelvis(phase, travelled):
    """Position and rotation of the hips; `phase` of the left leg."""
    turned = pelvis_rotation(phase)
    middle = scale(add(OFFSET["LeftUpLeg"], OFFSET["RightUpLeg"]), 0.5)
    sway = hip_joint(phase)[0] - rotate(turned, sub(OFFSET["LeftUpLeg"], middle))[0]
    hips = (sway, hip_height(phase), travelled)
    return sub(hips, rotate(turned, middle)), turned


def walk_pose(phase, travelled):
    """`phase` of the left leg at 0..1; `travelled` metres of the hips since phase 0."""
    position, rotation = walk_pelvis(phase, travelled)
    pose = {"translation": position, "Hips": rotation}
    for side, sign, own in (("Left", 1.0, phase), ("Right", -1.0, phase + 0.5)):
        y, ahead, roll, pitch, toes = foot_at(own)
        x = HALF_STEP_WIDTH_M + roll * math.sin(math.radians(TOE_OUT_DEG))
        z = travelled - hips_ahead(own % 1.0) + ahead - roll * (1.0 - math.cos(math.radians(TOE_OUT_DEG)))
        foot = multiply(turn("y", sign * TOE_OUT_DEG), turn("x", -pitch))
        pose_leg(pose, side, (position, rotation), (sign * x, y, z), foot, toes)
    walk_trunk(pose, phase)
    walk_arms(pose, phase)
    return pose


def walk_trunk(pose, phase):
    """The chest turns against the hips and stays level, the head looks ahead."""
    a = 2 * math.pi * phase
    turns, side = 9.0 * math.cos(a - 0.15), -2.5 * math.sin(a + 0.7)
    nod = 0.8 * math.cos(2 * a - 0.6)
    for name, share in (("Spine", 0.25), ("Spine1", 0.3), ("Spine2", 0.45)):
        pose[name] = product(turn("y", share * turns), turn("z", share * side * 0.9), turn("x", share * (2.0 + nod)))
    pose["Neck"] = product(turn("y", -1.8 * math.cos(a - 0.15)), turn("x", -0.5 - 0.5 * nod))
    pose["Head"] = product(turn("y", -2.2 * math.cos(a - 0.15)), turn("x", -2.5 - 0.5 * nod))


def walk_arms(pose, phase):
    """Each arm swings against its own leg, the elbow bends as it comes forward."""
    for side, own in (("Left", phase), ("Right", phase + 0.5)):
        swing = -math.cos(2 * math.pi * (own - 0.03))
        late = -math.cos(2 * math.pi * (own - 0.07))
        arm = hanging_arm(-5.0 + 19.0 * swing, 7.0, 24.0 + 12.0 * late, 18.0) | relaxed_hand()
        arm["Shoulder"] = multiply(turn("y", -2.0 * swing), arm["Shoulder"])
        for name, rotation in arm.items():
            pose[side + name] = rotation if side == "Left" else mirror_rotation(rotation)


def walk():
    frames = round(CYCLE_S * FPS)
    return Clip("walk", [walk_pose(i / frames, i / frames * STRIDE_M) for i in range(frames + 1)])
