"""The figure and its clips as one binary glTF."""

import json
import struct

from mannequin.figure import DARK, LIGHT
from mannequin.skeleton import CHILDREN, NAMES, OFFSET, REST

FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT = 5126, 5121, 5123
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
TYPES = {1: "SCALAR", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
FORMATS = {FLOAT: "f", UNSIGNED_BYTE: "B", UNSIGNED_SHORT: "H"}

# linear base colours: maple and walnut, oiled
WOODS = {LIGHT: ([0.75, 0.52, 0.28, 1.0], 0.55), DARK: ([0.16, 0.075, 0.032, 1.0], 0.45)}


class Buffer:
    def __init__(self):
        self.bytes = bytearray()
        self.views = []
        self.accessors = []

    def add(self, rows, component, target=None, bounds=False, normalized=False):
        """Appends rows of numbers; the new accessor's index."""
        width = len(rows[0])
        flat = [value for row in rows for value in row]
        data = struct.pack(f"<{len(flat)}{FORMATS[component]}", *flat)
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.views.append(view)
        self.bytes += data + b"\0" * (-len(data) % 4)
        accessor = {"bufferView": len(self.views) - 1, "componentType": component, "count": len(rows)}
        accessor["type"] = TYPES[width]
        if normalized:
            accessor["normalized"] = True
        if bounds:
            rounded = struct.unpack(f"<{len(flat)}{FORMATS[component]}", data)
            columns = [rounded[i::width] for i in range(width)]
            accessor["min"] = [min(column) for column in columns]
            accessor["max"] = [max(column) for column in columns]
        self.accessors.append(accessor)
        return len(self.accessors) - 1


def _round(row, digits=6):
    return [round(value, digits) + 0.0 for value in row]


def _bytes_of_weights(shares):
    """Up to four (joint, weight in 1/255) that add up to 255."""
    ranked = sorted(shares.items(), key=lambda item: -item[1])[:4]
    total = sum(weight for _, weight in ranked)
    weights = [round(255 * weight / total) for _, weight in ranked]
    weights[0] += 255 - sum(weights)
    joints = [NAMES.index(name) if weight else 0 for (name, _), weight in zip(ranked, weights)]
    padding = [0] * (4 - len(ranked))
    return joints + padding, weights + padding


def _primitive(buffer, parts, material):
    positions, normals, joints, weights, triangles = [], [], [], [], []
    for part in parts:
        first = len(positions)
        for position, normal in zip(part.piece.positions, part.piece.normals()):
            positions.append(_round(position))
            normals.append(normal)
            joint, weight = _bytes_of_weights(part.weights(position))
            joints.append(joint)
            weights.append(weight)
        triangles += [[first + index] for triangle in part.piece.triangles for index in triangle]
    return {
        "attributes": {
            "POSITION": buffer.add(positions, FLOAT, ARRAY_BUFFER, bounds=True),
            "NORMAL": buffer.add(normals, FLOAT, ARRAY_BUFFER),
            "JOINTS_0": buffer.add(joints, UNSIGNED_BYTE, ARRAY_BUFFER),
            "WEIGHTS_0": buffer.add(weights, UNSIGNED_BYTE, ARRAY_BUFFER, normalized=True),
        },
        "indices": buffer.add(triangles, UNSIGNED_SHORT, ELEMENT_ARRAY_BUFFER),
        "material": material,
    }


def _nodes():
    nodes = []
    for name in NAMES:
        node = {"name": name, "translation": _round(OFFSET[name])}
        if CHILDREN[name]:
            node["children"] = [NAMES.index(child) for child in CHILDREN[name]]
        nodes.append(node)
    nodes.append({"name": "Mannequin", "mesh": 0, "skin": 0})
    return nodes


def _inverse_binds():
    rows = []
    for name in NAMES:
        x, y, z = REST[name]
        rows.append(_round([1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -x, -y, -z, 1]))
    return rows


def _animation(buffer, clip):
    times = buffer.add([[round(frame / clip.fps, 6)] for frame in range(len(clip.poses))], FLOAT, bounds=True)
    samplers, channels = [], []

    def add(name, path, rows):
        rows = [_round(row, 7) for row in rows]
        samplers.append({"input": times, "output": buffer.add(rows, FLOAT), "interpolation": "LINEAR"})
        target = {"node": NAMES.index(name), "path": path}
        channels.append({"sampler": len(samplers) - 1, "target": target})

    add("Hips", "translation", [pose["translation"] for pose in clip.poses])
    for name in NAMES:
        if name in clip.poses[0]:
            add(name, "rotation", [pose[name] for pose in clip.poses])
    return {"name": clip.name, "samplers": samplers, "channels": channels}


def glb(parts, clips):
    buffer = Buffer()
    materials = [
        {"name": name, "pbrMetallicRoughness": {"baseColorFactor": color, "metallicFactor": 0.0, "roughnessFactor": rough}}
        for name, (color, rough) in WOODS.items()
    ]
    primitives = [
        _primitive(buffer, [part for part in parts if part.wood == wood], index) for index, wood in enumerate(WOODS)
    ]
    document = {
        "asset": {"version": "2.0", "generator": "ukemi tools/make_mannequin"},
        "scene": 0,
        "scenes": [{"name": "Scene", "nodes": [NAMES.index("Hips"), len(NAMES)]}],
        "nodes": _nodes(),
        "meshes": [{"name": "Mannequin", "primitives": primitives}],
        "skins": [
            {
                "name": "Mannequin",
                "skeleton": NAMES.index("Hips"),
                "joints": list(range(len(NAMES))),
                "inverseBindMatrices": buffer.add(_inverse_binds(), FLOAT),
            }
        ],
        "materials": materials,
        "animations": [_animation(buffer, clip) for clip in clips],
    }
    document["accessors"] = buffer.accessors
    document["bufferViews"] = buffer.views
    document["buffers"] = [{"byteLength": len(buffer.bytes)}]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text
    body += struct.pack("<I4s", len(buffer.bytes), b"BIN\0") + bytes(buffer.bytes)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body
