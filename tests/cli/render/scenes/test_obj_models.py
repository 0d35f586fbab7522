"""OBJ files with their materials: alone, in scenes, and damaged."""

import json
import os
import random
import struct
import subprocess
import unittest
import zlib

from harness import DIAGNOSED, RTSLC, SECONDS, WAYS, Case, deep

# Two squares side by side that face the camera, and a material for each.
OBJ = """mtllib squares.mtl
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 2 0 0
v 2 1 0
vt 0 0
vt 1 0
vt 1 1
vt 0 1
usemtl left
f 1/1 2/2 3/3 4/4
usemtl right
f 2/1 5/2 6/3 3/4
"""
CAMERA = """
class Front : rt_Camera { // the left half of the picture is the left square
  void generateRay() {
    rt_RayOrigin = vec3(2.0 * rt_ScreenCoord.x, rt_ScreenCoord.y, 1.0);
    rt_RayDirection = vec3(0.0, 0.0, -1.0);
  }
};
"""


def png(rows):
    """An image of 8 bits: rows from top to bottom of tuples of 3 or 4 numbers."""
    channels = len(rows[0][0])
    data = b"".join(b"\0" + bytes(x for pixel in row for x in pixel) for row in rows)

    def chunk(kind, content):
        return (
            struct.pack(">I", len(content))
            + kind
            + content
            + struct.pack(">I", zlib.crc32(kind + content))
        )

    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 2 if channels == 3 else 6, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(data))
        + chunk(b"IEND", b"")
    )


class ObjCase(Case):
    def setUp(self):
        super().setUp()
        self.write("front.rtsl", CAMERA)
        self.write("squares.obj", OBJ)

    def materials(self, left, right="Kd 0.2 0.4 0.6", file="squares.mtl"):
        self.write(file, f"newmtl left\n{left}\nnewmtl right\n{right}\n")

    def scene(self, engine="albedo", spp=64, **rest):
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["front.rtsl"],
                    "camera": {"class": "Front"},
                    "objects": [{"model": "squares.obj"}],
                    **rest,
                    "render": {"engine": engine, "size": [8, 4], "spp": spp},
                }
            ),
        )

    def halves(self, *arguments, height=4):
        """The means of the left and of the right half, and the warnings."""
        means, warnings = [], ""
        picture = ("-o", "p.exr", "-q", "-O0", f"--size={2 * height}x{height}")
        for left in (0, height):
            crop = f"--crop={left},0,{left + height},{height}"
            _, warnings = self.run_rtslc("render", "scene.json", *picture, crop, *arguments)
            out, _ = self.run_rtslc("compare", "p.exr", "p.exr", "--json")
            means.append(json.loads(out)["means"][0])
        return means[0], means[1], warnings

    def assert_color(self, found, expected, delta=0.002):
        for one, other in zip(found, expected):
            self.assertAlmostEqual(one, other, delta=delta)


class Materials(ObjCase):
    def test_each_group_has_its_material(self):
        self.materials("Ka 1 0 0\nKd 0.8 0.1 0.3\nillum 1")
        self.scene()
        left, right, warnings = self.halves()
        self.assert_color(left, [0.8, 0.1, 0.3])
        self.assert_color(right, [0.2, 0.4, 0.6])
        self.assertEqual(warnings, "")

    def test_an_image_where_it_belongs(self):
        """The upper left quarter of a texture is that of the square, multiplied by Kd."""
        red, black = (255, 0, 0), (0, 0, 0)
        (self.folder / "textures").mkdir()
        (self.folder / "textures" / "four squares.png").write_bytes(
            png([[red] * 2 + [black] * 2] * 2 + [[black] * 4] * 2)
        )
        self.materials("Kd 0.5 0.5 0.5\nmap_Kd textures\\four squares.png")
        self.scene()
        self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "p.exr",
            "-q",
            "-O0",
            "--size",
            "16x8",
            "--crop",
            "1,1,3,3",
        )
        means = json.loads(self.run_rtslc("compare", "p.exr", "p.exr", "--json")[0])["means"][0]
        self.assert_color(means, [0.5, 0, 0])
        # A gray of half the code, as a color of the screen and as a number.
        (self.folder / "gray.png").write_bytes(png([[(128, 128, 128)]]))
        for option, value in (
            ("", 0.2159),
            ("-colorspace sRGB", 0.2159),
            ("-colorspace linear", 0.502),
        ):
            self.materials(f"map_Kd {option} -s 1 1 1 gray.png")
            left, _, warnings = self.halves()
            self.assert_color(left, [value] * 3)
            self.assertEqual(warnings, "")
        # Twice as often: the same quarter at each corner.
        self.materials("map_Kd -s 2 2 2 -o 0 0 0 textures/four squares.png")
        left, _, _ = self.halves()
        self.assert_color(left, [0.25, 0, 0], 0.05)

    def test_what_shines(self):
        """Ke is the radiance, and a surface that shines is a lamp."""
        self.materials("Kd 0 0 0\nKe 3 2 1", "Kd 0.5 0.5 0.5")
        self.scene(engine="path")
        left, _, warnings = self.halves("--engine", "path", "--depth", "0")
        self.assert_color(left, [3, 2, 1], 1e-5)
        self.assertEqual(warnings, "")

    def test_holes(self):
        """Half of a white background, by `d`, by `Tr`, and by the alpha of an image."""
        (self.folder / "leaf.png").write_bytes(png([[(0, 0, 0, 128)] * 4] * 4))
        for holes in ("d 0.5", "Tr 0.5", "map_Kd leaf.png\nmap_d leaf.png"):
            with self.subTest(holes=holes):
                self.materials(f"Kd 0 0 0\n{holes}", "Kd 0 0 0")
                self.scene(background=[1, 1, 1])
                left, right, _ = self.halves("--engine", "path", "--spp", "1024", "--depth", "2")
                self.assert_color(left, [0.5] * 3, 0.02)
                self.assert_color(right, [0, 0, 0])

    def test_mirrors_and_glass(self):
        """In a furnace a mirror has the color of Ks, and glass loses nothing."""
        self.materials("illum 3\nKd 0.1 0.1 0.1\nKs 0.9 0.7 0.5", "illum 7\nNi 1.5\nKd 0 0 0")
        self.scene(background=[1, 1, 1])
        left, right, warnings = self.halves("--engine", "path", "--depth", "40", "--spp", "256")
        self.assert_color(left, [0.9, 0.7, 0.5], 0.02)
        self.assert_color(right, [1, 1, 1], 0.02)
        self.assertEqual(warnings, "")
        # An image multiplies the color of a mirror.
        (self.folder / "green.png").write_bytes(png([[(0, 255, 0)] * 2] * 2))
        self.materials("illum 3\nKs 0.9 0.7 0.5\nmap_Ks green.png", "illum 7\nNi 1.5\nKd 0 0 0")
        left, _, warnings = self.halves("--engine", "path", "--depth", "40", "--spp", "256")
        self.assert_color(left, [0, 0.7, 0], 0.02)
        self.assertEqual(warnings, "")

    def test_metal_and_roughness(self):
        """Smooth metal of the statements for physically based shading."""
        self.materials("Kd 0.9 0.6 0.3\nPm 1\nPr 0", "Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nNs 200")
        self.scene(background=[1, 1, 1])
        left, right, warnings = self.halves("--engine", "path", "--depth", "1", "--spp", "256")
        self.assert_color(left, [0.9, 0.6, 0.3], 0.01)
        self.assertTrue(0.45 < right[0] < 0.6, right)
        self.assertEqual(warnings, "")

    @deep
    def test_bumps(self):
        """A slope changes what a light gives; a flat image does not."""
        ramp = [[(16 * x, 16 * x, 16 * x) for x in range(16)]] * 16
        (self.folder / "ramp.png").write_bytes(png(ramp))
        (self.folder / "flat.png").write_bytes(png([[(99, 99, 99)] * 16] * 16))
        (self.folder / "tilted.png").write_bytes(png([[(204, 127, 230)] * 4] * 4))
        found = {}
        for name, relief in (
            ("plain", ""),
            ("flat", "map_Bump flat.png"),
            ("ramp", "map_Bump -bm 20 ramp.png"),
            ("normals", "norm tilted.png"),
        ):
            self.materials(f"Kd 0.5 0.5 0.5\n{relief}")
            self.scene(
                lights=[{"class": "DistantLight", "direction": [-1, 0, 1]}],
                **{"import": ["front.rtsl", "std.lights"]},
            )
            # A texel covers some pixels: a footprint of many texels has no slope.
            found[name], _, warnings = self.halves("--engine", "path", "--depth", "1", height=32)
            self.assertEqual(warnings, "")
        self.assert_color(found["flat"], found["plain"], 1e-4)
        for leaning in ("ramp", "normals"):
            self.assertGreater(abs(found[leaning][0] - found["plain"][0]), 0.02, found)

    def test_images_of_highlights(self):
        """Where the image of their strength is black there are none; an image of exponents has the
        roughness of its product with `Ns`."""
        for name, value in (("black", 0), ("white", 255), ("fifth", 51)):
            (self.folder / f"{name}.png").write_bytes(png([[(value,) * 3] * 2] * 2))
        shiny = "Kd 0.2 0.4 0.6\nKs 1 1 1\nNs {}\nmap_Ks {}.png"
        self.materials(shiny.format(20, "black"), shiny.format(20, "white"))
        self.scene(background=[1, 1, 1])
        left, right, warnings = self.halves()
        self.assert_color(left, [0.2, 0.4, 0.6], 0.01)
        self.assertEqual(warnings, "")
        self.materials(shiny.format(20, "white").rsplit("\n", 1)[0])
        plain, _, _ = self.halves()
        self.assert_color(plain, [0.25, 0.43, 0.62], 0.03)
        self.assertGreater(plain[0], 0.215)
        self.materials(shiny.format(100, "white") + "\nmap_Ns fifth.png", shiny.format(20, "white"))
        fifth, twenty, warnings = self.halves()
        self.assertEqual(warnings, "")
        for found in (right, fifth, twenty):
            self.assert_color(found, plain, 0.01)

    def test_statements_without_a_meaning_are_named(self):
        (self.folder / "x.png").write_bytes(png([[(9, 9, 9)]]))
        self.materials(
            "Kd 0.5 0.5 0.5\nmap_Tr x.png\nsharpness 60\nmap_Kd -blendu on -mm 0 1 x.png",
            "illum 7\nNi 1.5\nmap_Ks x.png\nmap_Ns x.png",
        )
        self.scene()
        _, _, warnings = self.halves()
        for name in (
            "`map_Tr` of the material `left`",
            *("`sharpness`", "`-blendu`", "`-mm`"),
            "`map_Ks` of the material `right`",
            "`map_Ns` of the material `right`",
        ):
            self.assertIn(name, warnings)
        self.assertIn("squares.mtl:3:1", warnings)

    def test_missing_materials(self):
        self.scene()
        left, right, warnings = self.halves()
        self.assert_color(left + right, [0.8] * 6)
        self.assertIn("there is no file `squares.mtl`: its materials are gray", warnings)
        self.assertIn("squares.obj:1:8", warnings)
        self.assertIn("no file of `mtllib` has the material `left`", warnings)
        self.write("squares.mtl", "newmtl left\nKd 0.1 0.1 0.1\n")
        left, right, warnings = self.halves()
        self.assert_color(left + right, [0.1] * 3 + [0.8] * 3)
        self.assertIn("squares.obj:14:8", warnings)

    def test_names_and_lines_as_they_come(self):
        """Blanks in names, continued lines, line ends and byte order marks of Windows, several
        files, one in a folder."""
        (self.folder / "sub").mkdir()
        self.write("sub/a.mtl", "\ufeffnewmtl the left one\r\nKd 0.1 \\\r\n 0.2 0.3\r\n")
        self.write("b.mtl", "# nothing\n\n  newmtl right\n\tKd 0.4\n")
        text = OBJ.replace("squares.mtl", "sub/a.mtl b.mtl").replace("left", "the left one")
        self.write("squares.obj", "\ufeff" + text.replace("\n", "\r\n"))
        self.scene()
        left, right, warnings = self.halves()
        self.assert_color(left + right, [0.1, 0.2, 0.3, 0.4, 0.4, 0.4])
        self.assertEqual(warnings, "")

    def test_a_name_that_is_given_again(self):
        """In the same file and in another one: the first one counts."""
        self.write("a.mtl", "newmtl left\nKd 0.1\nnewmtl right\nKd 0.2\nnewmtl left\nKd 0.3\n")
        self.write("b.mtl", "newmtl right\nKd 0.4\n")
        self.write("squares.obj", OBJ.replace("squares.mtl", "a.mtl b.mtl"))
        self.scene()
        left, right, warnings = self.halves()
        self.assert_color(left + right, [0.1] * 3 + [0.2] * 3)
        again = "the material `{}` is described again, which is ignored"
        for name, place, line in (("left", "a.mtl:5:8", 1), ("right", "b.mtl:1:8", 3)):
            self.assertRegex(
                warnings, f"{place}: warning.W2800.: {again.format(name)}: .*a.mtl` .* line {line}"
            )
        self.assertEqual(warnings.count("warning["), 2, warnings)

    def test_polygons(self):
        """Faces of more than four corners, which another reader divides, have their materials."""
        self.materials("Kd 0.8 0.1 0.3")
        self.scene()
        self.write(
            "squares.obj",
            OBJ.replace("v 2 1 0", "v 2 1 0\nv 0.5 0 0").replace("f 1/1 2/2", "f 1/1 7/1 2/2"),
        )
        left, right, _ = self.halves()
        self.assert_color(left + right, [0.8, 0.1, 0.3, 0.2, 0.4, 0.6])


class Models(ObjCase):
    def test_alone_and_framed(self):
        self.materials("Kd 0.8 0.1 0.3")
        small = ("--size", "24x16", "--spp", "2", "-O0", "-q")
        self.run_rtslc("render", "squares.obj", "-o", "a.exr", *small)
        self.run_rtslc("check", "squares.obj")
        # It is what a scene with the model is.
        self.write(
            "s.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["std"],
                    "camera": {"model": "squares.obj"},
                    "objects": [{"model": "squares.obj"}],
                    "background": {"class": "GradientSky", "ground": [0.42, 0.42, 0.4]},
                    "render": {"engine": "path", "depth": 8, "sampler": "sobol"},
                }
            ),
        )
        self.run_rtslc("render", "s.json", "-o", "b.exr", *small)
        self.assert_same_bits("a.exr", "b.exr")

    def test_parts_and_names(self):
        """A group alone, and a material of the model on another object."""
        self.materials("Kd 0.8 0.1 0.3")
        mesh = {"mesh": "squares.obj", "part": "meshes.0.primitives.1"}
        self.scene(
            objects=[
                {"model": "squares.obj", "transform": {"translate": [0, 0, -1]}},
                {**mesh, "material": "squares.obj/left"},
            ]
        )
        left, right, _ = self.halves()
        self.assert_color(left + right, [0.8, 0.1, 0.3] * 2)

    def test_every_path_gives_the_same_bits(self):
        (self.folder / "x.png").write_bytes(png([[(200, 90, 9), (9, 9, 200)]] * 2))
        self.materials("map_Kd x.png\nKs 0.5 0.5 0.5\nNs 50", "Kd 0.5 0.5 0.5\nKe 1 1 1")
        self.scene(engine="path", spp=4, background=[0.3, 0.3, 0.3])
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        for way in WAYS:
            self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q", *way)
            self.assert_same_bits("a.exr", "b.exr", way)

    def test_the_mesh_alone_needs_a_material(self):
        self.materials("Kd 0.8 0.1 0.3")
        self.scene(objects=[{"mesh": "squares.obj"}])
        self.diagnose("check", "scene.json")


class Mistakes(ObjCase):
    def test_mistakes_have_a_place(self):
        self.scene()
        for text, line, column, containing in (
            ("Kd 1 1 1\n", 1, 1, "`Kd` belongs to no material"),
            ("newmtl\n", 1, 1, "`newmtl` needs a name"),
            ("newmtl left\nKd 1 1\n", 2, 1, "needs three numbers, or one; it has 2"),
            (
                "newmtl left\n\nKd 1 x 1\n",
                3,
                1,
                "`x` in `Kd` of the material `left` is not a number",
            ),
            ("newmtl left\nKd nan 1 1\n", 2, 1, "`nan` in `Kd`"),
            ("newmtl left\nNs\nKs 1 1 1\n", 2, 1, "`Ns` of the material `left` needs a number"),
            ("newmtl left\nmap_Kd\n", 2, 1, "needs the path of an image"),
            ("newmtl left\nmap_Kd missing.png\n", None, None, "missing.png"),
        ):
            with self.subTest(text=text):
                self.write("squares.mtl", text)
                message = self.diagnose("check", "scene.json")
                self.assertIn(containing, message[0]["message"])
                if line:
                    place = message[0]["range"]
                    self.assertTrue(place["file"].endswith("squares.mtl"), place)
                    self.assertEqual(place["begin"]["line"], line)
                    self.assertEqual(place["begin"]["column"], column)

    def test_damaged_files(self):
        """Bytes that are changed, left out or repeated: a picture or a message, never a crash."""
        numbers = random.Random(1)
        self.scene(spp=1)
        materials = (
            "newmtl left\nKd 0.8 0.1 0.3\nKs 0.5 0.5 0.5\nNs 20\nd 0.9\nillum 2\n"
            "newmtl right\nmap_Kd -s 1 2 3 -clamp on -bm 0.1 x.png\nNi 1.5\nillum 7\n"
        )
        (self.folder / "x.png").write_bytes(png([[(9, 9, 9)]]))
        for i in range(60 if "RTSL_DEEP" in os.environ else 20):
            with self.subTest(i=i):
                self.write("squares.mtl", materials)
                self.write("squares.obj", OBJ)
                file, text = (("squares.mtl", materials), ("squares.obj", OBJ))[i % 2]
                data = bytearray(text.encode())
                for _ in range(numbers.randint(1, 8)):
                    at = numbers.randrange(len(data))
                    kind = numbers.randrange(4)
                    if kind == 0:
                        data[at] = numbers.randrange(256)
                    elif kind == 1:
                        del data[at : at + numbers.randint(1, 20)]
                    elif kind == 2:
                        data[at:at] = data[at : at + numbers.randint(1, 40)]
                    else:
                        data[at:at] = b" -1e999999 "
                    if not data:
                        data = bytearray(b"\n")
                (self.folder / file).write_bytes(bytes(data))
                done = subprocess.run(
                    [RTSLC, "check", "scene.json"],
                    cwd=self.folder,
                    stdout=subprocess.DEVNULL,
                    stderr=subprocess.PIPE,
                    timeout=SECONDS,
                )
                self.assertIn(done.returncode, (0, DIAGNOSED), done.stderr[:2000])

    def test_a_material_file_that_is_a_folder(self):
        (self.folder / "squares.mtl").mkdir()
        self.scene()
        self.diagnose("check", "scene.json")

    def test_no_triangles(self):
        self.write("squares.obj", "v 0 0 0\nusemtl left\n")
        self.scene()
        self.diagnose("check", "scene.json")


if __name__ == "__main__":
    unittest.main()
