"""Scenes whose programs write to buffers."""

import json
import re

from harness import EXAMPLES, Case
from numpy_files import npy, read_npy

SHADERS = (EXAMPLES.parent / "tests/cpp/scenes/Outputs.rtsl").read_text()  # of C++ programs too
PATHS = {
    "recursion": ["--trace=recurse", "--traversal=device"],
    "states on Embree": [],
    "states": ["--traversal=device"],
    "the host megakernel": ["--target=host-megakernel"],
    "-O0": ["-O0"],
    "everything kept": ["--keep=all"],
    "one thread": ["--threads=1"],
    "with exceptions": ["--exceptions"],
}
MARKS = [0, 0xFFFFFFFF, 0, 0xFFFFFFFF, 0, 5, 0]


class OutputCase(Case):
    def setUp(self):
        super().setUp()
        self.write("probe.rtsl", SHADERS)

    def scene(self, name="scene.json", start=None, size=(8, 6), **changes):
        scene = {
            "rtsl": 1,
            "import": ["probe.rtsl"],
            "buffers": {"histogram": {"size": [6]}, "most": {"buffer": "initial.npy"}},
            "rayGeneration": start or {"class": "Probe", "histogram": "histogram", "most": "most"},
            "materials": {"mirror": {"class": "Mirror"}},
            "objects": [
                {"primitive": {"class": "Ball"}, "material": "mirror"},
                {
                    "primitive": {"class": "Ball", "radius": 0.4},
                    "material": "mirror",
                    "transform": {"translate": [1.2, 0.5, 1]},
                },
            ],
            "render": {"engine": "programs", "size": list(size)},
        }
        scene.update(changes)
        self.write("initial.npy", npy("I", [len(MARKS)], MARKS))
        return self.write(
            name, json.dumps({key: value for key, value in scene.items() if value is not None})
        )

    def one(self, body, members, size=(1, 1), values="", **changes):
        """Runs one class; gives the buffers that were written, by name."""
        self.write(
            "one.rtsl",
            f"class One : rt_RayGeneration {{ {members} void generate() {{ {body} }} }};",
        )
        names = re.findall(r"(?:out|inout) \w+ (\w+)", members)
        self.scene(
            start={"class": "One", **json.loads(values or "{}")},
            size=size,
            **{"import": ["one.rtsl"], "objects": [], "materials": {}, **changes},
        )
        self.run_rtslc("run", "scene.json", "-q", *(f"--out={name}={name}.npy" for name in names))
        return {name: read_npy(self.folder / f"{name}.npy") for name in names}
