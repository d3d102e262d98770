"""Turned wood: closed smooth surfaces of rings about an axis."""

import math

from mannequin.maths import add, cross, dot, mirror, scale, spline, sub, unit


class Piece:
    """Closed triangle mesh with one normal per vertex.

    grain: each vertex's place in the wood: metres along the axis, radians around it (None at the ends of the axis).
    girth: the longest way around, metres.
    """

    def __init__(self, positions, triangles, grain, girth):
        self.positions = positions
        self.triangles = triangles
        self.grain = grain
        self.girth = girth
        if self._volume() < 0.0:
            self.triangles = [(a, c, b) for a, b, c in triangles]

    def _volume(self):
        return sum(
            dot(self.positions[a], cross(self.positions[b], self.positions[c])) for a, b, c in self.triangles
        )

    def normals(self):
        """Mean of the faces' normals at each vertex, weighted by their area."""
        sums = [(0.0, 0.0, 0.0)] * len(self.positions)
        for a, b, c in self.triangles:
            p, q, r = self.positions[a], self.positions[b], self.positions[c]
            area = cross(sub(q, p), sub(r, p))
            for vertex in (a, b, c):
                sums[vertex] = add(sums[vertex], area)
        return [unit(n) for n in sums]

    def moved(self, change):
        """The piece with `change` applied to every position."""
        return Piece([change(p) for p in self.positions], self.triangles, self.grain, self.girth)

    def mirrored(self):
        return self.moved(mirror)


def _ring_stations(total, caps, radii, rings):
    """(distance along the axis, factor on the radius) of each ring: evenly spaced over the surface.

    The ends are quarter ellipses of the lengths `caps`; `radii` are the surface's there.
    """
    arcs = [math.pi / 2 * math.sqrt((cap * cap + radius * radius) / 2) for cap, radius in zip(caps, radii)]
    body = total - sum(caps)
    spacing = (sum(arcs) + body) / (rings + 1)
    start, end = (max(2, round(arc / spacing)) for arc in arcs)
    between = max(1, round(body / spacing))
    rows = [(caps[0] * (1 - math.cos(a)), math.sin(a)) for a in _quarter(start)]
    rows += [(caps[0] + body * (i + 1) / between, 1.0) for i in range(between - 1)]
    return rows + [(total - caps[1] * (1 - math.cos(a)), math.sin(a)) for a in reversed(_quarter(end))]


def _quarter(count):
    return [math.pi / 2 * (i + 1) / count for i in range(count)]


def loft(origin, axis, front, stations, caps, rings=12, sectors=16, roundness=1.0, bend=0.0, front_dense=0.0):
    """Surface about the line from `origin` along `axis`.

    stations: rows (distance along the axis, half width to both sides, radius to the front, radius to the back), metres;
        the first and last rows are the ends, rounded off over the lengths `caps`.
    front: direction of the front radius; the sides are perpendicular to it and the axis.
    roundness: 1 gives ellipses, less gives boxes (exponent of the superellipse's sine and cosine).
    bend: sag of the axis away from the front: metres per square metre of distance.
    front_dense: 0..0.9, how much closer together the vertices are in front.
    """
    axis = unit(axis)
    side = unit(cross(axis, front))
    front = cross(side, axis)
    rows = list(zip(*stations))
    width, ahead, behind = (spline(rows[0], rows[k]) for k in (1, 2, 3))
    total = rows[0][-1]

    def centre(s):
        return add(add(origin, scale(axis, s)), scale(front, -bend * s * s))

    positions, grain = [centre(0.0)], [(0.0, None)]
    radii = [(2 * row[1] + row[2] + row[3]) / 4 for row in (stations[0], stations[-1])]
    ring_stations = _ring_stations(total, caps, radii, rings)
    for s, factor in ring_stations:
        for k in range(sectors):
            around = 2 * math.pi * k / sectors
            angle = around + front_dense * math.cos(around)
            x = factor * width(s) * _power(math.cos(angle), roundness)
            z = math.sin(angle)
            z = factor * (ahead(s) if z > 0 else behind(s)) * _power(z, roundness)
            positions.append(add(centre(s), add(scale(side, x), scale(front, z))))
            grain.append((s, around))
    positions.append(centre(total))
    grain.append((total, None))
    girth = math.pi * max(2 * w + f + b for _, w, f, b in stations) / 2
    return Piece(positions, _lathe_triangles(len(ring_stations), sectors), grain, girth)


def _power(value, exponent):
    return math.copysign(abs(value) ** exponent, value)


def _lathe_triangles(rings, sectors):
    triangles = []
    last = rings * sectors + 1
    for k in range(sectors):
        n = (k + 1) % sectors
        triangles.append((0, 1 + n, 1 + k))
        for ring in range(rings - 1):
            a, b = 1 + ring * sectors, 1 + (ring + 1) * sectors
            triangles.append((a + k, a + n, b + n))
            triangles.append((a + k, b + n, b + k))
        triangles.append((last, last - sectors + k, last - sectors + n))
    return triangles


def ball(centre, radii, sectors=12, rings=7):
    """Ellipsoid with radii along x, y and z."""
    positions, grain = [add(centre, (0.0, -radii[1], 0.0))], [(0.0, None)]
    for i in range(rings):
        latitude = math.pi * ((i + 1) / (rings + 1) - 0.5)
        for k in range(sectors):
            a = 2 * math.pi * k / sectors
            direction = (math.cos(latitude) * math.cos(a), math.sin(latitude), math.cos(latitude) * math.sin(a))
            positions.append(add(centre, tuple(r * d for r, d in zip(radii, direction))))
            grain.append((radii[1] * (1 + math.sin(latitude)), a))
    positions.append(add(centre, (0.0, radii[1], 0.0)))
    grain.append((2 * radii[1], None))
    return Piece(positions, _lathe_triangles(rings, sectors), grain, math.pi * (radii[0] + radii[2]))


def bump(piece, centre, size, push):
    """Moves the vertices around `centre` by `push`, less the farther they are (Gaussian of width `size` per axis)."""

    def change(p):
        weight = math.exp(-0.5 * sum(((a - b) / s) ** 2 for a, b, s in zip(p, centre, size)))
        return add(p, scale(push, weight))

    return piece.moved(change)

