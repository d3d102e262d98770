"""The figure and its clips as one binary glTF."""

import json
import math
import struct

from mannequin.figure import DARK, LIGHT
from mannequin.grain import grain_png
from mannequin.skeleton import CHILDREN, NAMES, OFFSET, REST

FLOAT, UNSIGNED_BYTE, UNSIGNED_SHORT = 5126, 5121, 5123
ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER = 34962, 34963
TYPES = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4", 16: "MAT4"}
FORMATS = {FLOAT: "f", UNSIGNED_BYTE: "B", UNSIGNED_SHORT: "H"}

GRAIN_M = 0.30  # side of the grain picture on the figure

# linear base colours: maple and walnut, oiled
WOODS = {LIGHT: ([0.75, 0.52, 0.28, 1.0], 0.55), DARK: ([0.16, 0.075, 0.032, 1.0], 0.45)}


class Buffer:
    def __init__(self):
        self.bytes = bytearray()
        self.views = []
        self.accessors = []

    def view(self, data, target=None):
        view = {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)}
        if target:
            view["target"] = target
        self.views.append(view)
        self.bytes += data + b"\0" * (-len(data) % 4)
        return len(self.views) - 1

    def add(self, rows, component, target=None, bounds=False, normalized=False):
        """Appends rows of numbers; the new accessor's index."""
        width = len(rows[0])
        flat = [value for row in rows for value in row]
        data = struct.pack(f"<{len(flat)}{FORMATS[component]}", *flat)
        accessor = {"bufferView": self.view(data, target), "componentType": component, "count": len(rows)}
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


def _unwrap(piece):
    """Corners (vertex, turn around the axis) of every triangle, without a jump where a turn ends."""
    triangles = []
    for triangle in piece.triangles:
        around = [piece.grain[vertex][1] for vertex in triangle]
        known = [a for a in around if a is not None]
        wrapped = max(known) - min(known) > math.pi
        around = [a if a is None or not wrapped or a > math.pi else a + 2 * math.pi for a in around]
        known = [a for a in around if a is not None]
        turns = [(sum(known) / len(known) if a is None else a) / (2 * math.pi) for a in around]
        triangles.append([(vertex, round(turn, 6)) for vertex, turn in zip(triangle, turns)])
    return triangles


def _primitive(buffer, parts, material):
    positions, normals, uvs, joints, weights, indices = [], [], [], [], [], []
    for number, part in enumerate(parts):
        piece_normals = part.piece.normals()
        repeats = max(1, round(part.piece.girth / GRAIN_M))
        index_of = {}
        for corner in [corner for triangle in _unwrap(part.piece) for corner in triangle]:
            if corner not in index_of:
                index_of[corner] = len(positions)
                vertex, turn = corner
                position = part.piece.positions[vertex]
                positions.append(_round(position))
                normals.append(piece_normals[vertex])
                along = part.piece.grain[vertex][0] / GRAIN_M
                uvs.append(_round([turn * repeats + 0.37 * number, along + 0.61 * number]))
                joint, weight = _bytes_of_weights(part.weights(position))
                joints.append(joint)
                weights.append(weight)
            indices.append([index_of[corner]])
    return {
        "attributes": {
            "POSITION": buffer.add(positions, FLOAT, ARRAY_BUFFER, bounds=True),
            "NORMAL": buffer.add(normals, FLOAT, ARRAY_BUFFER),
            "TEXCOORD_0": buffer.add(uvs, FLOAT, ARRAY_BUFFER),
            "JOINTS_0": buffer.add(joints, UNSIGNED_BYTE, ARRAY_BUFFER),
            "WEIGHTS_0": buffer.add(weights, UNSIGNED_BYTE, ARRAY_BUFFER, normalized=True),
        },
        "indices": buffer.add(indices, UNSIGNED_SHORT, ELEMENT_ARRAY_BUFFER),
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
        {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": color, "baseColorTexture": {"index": 0}, "metallicFactor": 0.0, "roughnessFactor": rough}}
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
    document["textures"] = [{"source": 0, "sampler": 0}]
    document["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}]
    document["images"] = [{"name": "grain", "mimeType": "image/png", "bufferView": buffer.view(grain_png())}]
    document["accessors"] = buffer.accessors
    document["bufferViews"] = buffer.views
    document["buffers"] = [{"byteLength": len(buffer.bytes)}]
    text = json.dumps(document, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    body = struct.pack("<I4s", len(text), b"JSON") + text
    body += struct.pack("<I4s", len(buffer.bytes), b"BIN\0") + bytes(buffer.bytes)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body
