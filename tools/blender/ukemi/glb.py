# SPDX-License-Identifier: GPL-3.0-or-later
"""Binary glTF, as much of it as goes to the program and comes back. Knows nothing of Blender."""

import array
import json
import struct
import sys

_MAGIC = b"glTF"
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_FLOAT, _USHORT, _UINT = 5126, 5123, 5125
_TYPES = {"SCALAR": 1, "VEC3": 3, "VEC4": 4, "MAT4": 16}
_CODES = {_FLOAT: "f", _USHORT: "H", _UINT: "I"}


class Document:
    """A glTF that is being written: JSON, and the bytes of its one buffer."""

    def __init__(self):
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}], "nodes": []}
        self._bytes = bytearray()

    def add(self, key, value):
        """Appends to a list of the document; returns the index."""
        entries = self.json.setdefault(key, [])
        entries.append(value)
        return len(entries) - 1

    def add_accessor(self, values, kind, component=_FLOAT, bounds=False):
        """`values`: numbers in a row, `kind` of them each (VEC3, ...). Returns the accessor's index."""
        width = _TYPES[kind]
        packed = array.array(_CODES[component], values)
        if sys.byteorder == "big":
            packed.byteswap()
        self._bytes.extend(b"\0" * (-len(self._bytes) % 4))
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self._bytes), "byteLength": len(packed) * packed.itemsize})
        self._bytes.extend(packed.tobytes())
        accessor = {"bufferView": view, "componentType": component, "count": len(packed) // width, "type": kind}
        if bounds:
            columns = [values[i::width] for i in range(width)]
            accessor["min"], accessor["max"] = [min(c) for c in columns], [max(c) for c in columns]
        return self.add("accessors", accessor)

    def write(self, path):
        self._bytes.extend(b"\0" * (-len(self._bytes) % 4))
        if self._bytes:
            self.json["buffers"] = [{"byteLength": len(self._bytes)}]
        text = json.dumps(self.json, separators=(",", ":")).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sII", _MAGIC, 2, 12 + 8 + len(text) + (8 + len(self._bytes) if self._bytes else 0)))
            file.write(struct.pack("<II", len(text), _JSON) + text)
            if self._bytes:
                file.write(struct.pack("<II", len(self._bytes), _BIN) + self._bytes)


USHORT, UINT = _USHORT, _UINT


class Clip:
    """The last animation of a file that the program wrote with all keys.

    `times`: seconds of the frames; `channels[node][path]`: a list with one value for each of them, quaternions as
    x y z w; `extras`: what the program says of the clip; `nodes`: the file's nodes, as they stand in it.
    """

    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        if data[:4] != _MAGIC:
            raise ValueError(f"{path} is no binary glTF")
        length = struct.unpack_from("<I", data, 12)[0]
        self._json = json.loads(data[20 : 20 + length])
        self._binary = memoryview(data)[20 + length + 8 :]
        self.nodes = self._json["nodes"]
        animation = self._json["animations"][-1]
        self.name = animation.get("name", "hit")
        self.extras = animation.get("extras", {}).get("ukemi", {})
        self.channels, self.times = {}, []
        times = {}
        for channel in animation["channels"]:
            sampler = animation["samplers"][channel["sampler"]]
            target = channel["target"]
            key = sampler["input"]
            if key not in times:
                times[key] = self._read(key)
            values = self._read(sampler["output"])
            self.channels.setdefault(target["node"], {})[target["path"]] = (times[key], values)
            if len(times[key]) > len(self.times):
                self.times = times[key]
        for paths in self.channels.values():
            for path, (own, values) in paths.items():
                paths[path] = values if len(own) == len(self.times) else _spread(own, values, self.times)

    def _read(self, index):
        accessor = self._json["accessors"][index]
        view = self._json["bufferViews"][accessor["bufferView"]]
        width = _TYPES[accessor["type"]]
        numbers = array.array(_CODES[accessor["componentType"]])
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        stride = view.get("byteStride", 0) or width * numbers.itemsize
        if stride == width * numbers.itemsize:
            numbers.frombytes(self._binary[start : start + accessor["count"] * stride])
        else:
            for i in range(accessor["count"]):
                at = start + i * stride
                numbers.frombytes(self._binary[at : at + width * numbers.itemsize])
        if sys.byteorder == "big":
            numbers.byteswap()
        return list(numbers) if width == 1 else [tuple(numbers[i : i + width]) for i in range(0, len(numbers), width)]


def _spread(own, values, times):
    """Values of a channel with fewer keys (one that stands still has one or two) at all times."""
    spread, at = [], 0
    for time in times:
        while at + 1 < len(own) and own[at + 1] <= time + 1e-6:
            at += 1
        spread.append(values[at])
    return spread
