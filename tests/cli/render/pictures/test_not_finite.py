"""Samples that are infinite or not a number, and rays that the depth limit cuts off: left out,
counted and said, the same on every path."""

import json
import re
import unittest

from harness import EXAMPLES, Case


SHADERS = """
struct P { color light; };

class Eye : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0);
    rt_RayDirection = vec3(2.0 * rt_ScreenCoord - vec2(1.0), 1.0);
  }
};

// One sample in four is bad in the left half, all of them in the last column, none elsewhere.
class Spoilt : rt_Material {
  public float zero = 0.0;

  float divide(float x) {
    return x / zero;
  }

  void shade() {
    vec3 inverse = 1.0 / (rt_RayDirection * zero); // rightly infinite, but for the last column
    float used = min(inverse.x, 1.0) > 2.0 ? 1.0 : 0.5;
    color c = color(used + 0.125 * rand());
    if (rt_LaunchIndex.x < 4u && rand() < 0.25)
      c = c * divide(1.0);
    if (rt_LaunchIndex.x == 7u)
      c = c + color(zero * inverse.y);
    rt_SampleColor = c;
  }
};

// The ball is around the eye: no ray misses it.
class Mirror : rt_Material {
  void shade() { rt_SampleColor = color(0.5) + 0.5 * trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal)); }
};
"""
DIVISION = 1 + SHADERS.split("\n").index("    return x / zero;")
INVERSE = 1 + next(i for i, line in enumerate(SHADERS.split("\n")) if "vec3 inverse" in line)

WAYS = (
    [],
    ["--trace=split"],
    ["--traversal=device"],
    ["-O", "0"],
    ["--threads", "1"],
    ["--target=host-megakernel"],
    ["--target=host-megakernel", "--threads", "1"],
    ["--keep=all"],
)
SPP = 16


class ShaderCase(Case):
    def setUp(self):
        super().setUp()
        self.write("shaders.rtsl", SHADERS)

    def scene(self, material="Spoilt", depth=4, spp=SPP):
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["shaders.rtsl", str(EXAMPLES / "glass" / "Sphere.rtsl")],
                    "camera": {"class": "Eye"},
                    "objects": [
                        {
                            "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 2},
                            "material": {"class": material},
                        }
                    ],
                    "render": {"engine": "classic", "size": [8, 4], "spp": spp, "depth": depth},
                }
            ),
        )

    def render(self, *arguments, picture="a.exr"):
        out, error = self.run_rtslc("render", "scene.json", "-o", picture, "--json", *arguments)
        return json.loads(out), error


class NotFinite(ShaderCase):
    def test_every_path_leaves_them_out(self):
        self.scene()
        first, error = self.render()
        self.assertGreater(first["samplesNotFinite"], 4 * SPP)
        self.assertLess(first["samplesNotFinite"], 4 * SPP + 16 * SPP)
        self.assertEqual(first["pixelsWithoutSample"], 4)
        self.assertEqual(first["samples"], 8 * 4 * SPP)
        for i, way in enumerate(WAYS):
            with self.subTest(way=way):
                figures, _ = self.render(*way, picture=f"{i}.exr")
                for key in ("samplesNotFinite", "pixelsWithoutSample", "notFinite"):
                    self.assertEqual(figures[key], first[key], key)
                self.assert_same_bits("a.exr", f"{i}.exr")
        # Each good sample lies between 0.5 and 0.625, and so does the mean of a pixel that has one;
        # a bad one that counted as 0 would pull it below.
        out, _ = self.run_rtslc("compare", "a.exr", "a.exr", "--json")
        mean = json.loads(out)["means"][0][0]
        self.assertTrue(0.5 * 7 / 8 < mean < 0.625 * 7 / 8, mean)
        self.assertGreater(mean, 0.555 * 7 / 8)

    def test_a_package_does_the_same(self):
        self.scene()
        first, _ = self.render("--target=host-megakernel")
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
        out, error = self.run_package(
            "x.rtslpkg", "--target=host", "-o", "b.exr", "--json", "--compare", "a.exr"
        )
        figures = json.loads(out)
        self.assertEqual(figures["samplesNotFinite"], first["samplesNotFinite"])
        self.assertEqual(
            figures["notFinite"],
            [{"pixel": one["pixel"], "sample": one["sample"]} for one in first["notFinite"]],
        )
        self.assertIn("samples were infinite or not a number, and are left out", error)
        self.assertIn(
            "pixel {},{} sample {}".format(
                *first["notFinite"][0]["pixel"], first["notFinite"][0]["sample"]
            ),
            error,
        )

    def test_the_first_are_named_with_the_line(self):
        self.scene()
        for way in WAYS + (["--fp=fast"], ["--fp=double"]):
            with self.subTest(way=way):
                figures, error = self.render(*way)
                self.assertEqual(len(figures["notFinite"]), 8)
                places = [
                    (one["pixel"][1], one["pixel"][0], one["sample"])
                    for one in figures["notFinite"]
                ]
                self.assertEqual(places, sorted(places))
                for one in figures["notFinite"]:
                    wanted = INVERSE if one["pixel"][0] == 7 else DIVISION
                    self.assertEqual(
                        (one["place"]["line"], one["place"]["file"]), (wanted, "shaders.rtsl")
                    )
                    self.assertEqual(one["color"][0], "nan" if wanted == INVERSE else "inf")
                self.assertRegex(
                    error,
                    rf"shaders\.rtsl:{DIVISION}:\d+: warning\[W2865\]: "
                    rf"{figures['samplesNotFinite']} of 512 samples "
                    "were infinite or not a number, and are left out of the means of their pixels; "
                    "4 pixels have no other samples and are black",
                )
                self.assertRegex(
                    error,
                    r"\n *[=|] *note: pixel \d,0 sample \d+ is infinite, since "
                    rf"shaders\.rtsl:{DIVISION}:",
                )
                self.assertIn(f"and {figures['samplesNotFinite'] - 8} more samples", error)

    def test_exceptions_say_all(self):
        self.scene()
        for way in ([], ["--target=host-megakernel"]):
            figures, error = self.render("--exceptions", *way)
            self.assertEqual(len(figures["notFinite"]), figures["samplesNotFinite"])
            self.assertEqual(len(re.findall(r"note: pixel", error)), figures["samplesNotFinite"])
            lines = {(one["pixel"][0] == 7, one["place"]["line"]) for one in figures["notFinite"]}
            self.assertEqual(lines, {(True, INVERSE), (False, DIVISION)})

    def test_the_warning_is_one_like_others(self):
        self.scene()
        out, error = self.run_rtslc(
            "render", "scene.json", "-o", "a.exr", "-q", "--diagnostics=json"
        )
        (message,) = json.loads(error)["diagnostics"]
        self.assertEqual(
            (message["code"], message["warning"], message["range"]["begin"]["line"]),
            ("W2865", "not-finite", DIVISION),
        )
        self.assertEqual(
            self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", "-Wno-not-finite"), ("", "")
        )
        self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q", "-Werror=not-finite", status=1)
        self.run_rtslc("compare", "a.exr", "b.exr")

    def line_of_bad_number(self, statements, *way):
        """The line in the body of `shade` that is named for all samples, counted from 0."""
        head = (
            "class Bad : rt_Material {\n  public float zero = 0.0, one = 1.0;\n  void shade() {\n"
        )
        text = SHADERS + head
        self.write("shaders.rtsl", text + "\n".join(statements) + "\n  }\n};\n")
        self.scene("Bad", spp=1)
        figures, _ = self.render("--size=2x2", *way)
        lines = {one.get("place", {"line": 0})["line"] for one in figures["notFinite"]}
        self.assertEqual((len(lines), figures["samplesNotFinite"]), (1, 4))
        return lines.pop() - text.count("\n") - 1

    def test_values_of_constants(self):
        """Folding and rounding hide no operation; the bad line has the index that is given."""
        in_single = (
            (0, ["float a = 1.0 / 0.0;", "rt_SampleColor = color(a * one);"]),
            (
                1,
                [
                    "mat3 m = mat3(0.0);",
                    "float d = 1.0 / determinant(m);",
                    "rt_SampleColor = color(d * zero + d);",
                ],
            ),
            (
                1,
                [
                    "const float large = 3e38;",
                    "float a = large * 2.0;",
                    "float b = a - 1.0;",
                    "rt_SampleColor = color(b);",
                ],
            ),
            (1, ["float a = 1e30 * one;", "float b = a * a;", "rt_SampleColor = color(b);"]),
            (
                2,
                [
                    "float a = 1.0;",
                    "for (int i = 0; i < 200; i++)",
                    "  a *= 10.0 + rand();",
                    "rt_SampleColor = color(a);",
                ],
            ),
        )
        for wanted, statements in in_single:
            with self.subTest(statements=statements):
                self.assertEqual(self.line_of_bad_number(statements), wanted)
        # In double the number is finite until it is stored.
        for wanted, statements in (
            (0, in_single[0][1]),
            (2, in_single[3][1]),
            (3, in_single[4][1]),
            (
                2,
                [
                    "float a = clamp(one / zero, 0.0, 1e38);",
                    "float b = a * 100.0;",
                    "rt_SampleColor = color(b);",
                ],
            ),
        ):
            with self.subTest(statements=statements):
                self.assertEqual(self.line_of_bad_number(statements, "--fp=double"), wanted)

    def test_a_line_that_passes_one_on_and_makes_others(self):
        """Its infinite number is later than the one that matters, but has no effect."""
        statements = (
            "float bad = zero / zero;",
            "float sum = 0.0;",
            "for (int i = 0; i < 2; ++i) {",
            "  float inverse = one / (i == 0 ? bad : zero);",
            "  sum += i == 0 ? inverse : min(inverse, 1.0);",
            "}",
            "rt_SampleColor = color(sum);",
        )
        for way in ((), ("--fp=double",)):
            self.assertEqual(self.line_of_bad_number(statements, *way), 0)

    def test_a_later_one_that_decides_where_rays_go(self):
        """It is rightly not a number; but with a number there the sample would be another one."""
        statements = (
            "float missed = 0.0, sum = 0.0;",
            "for (int i = 0; i < 2; ++i) {",
            "  float root = sqrt(-one);",
            "  missed += root == root ? 0.0 : 1.0;",
            "  if (i == 0 && missed > 0.5)",
            "    sum += one / zero;",
            "}",
            "rt_SampleColor = color(sum);",
        )
        self.assertEqual(self.line_of_bad_number(statements), 5)

    def test_two_causes(self):
        """No single line makes the sample finite: the first of them is named."""
        statements = (
            "float first = one / zero;",
            "float second = one / zero;",
            "rt_SampleColor = color(max(first, second));",
        )
        self.assertEqual(self.line_of_bad_number(statements), 0)

    def test_a_constant_and_a_payload(self):
        """What is computed from constants shows where that is; what a payload carries goes back to
        who made it."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Constant : rt_Material {
  void shade() {
    rt_SampleColor = color(1.0 / 0.0);
  }
};
class Light : rt_RayGeneration {
  void generate() {
    P p = P(color(0.0));
    trace(vec3(0.0), vec3(2.0 * rt_ScreenCoord - vec2(1.0), 1.0), 0.0, 1e30, p);
    rt_SampleColor = p.light;
  }
};
class Logarithm : rt_Material {
  public float zero = 0.0;
  void closestHit(inout P p) {
    float bad = log(zero);
    p.light = color(bad);
  }
};
""",
        )
        text = (self.folder / "shaders.rtsl").read_text().split("\n")
        self.scene("Constant")
        figures, _ = self.render()
        self.assertEqual(
            figures["notFinite"][0]["place"]["line"],
            1 + text.index("    rt_SampleColor = color(1.0 / 0.0);"),
        )
        self.scene("Logarithm")
        scene = json.loads((self.folder / "scene.json").read_text())
        del scene["camera"]
        scene["rayGeneration"] = {"class": "Light"}
        scene["render"]["engine"] = "programs"
        self.write("scene.json", json.dumps(scene))
        for way in WAYS:
            figures, _ = self.render(*way)
            self.assertEqual(
                figures["notFinite"][0]["place"]["line"],
                1 + text.index("    float bad = log(zero);"),
            )
            self.assertEqual(figures["notFinite"][0]["color"], ["-inf"] * 3)

    def test_good_pictures_say_nothing(self):
        self.scene("Mirror", depth=1)
        figures, error = self.render("-Wno-depth-limit", "-Wno-scene")
        self.assertEqual((figures["samplesNotFinite"], figures["notFinite"], error), (0, [], ""))


class TooDeep(ShaderCase):
    def test_they_are_counted_on_every_path(self):
        self.scene("Mirror", depth=3, spp=2)
        for way in WAYS:
            with self.subTest(way=way):
                figures, error = self.render(*way)
                self.assertEqual(figures["raysTooDeep"], 8 * 4 * 2, "the last ray of each sample")
                self.assertIn(
                    "warning[W2866]: 64 rays in 64 samples exceeded the depth limit 3 and "
                    "returned nothing: "
                    "give a larger `--depth`",
                    error,
                )
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
        out, error = self.run_package("x.rtslpkg", "--target=host", "-o", "b.exr", "--json", "-q")
        self.assertEqual(json.loads(out)["raysTooDeep"], 64)
        self.assertIn("64 rays in 64 samples exceeded the depth limit 3", error)

    def test_glass_at_its_default_depth(self):
        self.glass_scene()
        render = ("render", "scene.json", "-o", "a.png", "--size", "96x54", "--spp", "4", "--json")
        out, error = self.run_rtslc(*render)
        self.assertGreater(json.loads(out)["raysTooDeep"], 0)
        self.assertIn("[-Wdepth-limit]", error)
        self.assertEqual(self.run_rtslc(*render, "-Wno-depth-limit")[1], "")


if __name__ == "__main__":
    unittest.main()
