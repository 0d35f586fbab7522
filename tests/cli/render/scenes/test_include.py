"""Scene files that are parts of others."""

import json
import unittest

from harness import Case

CAMERA = {"class": "PerspectiveCamera", "constructor": [[0, 1, 5], [0, 0.5, 0], [0, 1, 0]]}
TRIANGLE = "v -1 0 0\nv 1 0 0\nv 0 1.5 0\nf 1 2 3\n"


class Include(Case):
    level = "-O0"

    def part(self, name, **members):
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(json.dumps({"rtsl": 1, **members}, indent=1))

    def render(self, name, scene="scene.json", *arguments):
        return self.run_rtslc(
            "render", scene, "-o", name, "-q", "--size", "16x12", "--spp", "2", *arguments
        )[1]

    def write_parts(self):
        """A scene in four files of three folders, and the same in one."""
        imports = ["std.cameras", "std.primitives", "std.materials", "std.lights"]
        clay, light = {"class": "Lambert", "reflectance": [0.7, 0.3, 0.1]}, {
            "class": "DistantLight"
        }
        floor = {
            "primitive": {"class": "Box", "low": [-9, -1, -9], "high": [9, 0, 9]},
            "material": "gray",
        }
        (self.folder / "models").mkdir()
        self.write("models/triangle.obj", TRIANGLE)
        self.write(
            "models/gray.rtsl",
            "import std.materials; class Gray : Lambert { void constructor(float r) { } };",
        )
        self.part(
            "shared/materials.json",
            **{"import": ["std.materials", "../models/gray.rtsl"]},
            materials={"clay": clay, "gray": {"class": "Gray", "constructor": [0.2]}},
        )
        self.part(
            "models/things.json",
            include="../shared/materials.json",
            objects=[{"mesh": "triangle.obj", "material": "clay"}],
            background=[9, 9, 9],
            render={"depth": 3, "seed": 7},
        )
        self.part(
            "lights.json",
            **{"import": "std.lights"},
            include=["shared/materials.json"],
            lights=[light],
            background=[0.5, 0.6, 0.7],
        )
        self.part(
            "scene.json",
            **{"import": ["std.cameras", "std.primitives"]},
            include=["models/things.json", "lights.json"],
            camera=CAMERA,
            objects=[floor],
            render={"seed": 2},
        )
        self.part(
            "one.json",
            **{"import": [*imports, "models/gray.rtsl"]},
            camera=CAMERA,
            materials={"clay": clay, "gray": {"class": "Gray", "constructor": [0.2]}},
            objects=[{"mesh": "models/triangle.obj", "material": "clay"}, floor],
            lights=[light],
            background=[0.5, 0.6, 0.7],
            render={"depth": 3, "seed": 2},
        )

    def test_it_is_the_scene_of_one_file(self):
        self.write_parts()
        self.assertEqual(self.render("a.exr"), "")
        self.render("b.exr", "one.json")
        self.assert_same_bits("a.exr", "b.exr")
        # From another folder, and with values that are overridden.
        self.render(
            "c.exr",
            str(self.folder / "scene.json"),
            "--set",
            "materials.clay.reflectance=0.5",
            "--set",
            "objects.0.mesh=models/triangle.obj",
        )
        self.render("d.exr", "one.json", "--set", "materials.clay.reflectance=0.5")
        self.assert_same_bits("c.exr", "d.exr")

    def test_files_of_a_rule_for_make(self):
        self.write_parts()
        self.render("a.exr", "scene.json", "-MD", "-MF", "rule")
        rule = (self.folder / "rule").read_text()
        for file in (
            "models/things.json",
            "shared/materials.json",
            "lights.json",
            "models/triangle.obj",
            "models/gray.rtsl",
        ):
            self.assertEqual(rule.count(file), 1, rule)

    def test_mistakes_are_shown_in_their_file(self):
        self.write_parts()
        self.part("lights.json", lights=[], material={})
        self.assert_message(
            self.diagnose("check", "scene.json"), "E0802", "`material`", file="lights.json"
        )
        self.part("lights.json", lights=[{"class": "DistantLight", "anglee": 3}])
        messages = self.diagnose(
            "render",
            "scene.json",
            "-o",
            "a.exr",
            "--set",
            'import=["std.cameras","std.primitives","std.lights","std.materials",'
            '"models/gray.rtsl"]',
        )
        self.assertTrue(messages[0]["range"]["file"].endswith("lights.json"), messages)
        self.assertIn("anglee", messages[0]["message"])
        self.write("lights.json", '{"rtsl": 1,\n "lights": [,]}')
        messages = self.diagnose("check", "scene.json")
        self.assertEqual(
            (messages[0]["code"], messages[0]["range"]["begin"]["line"]), ("E0800", 2), messages
        )
        self.assertTrue(messages[0]["range"]["file"].endswith("lights.json"))

    def test_names_in_two_files(self):
        self.write_parts()
        self.part(
            "scene.json",
            include=["models/things.json"],
            camera=CAMERA,
            materials={"clay": {"class": "Lambert"}},
        )
        messages = self.diagnose("check", "scene.json")
        self.assertIn("`clay` of `materials` is defined twice", messages[0]["message"])
        self.assertTrue(messages[0]["range"]["file"].endswith("scene.json"), messages)
        self.assertIn("shared/materials.json", json.dumps(messages[0]))

    def test_files_that_cannot_be_included(self):
        self.write_parts()
        self.part(
            "scene.json",
            include=["none.json", 3, "bad.json", "old.json", "bare.json"],
            camera=CAMERA,
        )
        self.write("bad.json", "[1]")
        self.write("old.json", '{"rtsl": 2}')
        self.write("bare.json", "{}")
        codes = [
            (message["code"], message["message"])
            for message in self.diagnose("check", "scene.json")
        ]
        self.assertEqual([code for code, _ in codes][:1], ["E0900"], codes)
        for text in (
            "`include` is a string, not a number",
            "a scene is an object, not a list",
            "version 2 of the scene format",
            'a scene begins with `"rtsl": 1`',
        ):
            self.assertIn(text, str(codes))

    def test_files_of_another_kind(self):
        self.write_parts()
        self.part("scene.json", include="models/gray.rtsl", camera=CAMERA)
        self.assert_message(
            self.diagnose("check", "scene.json"),
            "E0865",
            "`models/gray.rtsl` contains shaders, and `include` takes files of scenes: shaders are "
            "for `import`",
            file="scene.json",
        )
        self.part("scene.json", include=["models/triangle.obj"], camera=CAMERA)
        self.assert_message(
            self.diagnose("check", "scene.json"), "E0865", "a model is for `model` of a node"
        )
        for file in ("lights.json", "models/triangle.obj"):
            self.part("scene.json", **{"import": ["std.cameras", file]}, camera=CAMERA)
            self.assert_message(
                self.diagnose("check", "scene.json"), "E0865", f"`{file}` contains no shaders"
            )

    def test_cycles(self):
        self.part("scene.json", include="scene.json", camera=CAMERA)
        self.assert_message(
            self.diagnose("check", "scene.json"), "E0807", "`scene.json` includes itself", line=3
        )
        self.part("scene.json", include="a/b.json", camera=CAMERA)
        self.part("a/b.json", include=["../c.json"])
        self.part("c.json", include=["a/../a/b.json"])
        self.assert_message(
            self.diagnose("check", "scene.json"),
            "E0807",
            "these files include one another: `a/b.json`, `c.json`",
            file="c.json",
        )


if __name__ == "__main__":
    unittest.main()
