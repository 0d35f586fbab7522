"""Writes city.json and masts.csv: blocks of houses between streets, and eight masts on roofs."""

import json
import random

random.seed(11)
STREET, BLOCK, BLOCKS = 14.0, 46.0, 7
PITCH = STREET + BLOCK
SIDE = PITCH * BLOCKS + STREET

houses, roofs = [], []
for row in range(BLOCKS):
    for column in range(BLOCKS):
        x, z = STREET + column * PITCH, STREET + row * PITCH
        if (row, column) in ((2, 4), (3, 4), (5, 1)):
            continue  # parks
        cuts = sorted((0.0, random.uniform(0.3, 0.7), 1.0))
        deep = random.uniform(0.3, 0.7)
        for i in range(2):
            for low, high in ((0.0, deep - 0.06), (deep + 0.06, 1.0)):
                middle = ((column - 3) ** 2 + (row - 3) ** 2) ** 0.5
                height = random.uniform(7, 18) + max(0.0, 3 - middle) * random.uniform(2, 16)
                box = [
                    x + cuts[i] * BLOCK + (1.0 if i else 0.0),
                    0.0,
                    z + low * BLOCK,
                    x + cuts[i + 1] * BLOCK - (0.0 if i else 1.0),
                    height,
                    z + high * BLOCK,
                ]
                houses.append([round(value, 2) for value in box])
                roofs.append(houses[-1])

masts = []
for box in sorted(roofs, key=lambda box: -box[4]):
    top = [0.5 * (box[0] + box[3]), box[4] + 24.0, 0.5 * (box[2] + box[5])]
    if all(abs(top[0] - x) + abs(top[2] - z) > 120 for x, _, z in masts):
        masts.append(top)
masts = masts[:8]

with open("masts.csv", "w") as file:
    file.write("x,height,z\n")
    for x, height, z in masts:
        file.write(f"{x:.2f},{height:.2f},{z:.2f}\n")

objects = ",\n    ".join(
    json.dumps({"primitive": {"class": "Box", "low": box[:3], "high": box[3:]}, "material": "wall"})
    for box in houses
)
with open("city.json", "w") as file:
    file.write(
        f"""{{
  "rtsl": 1,
  "import": ["std.primitives.Box", "LineOfSight.rtsl"],
  "rayGeneration": {{"class": "LineOfSight", "masts": {{"buffer": "masts.csv", "columns": ["x", "height", "z"]}},
                    "low": [0, 0], "high": [{SIDE:.0f}, {SIDE:.0f}], "places": {{"size": [{len(masts)}]}}}},
  "materials": {{"wall": {{"class": "Wall"}}}},
  "background": {{"class": "Open"}},
  "objects": [
    {objects}
  ],
  "render": {{"engine": "programs", "size": [868, 868], "spp": 1, "depth": 0}}
}}
"""
    )
