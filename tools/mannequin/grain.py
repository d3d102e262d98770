"""The grain of the wood: a picture that tiles, multiplied into the woods' colours. Grain runs along v."""

import math
import random
import struct
import zlib

SIDE = 256
TONES = 32
LIGHTEST, DARKEST = (255, 255, 255), (200, 176, 152)


def _noise(generator, across, along):
    """Smooth noise that tiles, with so many cells across and along the grain."""
    cells = [[generator.random() for _ in range(across)] for _ in range(along)]

    def value(u, v):
        x, y = u * across, v * along
        i, j = int(x), int(y)
        s, t = x - i, y - j
        s, t = s * s * (3 - 2 * s), t * t * (3 - 2 * t)
        row, after = cells[j % along], cells[(j + 1) % along]
        i, k = i % across, (i + 1) % across
        return (row[i] * (1 - s) + row[k] * s) * (1 - t) + (after[i] * (1 - s) + after[k] * s) * t

    return value


def _darkness():
    """Darkness 0..1 of the grain as a function of (u, v) in [0, 1)."""
    generator = random.Random(7)
    drift = _noise(generator, 3, 2)
    fibre = _noise(generator, 90, 6)
    pores = _noise(generator, 128, 24)
    broad = _noise(generator, 4, 2)

    def darkness(u, v):
        rings = 0.5 + 0.5 * math.sin(2 * math.pi * (4 * u + 1.6 * drift(u, v)))
        fine = max(0.0, pores(u, v) - 0.72) * 2.2
        return 0.24 * rings**3 + 0.30 * fibre(u, v) + 0.25 * fine + 0.18 * broad(u, v)

    return darkness


def _chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def grain_png():
    darkness = _darkness()
    palette = b"".join(
        bytes(round(a + (b - a) * i / (TONES - 1)) for a, b in zip(LIGHTEST, DARKEST)) for i in range(TONES))
    rows = bytearray()
    for y in range(SIDE):
        rows.append(0)  # no filter
        rows += bytes(min(TONES - 1, int(TONES * darkness(x / SIDE, y / SIDE))) for x in range(SIDE))
    header = struct.pack(">IIBBBBB", SIDE, SIDE, 8, 3, 0, 0, 0)
    chunks = (b"IHDR", header), (b"PLTE", palette), (b"IDAT", zlib.compress(bytes(rows), 9)), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*chunk) for chunk in chunks)
