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
        (0.0, 1.567, 0.002), UP, FRONT,
        [(0.000, 0.032, 0.072, 0.010), (0.030, 0.051, 0.088, 0.048), (0.065, 0.066, 0.094, 0.080),
         (0.105, 0.076, 0.098, 0.099), (0.140, 0.079, 0.097, 0.104), (0.213, 0.076, 0.090, 0.100)],
        caps=(0.024, 0.088), rings=22, sectors=24, front_dense=0.45)
    piece = bump(piece, (0.0, 1.652, 0.105), (0.009, 0.019, 0.03), (0.0, -0.003, 0.016))  # nose
    piece = bump(piece, (0.0, 1.580, 0.085), (0.022, 0.012, 0.03), (0.0, 0.000, 0.008))  # chin
    for x in (-0.031, 0.031):
        piece = bump(piece, (x, 1.680, 0.090), (0.016, 0.011, 0.03), (0.0, 0.0, -0.008))  # eye sockets
        piece = bump(piece, (x, 1.702, 0.092), (0.024, 0.009, 0.03), (0.0, 0.0, 0.003))  # brows
    return Part(piece, LIGHT, "Head")


def trunk():
    pelvis = loft(
        (0.0, 0.856, -0.008), UP, FRONT,
        [(0.000, 0.036, 0.054, 0.052), (0.045, 0.080, 0.080, 0.092), (0.090, 0.126, 0.092, 0.108),
         (0.130, 0.138, 0.093, 0.104), (0.165, 0.128, 0.088, 0.090), (0.199, 0.112, 0.078, 0.078)],
        caps=(0.034, 0.026), rings=12, sectors=20, roundness=0.94)
    abdomen = loft(
        (0.0, 1.068, -0.010), UP, FRONT,
        [(0.000, 0.094, 0.074, 0.070), (0.050, 0.102, 0.083, 0.074), (0.100, 0.099, 0.084, 0.071),
         (0.155, 0.106, 0.087, 0.079), (0.208, 0.104, 0.080, 0.076)],
        caps=(0.040, 0.040), rings=12, sectors=20, roundness=0.96)
    chest = loft(
        (0.0, 1.280, -0.012), UP, FRONT,
        [(0.000, 0.108, 0.080, 0.078), (0.050, 0.132, 0.099, 0.097), (0.105, 0.151, 0.110, 0.112),
         (0.150, 0.159, 0.107, 0.115), (0.190, 0.147, 0.088, 0.101), (0.232, 0.094, 0.056, 0.070)],
        caps=(0.034, 0.042), rings=13, sectors=24, roundness=0.90)
    for x in (-0.065, 0.065):
        chest = bump(chest, (x, 1.402, 0.100), (0.042, 0.032, 0.05), (0.0, 0.0, 0.011))  # breast
        chest = bump(chest, (x, 1.420, -0.120), (0.040, 0.050, 0.05), (0.0, 0.0, -0.006))  # shoulder blades
    for x in (-0.055, 0.055):
        pelvis = bump(pelvis, (x, 0.925, -0.110), (0.040, 0.040, 0.05), (0.0, 0.0, -0.012))
    neck_axis = sub(REST["Head"], REST["Neck"])
    neck = loft(
        add(REST["Neck"], scale(neck_axis, -0.25)), neck_axis, FRONT,
        [(0.000, 0.062, 0.060, 0.058), (0.040, 0.051, 0.050, 0.051), (0.080, 0.047, 0.047, 0.048),
         (0.112, 0.048, 0.048, 0.049)],
        caps=(0.012, 0.012), rings=9, sectors=16)
    return [
        Part(pelvis, LIGHT, "Hips"),
        Part(abdomen, LIGHT, blend(("Spine", "Spine1"), (1.18,))),
        Part(chest, LIGHT, "Spine2"),
        Part(neck, LIGHT, blend(("Spine2", "Neck", "Head"), (1.50, 1.60))),
        Part(ball((0.0, 1.063, -0.010), (0.092, 0.040, 0.066), 18, 5), DARK, blend(("Hips", "Spine"), (1.063,))),
        Part(ball((0.0, 1.278, -0.011), (0.100, 0.040, 0.070), 18, 5), DARK, blend(("Spine1", "Spine2"), (1.278,))),
        Part(ball((0.0, 1.507, -0.030), (0.070, 0.026, 0.064), 16, 5), DARK, "Spine2"),
        Part(ball((0.0, 1.583, -0.010), (0.054, 0.026, 0.054), 16, 5), DARK, "Head"),
    ]


def limb(start, end, gap, stations, caps, front, **options):
    """Loft from `gap` metres after `start` towards `end`."""
    axis = unit(sub(end, start))
    return loft(add(start, scale(axis, gap)), axis, front, stations, caps, **options)


def left_arm():
    shoulder, elbow, wrist = REST["LeftArm"], REST["LeftForeArm"], REST["LeftHand"]
    yoke = limb(
        (0.040, 1.472, -0.016), shoulder, 0.0,
        [(0.000, 0.042, 0.030, 0.030), (0.060, 0.055, 0.044, 0.042), (0.116, 0.052, 0.047, 0.046)],
        (0.030, 0.026), UP, rings=7, sectors=12)
    upper = limb(
        shoulder, elbow, 0.006,
        [(0.000, 0.050, 0.050, 0.048), (0.060, 0.057, 0.058, 0.054), (0.130, 0.051, 0.050, 0.050),
         (0.205, 0.044, 0.042, 0.044), (0.260, 0.040, 0.038, 0.040)],
        (0.050, 0.026), UP, rings=10, sectors=12)
    fore = limb(
        elbow, wrist, 0.018,
        [(0.000, 0.038, 0.036, 0.037), (0.055, 0.047, 0.042, 0.043), (0.110, 0.043, 0.037, 0.039),
         (0.180, 0.033, 0.028, 0.028), (0.240, 0.029, 0.023, 0.023)],
        (0.030, 0.016), UP, rings=10, sectors=12)
    return [
        Part(yoke, LIGHT, "LeftShoulder"),
        Part(upper, LIGHT, "LeftArm"),
        Part(fore, LIGHT, "LeftForeArm"),
        Part(ball(shoulder, (0.051, 0.051, 0.051)), DARK, "LeftArm"),
        Part(ball(elbow, (0.038, 0.036, 0.038), 12, 6), DARK, "LeftForeArm"),
        Part(ball(wrist, (0.025, 0.024, 0.027), 10, 5), DARK, "LeftHand"),
    ]


def left_hand():
    wrist = REST["LeftHand"]
    palm = loft(
        add(wrist, (0.014, 0.0, 0.0)), LEFT, UP,
        [(0.000, 0.027, 0.020, 0.020), (0.030, 0.037, 0.020, 0.024), (0.060, 0.043, 0.017, 0.021),
         (0.090, 0.042, 0.012, 0.015)],
        (0.016, 0.014), rings=9, sectors=14, roundness=0.80)
    palm = palm.moved(lambda p: add(p, (0.0, 0.0, -0.08 * (p[0] - wrist[0]))))  # towards the middle finger
    parts = [Part(palm, LIGHT, "LeftHand")]
    for finger, reach, slant in (("Index", 0.076, 0.05), ("Middle", 0.084, 0.0), ("Ring", 0.078, -0.05),
                                 ("Pinky", 0.060, -0.10)):
        base = add(REST["LeftHand" + finger + "1"], (-0.012, -0.001, 0.0))
        piece = loft(
            base, (1.0, -0.06, slant), UP,
            [(0.000, 0.0105, 0.0105, 0.0105), (0.020, 0.0112, 0.0112, 0.0115), (reach * 0.6, 0.0100, 0.0100, 0.0105),
             (reach + 0.012, 0.0080, 0.0080, 0.0085)],
            (0.006, 0.010), rings=7, sectors=6, bend=1.8)
        parts.append(Part(piece, LIGHT, "LeftHand" + finger + "1"))
    thumb = loft(
        add(REST["LeftHandThumb1"], (-0.010, 0.0, -0.010)), (0.72, -0.28, 0.63), (0.0, 1.0, 0.2),
        [(0.000, 0.0120, 0.0120, 0.0120), (0.025, 0.0140, 0.0130, 0.0140), (0.055, 0.0110, 0.0110, 0.0110),
         (0.080, 0.0085, 0.0080, 0.0085)],
        (0.010, 0.010), rings=8, sectors=8, bend=0.8)
    return [*parts, Part(thumb, LIGHT, "LeftHandThumb1")]


def left_leg():
    hip, knee, ankle = REST["LeftUpLeg"], REST["LeftLeg"], REST["LeftFoot"]
    thigh = limb(
        hip, knee, 0.004,
        [(0.000, 0.064, 0.064, 0.066), (0.070, 0.077, 0.079, 0.080), (0.170, 0.072, 0.077, 0.072),
         (0.270, 0.060, 0.064, 0.059), (0.345, 0.051, 0.053, 0.049), (0.392, 0.047, 0.047, 0.045)],
        (0.070, 0.030), FRONT, rings=12, sectors=14)
    shank = limb(
        knee, ankle, 0.022,
        [(0.000, 0.044, 0.045, 0.043), (0.065, 0.051, 0.046, 0.059), (0.130, 0.053, 0.044, 0.066),
         (0.215, 0.043, 0.039, 0.051), (0.305, 0.032, 0.033, 0.035), (0.390, 0.030, 0.031, 0.033)],
        (0.034, 0.018), FRONT, rings=12, sectors=14)
    return [
        Part(thigh, LIGHT, "LeftUpLeg"),
        Part(shank, LIGHT, "LeftLeg"),
        Part(ball(hip, (0.063, 0.063, 0.063), 12, 7), DARK, "LeftUpLeg"),
        Part(ball(knee, (0.046, 0.045, 0.047), 12, 6), DARK, "LeftLeg"),
        Part(ball(ankle, (0.034, 0.034, 0.034), 10, 5), DARK, "LeftFoot"),
    ]


def on_floor(piece):
    """The piece with a flat sole."""
    return piece.moved(lambda p: (p[0], max(p[1], 0.0), p[2]))


def left_foot():
    x = REST["LeftFoot"][0]
    foot = loft(
        (x, 0.036, -0.076), (0.02, 0.0, 1.0), UP,
        [(0.000, 0.030, 0.024, 0.036), (0.030, 0.035, 0.036, 0.040), (0.066, 0.037, 0.044, 0.040),
         (0.105, 0.040, 0.032, 0.040), (0.150, 0.046, 0.014, 0.040), (0.194, 0.047, 0.003, 0.040)],
        (0.034, 0.014), rings=12, sectors=16, roundness=0.88)
    toes = loft(
        (x + 0.004, 0.017, 0.117), (0.01, 0.0, 1.0), UP,
        [(0.000, 0.046, 0.019, 0.021), (0.030, 0.046, 0.014, 0.021), (0.055, 0.040, 0.008, 0.019),
         (0.074, 0.031, 0.004, 0.019)],
        (0.012, 0.026), rings=8, sectors=14, roundness=0.88)
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
