"""glTF files: alone, in scenes, and damaged."""

import json
import shutil
import struct
import subprocess
import sys
import unittest

from harness import DIAGNOSED, EXAMPLES, Case

MODEL = EXAMPLES / "gltf"
SMALL = ("--size", "24x16", "--spp", "2", "-O", "0", "-q")
# What the scene of a model is without one.
SCENE = {
    "rtsl": 1,
    "camera": {"model": "still-life.gltf"},
    "objects": [{"model": "still-life.gltf"}],
    "render": {"engine": "path"},
}


class Gltf(Case):
    def setUp(self):
        super().setUp()
        for file in ("still-life.gltf", "still-life.bin", "tiles.png"):
            shutil.copy(MODEL / file, self.folder / file)
        self.document = json.loads((self.folder / "still-life.gltf").read_text())

    def render(self, file, *arguments, output="a.exr"):
        return self.run_rtslc("render", file, "-o", output, *SMALL, *arguments)[1]

    def same(self, first, second):
        self.assertIn("the same, bit for bit", self.run_rtslc("compare", first, second)[0])

    def glb(self, name, cut=0):
        """The model as one file."""
        document = {
            **self.document,
            "buffers": [{"byteLength": self.document["buffers"][0]["byteLength"]}],
        }
        text = json.dumps(document).encode()
        text += b" " * (-len(text) % 4)
        binary = (self.folder / "still-life.bin").read_bytes()
        binary += b"\0" * (-len(binary) % 4)
        chunks = (
            struct.pack("<I4s", len(text), b"JSON")
            + text
            + struct.pack("<I4s", len(binary), b"BIN\0")
            + binary
        )
        whole = struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks
        (self.folder / name).write_bytes(whole[: len(whole) - cut])

    def test_the_script_writes_the_files(self):
        subprocess.run([sys.executable, "-B", MODEL / "model.py", self.folder], check=True)
        for file in ("still-life.gltf", "tiles.png"):
            self.assertEqual((self.folder / file).read_bytes(), (MODEL / file).read_bytes())

    def test_a_model_renders_alone(self):
        self.assertEqual(self.render("still-life.gltf", "-Werror"), "")
        self.glb("packed.glb")
        self.assertEqual(self.render("packed.glb", output="b.exr"), "")
        self.same("a.exr", "b.exr")
        self.render("packed.glb", "--set", "camera.name=Plan", output="c.exr")
        self.run_rtslc("compare", "a.exr", "c.exr", "--threshold", "0.01", status=DIAGNOSED)
        self.assertEqual(self.run_rtslc("check", "still-life.gltf"), ("", ""))

    def test_files_of_a_model_are_dependencies(self):
        self.render("still-life.gltf", "-MD", "-MF", "deps")
        text = (self.folder / "deps").read_text()
        for file in ("still-life.gltf", "still-life.bin", "tiles.png"):
            self.assertIn(file, text)

    def test_a_model_is_what_one_would_write_for_it(self):
        """A triangle of the model's, in its material, as a model and by its parts."""
        self.document.update(
            scenes=[{"nodes": [0]}], nodes=[{"mesh": 1, "translation": [0.5, 0, 0]}], cameras=[]
        )
        (self.folder / "one.gltf").write_text(json.dumps(self.document))
        camera = {"class": "PerspectiveCamera", "constructor": [[0, 1, 4], [0, 0, 0], [0, 1, 0]]}
        common = {
            "rtsl": 1,
            "import": "std",
            "camera": camera,
            "background": [1, 1, 1],
            "render": {"engine": "path"},
        }
        (self.folder / "a.json").write_text(
            json.dumps({**common, "objects": [{"model": "one.gltf"}]})
        )
        node = {
            "mesh": "one.gltf",
            "part": "meshes.1.primitives.0",
            "transform": {"translate": [0.5, 0, 0]},
            "material": {
                "class": "Principled",
                "baseColor": [1, 0.77, 0.34],
                "metallic": 1,
                "roughness": 0.3,
            },
        }
        (self.folder / "b.json").write_text(json.dumps({**common, "root": node}))
        self.render("a.json")
        self.render("b.json", output="b.exr")
        self.same("a.exr", "b.exr")

    def test_all_mistakes_are_told_at_once(self):
        self.document["materials"][1]["pbrMetallicRoughness"]["metallicFactor"] = 2
        self.document["nodes"][0]["mesh"] = 99
        self.document["accessors"][0]["count"] = 10**6
        (self.folder / "still-life.gltf").write_text(json.dumps(self.document, indent=1))
        (self.folder / "scene.json").write_text(
            json.dumps({**SCENE, "objects": SCENE["objects"] + [{"model": 3}], "size": 1})
        )
        codes = [message["code"] for message in self.diagnose("check", "scene.json")]
        self.assertGreaterEqual(len(codes), 5, codes)

    def test_damaged_files(self):
        self.glb("cut.glb", cut=1000)
        (message,) = self.diagnose("check", "cut.glb")
        self.assertIn("truncated", message["message"])
        (self.folder / "still-life.bin").write_bytes(b"abc")
        messages = " ".join(
            message["message"] for message in self.diagnose("check", "still-life.gltf")
        )
        self.assertIn("`buffers.0` is truncated: it has 3 bytes", messages)
        self.assertIn("`bufferViews.0` ends at byte 513 of `buffers.0`, which has 3", messages)
        (self.folder / "tiles.png").write_bytes(b"abc")
        (self.folder / "still-life.bin").unlink()
        messages = " ".join(
            message["message"] for message in self.diagnose("check", "still-life.gltf")
        )
        self.assertIn("still-life.bin", messages)
        self.assertIn("tiles.png", messages)
        self.diagnose("check", "none.glb")


if __name__ == "__main__":
    unittest.main()
