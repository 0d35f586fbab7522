"""Ranges of members: values of scenes, key frames, constructors and buffers that are outside."""

import json
import math
import re
import unittest

from harness import DIAGNOSED, EXAMPLES, Case
from numpy_files import npy

SHADERS = """
import std.cameras;
class Ball : rt_Primitive {
  public float radius in (0, inf) = 1.0;
  void intersect() { hit(radius); }
  void computeBounds() { rt_BoundMin = vec3(-radius); rt_BoundMax = vec3(radius); }
};
class Paint : rt_Material {
  public float roughness in [0, 1] = 0.5;
  public int layers in [1, 8] = 1;
  public vec3 weights in [0, 1) = vec3(0.0);
  public color tint in [0, 1] = color(1.0);
  public float coats[2] in (-1, 1) = {0.0, 0.0};
  public float depths[] in [0, inf);
  void shade() {
    float sum = roughness + float(layers) + weights.x + coats[0];
    if (depths.length() > 0) sum += depths[0];
    rt_SampleColor = tint * sum;
  }
};
class Lens : rt_Light {
  public float power in (0, inf);
  void constructor(float given in [-2, 2]) { power = given; }
  void illumination() { rt_LightDirection = vec3(0.0, 0.0, power); rt_LightColor = color(1.0); }
};
"""


class Ranges(Case):
    def check(self, paint, *arguments, **more):
        """The messages about a scene with one material, one member a line."""
        self.write("shaders.rtsl", SHADERS)
        camera = {"class": "PerspectiveCamera", "constructor": [[0, 0, 5], [0, 0, 0], [0, 1, 0]]}
        members = "".join(f',\n"{name}": {value}' for name, value in paint.items())
        rest = json.dumps(
            {
                "camera": camera,
                "objects": [{"primitive": {"class": "Ball"}, "material": "paint"}],
                **more,
            }
        )
        self.write(
            "scene.json",
            '{"rtsl": 1, "import": ["shaders.rtsl"],\n"materials": {"paint": {"class": "Paint"'
            + members
            + "}},\n"
            + rest[1:],
        )
        _, error = self.run_rtslc(
            "check", "scene.json", "--diagnostics=json", *arguments, status=None
        )
        return json.loads(error)["diagnostics"] if error else []

    def places(self, diagnostics):
        return [
            (d["range"]["begin"]["line"], d["range"]["begin"]["column"], d["message"])
            for d in diagnostics
        ]

    def test_all_values_outside_are_said_at_once(self):
        found = self.check(
            {
                "roughness": "-0.2",
                "layers": "9",
                "weights": "[0.5, 0.25, 1]",
                "tint": "[0, 1.5, 0]",
                "coats": "[0, -1]",
                "depths": "[0, 1e9, -1e-9]",
            }
        )
        self.assertEqual([d["code"] for d in found], ["E0805"] * 6)
        text = "member `{}` of `paint` is {}, which is not in its range {}"
        self.assertEqual(
            self.places(found),
            [
                (3, 14, text.format("roughness", "-0.2", "[0, 1]")),
                (4, 11, text.format("layers", "9", "[1, 8]")),
                (5, 24, text.format("weights", "1", "[0, 1)")),
                (6, 13, text.format("tint", "1.5", "[0, 1]")),
                (7, 14, text.format("coats", "-1", "(-1, 1)")),
                (8, 20, text.format("depths", "-1e-09", "[0, inf)")),
            ],
        )
        self.assertIn("class `Paint` has `float roughness in [0, 1]`", str(found[0]["notes"]))
        (found,) = self.check({}, "--set", "materials.paint.roughness=1.0001")
        self.assertEqual((found["code"], found["range"]["begin"]["column"]), ("E0805", 33))

    def test_no_light_of_the_library_is_negative(self):
        """Colors of lights and backgrounds, and factors of them."""
        colors = "radiance|irradiance|intensity|scale|zenith|horizon|nadir|ground"
        library = EXAMPLES.parent / "library/std"

        def negative(folder):
            for file in sorted((library / folder).glob("*.rtsl")):
                name = file.stem.replace("AreaLight", "RectangleLight")  # a base of others
                for member in re.findall(rf"^public \w+ ({colors})\b", file.read_text(), re.M):
                    yield {"class": name, member: -0.1}

        def check(**parts):
            imports = ["std.lights", "std.backgrounds"]
            self.write("scene.json", json.dumps({"rtsl": 1, "import": imports, **parts}))
            _, error = self.run_rtslc("check", "scene.json", status=DIAGNOSED)
            return error

        lights, backgrounds = list(negative("lights")), list(negative("backgrounds"))
        self.assertGreater(min(len(lights), len(backgrounds)), 5)
        error = check(lights=lights)
        for light in lights:
            self.assertIn(f"member `{list(light)[1]}` of `{light['class']}", error)
        for background in backgrounds:
            self.assertIn(f"member `{list(background)[1]}` of", check(background=background))

    def test_bounds(self):
        inside = {
            "roughness": "1",
            "layers": "8",
            "weights": "[0, 0.99999994, 0]",
            "coats": "[-0.99999994, 0.99999994]",
            "tint": "1",
            "depths": "[0]",
        }
        self.assertEqual(self.check(inside), [])
        # What counts is the number that shaders read.
        self.assertEqual(len(self.check({"weights": "[0, 0.999999999, 0]"})), 1)
        self.assertEqual(self.check({"roughness": "1.00000001"}), [])

    def test_key_frames(self):
        frames = '{"frames": {"0": 0.5, "10": 1.5, "20": -0.5}}'
        found = self.check({"roughness": frames, "weights": f"[0, {frames}, 0]"})
        self.assertEqual(
            [(line, column) for line, column, _ in self.places(found)],
            [(3, 42), (3, 53), (4, 44), (4, 55)],
        )
        steps = '{"frames": {"0": [0, 0, 0], "10": [0, 0, 2]}, "interpolate": "step"}'
        (found,) = self.check({"weights": steps})
        self.assertEqual((found["code"], found["range"]["begin"]["column"]), ("E0805", 53))
        self.assertEqual(self.check({"roughness": frames.replace("1.5", "1").replace("-", "")}), [])

    def test_what_a_class_sets_itself(self):
        lights = [{"class": "Lens", "constructor": [-1]}]
        (found,) = self.check({}, lights=lights)
        self.assertEqual(found["code"], "E0805")
        self.assertIn("member `power` of `Lens (lights.0)` is -1", found["message"])
        self.assertEqual(self.check({}, lights=[{"class": "Lens", "constructor": [2]}]), [])

    def test_arguments_of_constructors(self):
        (found,) = self.check({}, lights=[{"class": "Lens", "constructor": [2.5]}])
        self.assertEqual(
            (found["code"], found["message"]),
            ("E0805", "parameter `given` of `Lens` is 2.5, which is not in its range [-2, 2]"),
        )
        (found,) = self.check({}, lights=[{"class": "Lens"}])
        self.assertIn("`Lens(float given in [-2, 2])`", str(found["notes"]))

    def test_nan_is_in_no_range(self):
        self.write("depths.npy", npy("f", [2], [1.0, math.nan]))
        (found,) = self.check({"depths": '{"buffer": "depths.npy"}'})
        self.assertIn("is nan, which is not in its range [0, inf)", found["message"])

    def test_buffers_of_a_launch(self):
        self.write(
            "twice.rtsl",
            "class Twice : rt_RayGeneration;\n"
            "public float data[] in [0, inf);\n"
            "public out float doubled[];\n"
            "void generate() { doubled[int(rt_LaunchIndex.x)] = 2.0 * data[0]; }\n",
        )
        scene = {
            "rtsl": 1,
            "import": ["twice.rtsl"],
            "rayGeneration": {"class": "Twice", "data": [1, 2]},
            "render": {"engine": "programs", "size": [2, 1]},
        }
        self.write("scene.json", json.dumps(scene))
        self.write("good.npy", npy("f", [3], [1.0, 0.0, 3.5]))
        self.write("bad.npy", npy("f", [3], [1.0, -1.0, 3.5]))
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg")
        options = ("--target=host", "--out=doubled=doubled.npy")
        self.run_package("x.rtslpkg", *options, "--in=data=good.npy")
        _, packed = self.run_package("x.rtslpkg", *options, "--in=data=bad.npy", status=DIAGNOSED)
        _, scene = self.run_rtslc(
            "run", "scene.json", options[1], "--in=data=bad.npy", status=DIAGNOSED
        )
        self.assertIn("`--in data` is -1, which is not in its range [0, inf)", packed)
        self.assertIn("is -1, which is not in its range [0, inf)", scene)

    def test_reflection(self):
        self.write("shaders.rtsl", SHADERS)
        text, _ = self.run_rtslc("compile", "shaders.rtsl", "--emit=reflection")
        classes = {one["name"]: one["members"] for one in json.loads(text)["classes"]}
        self.assertEqual(
            [member["range"] for member in classes["Paint"]],
            ["[0, 1]", "[1, 8]", "[0, 1)", "[0, 1]", "(-1, 1)", "[0, inf)"],
        )

    def test_previews_choose_a_number_in_the_range(self):
        self.write(
            "Paint.rtsl",
            "class Paint : rt_Material;\n"
            "public float index in (1, 3);\n"
            "void shade() { rt_SampleColor = color(index); }\n",
        )
        _, error = self.run_rtslc("render", "Paint.rtsl", "--size=8x8", "--spp=1", "-o", "x.png")
        self.assertIn("`index` of `Paint` has no default: here it is 2", error)


if __name__ == "__main__":
    unittest.main()
