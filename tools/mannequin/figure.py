"""The wooden figure: light turned pieces, one or two per bone, on dark balls. All sizes in metres."""

from mannequin.maths import add, mirror, scale, sub, unit
from mannequin.shapes import ball, bump, loft
from mannequin.skeleton import REST

LIGHT, DARK = "wood", "joint"
UP, FRONT, LEFT = (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
DOWN = (0.0, -1.0, 0.0)


class Part:
    """A piece, its wood and its bones: a name, or a function of the position that gives {name: weight}."""

    def __init__(self, piece, wood, bones):
        self.piece = piece
        self.wood = wood
        self.bones = bones

    def weights(self, position):
        return self.bones(position) if callable(self.bones) else {self.bones: 1.0}


def blend(bones, heights):
    """Weights that pass from one bone to the next around the heights between them (0.03 m either side)."""

    def weights(position):
        shares, left = {}, 1.0
        for bone, height in zip(bones, heights):
            t = min(max((position[1] - height) / 0.06 + 0.5, 0.0), 1.0)
            passed = t * t * (3 - 2 * t) * left
            if left - passed > 0.0:
                shares[bone] = left - passed
            left = passed
        if left > 0.0:
            shares[bones[-1]] = left
        return shares

    return weights


def head():
    piece = loft(
        (0.0, 1.568, 0.004), UP, FRONT,
        [(0.000, 0.034, 0.070, 0.018), (0.030, 0.053, 0.086, 0.050), (0.070, 0.067, 0.092, 0.082),
         (0.115, 0.077, 0.095, 0.100), (0.155, 0.077, 0.090, 0.101), (0.190, 0.064, 0.074, 0.086),
         (0.212, 0.050, 0.055, 0.065)],
        caps=(0.022, 0.060), rings=24, sectors=28, roundness=0.95, front_dense=0.45)
    piece = bump(piece, (0.0, 1.655, 0.105), (0.010, 0.020, 0.03), (0.0, -0.004, 0.017))  # nose
    piece = bump(piece, (0.0, 1.582, 0.085), (0.022, 0.012, 0.03), (0.0, 0.000, 0.007))  # chin
    for x in (-0.032, 0.032):
        piece = bump(piece, (x, 1.683, 0.090), (0.016, 0.010, 0.03), (0.0, 0.0, -0.007))  # eye sockets
        piece = bump(piece, (x, 1.705, 0.092), (0.022, 0.008, 0.03), (0.0, 0.0, 0.004))  # brows
    return Part(piece, LIGHT, "Head")


def trunk():
    pelvis = loft(
        (0.0, 0.858, -0.008), UP, FRONT,
        [(0.000, 0.034, 0.052, 0.050), (0.045, 0.080, 0.080, 0.094), (0.090, 0.128, 0.092, 0.108),
         (0.130, 0.138, 0.092, 0.104), (0.165, 0.126, 0.088, 0.090), (0.197, 0.110, 0.078, 0.078)],
        caps=(0.030, 0.022), rings=14, sectors=24, roundness=0.92)
    abdomen = loft(
        (0.0, 1.070, -0.010), UP, FRONT,
        [(0.000, 0.098, 0.074, 0.072), (0.050, 0.106, 0.084, 0.076), (0.105, 0.104, 0.086, 0.073),
         (0.160, 0.110, 0.088, 0.080), (0.205, 0.110, 0.080, 0.080)],
        caps=(0.026, 0.026), rings=13, sectors=24, roundness=0.94)
    chest = loft(
        (0.0, 1.283, -0.012), UP, FRONT,
        [(0.000, 0.112, 0.080, 0.080), (0.050, 0.136, 0.100, 0.098), (0.105, 0.154, 0.112, 0.112),
         (0.150, 0.160, 0.108, 0.114), (0.190, 0.146, 0.088, 0.100), (0.225, 0.092, 0.058, 0.072)],
        caps=(0.028, 0.036), rings=15, sectors=28, roundness=0.88)
    for x in (-0.065, 0.065):
        chest = bump(chest, (x, 1.405, 0.100), (0.040, 0.032, 0.05), (0.0, 0.0, 0.010))  # breast
        chest = bump(chest, (x, 1.420, -0.120), (0.040, 0.050, 0.05), (0.0, 0.0, -0.006))  # shoulder blades
    for x in (-0.055, 0.055):
        pelvis = bump(pelvis, (x, 0.925, -0.110), (0.040, 0.040, 0.05), (0.0, 0.0, -0.012))
    neck_axis = sub(REST["Head"], REST["Neck"])
    neck = loft(
        add(REST["Neck"], scale(neck_axis, -0.25)), neck_axis, FRONT,
        [(0.000, 0.060, 0.058, 0.056), (0.040, 0.050, 0.049, 0.050), (0.080, 0.047, 0.047, 0.048),
         (0.112, 0.047, 0.047, 0.048)],
        caps=(0.012, 0.012), rings=10, sectors=18)
    return [
        Part(pelvis, LIGHT, "Hips"),
        Part(abdomen, LIGHT, blend(("Spine", "Spine1"), (1.18,))),
        Part(chest, LIGHT, "Spine2"),
        Part(neck, LIGHT, blend(("Spine2", "Neck", "Head"), (1.50, 1.60))),
        Part(ball((0.0, 1.064, -0.010), (0.093, 0.040, 0.066), 20, 7), DARK, blend(("Hips", "Spine"), (1.064,))),
        Part(ball((0.0, 1.280, -0.011), (0.100, 0.040, 0.070), 20, 7), DARK, blend(("Spine1", "Spine2"), (1.280,))),
        Part(ball((0.0, 1.505, -0.030), (0.068, 0.026, 0.062), 18, 5), DARK, "Spine2"),
        Part(ball((0.0, 1.584, -0.010), (0.054, 0.026, 0.054), 18, 5), DARK, "Head"),
    ]


def limb(start, end, gap, stations, caps, front, **options):
    """Loft from `gap` metres after `start` towards `end`."""
    axis = unit(sub(end, start))
    return loft(add(start, scale(axis, gap)), axis, front, stations, caps, **options)


def left_arm():
    shoulder, elbow, wrist = REST["LeftArm"], REST["LeftForeArm"], REST["LeftHand"]
    yoke = limb(
        (0.045, 1.468, -0.014), shoulder, 0.0,
        [(0.000, 0.040, 0.030, 0.030), (0.060, 0.052, 0.044, 0.040), (0.108, 0.050, 0.046, 0.044)],
        (0.030, 0.014), UP, rings=9, sectors=16)
    upper = limb(
        shoulder, elbow, 0.030,
        [(0.000, 0.046, 0.046, 0.046), (0.050, 0.054, 0.055, 0.052), (0.110, 0.050, 0.049, 0.050),
         (0.180, 0.044, 0.042, 0.044), (0.232, 0.040, 0.038, 0.039)],
        (0.036, 0.022), UP, rings=12, sectors=16)
    fore = limb(
        elbow, wrist, 0.026,
        [(0.000, 0.037, 0.036, 0.036), (0.050, 0.046, 0.042, 0.043), (0.100, 0.043, 0.038, 0.040),
         (0.170, 0.034, 0.028, 0.029), (0.228, 0.030, 0.023, 0.023)],
        (0.024, 0.014), UP, rings=12, sectors=16)
    return [
        Part(yoke, LIGHT, "LeftShoulder"),
        Part(upper, LIGHT, "LeftArm"),
        Part(fore, LIGHT, "LeftForeArm"),
        Part(ball(shoulder, (0.049, 0.049, 0.049)), DARK, "LeftArm"),
        Part(ball(elbow, (0.038, 0.036, 0.038)), DARK, "LeftForeArm"),
        Part(ball(wrist, (0.026, 0.025, 0.028), 12, 6), DARK, "LeftHand"),
    ]


def left_hand():
    wrist = REST["LeftHand"]
    palm = loft(
        add(wrist, (0.014, 0.0, 0.0)), LEFT, UP,
        [(0.000, 0.026, 0.018, 0.019), (0.030, 0.036, 0.018, 0.022), (0.060, 0.042, 0.016, 0.019),
         (0.088, 0.041, 0.012, 0.014)],
        (0.014, 0.014), rings=10, sectors=14, roundness=0.80)
    palm = palm.moved(lambda p: add(p, (0.0, 0.0, -0.08 * (p[0] - wrist[0]))))  # towards the middle finger
    parts = [Part(palm, LIGHT, "LeftHand")]
    for finger, reach, slant in (("Index", 0.076, 0.05), ("Middle", 0.084, 0.0), ("Ring", 0.078, -0.05),
                                 ("Pinky", 0.060, -0.10)):
        base = add(REST["LeftHand" + finger + "1"], (-0.012, -0.001, 0.0))
        piece = loft(
            base, (1.0, -0.06, slant), UP,
            [(0.000, 0.0100, 0.0100, 0.0100), (0.020, 0.0105, 0.0105, 0.0105), (reach * 0.6, 0.0095, 0.0095, 0.0100),
             (reach + 0.012, 0.0075, 0.0075, 0.0080)],
            (0.006, 0.010), rings=9, sectors=8, bend=1.6)
        parts.append(Part(piece, LIGHT, "LeftHand" + finger + "1"))
    thumb = loft(
        add(REST["LeftHandThumb1"], (-0.010, 0.0, -0.010)), (0.72, -0.28, 0.63), (0.0, 1.0, 0.2),
        [(0.000, 0.0120, 0.0120, 0.0120), (0.025, 0.0140, 0.0130, 0.0140), (0.055, 0.0110, 0.0110, 0.0110),
         (0.080, 0.0085, 0.0080, 0.0085)],
        (0.010, 0.010), rings=9, sectors=9, bend=0.8)
    return [*parts, Part(thumb, LIGHT, "LeftHandThumb1")]


def left_leg():
    hip, knee, ankle = REST["LeftUpLeg"], REST["LeftLeg"], REST["LeftFoot"]
    thigh = limb(
        hip, knee, 0.026,
        [(0.000, 0.060, 0.058, 0.062), (0.060, 0.076, 0.078, 0.078), (0.150, 0.072, 0.076, 0.072),
         (0.250, 0.060, 0.064, 0.060), (0.320, 0.052, 0.054, 0.050), (0.362, 0.047, 0.047, 0.045)],
        (0.046, 0.026), FRONT, rings=14, sectors=18)
    shank = limb(
        knee, ankle, 0.032,
        [(0.000, 0.044, 0.044, 0.042), (0.060, 0.051, 0.045, 0.060), (0.120, 0.053, 0.043, 0.066),
         (0.200, 0.044, 0.039, 0.052), (0.290, 0.033, 0.034, 0.036), (0.378, 0.030, 0.031, 0.032)],
        (0.026, 0.016), FRONT, rings=14, sectors=18)
    return [
        Part(thigh, LIGHT, "LeftUpLeg"),
        Part(shank, LIGHT, "LeftLeg"),
        Part(ball(hip, (0.062, 0.062, 0.062), 14, 8), DARK, "LeftUpLeg"),
        Part(ball(knee, (0.045, 0.044, 0.046), 14, 7), DARK, "LeftLeg"),
        Part(ball(ankle, (0.034, 0.034, 0.034), 12, 6), DARK, "LeftFoot"),
    ]


def on_floor(piece):
    """The piece with a flat sole."""
    return piece.moved(lambda p: (p[0], max(p[1], 0.0), p[2]))


def left_foot():
    x = REST["LeftFoot"][0]
    foot = loft(
        (x, 0.034, -0.074), (0.02, 0.0, 1.0), UP,
        [(0.000, 0.028, 0.024, 0.034), (0.030, 0.033, 0.030, 0.038), (0.066, 0.036, 0.034, 0.038),
         (0.110, 0.041, 0.026, 0.038), (0.150, 0.046, 0.014, 0.038), (0.186, 0.047, 0.004, 0.038)],
        (0.030, 0.010), rings=13, sectors=18, roundness=0.85)
    foot = foot.moved(lambda p: (p[0], p[1] - max(0.0, p[2] - 0.02) * 0.07 if p[1] > 0.02 else p[1], p[2]))
    toes = loft(
        (x + 0.004, 0.016, 0.120), (0.01, 0.0, 1.0), UP,
        [(0.000, 0.046, 0.018, 0.020), (0.030, 0.046, 0.012, 0.020), (0.055, 0.040, 0.006, 0.018),
         (0.072, 0.030, 0.002, 0.018)],
        (0.008, 0.026), rings=9, sectors=16, roundness=0.85)
    pin = ball(add(REST["LeftToeBase"], (0.0, -0.001, 0.0)), (0.040, 0.017, 0.014), 12, 5)
    return [
        Part(on_floor(foot), LIGHT, "LeftFoot"),
        Part(on_floor(toes), LIGHT, "LeftToeBase"),
        Part(on_floor(pin), DARK, "LeftToeBase"),
    ]


def right_of(part):
    return Part(part.piece.mirrored(), part.wood, "Right" + part.bones.removeprefix("Left"))


def parts():
    left = left_arm() + left_hand() + left_leg() + left_foot()
    return [head(), *trunk(), *left, *(right_of(part) for part in left)]


__all__ = ["DARK", "LIGHT", "mirror", "parts"]
