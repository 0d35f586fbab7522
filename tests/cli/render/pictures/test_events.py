"""What samples do beside colors: `print` and exceptions."""

import json
import struct
import unittest

from exr_files import channels
from harness import EXAMPLES, Case, has_gpu

SHADERS = """
struct P { float depth; };

class Eye : rt_RayGeneration {
  public float table[3] = float[](0.25, 0.5, 0.75);
  void generate() {
    uint x = rt_LaunchIndex.x;
    uint y = rt_LaunchIndex.y;
    if (x == 1u || y == 2u)
      print("at", rt_LaunchIndex, "is", x == 1u, ivec2(-1, 2), color(0.5), mat2(1.0), -0.125);
    P p = P(0.0);
    // Row 1: no direction in column 0. Row 2: a ball that mirrors itself without end, but for column 3.
    if (y == 1u && x == 0u)
      trace(vec3(0.0), vec3(0.0), 0.0, 1e30, p);
    if (y == 2u)
      trace(x == 3u ? vec3(90.0) : vec3(0.0), vec3(0.0, 0.0, 1.0), 0.0, 1e30, p);
    rt_SampleColor = color(y == 0u ? table[x] : 0.125 * p.depth);
  }
};

class Endless : rt_Material {
  void closestHit(inout P p) {
    P next = P(0.0);
    trace(rt_HitPoint, -rt_RayDirection, 0.0, 1e30, next);
    p.depth = next.depth + 1.0;
  }
};

class Code : rt_Exception {
  void exception() { rt_SampleColor = color(0.25 * float(rt_ExceptionCode)); }
};
"""

SCENE = {
    "rtsl": 1,
    "import": ["shaders.rtsl", str(EXAMPLES / "glass" / "Sphere.rtsl")],
    "rayGeneration": {"class": "Eye"},
    "objects": [
        {
            "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 2},
            "material": {"class": "Endless"},
        }
    ],
    "render": {"engine": "programs", "size": [4, 3], "spp": 2, "depth": 5},
}


class Events(Case):
    def setUp(self):
        super().setUp()
        self.write("shaders.rtsl", SHADERS)
        self.write("scene.json", json.dumps(SCENE))
        self.write("answered.json", json.dumps(dict(SCENE, exception={"class": "Code"})))

    def render(self, scene, picture, *arguments):
        out, _ = self.run_rtslc("render", scene, "-o", picture, "--json", *arguments)
        return json.loads(out)

    def assert_same(self, a, b):
        self.assert_same_bits(a, b)

    def test_prints_come_in_the_order_of_the_launch(self):
        said = self.render("scene.json", "a.exr", "--print")["printed"]
        places = [
            (x, y, s) for y in range(3) for x in range(4) for s in range(2) if x == 1 or y == 2
        ]
        self.assertEqual(
            said,
            [
                f"pixel {x},{y} sample {s}: at uvec3({x}, {y}, 0) is "
                f"{'true' if x == 1 else 'false'} ivec2(-1, 2) "
                "color(0.5, 0.5, 0.5) mat2(1, 0, 0, 1) -0.125"
                for x, y, s in places
            ],
        )
        for arguments in (
            ["--threads", "1", "-O", "0"],
            ["--trace", "split"],
            ["--target", "host-megakernel"],
        ):
            with self.subTest(arguments=arguments):
                self.assertEqual(
                    self.render("scene.json", "b.exr", "--print", *arguments)["printed"], said
                )
                self.assert_same("a.exr", "b.exr")

    def test_more_lines_than_the_memory_of_a_launch(self):
        many = json.loads(json.dumps(SCENE).replace('"size": [4, 3]', '"size": [100, 100]'))
        self.write("shaders.rtsl", SHADERS.replace("x == 1u ||", "x % 2u == 1u ||"))
        self.write("scene.json", json.dumps(many))
        said = self.render("scene.json", "a.exr", "--print")["printed"]
        self.assertEqual(len(said), 2 * (50 * 100 + 50))
        targets = ["host-megakernel"] + (["gpu"] if has_gpu() else [])
        for target in targets:
            with self.subTest(target=target):
                again = self.render("scene.json", "b.exr", "--print", "--target", target)
                self.assertEqual(again["printed"], said)
                self.assert_same("a.exr", "b.exr")

    def test_nothing_is_printed_unless_asked(self):
        self.assertNotIn("printed", self.render("scene.json", "a.exr"))
        out, _ = self.run_rtslc("render", "scene.json", "-o", "b.exr", "--quiet")
        self.assertEqual(out, "")
        out, _ = self.run_rtslc(
            "render", "scene.json", "-o", "b.exr", "--quiet", "--print", "--spp", "1"
        )
        self.assertEqual(len(out.splitlines()), 6)
        self.assert_same("a.exr", "b.exr")

    def test_exceptions_are_counted_and_answered(self):
        # Two samples a pixel: table[3], the ray without a direction, three mirrors.
        expected = {"stackOverflow": 6, "badRay": 2, "index": 2}
        ways = (
            [],
            ["-O", "0", "--trace", "split", "--threads", "1"],
            ["--target", "host-megakernel"],
        )
        for way in ways:
            with self.subTest(way=way):
                self.assertEqual(
                    self.render("scene.json", "a.exr", "--exceptions", *way)["exceptions"], expected
                )
                self.assertEqual(
                    self.render("answered.json", "b.exr", *way)["exceptions"], expected
                )
                if not way:
                    self.run_rtslc("render", "scene.json", "-o", "first.exr", "-q", "--exceptions")
                    self.run_rtslc("render", "answered.json", "-o", "second.exr", "-q")
                self.assert_same("a.exr", "first.exr")
                self.assert_same("b.exr", "second.exr")
        self.run_rtslc("compare", "first.exr", "second.exr", "--threshold", "0", status=1)

    def test_a_light_without_a_direction(self):
        """One way to light a point says the same as another of a direction that no ray can have."""
        lit = """
struct P { float light; };
class Eye : rt_RayGeneration {
  void generate() {
    P p = P(0.0);
    trace(vec3(0.0, 0.0, 4.0), vec3(0.0, 0.0, -1.0), 0.0, 1e30, p);
    rt_SampleColor = color(p.light);
  }
};
class Nowhere : rt_Light {
  public vec3 towards;
  void illumination() { rt_LightDirection = 1e38 * towards; rt_LightColor = color(1.0); }
};
class Lit : rt_Material {
  void closestHit(inout P p) {
    vec3 n = rt_GeometricNormal;
    if (rt_LaunchIndex.x == 0u && illuminate(0, rt_HitPoint)) p.light = 1.0;
    if (rt_LaunchIndex.x == 1u && illuminate(0, rt_HitPoint, n)) p.light = 1.0;
    if (rt_LaunchIndex.x == 2u)
      illuminance (rt_HitPoint, n, 1.0) p.light = 1.0;
  }
};
"""
        self.write("shaders.rtsl", lit)
        for z, raised, light in ((1e38, 3, 0), (0, 3, 0), (1e-38, 0, 1), (-1e-38, 0, 0)):
            scene = json.loads(json.dumps(SCENE))
            scene["objects"][0]["material"]["class"] = "Lit"
            scene["lights"] = [{"class": "Nowhere", "towards": [0, 0, z]}]
            scene["render"].update(size=[3, 1], spp=1)
            self.write("scene.json", json.dumps(scene))
            found = self.render("scene.json", "a.exr", "--exceptions")
            self.assertEqual(found.get("exceptions", {}).get("badRay", 0), raised, z)
            self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q")
            words = channels((self.folder / "b.exr").read_bytes())["R"]
            self.assertEqual(struct.pack("3I", *words), struct.pack("3f", *[light] * 3))

    def test_shaders_that_return_after_an_exception_print(self):
        said = """
    if (y == 2u) print("back", p.depth);
    rt_SampleColor = color(y == 0u ? table[x] : 0.125 * p.depth);
    if (x == 3u) print("last", y);
"""
        shaders = SHADERS.replace(
            "\n    rt_SampleColor = color(y == 0u ? table[x] : 0.125 * p.depth);\n", said
        )
        shaders = shaders.replace("    if (x == 1u || y == 2u)\n", "    if (false)\n")
        shaders = shaders.replace(
            "    p.depth = next.depth", '    print("up", next.depth);\n    p.depth = next.depth'
        )
        shaders = shaders.replace("exception() {", 'exception() { print("code", rt_ExceptionCode);')
        self.write("shaders.rtsl", shaders)
        mirrored = [f"up {n}" for n in range(6)] + ["back 6", "code 1"]
        pixels = {
            (3, 0): ["last 0", "code 3"],
            (0, 1): ["code 2"],
            (3, 1): ["last 1"],
            (0, 2): mirrored,
            (1, 2): mirrored,
            (2, 2): mirrored,
            (3, 2): ["back 0", "last 2"],
        }
        expected = [
            f"pixel {x},{y} sample {sample}: {line}"
            for (x, y), lines in pixels.items()
            for sample in range(2)
            for line in lines
        ]
        ways = (
            [],
            ["-O", "0", "--trace", "split", "--threads", "1"],
            ["--trace", "split"],
            ["--target", "host-megakernel"],
            ["--target", "host-megakernel", "--organisation", "wavefront"],
            ["--target", "host-megakernel", "--organisation", "persistent"],
        )
        for way in ways:
            with self.subTest(way=way):
                found = self.render("answered.json", "a.exr", "--print", *way)
                self.assertEqual(found["printed"], expected)

    def test_what_is_no_exception_has_its_value(self):
        self.assertNotIn("exceptions", self.render("scene.json", "a.exr"))
        for way in (["--trace", "split"], ["--target", "host-megakernel"]):
            self.render("scene.json", "b.exr", *way)
            self.assert_same("a.exr", "b.exr")

    def test_the_count_is_said_in_words(self):
        _, error = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--exceptions")
        self.assertIn("6 samples sent rays deeper than 5: give a larger `--depth`", error)
        self.assertIn("2 samples sent a ray without a direction", error)
        self.assertNotIn("returned black", error)
        self.assertIn("2 samples used an index that was out of range", error)


if __name__ == "__main__":
    unittest.main()
