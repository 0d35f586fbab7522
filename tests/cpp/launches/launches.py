#!/usr/bin/env python3
"""launches.py RTSLC SOURCE LAUNCHES TURNTABLE: runs the test of launches in C, checks the messages
of its mistakes, and compares pictures of the turntable, whose trees follow what moves, with those
of scenes that `rtslc render` makes."""
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from programs import run

rtslc, source, launches, turntable = sys.argv[1:]

WORDS = (
    "no node is entered",
    "no buffer number 9",
    "no buffer number 0",
    "no memory for a buffer of",
    "1 to 3 dimensions, not 4",
    "`steps` of `Measure`",
    "no node number 7",
    "no instance number 99",
    "not finite",
    "flattens it",
    "no mesh number 5",
    "no mesh number 0",
    "the vertices of mesh 0 are mapped",
    "not finite: x of vertex 1",
    "wait",
    "reference 4711",
    "the width",
    "slices",
    "there is no file `nowhere.png`",
    "a `sampler2D` has one file",
    "of 1, 2 or 4 channels",
)
said = run(launches, f"{source}/examples/bindless/tiles/00.png", 64).splitlines()
for line, word in zip(said, WORDS, strict=True):
    assert word in line, (word, said)

scene = {
    "rtsl": 1,
    "import": [
        f"{source}/examples/glass/{name}.rtsl"
        for name in ("PinholeCamera", "Parallelogram", "Lambert", "Solid", "BallLight", "Sky")
    ],
    "camera": {
        "class": "PinholeCamera",
        "constructor": [[0, 2.2, 7.5], [0, 1, 0], [0, -0.19, -1], [-1.6, -0.9], [1.6, 0.9], 4],
    },
    "materials": {
        "floor": {"class": "Lambert", "albedo": {"class": "Solid", "value": [0.7, 0.7, 0.65]}},
        "clay": {"class": "Lambert", "albedo": {"class": "Solid", "value": [0.8, 0.35, 0.2]}},
    },
    "objects": [
        {
            "primitive": {
                "class": "Parallelogram",
                "constructor": [[-8, 0, 8], [16, 0, 0], [0, 0, -16]],
            },
            "material": "floor",
        }
    ],
    "lights": [{"class": "BallLight", "position": [4, 6, 4], "intensity": [38, 36, 33]}],
    "ambient": [0.12, 0.13, 0.16],
    "background": {"class": "Sky"},
    "render": {"size": [64, 36]},
}
FRAMES = 4
with tempfile.TemporaryDirectory(prefix="rtsl-launches-") as name:
    folder = pathlib.Path(name)
    run(turntable, f"{source}/examples/glass/knot.obj", folder, FRAMES, 64)
    for i in range(FRAMES):
        scene["nodes"] = {
            "knot": {"mesh": f"{source}/examples/glass/knot.obj", "material": "clay"},
            "table": {
                "child": "knot",
                "transform": {"rotate": [0, 360 * i / FRAMES, 0], "translate": [0, 1.15, 0]},
            },
        }
        scene["root"] = "table"
        (folder / "scene.json").write_text(json.dumps(scene))
        run(rtslc, "render", folder / "scene.json", "-o", folder / "expected.png", "-q")
        said = json.loads(
            run(rtslc, "compare", folder / f"turn{i}.png", folder / "expected.png", "--json")
        )
        assert said["rmse"] < 2e-3, said  # of 8 bits: the sines of the two programs may differ
