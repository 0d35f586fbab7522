"""Modules of the standard library: which files an import reads, and what is said of modules that do
not exist."""

import base64
import json
import pathlib
import struct
import unittest

from harness import RTSLC, Case

LIBRARY = (pathlib.Path(RTSLC).parent.parent / "share/rtslc/library").resolve()

SPHERE = {"primitive": {"class": "Sphere", "center": [0, 0, -3]}, "material": {"class": "Grey"}}
# A triangle in front of the camera.
CORNERS = struct.pack("<9f", -1, -1, -3, 1, -1, -3, 0, 1, -3)
URI = "data:application/octet-stream;base64," + base64.b64encode(CORNERS).decode()
GREY = "class Grey : rt_Material;\nvoid shade() { rt_SampleColor = color(0.5); }\n"


class Library(Case):
    def classes(self, text, *options):
        """The classes of a program of one file."""
        self.write("main.rtsl", text)
        reflection, _ = self.run_rtslc("compile", "main.rtsl", "--emit=reflection", *options)
        return sorted(each["name"] for each in json.loads(reflection)["classes"])

    def scene(self, **changes):
        scene = {
            "rtsl": 1,
            "import": ["std.primitives", "std.cameras", "Grey.rtsl"],
            "camera": {
                "class": "PerspectiveCamera",
                "constructor": [[0, 0, 0], [0, 0, -1], [0, 1, 0]],
            },
            "objects": [SPHERE],
            "render": {"size": [8, 6], "spp": 1},
        }
        scene.update(changes)
        self.write("Grey.rtsl", GREY)
        self.write("scene.json", json.dumps(scene))

    def test_only_what_is_mentioned_is_read(self):
        self.assertEqual(self.classes("import std.cameras;\n" + GREY), ["Grey"])
        self.assertEqual(
            self.classes("import std;\nclass Ball : Sphere { };\n"), ["Ball", "Sphere"]
        )
        self.assertEqual(
            self.classes("import std.cameras.PinholeCamera;\n" + GREY), ["Grey", "PinholeCamera"]
        )

    def test_each_module_can_be_imported(self):
        modules = [
            ".".join(file.relative_to(LIBRARY).with_suffix("").parts)
            for file in sorted((LIBRARY / "std").rglob("*.rtsl"))
        ]
        self.write("main.rtsl", "".join(f"import {module};\n" for module in modules) + GREY)
        self.run_rtslc("check", "main.rtsl")

    def test_files_imported_after_the_module_count_too(self):
        self.write("ball.rtsl", "class Ball : Sphere { };\n")
        self.assertEqual(
            self.classes('import std.primitives;\nimport "ball.rtsl";\n' + GREY),
            ["Ball", "Grey", "Sphere"],
        )

    def test_a_name_of_the_library_is_free_unless_imported(self):
        self.assertEqual(
            self.classes("import std.cameras;\nclass Sphere { int i() { return 1; } };\n"),
            ["Sphere"],
        )
        self.write("main.rtsl", "import std.primitives;\nclass Sphere { int i() { return 1; } };\n")
        messages = self.diagnose("check", "main.rtsl")
        self.assertEqual([each["code"] for each in messages], ["E0207"], messages)

    def test_names_of_classes_that_a_scene_does_not_name(self):
        """Engines, background colors and models use classes of the library: the picture must not
        change if the author's classes have their names, or those of classes that they need."""
        model = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": [0]}],
            "nodes": [{"mesh": 0}],
            "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.4, 0.8, 1]}}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
            "accessors": [
                {
                    "bufferView": 0,
                    "componentType": 5126,
                    "count": 3,
                    "type": "VEC3",
                    "min": [-1, -1, -3],
                    "max": [1, 1, -3],
                }
            ],
            "bufferViews": [{"buffer": 0, "byteLength": 36}],
            "buffers": [{"byteLength": 36, "uri": URI}],
        }
        self.write("model.gltf", json.dumps(model))
        own = "".join(
            f"class {name} {{ public float mine = 1.0; float twice() {{ return 2.0 * mine; }} }};\n"
            for name in ("UniformSky", "PathTracer", "Principled", "Scatterer", "Emission")
        )
        for engine in ("path", "normals"):
            for text, picture in (
                (GREY, "a.exr"),
                (GREY.replace(";", " {", 1) + "};\n" + own, "b.exr"),
            ):
                self.scene(
                    background=[0.1, 0.2, 0.3],
                    objects=[{"model": "model.gltf"}],
                    render={"size": [8, 6], "spp": 1, "engine": engine},
                )
                self.write("Grey.rtsl", text)
                self.run_rtslc("render", "scene.json", "-o", picture)
            self.assert_same_bits("a.exr", "b.exr")
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"].append("std.backgrounds")
        scene["render"]["engine"] = "path"
        self.write("scene.json", json.dumps(scene))
        messages = self.diagnose("check", "scene.json")
        self.assertEqual({each["code"] for each in messages}, {"E0207"}, messages)

    def test_the_author_s_names_do_not_reach_the_library(self):
        """Functions with the names of built-in ones, and names that an engine has: the picture must
        not change."""
        own = GREY.replace(";\n", " {\n", 1) + "};\n"
        names = """
            float max(float a, float b, float c) { return 1.0; }
            float clamp(float low, float x, float high) { return low; } // another order
            color mix(color a, color b, float share) { return color(0.0); }
            vec3 normalize(vec3 v) { return v; }
            const float dot = 2.0;
            struct PathRay { float x; };
            const float pathFarthest = 1.0;
            float pathShare(float density, float other) { return 0.0; }
            class PathSampler { float half() { return max(0.0, 1.0, clamp(0.0, dot, pathFarthest)) * pathShare(0.0, PathRay(1.0).x); } };
            """
        pictures = []
        for text in (own, own + names):
            self.scene(
                materials={
                    "noisy": {
                        "class": "Lambert",
                        "albedo": {"class": "Noise", "kind": 1, "low": [0.2, 0.1, 0.9]},
                    }
                },
                objects=[
                    SPHERE,
                    {
                        **SPHERE,
                        "primitive": {"class": "Sphere", "center": [0.5, 0, -2.5]},
                        "material": "noisy",
                    },
                ],
                background=[1, 1, 1],
                render={"engine": "path", "size": [16, 12], "spp": 4},
                **{
                    "import": [
                        "std.primitives",
                        "std.cameras",
                        "std.materials",
                        "std.textures",
                        "Grey.rtsl",
                    ]
                },
            )
            self.write("Grey.rtsl", text)
            pictures.append(f"{len(pictures)}.exr")
            self.run_rtslc("render", "scene.json", "-o", pictures[-1])
        self.assert_same_bits(*pictures)

    def test_macros_do_not_apply(self):
        self.assertEqual(
            self.classes("import std.primitives.Sphere;\n", "-Dcenter=2", "-Dradius=3"), ["Sphere"]
        )

    def test_scenes(self):
        self.scene()
        self.run_rtslc("render", "scene.json", "-o", "picture.png")
        self.run_rtslc("pack", "scene.json", "-o", "scene.pack")
        self.run_rtslc("explain", "scene.json", "--no-savings")
        self.run_rtslc("compile", "scene.json", "--emit=ptx")
        self.run_rtslc("check", "scene.json", "-MD", "-MF", "scene.d")
        rule = (self.folder / "scene.d").read_text()
        self.assertIn(str(LIBRARY / "std/primitives/Sphere.rtsl"), rule)
        self.assertIn(str(LIBRARY / "std/cameras/ViewCamera.rtsl"), rule)
        self.assertNotIn("PinholeCamera", rule)

    def test_spaces(self):
        """A ball with the center of object space, somewhere far away: points, vectors and normals
        of its hits."""
        self.scene()
        self.write(
            "Spaces.rtsl",
            """class Spaces : rt_Material {
              void shade() {
                vec3 p = pointToObject(rt_HitPoint);
                print(length(p), pointToWorld(p) - rt_HitPoint, cross(normalize(normalToWorld(p)), normalize(rt_GeometricNormal)),
                      cross(normalize(normalToObject(rt_GeometricNormal)), p),
                      pointToWorld(p + vectorToObject(vec3(0.0, 0.25, 0.0))) - rt_HitPoint, vectorToWorld(vectorToObject(p)) - p);
              }
            };""",
        )
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"].append("Spaces.rtsl")
        scene["camera"] = {
            "class": "PerspectiveCamera",
            "constructor": [[1000, 2000, 3020], [1000, 2000, 3000], [0, 1, 0]],
            "fieldOfView": 10,
        }
        scene["objects"] = [
            {
                "primitive": {"class": "Sphere", "center": [0, 0, 0]},
                "material": {"class": "Spaces"},
                "transform": [
                    {"scale": [1, 3, 2]},
                    {"rotate": [20, 30, 40]},
                    {"translate": [1000, 2000, 3000]},
                ],
            }
        ]
        self.write("scene.json", json.dumps(scene))
        output, _ = self.run_rtslc("render", "scene.json", "-q", "--print", "-o", "x.exr")
        lines = output.splitlines()
        self.assertGreater(len(lines), 10)
        for line in lines:
            length, *rest = [
                float(n)
                for n in line.split(": ", 1)[1]
                .replace("vec3(", "")
                .replace(")", "")
                .replace(",", " ")
                .split()
            ]
            self.assertAlmostEqual(length, 1, delta=0.001)
            for value, wanted in zip(rest, [0] * 10 + [0.25] + [0] * 4):
                self.assertAlmostEqual(value, wanted, delta=0.001, msg=line)

    def test_an_object_may_be_of_a_class_far_below_that_of_a_member(self):
        # Gold : Conductor : Scatterer; no object is a Conductor, so the program does not have that
        # class.
        self.scene(
            **{
                "import": ["std.primitives", "std.cameras", "std.materials"],
                "objects": [
                    {
                        **SPHERE,
                        "material": {
                            "class": "TwoSided",
                            "front": {"class": "Gold"},
                            "back": {"class": "Gold"},
                        },
                    }
                ],
            }
        )
        self.run_rtslc("render", "scene.json", "-o", "picture.png")

    def test_messages_say_where_the_library_defines_a_name(self):
        self.write(
            "main.rtsl",
            """class Painted : rt_Material {
              public Sphere ball;
              void shade() { rt_SampleColor = color(gradientNoise(rt_HitPoint) + pi); }
            };
            class Egg : Torus { };
            class Nowhere : Dodecahedron { };""",
        )
        messages = self.diagnose("check", "main.rtsl")
        said = {(each["code"], tuple(each["notes"])) for each in messages}
        for code, module in (
            ("E0201", "std.primitives.Sphere"),
            ("E0202", "std.noise"),
            ("E0206", "std.primitives.Torus"),
        ):
            self.assertIn((code, (f"it is in the standard library: add `import {module};`",)), said)
        self.assertTrue(
            any("the base classes are" in note for each in messages for note in each["notes"]),
            messages,
        )
        # With what the messages say, they are gone.
        imports = "".join(
            f"import {module};\n"
            for module in (
                "std.primitives.Sphere",
                "std.noise",
                "std.primitives.Torus",
            )
        )
        self.write(
            "main.rtsl",
            imports
            + (self.folder / "main.rtsl")
            .read_text()
            .replace(" + pi", "")
            .replace("Dodecahedron", "Sphere"),
        )
        self.run_rtslc("check", "main.rtsl")

    def test_unknown_modules(self):
        for text, meant in (
            ("std.cameas", "std.cameras"),
            ("std.cameras.Pinhole", "std.cameras.PinholeCamera"),
            ("PinholeCamera", "std.cameras.PinholeCamera"),
            ("std.primitives.sphere", "std.primitives.Sphere"),
        ):
            self.write("main.rtsl", f"import {text};\n")
            messages = self.diagnose("check", "main.rtsl")
            self.assert_message(messages, "E0126", text, line=1, column=8)
            self.assertEqual(messages[0]["fixes"][0]["replacement"], meant)
        for text in ("std.nothing", "other.things"):
            self.write("main.rtsl", f"import {text};\n")
            messages = self.diagnose("check", "main.rtsl")
            self.assertIn("`cameras`", str(messages[0]["notes"]))

    def test_unknown_modules_and_classes_of_scenes(self):
        self.scene(**{"import": ["std.primitive", "Grey.rtsl"]})
        messages = self.diagnose("check", "scene.json")
        self.assert_message(messages, "E0126", "std.primitive", file="scene.json")
        self.scene(objects=[{**SPHERE, "primitive": {"class": "Sphre"}}])
        messages = self.diagnose("check", "scene.json")
        self.assertIn("Sphere", str(messages[0]["fixes"]))
        self.scene(background={"class": "UniformSky"})
        messages = self.diagnose("check", "scene.json")
        self.assert_message(messages, "E0810", "UniformSky")
        self.assertEqual(
            messages[0]["notes"],
            ['it is in the standard library: add "std.backgrounds" to `import`'],
        )


if __name__ == "__main__":
    unittest.main()
