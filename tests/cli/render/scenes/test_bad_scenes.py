"""Scenes, meshes and arguments of `rtslc render` that make no sense."""

import json
import unittest

from harness import DIAGNOSED, USAGE, Case

TRIANGLE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"
SMALL = ("--size", "32x18", "--spp", "1")


class BadScenes(Case):
    def render(self, *arguments):
        """The messages of a rendering that must fail and leave no picture."""
        diagnostics = self.diagnose("render", "scene.json", "-o", "picture.png", *SMALL, *arguments)
        self.assertFalse(
            [name for name in self.files() if "picture" in name], "a picture was left behind"
        )
        return diagnostics

    def line_of(self, text):
        lines = (self.folder / "scene.json").read_text().splitlines()
        return next(i + 1 for i, line in enumerate(lines) if text in line)

    def test_missing_scene(self):
        self.assert_message(self.render(), "E0900", "scene.json")

    def test_json_syntax(self):
        self.write("scene.json", '{\n  "rtsl": 1,\n  "camera": }\n')
        self.assert_message(self.render(), "E0800", line=3, column=13, file="scene.json")

    def test_truncated_json(self):
        text = self.glass_scene().read_text()
        self.write("scene.json", text[: len(text) // 2])
        self.assertEqual([d["code"] for d in self.render()], ["E0800"])

    def test_unknown_class(self):
        self.glass_scene(background={"class": "Skye"})
        self.assert_message(
            self.render(), "E0810", "Skye", line=self.line_of('"Skye"'), file="scene.json"
        )

    def test_everything_wrong_is_said_at_once(self):
        self.glass_scene(background={"class": "Skye"}, camera={"class": "PinholeCamra"})
        diagnostics = self.render()
        self.assertEqual(
            [(d["code"], d["fixes"][0]["replacement"]) for d in diagnostics],
            [("E0810", "PinholeCamera"), ("E0810", "Sky")],
        )
        self.glass_scene(
            background={"class": "Sky", "horizont": 1}, ambient="blue", render={"spp": 0}
        )
        self.assertEqual([d["code"] for d in self.render()], ["E0804", "E0805"])
        self.glass_scene(background={"class": "Sky", "horizont": 1, "zenit": 2})
        self.assertEqual(
            [d["code"] for d in self.render("--set", "objects.1.material=gless")],
            ["E0806", "E0812", "E0812"],
        )

    def test_engines_want_their_beginning(self):
        self.glass_scene(render={"engine": "programs"})
        self.assert_message(
            self.render(), "E0803", "a scene for the engine `programs` needs a `rayGeneration`"
        )
        self.assert_message(
            self.render("--set", "render.engine=wavefront"), "E0808", "no engine `wavefront`"
        )

    def test_a_ray_generation_that_no_engine_runs(self):
        self.write(
            "Flat.rtsl",
            "class Flat : rt_RayGeneration;\nvoid generate() { rt_SampleColor = color(1.0); }\n",
        )
        scene = {
            "rtsl": 1,
            "import": ["std.cameras", "Flat.rtsl"],
            "camera": {
                "class": "OrthographicCamera",
                "constructor": {"eye": [0, 0, 5], "target": [0, 0, 0], "up": [0, 1, 0]},
            },
            "rayGeneration": {"class": "Flat"},
        }
        self.write("scene.json", json.dumps(scene))
        warning = "`rayGeneration` is ignored: the engine is `classic`"
        _, error = self.run_rtslc("check", "scene.json")
        self.assertEqual(error.count(warning), 1, error)
        for engine in ("programs", "classic", "normals"):
            _, error = self.run_rtslc("check", "scene.json", f"--set=render.engine={engine}")
            self.assertNotIn(warning, error)
        # `rtslc run` names what starts its samples.
        size = "--set=render.size=[2, 1]"
        _, summary = self.run_rtslc("run", "scene.json", size, "-Wno-scene")
        self.assertRegex(summary, "^camera: 2x1")
        _, summary = self.run_rtslc("run", "scene.json", size, "--set=render.engine=programs")
        self.assertRegex(summary, "^Flat: 2x1")

    def test_overrides_are_shown_where_they_are_wrong(self):
        self.glass_scene()
        for text, code, begin, length in (
            ("objects.7.material=glass", "E0809", 15, 1),
            ("textures.cheks.scale=8", "E0809", 16, 5),
            ("render.spp=many", "E0804", 18, 4),
            ("rendr.spp=4", "E0802", 7, 5),
            ("objects.1.material=gless", "E0806", 26, 5),
            ('background={"class": "Sky", "horizont": 1}', "E0812", 36, 8),
        ):
            (message,) = self.render("--set", text)
            place = message["range"]
            self.assertEqual(
                (message["code"], place["file"], place["begin"]),
                (code, "command line", {**place["begin"], "line": 1, "column": begin}),
            )
            self.assertEqual(place["end"]["column"] - begin, length, text)
        _, error = self.run_rtslc("check", "scene.json", "--set", "render.spp=many", status=1)
        self.assertIn("1 | --set render.spp=many\n  |                  ^^^^\n", error)

    def test_unknown_member(self):
        self.glass_scene(background={"class": "Sky", "horizont": [1, 1, 1]})
        self.assert_message(self.render(), "E0812", "horizont", line=self.line_of('"horizont"'))

    def test_unknown_source(self):
        self.glass_scene()
        diagnostics = self.render("--set", "import.0=Nothing.rtsl")
        self.assertEqual(diagnostics[0]["code"], "E0100")
        self.assertIn("Nothing.rtsl", diagnostics[0]["message"])

    def test_unknown_mesh(self):
        self.glass_scene()
        diagnostics = self.render("--set", "objects.3.mesh=nothing.obj")
        self.assert_message(diagnostics, "E0900", "nothing.obj")

    def test_each_mention_of_a_file_that_is_missing(self):
        """The file is read once for all of them."""
        self.write(
            "scene.json",
            """{"rtsl": 1, "import": "std",
"camera": {"class": "PerspectiveCamera", "constructor": [[0, 1, 4], [0, 0, 0], [0, 1, 0]]},
"materials": {"m": {"class": "Lambert"},
 "a": {"class": "Lambert", "reflectanceMap": {"class": "ImageTexture", "image": {"file": "n.png"}}},
 "b": {"class": "Lambert", "reflectanceMap": {"class": "ImageTexture", "image": {"file": "n.png"}}}},
"objects": [{"mesh": "none.obj", "material": "a"},
 {"mesh": "none.obj", "material": "b", "transform": {"scale": 2}},
 {"mesh": "none.obj", "material": "m", "transform": {"scale": 3}}]}""",
        )
        for text, lines in (
            ("cannot read mesh `none.obj`: No such file", [6, 7, 8]),
            ("n.png", [4, 5]),
        ):
            self.assertEqual(
                sorted(d["range"]["begin"]["line"] for d in self.render() if text in d["message"]),
                lines,
            )

    def test_unknown_material(self):
        self.glass_scene()
        self.assert_message(self.render("--set", "objects.1.material=gless"), "E0806", "gless")

    def test_mesh_with_nan(self):
        self.write("broken.obj", TRIANGLE.replace("1 0 0", "nan 0 0"))
        self.glass_scene()
        self.assert_message(
            self.render("--set", "objects.3.mesh=broken.obj"), "E0904", "broken.obj"
        )

    def test_truncated_mesh(self):
        header = (
            b"ply\nformat binary_little_endian 1.0\nelement vertex 100\nproperty float x\n"
            b"property float y\n"
            b"property float z\nelement face 50\nproperty list uchar int vertex_indices\n"
            b"end_header\n"
        )
        self.write("half.ply", header + b"\0" * 300)
        self.glass_scene()
        self.assert_message(
            self.render("--set", "objects.3.mesh=half.ply"),
            "E0904",
            "mesh `half.ply` is truncated: it ends in element 26 of 100 of `vertex`",
        )

    def test_damaged_headers_of_ply_meshes(self):
        header = (
            b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
            b"property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
            b"end_header\n"
        )
        body = b"0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
        self.glass_scene()
        for damaged, line in (
            (header[:42], "mesh `damaged.ply` is damaged or truncated in line 4 of its header"),
            (header[:-11], "line 8"),
            (header.replace(b"float y", b"flo\nt y") + body, "line 5"),
            (header.replace(b"element vertex 3", b"element vertex") + body, "line 3"),
            (b"plx" + header[3:] + body, "is damaged: it does not begin with `ply`"),
        ):
            with self.subTest(damaged=damaged):
                self.write("damaged.ply", damaged)
                message = self.render("--set", "objects.3.mesh=damaged.ply")
                self.assert_message(message, "E0904", "damaged.ply")
                self.assert_message(message, "E0904", line)

    def test_mesh_with_an_index_out_of_range(self):
        self.write("range.obj", TRIANGLE.replace("f 1 2 3", "f 1 2 77"))
        self.glass_scene()
        self.assert_message(self.render("--set", "objects.3.mesh=range.obj"), "E0904", "range.obj")

    def test_lines_of_meshes_that_are_no_numbers(self):
        """Each is named; a vertex that is left out would give faces other corners."""
        self.glass_scene()
        for line, said in (
            ("v 0 1 x", "in line 2: `x` is not a number"),
            ("v 0 1", "in line 2: `v` needs 3 numbers or more"),
            ("f 1 2 3/a", "in line 2: `3/a` is not a number"),
            ("f 1 2 0", "in line 2: it has the corner 0, and there are 3 vertices"),
            ("f 1 2 -1", "in line 2: it has the corner -1, and there are 3 vertices"),
            ("f 1 2 " + 20 * "9", f"in line 2: it has the corner {2**63 - 1}, and there are 3"),
        ):
            self.write("line.obj", "# a comment\n" + line + "\n" + TRIANGLE)
            message = self.render("--set", "objects.3.mesh=line.obj")
            self.assert_message(message, "E0904", said)

    def test_empty_mesh(self):
        self.write("empty.obj", "")
        self.glass_scene()
        self.assert_message(self.render("--set", "objects.3.mesh=empty.obj"), "E0904", "empty.obj")

    def test_sphere_of_radius_zero(self):
        self.glass_scene()
        out, error = self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "picture.png",
            *SMALL,
            "--set",
            "objects.1.primitive.radius=0",
            "--diagnostics=json",
        )
        warnings = json.loads(error)["diagnostics"]
        self.assertTrue(
            any(w["code"] == "W2800" and "Sphere" in w["message"] for w in warnings), error
        )

    def test_sphere_of_radius_nan(self):
        self.glass_scene()
        diagnostics = self.render("--set", "objects.1.primitive.radius=1e999")
        self.assertTrue(diagnostics)

    def test_attribute_without_source(self):
        self.write(
            "Needy.rtsl",
            "class Needy : rt_Material;\nscratch vec3 grain;\n"
            "void shade() { rt_SampleColor = color(grain.x); }\n",
        )
        path = self.glass_scene()
        scene = json.loads(path.read_text())
        scene["import"].append("Needy.rtsl")
        scene["materials"]["glass"] = {"class": "Needy"}
        path.write_text(json.dumps(scene))
        diagnostics = self.render()
        self.assert_message(diagnostics, "E0700", "grain", line=2, column=14, file="Needy.rtsl")
        self.assertTrue(diagnostics[0]["labels"][0]["range"]["file"].endswith("Sphere.rtsl"))

    def test_attribute_of_another_type(self):
        self.write(
            "Needy.rtsl",
            "class Needy : rt_Material;\nscratch vec3 coordinates;\n"
            "void shade() { rt_SampleColor = color(coordinates.x); }\n",
        )
        path = self.glass_scene()
        scene = json.loads(path.read_text())
        scene["import"].append("Needy.rtsl")
        scene["materials"]["floor"] = {"class": "Needy"}
        path.write_text(json.dumps(scene))
        diagnostics = self.render()
        self.assert_message(diagnostics, "E0701", "vec2", file="Needy.rtsl")
        self.assertTrue(diagnostics[0]["labels"][0]["range"]["file"].endswith("Parallelogram.rtsl"))

    def add_material(self, text, **members):
        """The glass scene with the floor made of class Odd."""
        self.write("Odd.rtsl", text)
        path = self.glass_scene()
        scene = json.loads(path.read_text())
        scene["import"].append("Odd.rtsl")
        scene["materials"]["floor"] = {"class": "Odd", **members}
        path.write_text(json.dumps(scene, indent=1))

    def test_more_attributes_than_a_ray_carries(self):
        self.add_material(
            "class Odd : rt_Material;\nscratch mat4 a, b, c;\n"
            "void shade() { rt_SampleColor = color(a[0].x + b[0].x + c[0].x); }\n"
        )
        sphere = (self.folder / "Parallelogram.rtsl").read_text()
        (self.folder / "Parallelogram.rtsl").write_text(
            sphere.replace(
                "scratch vec2 coordinates;", "scratch vec2 coordinates;\nscratch mat4 a, b, c;"
            ).replace("    hit(t);", "  {\n    a = mat4(t); b = a; c = a;\n    hit(t);\n  }")
        )
        self.assert_message(self.render(), "E0702", "32")

    def test_reference_that_is_not_set(self):
        self.add_material(
            "class Odd : rt_Material;\npublic rt_Texture albedo;\n"
            "void shade() { rt_SampleColor = albedo.lookup(); }\n"
        )
        self.assert_message(self.render(), "E0815", "albedo", file="scene.json")

    def test_material_that_shades_nothing(self):
        self.add_material("class Odd : rt_Material;\nvoid evaluatePDF() { rt_PDF = 1.0; }\n")
        self.assert_message(self.render(), "E0817", "shade", file="scene.json")

    def test_module_that_is_not_there(self):
        self.glass_scene()
        self.assert_message(self.render("--set", "import.0=std.nothing"), "E0126", "std.nothing")

    def test_pictures_that_are_none(self):
        self.write("text.png", "this is no picture")
        self.write("cut.exr", b"\x76\x2f\x31\x01\x02\0\0\0")
        for picture in ("text.png", "cut.exr"):
            self.assert_message(self.diagnose("compare", picture, picture), "E0905", picture)

    def test_unwritable_picture(self):
        self.glass_scene()
        diagnostics = self.diagnose("render", "scene.json", "-o", "nowhere/picture.png", *SMALL)
        self.assert_message(diagnostics, "E0902", "nowhere")

    def test_picture_of_unknown_format(self):
        self.glass_scene()
        _, error = self.run_rtslc(
            "render", "scene.json", "-o", "picture.jpeg", *SMALL, status=USAGE
        )
        self.assertIn("`picture.jpeg`", error)

    def test_arguments_that_make_no_sense(self):
        self.glass_scene()
        for arguments in (
            ["--spp", "0"],
            ["--spp", "-3"],
            ["--size", "0x10"],
            ["--size", "10"],
            ["--size", "1e9x2"],
            ["--threads", "0"],
            ["--color", "spectral:99"],
            ["--traversal", "fast"],
            ["--unknown"],
        ):
            with self.subTest(arguments=arguments):
                _, error = self.run_rtslc(
                    "render", "scene.json", "-o", "picture.png", *arguments, status=USAGE
                )
                self.assertIn(arguments[0], error)
        self.run_rtslc("render", "scene.json", status=USAGE)
        self.run_rtslc(status=USAGE)
        _, error = self.run_rtslc("rendr", status=USAGE)
        self.assertIn("unknown command `rendr`", error)


BALL = {"center": [0, 0, 0], "radius": 1}
STANDARD = ["std." + name for name in "cameras lights primitives materials textures".split()]
OWN = """class Own : rt_Material;
public float gain = 1.0;
void shade() { rt_SampleColor = color(gain); }
"""


class AllAtOnce(Case):
    """`rtslc check` of a scene reports in one run what it reports of each mistake alone, and no
    error that follows from another."""

    def scene(self):
        return {
            "rtsl": 1,
            "import": ["Own.rtsl", *STANDARD],
            "render": {"size": [8, 8], "spp": 1},
            "camera": {"class": "FisheyeCamera", "constructor": [[0, 1, 5], [0, 0, 0], [0, 1, 0]]},
            "lights": [{"class": "PointLight", "position": [1, 2, 3]}],
            "background": 0.5,
            "textures": {"gray": {"class": "Solid", "value": 0.5}},
            "materials": {
                "clay": {"class": "Lambert", "albedo": "gray"},
                "own": {"class": "Own", "gain": 2},
            },
            "objects": [
                {"mesh": "knot.obj", "material": "clay"},
                {
                    "primitive": {"class": "Sphere", **BALL},
                    "material": "own",
                },
                {"mesh": "knot.obj", "material": {"class": "Lambert", "reflectance": 0.3}},
                {"primitive": {"class": "Sphere", **BALL}, "material": "clay"},
                {"primitive": {"class": "Sphere", **BALL}, "material": "clay"},
            ],
        }

    # Path, value, code, and a part of the message. What uses the value must not be reported.
    MISTAKES = (
        ("render.size", [8, 0], "E0805", "the height must be between"),
        ("render.tint", 3, "E0802", "`render` has no key `tint`"),
        ("camera.constructor", [[0, 1, 5]], "E0814", "takes 3 arguments, not 1"),
        ("lights.0.power", 3, "E0812", "class `PointLight` has no member `power`"),
        ("background", "blue", "E0804", "`background` is"),
        ("textures.gray.class", 7, "E0804", "`class`"),
        ("materials.own.gain", "loud", "E0804", "member `gain` of `own` is a `float`"),
        ("objects.1.primitive.radius", [1, 2], "E0804", "member `radius`"),
        ("objects.3.primitive.class", "Spher", "E0810", "no class is named `Spher`"),
        ("objects.4.primitive", 5, "E0804", "`primitive`"),
        ("objects.2.mesh", "nowhere.obj", "E0900", "nowhere.obj"),
        ("objects.2.material.class", "Lambrt", "E0810", "no class is named `Lambrt`"),
        ("objects.2.mask", -1, "E0805", "`mask` must be between"),
        ("ambient", {"frames": {"0": 0.1, "last": 1}}, "E0804", "a key of `frames`"),
        (
            "objects.0.transform",
            {"frames": {"0": {"scale": 2}, "1": {"rotate": [0, 9, 0]}}},
            "E0804",
            "this has no `scale`",
        ),
    )
    # With these, classes that no file has might be in a file that cannot be checked.
    IMPORTS = (
        ("Bad.rtsl", "E0202", "unknown function `colour`"),
        ("missing.rtsl", "E0100", "missing.rtsl"),
        ("std.nothing", "E0126", "unknown module `std.nothing`"),
    )

    def setUp(self):
        super().setUp()
        self.glass_scene()
        self.write("Own.rtsl", OWN)
        self.write("Bad.rtsl", "class Bad : rt_Material;\nvoid shade() { colour(1.0); }\n")

    def check(self, scene, expected):
        self.write("check.json", json.dumps(scene, indent=1))
        messages = [
            (message["code"], message["message"])
            for message in self.diagnose("check", "check.json", "--error-limit=0")
            if message["severity"] == "error"
        ]
        self.assertEqual(sorted(code for code, _ in messages), sorted(code for code, _ in expected))
        for code, part in expected:
            self.assertTrue(
                any(code == said and part in text for said, text in messages), (code, part)
            )

    @staticmethod
    def put(scene, path, value):
        *way, last = [int(key) if key.isdigit() else key for key in path.split(".")]
        for key in way:
            scene = scene[key]
        scene[last] = value

    def test_each_alone_and_all_together(self):
        self.write("good.json", json.dumps(self.scene()))
        self.run_rtslc("check", "good.json")
        every = self.scene()
        for path, value, *said in self.MISTAKES:
            with self.subTest(path=path):
                scene = self.scene()
                self.put(scene, path, value)
                self.check(scene, [said])
                self.put(every, path, value)
        self.check(every, [said for _, _, *said in self.MISTAKES])

    def test_with_shaders_that_have_mistakes(self):
        every = self.scene()
        for path, value, *_ in self.MISTAKES:
            self.put(every, path, value)
        every["import"] += [name for name, *_ in self.IMPORTS]
        expected = [said for _, _, *said in self.MISTAKES] + [said for _, *said in self.IMPORTS]
        self.check(every, [said for said in expected if said[0] != "E0810"])

    def test_all_values_of_an_object(self):
        scene = self.scene()
        scene["camera"] = {
            "class": "PerspectiveCamera",
            "constructor": {"eye": [0, 1], "target": [0, 0, 0], "up": "y"},
            "fieldOfView": "wide",
        }
        scene["objects"][1]["primitive"].update(center=[0, 0], radius="x")
        scene["materials"]["clay"].update(albedo="nothing", reflectance=[1, 2])
        scene["lights"][0].update(power=3, position=[0, "high", 0])
        self.check(
            scene,
            [
                ("E0804", "parameter `eye`"),
                ("E0804", "parameter `up`"),
                ("E0804", "member `fieldOfView`"),
                ("E0804", "member `center`"),
                ("E0804", "member `radius`"),
                ("E0806", "`nothing`"),
                ("E0804", "member `reflectance`"),
                ("E0812", "no member `power`"),
                ("E0804", "member `position`"),
            ],
        )

    def test_arguments_beside_the_constructor(self):
        """They are one mistake, and a note says where arguments are."""
        scene = self.scene()
        disk = {"class": "Disk", "center": [0, 0, 0], "normal": [0, 0, 1], "radius": 1}
        scene["objects"][0] = {"primitive": disk, "material": "clay"}
        self.check(scene, [("E0814", "requires an argument for `center`, `normal`, `radius`")])
        _, error = self.run_rtslc("check", "check.json", status=DIAGNOSED)
        self.assertIn("= note: arguments are in `constructor`, not beside it", error)
        disk["constructor"] = [[0, 0, 0], [0, 0, 1], 1, 0]
        self.check(scene, 3 * [("E0812", "class `Disk` has no member")])

    def test_overrides_with_mistakes(self):
        """Nothing is said of what they might have added."""
        scene = self.scene()
        del scene["camera"]
        self.put(scene, "render.size", [8, 0])
        self.put(scene, "objects.1.material", "none")
        self.write("check.json", json.dumps(scene))
        wrong = [["--set", text] for text in ("camera={", "objects.9.mask=1", "render.tint.r=1")]
        messages = self.diagnose("check", "check.json", *sum(wrong, []))
        self.assertEqual([each["code"] for each in messages], 3 * ["E0809"] + ["E0805"])

    def test_a_file_with_mistakes_has_unknown_classes(self):
        """Of which nothing is said."""
        self.write("Own.rtsl", OWN.replace("gain", "loss", 1))
        self.check(self.scene(), [("E0200", "gain")])


if __name__ == "__main__":
    unittest.main()
