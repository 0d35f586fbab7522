#!/usr/bin/env python3
"""Writes the scene of this example and its one mesh; with a path to rtslc, renders the frames of
the animation, and puts them into one animated PNG.

usage: make-whirligig.py [RTSLC [FRAMES]]
"""

import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
COLORS = [[0.75, 0.16, 0.1], [0.85, 0.6, 0.1], [0.15, 0.45, 0.2], [0.12, 0.3, 0.6]]


def turn(axis, turns):
    """Whole turns while time runs from 0 to 1, so that the animation can be repeated."""
    keys = [
        {"rotate": {"axis": axis, "angle": 0}},
        {"rotate": {"axis": axis, "angle": 360 * turns}},
    ]
    return {"keys": keys}


def vane():
    """A vane of a pinwheel in the plane z = 0, bent towards the viewer, with its normals: lines
    from its lower edge to its upper one."""

    def edges(s):
        lower = (s, 0, 0.1 * s)
        upper = (s, 0.95 * s * (1.2 - s) + 0.05, 0.22 * math.sin(math.pi * s) + 0.1 * s)
        return lower, upper

    def cross(a, b):
        return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]

    lines, steps, small = [], 24, 1e-4
    for i in range(steps + 1):
        s = i / steps
        lower, upper = edges(s)
        across = [b - a for a, b in zip(lower, upper)]
        for edge, point in enumerate((lower, upper)):
            before, behind = edges(s - small)[edge], edges(s + small)[edge]
            along = [(b - a) / (2 * small) for a, b in zip(before, behind)]
            normal = cross(along, across)
            length = math.hypot(*normal)
            lines.append("v {:.4f} {:.4f} {:.4f}".format(*point))
            lines.append("vn {:.4f} {:.4f} {:.4f}".format(*(c / length for c in normal)))
    for i in range(steps):
        corners = (2 * i + 1, 2 * i + 3, 2 * i + 4, 2 * i + 2)
        lines.append("f " + " ".join(f"{corner}//{corner}" for corner in corners))
    return lines


def scene():
    nodes = {
        "floor": {
            "primitive": {
                "class": "Parallelogram",
                "constructor": [[-300, 0, 20], [600, 0, 0], [0, 0, -600]],
            },
            "material": "floor",
        },
        "post": {
            "primitive": {"class": "Cylinder", "constructor": [[0, 0, 0], [0, 3, 0], 0.09]},
            "material": "wood",
        },
        "axle": {
            "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 0.16},
            "material": "brass",
        },
        "lamp": {
            "primitive": {"class": "Sphere", "center": [-7, 11, 9], "radius": 1.6},
            "material": "lamp",
        },
    }
    for number in range(4):
        nodes[f"vane {number}"] = {"mesh": "vane.obj", "material": f"paint {number}"}
    nodes["pinwheel"] = {
        "children": [
            {"child": f"vane {number}", "transform": {"rotate": [0, 0, 90 * number]}}
            for number in range(4)
        ]
        + ["axle"],
        "transform": turn([0, 0, 1], -4),
    }
    nodes["spoke"] = {
        "children": [
            {
                "primitive": {"class": "Cylinder", "constructor": [[0, 0, 0], [2, 0, 0], 0.05]},
                "material": "wood",
            },
            # Each pinwheel keeps upright: its axis turns back as the wheel turns.
            {
                "child": "pinwheel",
                "transform": [{"scale": 1.1}, turn([0, 0, 1], -1), {"translate": [2, 0, 0.15]}],
            },
        ]
    }
    nodes["wheel"] = {
        "children": [
            {"child": "spoke", "transform": {"rotate": [0, 0, 72 * number]}} for number in range(5)
        ]
        + [{"child": "axle", "transform": {"scale": 1.6}}],
        "transform": turn([0, 0, 1], 1),
    }
    nodes["whirligig"] = {
        "children": [
            "post",
            {
                "child": "wheel",
                "transform": [
                    {"translate": [0, 0, 0.3]},
                    {
                        "keys": [
                            {"rotate": [0, -18, 0]},
                            {"rotate": [0, 18, 0]},
                            {"rotate": [0, -18, 0]},
                        ]
                    },
                    {"translate": [0, 3, 0]},
                ],
            },
        ],
    }
    nodes["world"] = {"children": ["floor", "whirligig", "lamp"]}
    materials = {
        "floor": {"class": "Lambert", "reflectance": [0.42, 0.5, 0.3]},
        "wood": {"class": "Lambert", "reflectance": [0.3, 0.19, 0.1]},
        "brass": {"class": "Gold", "alpha": 0.2},
        "lamp": {"class": "Emitter", "radiance": [38, 35, 30]},
    }
    for number, color in enumerate(COLORS):
        materials[f"paint {number}"] = {"class": "Plastic", "reflectance": color, "alpha": 0.1}
    return {
        "rtsl": 1,
        "import": ["std.cameras", "std.primitives", "std.materials", "std.backgrounds"],
        "camera": {
            "class": "PerspectiveCamera",
            "constructor": {"eye": [0.6, 2.9, 9.6], "target": [0, 3, 0], "up": [0, 1, 0]},
            "fieldOfView": 38,
        },
        "background": {
            "class": "GradientSky",
            "zenith": [0.25, 0.45, 0.8],
            "horizon": [0.85, 0.9, 0.95],
            "ground": [0.3, 0.32, 0.25],
        },
        "materials": materials,
        "nodes": nodes,
        "root": "world",
        # A frame of 24: the shutter is open for a quarter of its time.
        "render": {
            "engine": "path",
            "size": [480, 360],
            "spp": 128,
            "depth": 5,
            "shutter": [0.125, 0.135],
        },
    }


def chunks(png):
    """The chunks of a PNG file: (type, data)."""
    at = 8
    while at < len(png):
        (length,) = struct.unpack(">I", png[at : at + 4])
        yield png[at + 4 : at + 8], png[at + 8 : at + 8 + length]
        at += 12 + length


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def animated(frames, milliseconds):
    """An animated PNG of PNG files of one size (APNG 1.0)."""
    first = dict(chunks(frames[0]))
    width, height = struct.unpack(">II", first[b"IHDR"][:8])
    out, number = (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", first[b"IHDR"])
        + chunk(b"acTL", struct.pack(">II", len(frames), 0)),
        0,
    )
    for index, frame in enumerate(frames):
        out += chunk(
            b"fcTL",
            struct.pack(">IIIIIHHBB", number, width, height, 0, 0, milliseconds, 1000, 0, 0),
        )
        number += 1
        for kind, data in chunks(frame):
            if kind != b"IDAT":
                continue
            if index == 0:
                out += chunk(b"IDAT", data)
            else:
                out += chunk(b"fdAT", struct.pack(">I", number) + data)
                number += 1
    return out + chunk(b"IEND", b"")


def main():
    if len(sys.argv) > 3:
        sys.exit(__doc__)
    (HERE / "vane.obj").write_text("\n".join(vane()) + "\n")
    (HERE / "whirligig.json").write_text(json.dumps(scene(), indent=1) + "\n")
    if len(sys.argv) < 2:
        return
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 24
    with tempfile.TemporaryDirectory() as folder:
        frames = []
        for frame in range(count):
            picture = pathlib.Path(folder, f"{frame:04}.png")
            shutter = [frame / count, (frame + 0.25) / count]
            subprocess.run(
                [
                    sys.argv[1],
                    "render",
                    HERE / "whirligig.json",
                    "-o",
                    picture,
                    "--size",
                    "240x180",
                    "--spp",
                    "64",
                    "--set",
                    f"render.shutter={shutter}",
                ],
                check=True,
            )
            frames.append(picture.read_bytes())
    (HERE / "animation.png").write_bytes(animated(frames, 2000 // count))


if __name__ == "__main__":
    main()
