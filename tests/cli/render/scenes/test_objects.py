"""Objects of a scene: helpers, references that may be empty, recursion through members; the same
bits on every path."""

import json
import os
import shutil
import subprocess
import sys
import unittest

from harness import EXAMPLES, Case

SHADERS = EXAMPLES.parent / "tests/cpp/scenes/Objects.rtsl"
sys.path.insert(0, str(SHADERS.parent))
from objects import objects_scene

WAYS = (
    ["--trace=recurse", "--traversal=device"],
    ["--trace=split", "--traversal=device"],
    ["--target=host-megakernel"],
)


class Objects(Case):
    def setUp(self):
        super().setUp()
        self.write("shaders.rtsl", SHADERS.read_text())

    def scene(self, **changes):
        scene = objects_scene(
            "shaders.rtsl", EXAMPLES / "glass" / "Sphere.rtsl", changes.pop("layers", 3)
        )
        for path, value in changes.items():
            scene[path].update(value)
        self.write("scene.json", json.dumps(scene))

    def require_same_pictures(self, *more):
        for i, way in enumerate([*WAYS, *more]):
            self.run_rtslc("render", "scene.json", "-o", f"{i}.exr", *way)
            self.assert_same_bits("0.exr", f"{i}.exr")

    def test_engines_agree(self):
        self.scene()
        # What is kept and what is checked is decided before machine code is optimised.
        self.require_same_pictures(
            ["--keep=all", "-O0"], ["--keep=parameters", "-O0", *WAYS[2]], ["--unchecked", "-O0"]
        )

    def test_long_rows_of_layers(self):
        self.level = "-O0"
        self.scene(layers=12)
        self.require_same_pictures()
        self.scene(layers=40)
        self.require_same_pictures()

    def test_recursion_is_copied_for_each_level(self):
        self.scene(layers=6)
        self.run_rtslc("compile", "scene.json", "--emit=ptx", "-O1", "-o", "x.ptx")
        if shutil.which("ptxas"):
            said = subprocess.run(
                ["ptxas", "-v", "-arch=sm_75", "x.ptx", "-o", os.devnull],
                cwd=self.folder,
                capture_output=True,
                text=True,
            )
            self.assertEqual(said.returncode, 0, said.stderr)
            self.assertNotIn("cannot be statically determined", said.stderr)
        self.scene(layers=40)
        error = self.run_rtslc("compile", "scene.json", "--emit=ptx", "-o", "x.ptx", status=1)[1]
        self.assertIn("error[E0770]: `", error)
        self.assertIn(
            "calls itself on more objects in a row than a GPU program has room for: 32", error
        )

    def test_a_package_holds_them(self):
        self.scene()
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg")
        self.run_rtslc("render", "scene.json", "-o", "0.exr", "--target=host-megakernel")
        self.run_package("x.rtslpkg", "-o", "1.exr", "--target=host")
        self.assert_same_bits("0.exr", "1.exr")

    def test_what_is_always_empty_is_left_out(self):
        self.scene(
            materials={
                "painted": {"class": "Painted"},
                "coated": {"class": "Coated"},
                "tilted": {"class": "Tilted", "bump": None},
            }
        )
        ir = self.run_rtslc("compile", "scene.json", "--emit=ir")[0]
        self.assertNotIn("@dispatch.rt_Texture.lookup", ir)
        self.assertNotIn("TextureUVW", ir)
        self.require_same_pictures()
        self.assertRegex(
            self.run_rtslc("explain", "scene.json", "--no-savings")[0],
            r"Painted\.bump\b.*it is empty in all objects",
        )
        kept = self.run_rtslc("compile", "scene.json", "--emit=ir", "--keep=parameters")[0]
        self.assertIn("@dispatch.rt_Texture.lookup", kept)
        self.run_rtslc("render", "scene.json", "-o", "kept.exr", "--keep=parameters", *WAYS[0])
        self.assert_same_bits("0.exr", "kept.exr")

    def test_a_reference_that_is_not_optional_is_set(self):
        self.scene(textures={"t0": {"class": "Layered"}})
        error = self.run_rtslc("render", "scene.json", "-o", "x.exr", status=1)[1]
        self.assertIn(
            "`t0` refers to nothing: set member `noise` of class `Layered`, a `Noise`, or a "
            "variable of this name in ",
            error,
        )
        self.scene(textures={"t0": {"class": "Layered", "noise": None}})
        error = self.run_rtslc("render", "scene.json", "-o", "x.exr", status=1)[1]
        self.assertIn("member `noise` of `t0` cannot be null", error)

    def test_helpers_have_a_section(self):
        self.scene(helpers={"fine": {"class": "Noise", "constructor": [0.25], "finer": "coarse"}})
        error = self.run_rtslc("render", "scene.json", "-o", "x.exr", status=1)[1]
        self.assertIn("refers to itself indirectly", error)
        self.scene(textures={"fine": {"class": "Layered", "noise": "fine"}})
        error = self.run_rtslc("render", "scene.json", "-o", "x.exr", status=1)[1]
        self.assertIn("`fine` is already the name of a helper", error)
        self.scene(materials={"plain": {"class": "Painted", "bump": "fein"}})
        error = self.run_rtslc("render", "scene.json", "-o", "x.exr", status=1)[1]
        self.assertIn("no helper, texture or material is named `fein`", error)
        self.scene(materials={"plain": {"class": "Painted", "bump": "t0"}})
        error = self.run_rtslc("render", "scene.json", "-o", "x.exr", status=1)[1]
        self.assertIn("takes a `Noise`, not a `Layered`", error)

    def test_reflection_tells_of_them(self):
        text = self.run_rtslc("compile", "shaders.rtsl", "--emit=reflection")[0]
        classes = {one["name"]: one for one in json.loads(text)["classes"]}
        self.assertEqual(classes["Noise"]["root"], "helper class")
        [finer] = [member for member in classes["Noise"]["members"] if member["name"] == "finer"]
        self.assertTrue(finer["isOptional"])


if __name__ == "__main__":
    unittest.main()
