#!/usr/bin/env python3
"""make-forest.py: writes tree.obj, leaves.obj, far.obj and forest.json, always the same ones."""

import json
import math
import random

shuffle = random.Random(7)


def write(name, vertices, coordinates, faces):
    with open(name, "w") as file:
        file.writelines(f"v {x:.4g} {y:.4g} {z:.4g}\n" for x, y, z in vertices)
        file.writelines(f"vt {u:g} {v:g}\n" for u, v in coordinates)
        file.writelines(
            "f " + " ".join(str(i) if not coordinates else f"{i}/{t}" for i, t in face) + "\n"
            for face in faces
        )


def branch(vertices, faces, start, end, thick, thin, sides):
    """A cone between two points."""
    along = [b - a for a, b in zip(start, end)]
    length = math.hypot(*along)
    along = [x / length for x in along]
    other = (1, 0, 0) if abs(along[0]) < 0.7 else (0, 0, 1)
    u = [
        along[1] * other[2] - along[2] * other[1],
        along[2] * other[0] - along[0] * other[2],
        along[0] * other[1] - along[1] * other[0],
    ]
    size = math.hypot(*u)
    u = [x / size for x in u]
    v = [
        along[1] * u[2] - along[2] * u[1],
        along[2] * u[0] - along[0] * u[2],
        along[0] * u[1] - along[1] * u[0],
    ]
    first = len(vertices) + 1
    for center, radius in ((start, thick), (end, thin)):
        for i in range(sides):
            c, s = math.cos(2 * math.pi * i / sides), math.sin(2 * math.pi * i / sides)
            vertices.append([p + radius * (c * a + s * b) for p, a, b in zip(center, u, v)])
    for i in range(sides):
        j = (i + 1) % sides
        faces.append(
            [(first + i, 0), (first + j, 0), (first + sides + j, 0), (first + sides + i, 0)]
        )


def tree():
    """A trunk with branches, about 9 high, and where its leaves are."""
    vertices, faces, tips = [], [], []
    branch(vertices, faces, (0, 0, 0), (0, 7.5, 0), 0.3, 0.05, 8)
    for i in range(26):
        height = 2.2 + 5.2 * i / 26
        turn = 2.4 * i + shuffle.uniform(-0.3, 0.3)
        reach = (2.9 - 0.3 * abs(i - 6)) if i < 6 else 2.9 * (1 - ((i - 6) / 24) ** 1.3)
        tip = (reach * math.cos(turn), height + 0.45 * reach, reach * math.sin(turn))
        branch(vertices, faces, (0, height, 0), tip, 0.09, 0.015, 4)
        for share in (0.45, 0.7, 0.9, 1.05):
            tips.append([share * tip[0], height + share * 0.45 * reach, share * tip[2]])
    tips.append([0, 7.7, 0])
    return vertices, faces, tips


def leaves(tips):
    """Cards at random angles around the tips."""
    vertices, faces = [], []
    for tip in tips:
        for _ in range(5):
            center = [x + shuffle.gauss(0, 0.28) for x in tip]
            a, b = shuffle.uniform(0, 2 * math.pi), shuffle.uniform(-0.9, 0.9)
            u = [
                0.34 * math.cos(a) * math.cos(b),
                0.34 * math.sin(b),
                0.34 * math.sin(a) * math.cos(b),
            ]
            c = a + math.pi / 2
            v = [0.34 * math.cos(c), shuffle.uniform(-0.15, 0.15), 0.34 * math.sin(c)]
            first = len(vertices) + 1
            for s, t in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                vertices.append([p + s * x + t * y for p, x, y in zip(center, u, v)])
            faces.append([(first + i, i + 1) for i in range(4)])
    return vertices, faces


def far():
    """A trunk and a crown of a few triangles."""
    vertices, faces = [], []
    branch(vertices, faces, (0, 0, 0), (0, 3, 0), 0.25, 0.2, 4)
    branch(vertices, faces, (0, 2.2, 0), (0, 4.4, 0), 1.4, 2.6, 6)
    branch(vertices, faces, (0, 4.4, 0), (0, 8.2, 0), 2.6, 0.1, 6)
    return vertices, faces


def group(child, count, size, wobble, **changes):
    """`count` children on a loose grid of `size` meters a cell."""
    across = round(math.sqrt(count))
    children = []
    for i in range(count):
        x, z = (i % across - (across - 1) / 2) * size, (i // across - (across - 1) / 2) * size
        children.append(
            {
                "child": child,
                "transform": {
                    "scale": round(shuffle.uniform(0.75, 1.25), 3) if child == "tree" else 1,
                    "rotate": [
                        0,
                        round(shuffle.uniform(0, 360))
                        if child == "tree"
                        else 90 * shuffle.randrange(4),
                        0,
                    ],
                    "translate": [
                        round(x + shuffle.uniform(-wobble, wobble), 2),
                        0,
                        round(z + shuffle.uniform(-wobble, wobble), 2),
                    ],
                },
            }
        )
    return {"children": children, **changes}


trunk, faces, tips = tree()
write("tree.obj", trunk, [], faces)
vertices, cards = leaves(tips)
write("leaves.obj", vertices, [(0, 0), (1, 0), (1, 1), (0, 1)], cards)
vertices, faces = far()
write("far.obj", vertices, [], faces)

autumn = [
    [0.3, 0.5, 0.12],
    [0.36, 0.5, 0.1],
    [0.55, 0.45, 0.08],
    [0.7, 0.35, 0.07],
    [0.25, 0.42, 0.14],
]
nodes = {
    "trunk": {"mesh": "tree.obj", "material": {"class": "Sunlit", "tint": [0.28, 0.2, 0.14]}},
    "leaves": {"mesh": "leaves.obj", "material": {"class": "Leaves"}},
    "far": {"mesh": "far.obj", "material": {"class": "Sunlit"}},
    "tree": {
        "selector": {"class": "Detail"},
        "children": [{"children": ["trunk", "leaves"]}, "far"],
    },
    "grove": group("tree", 9, 6, 1.8),
    "copse": group("grove", 16, 18, 0),
    "wood": group("copse", 16, 72, 0),
    "forest": group("wood", 16, 288, 0),
    "meadow": {
        "primitive": {"class": "Meadow"},
        "material": {"class": "Clearing", "tint": [0.2, 0.3, 0.08]},
    },
}
for i, one in enumerate(nodes["copse"]["children"]):
    one["variables"] = {"tint": autumn[i % 5]}
nodes["world"] = {"children": ["forest", "meadow"]}

with open("forest.json", "w") as file:
    file.write("{\n")
    rows = {
        "rtsl": 1,
        "import": ["Forest.rtsl"],
        "rayGeneration": {
            "class": "Walker",
            "constructor": {
                "eye": [148, 19, 330],
                "target": [60, -8, 180],
                "width": 1.3,
                "height": 0.73125,
            },
        },
    }
    for key, value in rows.items():
        file.write(f"  {json.dumps(key)}: {json.dumps(value)},\n")
    file.write('  "nodes": {\n')
    texts = []
    for name, node in nodes.items():
        if len(json.dumps(node)) < 140:
            texts.append(f"    {json.dumps(name)}: {json.dumps(node)}")
        else:
            children = ",\n".join("      " + json.dumps(child) for child in node["children"])
            texts.append(f'    {json.dumps(name)}: {{"children": [\n{children}]}}')
    file.write(",\n".join(texts))
    file.write('},\n  "root": "world",\n  "background": {"class": "Morning"},\n')
    file.write('  "render": {"engine": "programs", "size": [960, 540], "spp": 64, "depth": 1}\n}\n')
