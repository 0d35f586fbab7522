#!/usr/bin/env python3
"""states.py RTSLC GLASS PROGRAM...: the programs' pictures are that of the same scene by machine
code, to the last bit, and recursion, states and the host megakernel make one picture of it too,
with the traversal that all three have."""
import json
import pathlib
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from programs import run, same_picture

rtslc, glass, *programs = sys.argv[1:]
here = pathlib.Path(__file__).parent
names = [
    "Many",
    "Nested",
    "Middle",
    "Choices",
    "Endless",
    "Mirror",
    "Base",
    "Derived",
    "Table",
    "Bundle",
    "Turned",
    "Outputs",
    "Component",
    "Lit",
    "Tangled",
    "Loud",
    "Quiet",
    "Columns",
    "Flags",
    "Scattered",
    "Replaced",
    "Arms",
    "Late",
    "Polished",
    "Matte",
    "Lacquered",
    "Chalk",
    "Varnished",
    "Worn",
    "Waxed",
    "Rounded",
    "Patterned",
    "Enamel",
    "Glazed",
    "Frosted",
    "Stained",
]
shaders = ["PinholeCamera", "Sphere", "Parallelogram", "Checker", "BallLight", "Sky"]
scene = {
    "rtsl": 1,
    "import": [f"{glass}/{name}.rtsl" for name in shaders] + [str(here / "Shapes.rtsl")],
    "camera": {
        "class": "PinholeCamera",
        "constructor": [[0, 2, 9], [0, 1, 0], [0, -0.12, -1], [-1.6, -0.9], [1.6, 0.9], 2.7],
    },
    "textures": {
        "checks": {
            "class": "Checker",
            "scale": 8,
            "even": [0.85, 0.83, 0.78],
            "odd": [0.12, 0.14, 0.2],
        }
    },
    "materials": {
        "floor": {"class": "Glossy", "albedo": "checks"},
        **{name: {"class": name} for name in names},
    },
    "objects": [
        {
            "primitive": {
                "class": "Parallelogram",
                "constructor": [[-8, 0, 6], [16, 0, 0], [0, 0, -16]],
            },
            "material": "floor",
        }
    ],
    "lights": [
        {"class": "BallLight", "position": [4, 6, 4], "radius": 0.4, "intensity": [38, 36, 33]},
        {"class": "BallLight", "position": [-5, 5, 3], "radius": 0.2, "intensity": [18, 20, 25]},
    ],
    "ambient": [0.12, 0.13, 0.16],
    "background": {"class": "Sky"},
    "render": {"engine": "classic", "size": [96, 54], "spp": 2, "depth": 4, "seed": 1},
}
for i, name in enumerate(names):
    center = [-4.5 + i % 10, 0.7 + 1.3 * (i // 10), 0]
    scene["objects"].append(
        {"primitive": {"class": "Sphere", "center": center, "radius": 0.7}, "material": name}
    )
with tempfile.TemporaryDirectory(prefix="rtsl-cpp-") as folder:
    file, ours, theirs = (
        str(pathlib.Path(folder) / name) for name in ("scene.json", "cpp.exr", "jit.exr")
    )
    pathlib.Path(file).write_text(json.dumps(scene))

    def render(picture, *how):
        run(rtslc, "render", file, "-o", picture, "-q", *how)

    render(theirs)
    for program in programs:
        run(program, ours)
        same_picture(rtslc, ours, theirs)
    render(theirs, "--trace=recurse", "--traversal=device")
    for how in (["--trace=split", "--traversal=device"], ["--target=host-megakernel"]):
        render(ours, *how)
        same_picture(rtslc, ours, theirs)
