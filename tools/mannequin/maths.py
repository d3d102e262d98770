"""Vectors as 3-tuples, quaternions as (x, y, z, w), both right-handed with y up."""

import math


def add(a, b):
    return (a[0] + b[0], a[1] + b[1], a[2] + b[2])


def sub(a, b):
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def scale(a, s):
    return (a[0] * s, a[1] * s, a[2] * s)


def dot(a, b):
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def length(a):
    return math.sqrt(dot(a, a))


def unit(a):
    return scale(a, 1.0 / length(a))


def mirror(a):
    """The point on the other side of the body."""
    return (-a[0], a[1], a[2])


IDENTITY = (0.0, 0.0, 0.0, 1.0)


def multiply(a, b):
    """The rotation b, then a."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by - ax * bz + ay * bw + az * bx,
        aw * bz + ax * by - ay * bx + az * bw,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def product(*rotations):
    """Rotations from left to right, as matrices multiply."""
    result = IDENTITY
    for rotation in rotations:
        result = multiply(result, rotation)
    return result


def inverse(q):
    return (-q[0], -q[1], -q[2], q[3])


def rotate(q, v):
    t = scale(cross(q[:3], v), 2.0)
    return add(add(v, scale(t, q[3])), cross(q[:3], t))


def turn(axis, degrees):
    """Rotation about "x", "y" or "z"."""
    half = math.radians(degrees) / 2.0
    vector = [0.0, 0.0, 0.0]
    vector["xyz".index(axis)] = math.sin(half)
    return (*vector, math.cos(half))


def from_axes(x, y, z):
    """The rotation that takes the unit axes to x, y and z (orthonormal, right-handed)."""
    trace = x[0] + y[1] + z[2]
    if trace > 0.0:
        s = 2.0 * math.sqrt(1.0 + trace)
        return ((y[2] - z[1]) / s, (z[0] - x[2]) / s, (x[1] - y[0]) / s, s / 4.0)
    columns = (x, y, z)
    i = max(range(3), key=lambda k: columns[k][k])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = 2.0 * math.sqrt(1.0 + columns[i][i] - columns[j][j] - columns[k][k])
    q = [0.0, 0.0, 0.0, (columns[j][k] - columns[k][j]) / s]
    q[i] = s / 4.0
    q[j] = (columns[i][j] + columns[j][i]) / s
    q[k] = (columns[i][k] + columns[k][i]) / s
    return tuple(q)


def monotone(xs, ys):
    """Interpolating curve that does not overshoot (Fritsch and Carlson 1980, harmonic slopes)."""
    h = [b - a for a, b in zip(xs, xs[1:])]
    d = [(b - a) / w for a, b, w in zip(ys, ys[1:], h)]
    inner = [0.0 if p * q <= 0.0 else 2.0 * p * q / (p + q) for p, q in zip(d, d[1:])]
    slopes = [d[0], *inner, d[-1]]

    def curve(x):
        x = min(max(x, xs[0]), xs[-1])
        i = next(k for k in range(len(h)) if x <= xs[k + 1] or k == len(h) - 1)
        t = (x - xs[i]) / h[i]
        return (
            (1 + 2 * t) * (1 - t) ** 2 * ys[i]
            + t * (1 - t) ** 2 * h[i] * slopes[i]
            + t * t * (3 - 2 * t) * ys[i + 1]
            + t * t * (t - 1) * h[i] * slopes[i + 1]
        )

    return curve


def spline(xs, ys):
    """Interpolating natural cubic spline: curvature is continuous and zero at the ends."""
    n = len(xs)
    h = [b - a for a, b in zip(xs, xs[1:])]
    bends = [0.0] * n  # second derivatives
    for _ in range(200):  # Gauss-Seidel; the system is diagonally dominant
        for i in range(1, n - 1):
            right = 6.0 * ((ys[i + 1] - ys[i]) / h[i] - (ys[i] - ys[i - 1]) / h[i - 1])
            bends[i] = (right - h[i - 1] * bends[i - 1] - h[i] * bends[i + 1]) / (2.0 * (h[i - 1] + h[i]))

    def curve(x):
        x = min(max(x, xs[0]), xs[-1])
        i = next(k for k in range(n - 1) if x <= xs[k + 1] or k == n - 2)
        a, b = (xs[i + 1] - x) / h[i], (x - xs[i]) / h[i]
        return a * ys[i] + b * ys[i + 1] + ((a**3 - a) * bends[i] + (b**3 - b) * bends[i + 1]) * h[i] ** 2 / 6.0

    return curve


def periodic(xs, ys):
    """Smooth closed curve of period 1 through (x, y), x in [0, 1) (cubic spline with continuous curvature)."""
    n = len(xs)
    h = [(xs[(i + 1) % n] - xs[i]) % 1.0 for i in range(n)]
    d = [(ys[(i + 1) % n] - ys[i]) / h[i] for i in range(n)]
    slopes = list(d)
    for _ in range(200):  # Gauss-Seidel on the tridiagonal system of the slopes
        for i in range(n):
            before, after = h[i - 1], h[i]
            right = 3.0 * (d[i - 1] * after + d[i] * before)
            slopes[i] = (right - after * slopes[i - 1] - before * slopes[(i + 1) % n]) / (2.0 * (before + after))

    def curve(x):
        x %= 1.0
        i = max((k for k in range(n) if xs[k] <= x), default=n - 1)
        t = ((x - xs[i]) % 1.0) / h[i]
        y0, y1, m0, m1 = ys[i], ys[(i + 1) % n], slopes[i], slopes[(i + 1) % n]
        return (
            (1 + 2 * t) * (1 - t) ** 2 * y0
            + t * (1 - t) ** 2 * h[i] * m0
            + t * t * (3 - 2 * t) * y1
            + t * t * (t - 1) * h[i] * m1
        )

    return curve
