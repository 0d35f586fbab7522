#!/usr/bin/env python3
"""Writes a glTF model with each feature that scenes read: still-life.gltf, its buffer, and its
images.

    model.py FOLDER

Images lie in a file, in the buffer, and in the JSON itself.
"""
import base64
import json
import math
import struct
import sys
import zlib
from pathlib import Path

buffer = bytearray()
views, accessors, images, textures, materials, meshes, nodes = [], [], [], [], [], [], []

ARRAY, INDICES = 34962, 34963
UNSIGNED_BYTE, UNSIGNED_SHORT, FLOAT = 5121, 5123, 5126


def add(items, item):
    items.append(item)
    return len(items) - 1


def view(data, target=None):
    buffer.extend(b"\0" * (-len(buffer) % 4))
    item = {"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)}
    if target:
        item["target"] = target
    buffer.extend(data)
    return add(views, item)


def vectors(rows, bounds=False):
    item = {
        "bufferView": view(b"".join(struct.pack(f"<{len(row)}f", *row) for row in rows), ARRAY),
        "componentType": FLOAT,
        "count": len(rows),
        "type": f"VEC{len(rows[0])}",
    }
    if bounds:  # as the file has the numbers
        rounded = [struct.unpack("<3f", struct.pack("<3f", *row)) for row in rows]
        item["min"] = [min(column) for column in zip(*rounded)]
        item["max"] = [max(column) for column in zip(*rounded)]
    return add(accessors, item)


def whole(numbers):
    return add(
        accessors,
        {
            "bufferView": view(struct.pack(f"<{len(numbers)}H", *numbers), INDICES),
            "componentType": UNSIGNED_SHORT,
            "count": len(numbers),
            "type": "SCALAR",
        },
    )


def primitive(points, normals, uvs, triangles, material, mode=4):
    attributes = {"POSITION": vectors(points, True), "NORMAL": vectors(normals)}
    if uvs:
        attributes["TEXCOORD_0"] = vectors(uvs)
    item = {"attributes": attributes, "material": material}
    if triangles:
        item["indices"] = whole(triangles)
    if mode != 4:
        item["mode"] = mode
    return item


def ball(material, rings=16, sides=28):
    points, uvs, triangles = [], [], []
    for i in range(rings + 1):
        for j in range(sides + 1):
            down, around = math.pi * i / rings, 2 * math.pi * j / sides
            points.append(
                (
                    math.sin(down) * math.sin(around),
                    math.cos(down),
                    math.sin(down) * math.cos(around),
                )
            )
            uvs.append((j / sides, i / rings))
    for i in range(rings):
        for j in range(sides):
            a = i * (sides + 1) + j
            b = a + sides + 1
            triangles += ([a, b, a + 1] if i else []) + ([a + 1, b, b + 1] if i < rings - 1 else [])
    return primitive(points, points, uvs, triangles, material)


def card(material, width, height, repeats=1, mode=5):
    """A rectangle that faces z, as a strip."""
    x, y = width / 2, height / 2
    points = [(-x, -y, 0), (x, -y, 0), (-x, y, 0), (x, y, 0)]
    uvs = [(0, repeats), (repeats, repeats), (0, 0), (repeats, 0)]
    return primitive(points, [(0, 0, 1)] * 4, uvs, None, material, mode)


def post(material, sides=24):
    """A cylinder about y from 0 to 1, flat-shaded at its ends: a side and a lid."""
    circle = [
        (math.sin(2 * math.pi * i / sides), math.cos(2 * math.pi * i / sides))
        for i in range(sides + 1)
    ]
    points = [(x, y, z) for x, z in circle for y in (0, 1)]
    normals = [(x, 0, z) for x, z in circle for _ in (0, 1)]
    uvs = [(2 * i / sides, 1 - y) for i in range(sides + 1) for y in (0, 1)]
    side = []
    for i in range(sides):
        side += [2 * i, 2 * i + 2, 2 * i + 1, 2 * i + 1, 2 * i + 2, 2 * i + 3]
    lid = [(0, 1, 0)] + [(x, 1, z) for x, z in circle]
    return [
        primitive(points, normals, uvs, side, material),
        primitive(lid, [(0, 1, 0)] * len(lid), [(0.5, 0.5)] * len(lid), None, material, 6),
    ]


def png(size, pixel, channels=3):
    def chunk(name, data):
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    rows = b"".join(
        b"\0" + bytes(c for x in range(size) for c in pixel(x / size, y / size))
        for y in range(size)
    )
    kind = {1: 0, 3: 2, 4: 6}[channels]
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, 8, kind, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(rows, 9))
        + chunk(b"IEND", b"")
    )


def byte(value):
    return max(0, min(255, round(255 * value)))


def tiles(u, v):
    """Glazed tiles in two colors; upright letters show which way is up."""
    odd = (int(u * 4) + int(v * 4)) % 2
    near = min(u * 4 % 1, v * 4 % 1) < 0.06
    return (190, 186, 176) if near else (206, 124, 72) if odd else (228, 214, 186)


def bumps(u, v):
    """Normals of a pattern of waves."""
    slope = [0.55 * math.sin(8 * math.pi * u), 0.55 * math.sin(8 * math.pi * v)]
    length = math.sqrt(slope[0] ** 2 + slope[1] ** 2 + 1)
    return [byte(0.5 + 0.5 * x / length) for x in (-slope[0], slope[1], 1)]


def wear(u, v):
    """Metal in blue and roughness in green: bands of brushed metal and paint."""
    band = int(v * 6) % 2
    return (0, 60 if band else 150, 255 if band else 0)


def leaf(u, v):
    """Green with a hole around it, in alpha."""
    x, y = abs(2 * u - 1), 1 - v
    inside = (
        x < 0.95 * math.sin(math.pi * y) ** 0.7 * (0.6 + 0.4 * abs(math.sin(9 * math.pi * y)))
        or x < 0.03
    )
    vein = x < 0.03 or abs((y * 9 + x * 3) % 1 - 0.5) < 0.06
    return (118, 160, 60, 255 * inside) if vein else (52, 112, 36, 255 * inside)


def texture(data, file=None, sampler=0, embedded=False):
    item = {"mimeType": "image/png"}
    if file:
        (folder / file).write_bytes(data)
        item = {"uri": file}
    elif embedded:
        item = {"uri": "data:image/png;base64," + base64.b64encode(data).decode()}
    else:
        item["bufferView"] = view(data)
    return add(textures, {"source": add(images, item), "sampler": sampler})


def material(
    name, color=(1, 1, 1, 1), metallic=0.0, roughness=0.5, extensions=None, pbr=None, **others
):
    item = {
        "name": name,
        "pbrMetallicRoughness": {
            "baseColorFactor": list(color),
            "metallicFactor": metallic,
            "roughnessFactor": roughness,
            **(pbr or {}),
        },
        **others,
    }
    if extensions:
        item["extensions"] = {f"KHR_materials_{key}": value for key, value in extensions.items()}
    return add(materials, item)


def mesh(name, *primitives):
    return add(meshes, {"name": name, "primitives": list(primitives)})


def node(name, children=(), **others):
    item = {"name": name, **others}
    if children:
        item["children"] = list(children)
    return add(nodes, item)


def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return [math.sin(half) * x for x in axis] + [math.cos(half)]


def build():
    tiled = {
        "index": texture(png(32, tiles), "tiles.png"),
        "extensions": {
            "KHR_texture_transform": {"offset": [0.125, 0.25], "scale": [3, 3], "rotation": 0.2}
        },
    }
    floor = material("tiles", roughness=0.35, pbr={"baseColorTexture": tiled}, doubleSided=True)
    gold = material("gold", (1, 0.77, 0.34, 1), 1, 0.3)
    lacquer = material(
        "lacquer",
        (0.6, 0.02, 0.03, 1),
        0,
        0.6,
        {
            "clearcoat": {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.05},
            "ior": {"ior": 1.6},
        },
        normalTexture={"index": texture(png(64, bumps)), "scale": 0.7},
    )
    worn = material(
        "worn paint",
        (0.25, 0.5, 0.75, 1),
        1,
        1,
        pbr={
            "metallicRoughnessTexture": {"index": texture(png(32, wear), embedded=True, sampler=1)}
        },
    )
    glass = material(
        "pane", (0.75, 0.95, 0.85, 1), 0, 0, {"transmission": {"transmissionFactor": 0.95}}
    )
    leaves = material(
        "leaf",
        roughness=0.7,
        alphaMode="MASK",
        alphaCutoff=0.4,
        doubleSided=True,
        pbr={"baseColorTexture": {"index": texture(png(64, leaf, 4), sampler=2)}},
    )
    gauze = material(
        "gauze", (0.9, 0.9, 1, 0.35), roughness=0.9, alphaMode="BLEND", doubleSided=True
    )
    cloth = material(
        "cloth",
        (0.15, 0.05, 0.25, 1),
        0,
        0.9,
        {"sheen": {"sheenColorFactor": [0.5, 0.4, 0.6], "sheenRoughnessFactor": 0.6}},
    )
    lamp = material(
        "lamp",
        (0, 0, 0, 1),
        emissiveFactor=[1, 0.8, 0.5],
        extensions={"emissive_strength": {"emissiveStrength": 30}},
    )
    sign = material("sign", (0.1, 0.6, 0.3, 1), extensions={"unlit": {}})

    ground = mesh("ground", card(floor, 9, 9))
    balls = {
        name: mesh(f"{name} ball", ball(made))
        for name, made in (("gold", gold), ("lacquer", lacquer), ("cloth", cloth))
    }
    bulb = mesh("bulb", ball(lamp, 8, 12))
    pillar = mesh("pillar", *post(worn))
    pane, gauzeCard = mesh("pane", card(glass, 1.3, 1.6)), mesh("gauze", card(gauze, 1.2, 1.4))
    leafCard, signCard = mesh("leaf", card(leaves, 0.8, 1.2)), mesh("sign", card(sign, 0.5, 0.12))

    pillars = [
        node(
            f"pillar {i}",
            mesh=pillar,
            translation=[1.15 * i - 2.3, 0, -1.9],
            scale=[0.22, 0.7 + 0.25 * i, 0.22],
        )
        for i in range(5)
    ]
    twig = [
        node(f"leaf {i}", mesh=leafCard, translation=[0, 0.55, 0.12], rotation=turn([1, 0, 0], 20))
        for i in range(3)
    ]
    plant = node(
        "plant",
        [
            node(f"turned {i}", [one], rotation=turn([0, 1, 0], 120 * i - 40))
            for i, one in enumerate(twig)
        ],
        translation=[2.0, 0, -0.4],
    )
    lights = [
        {
            "type": "spot",
            "color": [1, 0.95, 0.85],
            "intensity": 75,
            "spot": {"innerConeAngle": 0.3, "outerConeAngle": 0.6},
        },
        {"type": "point", "color": [0.6, 0.75, 1], "intensity": 9},
        {"type": "directional", "intensity": 0.5},
    ]

    def lit(name, index, **others):
        return node(name, extensions={"KHR_lights_punctual": {"light": index}}, **others)

    # Looks from (0, 2.4, 5.2) down by 18 degrees.
    front = node("front", camera=0, translation=[0, 2.4, 5.2], rotation=turn([1, 0, 0], -18))
    plan = node("plan", camera=1, translation=[0, 8, 0], rotation=turn([1, 0, 0], -90))
    down = [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1]
    still = node(
        "still life",
        [
            node("ground", mesh=ground, matrix=down),
            *pillars,
            plant,
            node("gold", mesh=balls["gold"], translation=[-1.2, 0.55, 0.2], scale=[0.55] * 3),
            node(
                "lacquer",
                mesh=balls["lacquer"],
                translation=[0.1, 0.6, -0.5],
                scale=[0.6] * 3,
                rotation=turn([0, 1, 0], 30),
            ),
            node("cloth", mesh=balls["cloth"], translation=[1.15, 0.35, 0.7], scale=[0.35] * 3),
            node("small gold", mesh=balls["gold"], translation=[0.35, 0.2, 1.1], scale=[0.2] * 3),
            node("bulb", mesh=bulb, translation=[-2.3, 0.88, -1.9], scale=[0.18] * 3),
            node("pane", mesh=pane, translation=[-0.6, 0.8, 1.0], rotation=turn([0, 1, 0], 25)),
            node(
                "gauze", mesh=gauzeCard, translation=[1.5, 0.7, -1.0], rotation=turn([0, 1, 0], -20)
            ),
            node(
                "sign", mesh=signCard, translation=[1.6, 0.06, 1.5], rotation=turn([0, 1, 0], -20)
            ),
            lit("spot", 0, translation=[2.5, 5, 3], rotation=turn([-0.79, 0.39, 0.47], 70)),
            lit("point", 1, translation=[-3.2, 3.2, 2.5]),
            lit("sun", 2, rotation=turn([1, 0, 0], -60)),
        ],
    )

    return {
        "asset": {"version": "2.0", "generator": "examples/gltf/model.py"},
        "extensionsUsed": ["KHR_lights_punctual", "KHR_texture_transform"]
        + sorted({key for one in materials for key in one.get("extensions", {})}),
        "scene": 0,
        "scenes": [{"nodes": [still, front, plan]}],
        "nodes": nodes,
        "meshes": meshes,
        "cameras": [
            {"name": "Front", "type": "perspective", "perspective": {"yfov": 0.62, "znear": 0.1}},
            {
                "name": "Plan",
                "type": "orthographic",
                "orthographic": {"xmag": 3.2, "ymag": 2.4, "znear": 0.1, "zfar": 20},
            },
        ],
        "extensions": {"KHR_lights_punctual": {"lights": lights}},
        "materials": materials,
        "textures": textures,
        "images": images,
        "samplers": [
            {"wrapS": 10497, "wrapT": 10497, "magFilter": 9729, "minFilter": 9987},
            {"wrapS": 10497, "wrapT": 33648, "magFilter": 9728},
            {"wrapS": 33071, "wrapT": 33071, "magFilter": 9729},
        ],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"uri": "still-life.bin", "byteLength": len(buffer)}],
    }


folder = Path(sys.argv[1])
document = build()
(folder / "still-life.bin").write_bytes(buffer)


def dump(value, indent=""):
    """JSON with short lists on one line."""
    line = json.dumps(value)
    if len(indent) + len(line) <= 120 or not isinstance(value, (dict, list)):
        return line
    inner = indent + " "
    if isinstance(value, dict):
        return (
            "{\n"
            + ",\n".join(f"{inner}{json.dumps(k)}: {dump(v, inner)}" for k, v in value.items())
            + "\n"
            + indent
            + "}"
        )
    return "[\n" + ",\n".join(inner + dump(v, inner) for v in value) + "\n" + indent + "]"


(folder / "still-life.gltf").write_text(dump(document) + "\n")
