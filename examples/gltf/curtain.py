#!/usr/bin/env python3
"""Writes a glTF model whose shape changes: curtain.gltf, a cloth with two morph targets whose
weights are animated.

    curtain.py FOLDER

One target is a fold that hangs to the left, the other one a fold to the right; the cloth swings
from one to the other and back in two seconds. Its buffer is in the JSON.
"""
import base64
import json
import math
import struct
import sys
from pathlib import Path

COLUMNS, ROWS = 36, 16
WIDTH, HEIGHT = 3.0, 2.0


def grid(function):
    return [
        function(column / COLUMNS, row / ROWS)
        for row in range(ROWS + 1)
        for column in range(COLUMNS + 1)
    ]


def hanging(u, v):
    """A cloth in even folds, fixed at v = 1."""
    return (WIDTH * (u - 0.5), HEIGHT * v, 0.12 * math.sin(6 * math.pi * u) * (1.2 - 0.4 * v))


def swung(side):
    """What a draught adds: more, the lower it is."""

    def difference(u, v):
        loose = (1 - v) ** 2
        wave = math.sin(2 * math.pi * (u + 0.25 * side) + 3 * v)
        return (0.35 * side * loose, 0.1 * loose, 0.45 * loose * wave)

    return difference


def normals(shape):
    def at(u, v):
        step = 1e-4
        (ax, ay, az), (bx, by, bz) = shape(u - step, v), shape(u + step, v)
        (cx, cy, cz), (dx, dy, dz) = shape(u, v - step), shape(u, v + step)
        a, b = (bx - ax, by - ay, bz - az), (dx - cx, dy - cy, dz - cz)
        n = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
        length = math.sqrt(sum(x * x for x in n))
        return tuple(x / length for x in n)

    return at


def main():
    buffer, views, accessors = bytearray(), [], []

    def accessor(rows, kind, form="f", component=5126, **more):
        data = b"".join(struct.pack(f"<{len(row)}{form}", *row) for row in rows)
        views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
        buffer.extend(data)
        buffer.extend(b"\0" * (-len(buffer) % 4))
        accessors.append(
            {
                "bufferView": len(views) - 1,
                "componentType": component,
                "count": len(rows),
                "type": kind,
                **more,
            }
        )
        return len(accessors) - 1

    def difference(side):
        """Positions and normals of a target, less those of the cloth at rest."""
        add = swung(side)

        def shape(u, v):
            return tuple(a + b for a, b in zip(hanging(u, v), add(u, v)))

        before, after = grid(normals(hanging)), grid(normals(shape))
        turns = [tuple(b - a for a, b in zip(*pair)) for pair in zip(before, after)]
        return {"POSITION": accessor(grid(add), "VEC3"), "NORMAL": accessor(turns, "VEC3")}

    positions = grid(hanging)
    rounded = [struct.unpack("<3f", struct.pack("<3f", *p)) for p in positions]
    bounds = {key: [f(c) for c in zip(*rounded)] for key, f in (("min", min), ("max", max))}
    indices = []
    for row in range(ROWS):
        for column in range(COLUMNS):
            a = row * (COLUMNS + 1) + column
            b = a + COLUMNS + 1
            indices += [(i,) for i in (a, a + 1, b + 1, a, b + 1, b)]
    primitive = {
        "attributes": {
            "POSITION": accessor(positions, "VEC3", **bounds),
            "NORMAL": accessor(grid(normals(hanging)), "VEC3"),
            "TEXCOORD_0": accessor(grid(lambda u, v: (u, 1 - v)), "VEC2"),
        },
        "indices": accessor(indices, "SCALAR", "H", 5123),
        "targets": [difference(-1), difference(1)],
        "material": 0,
    }
    times = accessor([(t / 2,) for t in range(5)], "SCALAR", min=[0], max=[2])
    swing = [(1, 0), (0, 0), (0, 1), (0, 0), (1, 0)]
    weights = accessor([(w,) for key in swing for w in key], "SCALAR")
    cloth = {"baseColorFactor": [0.62, 0.1, 0.08, 1], "metallicFactor": 0, "roughnessFactor": 0.9}
    document = {
        "asset": {"version": "2.0", "generator": "curtain.py"},
        "scenes": [{"nodes": [0]}],
        "scene": 0,
        "nodes": [{"name": "curtain", "mesh": 0}],
        "meshes": [{"name": "cloth", "primitives": [primitive], "weights": [0, 0]}],
        "materials": [{"name": "velvet", "pbrMetallicRoughness": cloth, "doubleSided": True}],
        "animations": [
            {
                "name": "draught",
                "samplers": [{"input": times, "output": weights}],
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}],
            }
        ],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [
            {
                "byteLength": len(buffer),
                "uri": "data:application/octet-stream;base64," + base64.b64encode(buffer).decode(),
            }
        ],
    }
    text = json.dumps(document, indent=1)
    Path(sys.argv[1], "curtain.gltf").write_text(text + "\n")


main()
