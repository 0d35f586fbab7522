"""glTF files: alone, in scenes, and damaged."""

import base64
import json
import shutil
import struct
import subprocess
import sys
import unittest

from exr_files import channels
from harness import DIAGNOSED, EXAMPLES, Case
from image_files import jpeg, png
from image_oracle import encode_srgb

MODEL = EXAMPLES / "gltf"
SMALL = ("--size", "24x16", "--spp", "2", "-O", "0", "-q")
# What the scene of a model is without one.
SCENE = {
    "rtsl": 1,
    "camera": {"model": "still-life.gltf"},
    "objects": [{"model": "still-life.gltf"}],
    "render": {"engine": "path"},
}


FRONT = """
class Front : rt_Camera { // x from 0 to 2, y from 0 to 1
  void generateRay() {
    vec2 pixel = (vec2(rt_LaunchIndex.xy) + vec2(0.5)) / vec2(rt_LaunchSize.xy);
    rt_RayOrigin = vec3(2.0 * pixel.x, 1.0 - pixel.y, 1.0);
    rt_RayDirection = vec3(0.0, 0.0, -1.0);
  }
};
"""
PLY = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
property uchar red
property uchar green
property uchar blue
element face 1
property list uchar int vertex_indices
end_header
0 0 0 255 0 0
1 0 0 0 255 0
0 1 0 0 0 255
3 0 1 2
"""


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

    def colored(self, name, colors, material):
        """A triangle with a color for each corner: red, green, blue and perhaps alpha."""
        numbers = [0, 0, 0, 1, 0, 0, 0, 1, 0, *(x for color in colors for x in color)]
        data = base64.b64encode(struct.pack(f"<{len(numbers)}f", *numbers)).decode()
        view = {"buffer": 0, "byteOffset": 36, "byteLength": 4 * len(numbers) - 36}
        kind = {"componentType": 5126, "count": 3}
        uri = f"data:application/octet-stream;base64,{data}"
        document = {
            "asset": {"version": "2.0"},
            "extensionsUsed": ["KHR_materials_unlit"],
            "nodes": [{"mesh": 0}],
            "meshes": [
                {"primitives": [{"attributes": {"POSITION": 0, "COLOR_0": 1}, "material": 0}]}
            ],
            "materials": [material],
            "accessors": [
                {"bufferView": 0, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0], **kind},
                {"bufferView": 1, "type": f"VEC{len(colors[0])}", **kind},
            ],
            "bufferViews": [{"buffer": 0, "byteLength": 36}, view],
            "buffers": [{"byteLength": 4 * len(numbers), "uri": uri}],
        }
        (self.folder / name).write_text(json.dumps(document))

    def front(self, *objects, **settings):
        """A picture of 8 x 4 pixels, with rays through their middles, in light from all around."""
        self.write("front.rtsl", FRONT)
        scene = {
            "rtsl": 1,
            "import": ["std", "front.rtsl"],
            "camera": {"class": "Front"},
            "objects": objects,
            "background": [1, 1, 1],
            "render": {"engine": "path", "size": [8, 4], "spp": 1, **settings},
        }
        self.write("scene.json", json.dumps(scene))
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", "-O0", "-Werror")
        return {
            name: [struct.unpack("<f", struct.pack("<I", bits))[0] for bits in values]
            for name, values in channels((self.folder / "a.exr").read_bytes()).items()
        }

    def test_vertex_colors_are_factors_of_the_base_color(self):
        """Three formats: what is seen of a corner's color is its barycentric coordinate."""
        corners = [(2, 0, 0), (0, 1, 0), (0, 0, 1)]  # values above 1 count as 1
        unlit = {"extensions": {"KHR_materials_unlit": {}}}
        unlit["pbrMetallicRoughness"] = {"baseColorFactor": [0.5, 0.25, 1, 1]}
        self.colored("unlit.gltf", corners, unlit)
        self.write("lit.obj", "v 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n")
        self.write("lit.ply", PLY)
        for other in ("lit.obj", "lit.ply"):
            right = {"model": other, "transform": {"translate": [1, 0, 0]}}
            seen = self.front({"model": "unlit.gltf"}, right)
            for pixel in range(32):
                x, y = (pixel % 4 + 0.5) / 4, 1 - (pixel // 8 + 0.5) / 4
                if x + y >= 1:  # its edge, and the background
                    continue
                factors = (0.5, 0.25, 1) if pixel % 8 < 4 else (1, 1, 1)
                for name, factor, share in zip("RGB", factors, (1 - x - y, x, y)):
                    self.assertAlmostEqual(seen[name][pixel], factor * share, delta=1e-5)

    def test_vertex_colors_are_those_of_the_material(self):
        """The same color in all corners, and as a factor of the material; with alpha."""
        base = [0.25, 0.5, 0.75, 0.5]
        for mode in ("BLEND", "MASK"):
            means = []
            for vertex, factor in ((base, [1, 1, 1, 1]), ([1, 1, 1, 1], base)):
                metal = {"baseColorFactor": factor, "metallicFactor": 0.5}
                material = {"alphaMode": mode, "pbrMetallicRoughness": metal}
                self.colored("a.gltf", [vertex] * 3, {**material, "alphaCutoff": 0.45})
                seen = self.front({"model": "a.gltf"}, spp=64)
                means.append([sum(values) / 32 for values in seen.values()])
            for one, other in zip(*means):
                self.assertAlmostEqual(one, other, delta=1e-3)
            self.assertLess(max(means[0]), 0.99)

    def test_volumes_are_solid_glass(self):
        """A slab that rays cross straight on, in light from all around: Fresnel's reflectance,
        Beer's law and the base color at each crossing."""
        corners = [(x, y, z) for x in (-1, 3) for y in (-1, 2) for z in (-0.5, 0)]
        sides = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
        triangles = [i for a, b, c, d in sides for i in (a, b, c, a, c, d)]
        data = struct.pack("<24f", *(x for corner in corners for x in corner)) + bytes(triangles)
        base, left = (1, 0.9, 0.5), (0.25, 0.5, 1)
        extensions = {
            "KHR_materials_ior": {"ior": 1.8},
            "KHR_materials_transmission": {"transmissionFactor": 1},
            "KHR_materials_volume": {
                "thicknessFactor": 0.1,  # for programs that do not follow rays
                "attenuationColor": left,
                "attenuationDistance": 0.25,
            },
        }
        uri = f"data:application/octet-stream;base64,{base64.b64encode(data).decode()}"
        document = {
            "asset": {"version": "2.0"},
            "extensionsUsed": list(extensions),
            "nodes": [{"mesh": 0}],
            "meshes": [
                {"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}
            ],
            "materials": [
                {
                    "pbrMetallicRoughness": {
                        "baseColorFactor": [*base, 1],
                        "metallicFactor": 0,
                        "roughnessFactor": 0,
                    },
                    "extensions": extensions,
                }
            ],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": 8,
                    "type": "VEC3",
                    "min": corners[0],
                    "max": corners[-1],
                },
                {"bufferView": 1, "componentType": 5121, "count": 36, "type": "SCALAR"},
            ],
            "bufferViews": [
                {"buffer": 0, "byteLength": 96},
                {"buffer": 0, "byteOffset": 96, "byteLength": 36},
            ],
            "buffers": [{"byteLength": len(data), "uri": uri}],
        }
        reflected = (0.8 / 2.8) ** 2
        for scale, thick in (([1, 1, 1], 0.5), ([1, 1, -0.5], 0.25)):
            document["nodes"][0]["scale"] = scale
            self.write("slab.gltf", json.dumps(document))
            seen = self.front({"model": "slab.gltf"}, spp=1024)
            for channel, tint, after in zip("RGB", base, left):
                inside = after ** (thick / 0.25)
                passed = ((1 - reflected) * tint) ** 2 * inside / (1 - reflected * inside)
                mean = sum(seen[channel]) / 32
                self.assertAlmostEqual(mean, reflected + passed, delta=0.01, msg=(channel, thick))

    def test_images_wherever_they_are(self):
        """A file, its bytes in the JSON, and in a buffer."""
        colors = {(0, 0): (250, 20, 60), (1, 0): (0, 128, 255)}
        pixel = lambda x, y: colors[x // 8, y // 8]
        for name, mime, data in (
            ("a.png", "image/png", png(16, 8, pixel)),
            ("a.jpg", "image/jpeg", jpeg(16, 8, pixel)),
        ):
            self.write(name, data)
            text = base64.b64encode(bytes(8) + data).decode()
            document = {
                "asset": {"version": "2.0"},
                "buffers": [
                    {
                        "byteLength": 8 + len(data),
                        "uri": f"data:application/octet-stream;base64,{text}",
                    }
                ],
                "bufferViews": [{"buffer": 0, "byteOffset": 8, "byteLength": len(data)}],
                "images": [
                    {"uri": name},
                    {"uri": f"data:{mime};base64,{base64.b64encode(data).decode()}"},
                    {"bufferView": 0, "mimeType": mime},
                ],
            }
            self.write("images.gltf", json.dumps(document))
            square = {"class": "Parallelogram", "constructor": [[0, 0, 0], [2, 0, 0], [0, 1, 0]]}
            pictures = []
            for image in (
                {"file": name},
                *({"file": "images.gltf", "part": f"images.{i}"} for i in range(1, 3)),
            ):
                pattern = {"class": "ImageTexture", "image": {**image, "filter": "nearest"}}
                material = {"class": "Emitter", "radianceMap": pattern, "isTwoSided": True}
                pictures.append(self.front({"primitive": square, "material": material}))
            self.assertEqual(pictures[1], pictures[0], name)
            self.assertEqual(pictures[2], pictures[0], name)
            for i, channel in enumerate("RGB"):
                for at, side in enumerate((colors[0, 0], colors[1, 0])):
                    seen = pictures[0][channel][4 * at]
                    self.assertAlmostEqual(encode_srgb(seen) * 255, side[i], delta=2.5)

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

    def test_a_missing_buffer_is_one_mistake(self):
        """Meshes and images need it."""
        (self.folder / "still-life.bin").unlink()
        self.assert_message(
            self.diagnose("render", "still-life.gltf", "-o", "a.exr"),
            "E0900",
            "cannot read `still-life.bin`",
            line=391,
            file="still-life.gltf",
        )
        self.document["buffers"][0]["uri"] = "none.bin"
        (self.folder / "scene.gltf").write_text(json.dumps(self.document, indent=1))
        (self.folder / "scene.json").write_text(
            json.dumps(
                {
                    "rtsl": 1,
                    "camera": {"model": "scene.gltf"},
                    "objects": [{"model": "scene.gltf"}, {"model": "scene.gltf"}],
                    "render": {"engine": "path"},
                }
            )
        )
        for command in (["check"], ["render", "-o", "a.exr"]):
            self.assert_message(
                self.diagnose(*command, "scene.json"),
                "E0900",
                "cannot read `none.bin`",
                file="scene.gltf",
            )

    def test_a_buffer_that_is_cut_is_one_mistake(self):
        data = (self.folder / "still-life.bin").read_bytes()
        (self.folder / "still-life.bin").write_bytes(data[:400])
        self.assert_message(
            self.diagnose("check", "still-life.gltf"),
            "E0906",
            "`buffers.0` is truncated: it has 400 bytes of its `byteLength` 71824",
            line=391,
            file="still-life.gltf",
        )
        (self.folder / "still-life.bin").write_bytes(data)
        self.document["buffers"][0]["byteLength"] += 8
        (self.folder / "long.gltf").write_text(json.dumps(self.document))
        for command in (["check"], ["render", *SMALL, "-o", "a.exr"]):
            _, error = self.run_rtslc(*command, "long.gltf")
            self.assertEqual(error.count("warning[W2800]"), 1, error)
            self.assertIn("`buffers.0` has 71824 bytes, and its `byteLength` is 71832", error)

    def test_damaged_files(self):
        self.glb("cut.glb", cut=1000)
        (message,) = self.diagnose("check", "cut.glb")
        self.assertIn("truncated", message["message"])
        (self.folder / "still-life.bin").write_bytes(b"abc")
        messages = " ".join(
            message["message"] for message in self.diagnose("check", "still-life.gltf")
        )
        self.assertIn("`buffers.0` is truncated: it has 3 bytes", messages)
        self.assertIn("and `bufferViews.0` ends at byte 513", messages)
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
