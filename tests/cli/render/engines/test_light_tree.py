"""Many lamps: the light tree of `illuminate(P)`, next to the choice of lamps by their power."""

import json
import math
import os
import random
import subprocess
import unittest

from harness import SECONDS, deep
from path_case import FLOOR, WAYS, PathCase

RTSL_RUN = os.environ["RTSL_RUN"]
CLAY = {"class": "Own", "albedo": 0.5}


def lamps(count, seed=1, height=0.5):
    """Small balls above the floor, from dim to bright."""
    numbers = random.Random(seed)
    return [
        (
            {
                "class": "Sphere",
                "center": [numbers.uniform(-20, 20), height, numbers.uniform(-20, 20)],
                "radius": 0.05,
            },
            {"class": "Emitter", "radiance": 10 ** numbers.uniform(0, 2)},
        )
        for _ in range(count)
    ]


class LightTreeCase(PathCase):
    def sampled_by(self, sampler):
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["render"]["lightSampler"] = sampler
        self.write("scene.json", json.dumps(scene))

    def statistics(self, sampler, seeds=8):
        """The mean of pictures, that of red over all pixels, the standard error of it, and the
        standard deviation of a pixel."""
        self.sampled_by(sampler)
        pictures = []
        for seed in range(seeds):
            self.run_rtslc("render", "scene.json", "-o", "p.exr", "-q", self.level, "--seed", seed)
            out, _ = self.run_rtslc("compare", "p.exr", "p.exr", "--json")
            pictures.append(json.loads(out)["means"][0][0])
        mean = sum(pictures) / seeds
        variance = sum((one - mean) ** 2 for one in pictures) / (seeds - 1)
        return mean, math.sqrt(variance / seeds)

    def assert_agree(self, seeds=8):
        """Both samplers have the same mean, within the confidence interval."""
        by_power, error_by_power = self.statistics("power", seeds)
        by_tree, error_by_tree = self.statistics("tree", seeds)
        self.assertLess(
            abs(by_power - by_tree), 4 * math.hypot(error_by_power, error_by_tree) + 1e-4 * by_power
        )
        self.assertGreater(by_tree, 0)
        return error_by_power, error_by_tree


class Light(LightTreeCase):
    @deep
    def test_lamps_on_a_ceiling(self):
        """Far from most lamps a tree finds the near ones."""
        self.scene([(FLOOR, CLAY), *lamps(300)], camera="Under", depth=1, spp=64)
        by_power, by_tree = self.assert_agree()
        self.assertLess(by_tree, 0.5 * by_power)

    def test_one_lamp_in_the_tree(self):
        """A tree of a single leaf: the closed form of a ball, pi L (r / d)^2."""
        lamp = (
            {"class": "Sphere", "center": [0, 3, 0], "radius": 0.1},
            {"class": "Emitter", "radiance": 900},
        )
        self.scene([(FLOOR, {"class": "Own", "albedo": 1}), lamp], camera="Under", depth=1, spp=16)
        self.sampled_by("tree")
        self.assert_gray(900 * (0.1 / 3) ** 2, 0.02)

    @deep
    def test_squares_however_they_are_described(self):
        """Nine squares at height 1 of which one is above the point, by the form factor of each:
        primitives that are flat, a mesh, and nodes with transforms that shear and mirror; on one
        side and on both."""

        def factor(x0, x1, z0, z1, n=400):
            """Of a rectangle at height 1, at the point below the origin."""
            total = 0.0
            for i in range(n):
                x = x0 + (x1 - x0) * (i + 0.5) / n
                for j in range(n):
                    z = z0 + (z1 - z0) * (j + 0.5) / n
                    total += 1 / (1 + x * x + z * z) ** 2
            return total * (x1 - x0) * (z1 - z0) / (n * n) / math.pi

        places = [(3 * i - 1, 3 * j - 1) for i in (-1, 0, 1) for j in (-1, 0, 1)]
        expected = 2 * 0.5 * sum(factor(x, x + 2, z, z + 2) for x, z in places)
        self.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3\nf 1 3 4\n")
        square = {"class": "Parallelogram", "constructor": [[0, 0, 0], [2, 0, 0], [0, 0, 2]]}
        for two_sided in (True, False):
            lamp = {"class": "Emitter", "radiance": 2, "isTwoSided": two_sided}
            for name, node in (
                ("parallelogram", {"primitive": square}),
                ("mesh", {"mesh": "square.obj", "transform": {"scale": 2}}),
                (
                    "sheared",
                    {
                        "mesh": "square.obj",
                        "transform": {"matrix": [2, 0, 0, 0, 5, 3, 7, 0, 0, 0, 2, 0, 0, 0, 0, 1]},
                    },
                ),
                (
                    "mirrored",
                    {
                        "primitive": square,
                        "transform": {"matrix": [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 2, 0, 0, 1]},
                    },
                ),
            ):
                with self.subTest(name=name, two_sided=two_sided):
                    nodes = {
                        f"place{i}": {
                            "children": [{**node, "material": lamp}],
                            "transform": {"translate": [x, 1, z]},
                        }
                        for i, (x, z) in enumerate(places)
                    }
                    nodes["all"] = {"children": list(nodes)}
                    self.scene(
                        [(FLOOR, CLAY)], camera="Under", depth=1, spp=256, nodes=nodes, root="all"
                    )
                    self.sampled_by("tree")
                    found = self.mean()[0]
                    self.assertTrue(
                        abs(found - expected) < 0.01 * expected
                        or (not two_sided and found == 0),  # it shines upwards
                        (found, expected),
                    )
                    self.sampled_by("power")
                    self.assertAlmostEqual(self.mean()[0], found, delta=0.015 * expected)

    def test_mirrored_squares_shine_on_one_side(self):
        """One of the two ways to describe a square shines down."""
        bright = 0
        for sides in ([[2, 0, 0], [0, 0, 2]], [[0, 0, 2], [2, 0, 0]]):
            squares = [
                (
                    {"class": "Parallelogram", "constructor": [[4 * i - 1, 1, -1], *sides]},
                    {"class": "Emitter", "radiance": 2},
                )
                for i in range(-9, 10)
            ]
            self.scene([(FLOOR, CLAY), *squares], camera="Under", depth=1, spp=64)
            self.sampled_by("tree")
            bright += self.mean()[0] > 0
        self.assertEqual(bright, 1)

    @deep
    def test_objects_with_several_primitives_and_lamps_that_move(self):
        self.write(
            "many.rtsl",
            """
import std.sampling;
class Many : rt_Primitive {
  void constructor(int n) { count = n; }
  private int count;
  vec3 center() {
    return vec3(float(rt_PrimitiveIndex % 8) * 2.0 - 7.0, 0.5, float(rt_PrimitiveIndex / 8) * 2.0 - 7.0);
  }
  void computeBounds() { rt_BoundMin = center() - vec3(0.1); rt_BoundMax = center() + vec3(0.1); }
  void intersect() {
    vec3 f = rt_RayOrigin - center();
    float a = dot(rt_RayDirection, rt_RayDirection), b = dot(f, rt_RayDirection);
    float d = b * b - a * (dot(f, f) - 0.01);
    if (d >= 0.0) { hit((-b - sqrt(d)) / a); hit((-b + sqrt(d)) / a); }
  }
  void computeNormal() { rt_GeometricNormal = 10.0 * (rt_HitPoint - center()); }
  void generateSample() {
    rt_GeometricNormal = sampleSphere(vec2(rand(), rand()));
    rt_HitPoint = center() + 0.1 * rt_GeometricNormal;
    rt_PDF = 7.9577472;
  }
  void samplePDF() { rt_PDF = 7.9577472; }
};
""",
        )
        lamp = {"class": "Emitter", "radiance": 30}
        for name, transform in (
            ("rests", None),
            ("rotated", {"rotate": [0, 30, 0]}),
            (
                "moves",
                {"keys": [{"translate": [0, 0, 0]}, {"translate": [3, 0, 1]}]},
            ),
        ):
            with self.subTest(name=name):
                node = {"primitive": {"class": "Many", "constructor": [64]}, "count": 64}
                node["material"] = lamp
                if transform:
                    node["transform"] = transform
                self.scene(
                    [(FLOOR, CLAY), *lamps(5)],
                    camera="Under",
                    depth=1,
                    spp=64,
                    nodes={"many": node},
                    root="many",
                )
                scene = json.loads((self.folder / "scene.json").read_text())
                scene["import"].append("many.rtsl")
                self.write("scene.json", json.dumps(scene))
                by_power, by_tree = self.assert_agree()
                if name != "moves":
                    self.assertLess(by_tree, by_power)

    @deep
    def test_far_from_the_origin(self):
        """At 1e7, where a step of a float is 1."""
        far = 1e7
        floor = {
            "class": "Parallelogram",
            "constructor": [[far - 1e4, 0, far - 1e4], [0, 0, 2e4], [2e4, 0, 0]],
        }
        self.write(
            "far.rtsl",
            """
class Far : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(1e7, 400.0, 1e7);
    rt_RayDirection = vec3(0.1 * rt_ScreenCoord.x - 0.05, -1.0, 0.1 * rt_ScreenCoord.y - 0.05);
  }
};
""",
        )
        numbers = random.Random(3)
        balls = [
            (
                {
                    "class": "Sphere",
                    "center": [
                        far + numbers.uniform(-5000, 5000),
                        300,
                        far + numbers.uniform(-5000, 5000),
                    ],
                    "radius": 40,
                },
                {"class": "Emitter", "radiance": 100},
            )
            for _ in range(100)
        ]
        self.scene([(floor, CLAY), *balls], camera="Far", depth=1, spp=64)
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"].append("far.rtsl")
        self.write("scene.json", json.dumps(scene))
        self.assert_agree()

    def test_lamps_in_the_same_place_and_dark_ones(self):
        """Of lamps in the same place the first is hit; those that do not shine are no lamps."""
        ball = {"class": "Sphere", "center": [0, 3, 0], "radius": 0.1}
        here = [(ball, {"class": "Emitter", "radiance": 9}) for _ in range(10)]
        dark = [
            (
                {"class": "Sphere", "center": [x, 1, 2], "radius": 0.1},
                {"class": "Emitter", "radiance": 0},
            )
            for x in range(20)
        ]
        floor = (FLOOR, {"class": "Own", "albedo": 1})
        self.scene([floor, *here, *dark], camera="Under", depth=1, spp=1024)
        self.sampled_by("tree")
        self.assert_gray(9 * (0.1 / 3) ** 2, 0.03)

    def test_lamps_without_an_area(self):
        """Triangles that are lines or points, and a ball without a radius, are never chosen; the
        light of the others is what it is without them."""
        good = "v -1 1 -1\nv 1 1 -1\nv 1 1 1\nv -1 1 1\nf 1 2 3\nf 1 3 4\n"
        bad = good + "f 1 1 2\nf 3 3 3\nf 1 2 1\n" + "f 2 2 2\n" * 10
        lamp = {"class": "Emitter", "radiance": 2, "isTwoSided": True}
        point = ({"class": "Sphere", "center": [0, 2, 0], "radius": 0}, lamp)
        for sampler in ("power", "tree"):
            means = []
            for text, more in ((good, []), (bad, [point])):
                self.write("lamp.obj", text)
                self.scene(
                    [(FLOOR, CLAY), *more],
                    camera="Under",
                    depth=1,
                    spp=256,
                    nodes={"lamp": {"mesh": "lamp.obj", "material": lamp}},
                    root="lamp",
                )
                self.sampled_by(sampler)
                _, messages = self.run_rtslc("render", "scene.json", "-o", "z.exr", "-q")
                self.assertNotIn("not a number", messages)
                means.append(self.mean()[0])
            self.assertAlmostEqual(means[0], means[1], delta=0.01 * means[0])

    def test_both_ways_find_the_same_light(self):
        """What materials find by chance is weighed against what the tree finds, at smooth and rough
        surfaces, for a whole path."""
        self.scene(
            [
                (FLOOR, CLAY),
                (
                    {"class": "Sphere", "center": [0.6, 0.4, 0.6], "radius": 0.4},
                    {"class": "Conductor", "alpha": 0.3},
                ),
                *lamps(60, height=0.8),
            ],
            camera="Under",
            depth=3,
            spp=64,
        )
        self.assert_agree()


class Programs(LightTreeCase):
    def test_every_path_gives_the_same_bits(self):
        self.scene(
            [(FLOOR, {"class": "Lambert"}), *lamps(100)],
            camera="Under",
            background=[0.1, 0.1, 0.1],
            spp=4,
            depth=2,
        )
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        for way in WAYS:
            self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q", *way)
            self.assert_same_bits("a.exr", "b.exr", way)
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
        done = subprocess.run(
            [RTSL_RUN, "x.rtslpkg", "--target=host", "-o", "b.exr", "--compare", "a.exr"],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=SECONDS,
        )
        self.assertEqual(done.returncode, 0, done.stdout)

    def needs_tree(self):
        out, _ = self.run_rtslc("explain", "scene.json", "--no-savings", "--json")
        for item in json.loads(out)["items"]:
            if item["item"] == "lights":
                for entry in item["entries"]:
                    if entry["subject"] == "light tree":
                        return entry["needed"]
        self.fail("no entry")

    @deep
    def test_only_where_there_are_many_lamps(self):
        for count, sampler, needed in (
            (3, None, False),
            (3, "tree", True),
            (100, None, True),
            (100, "auto", True),
            (100, "power", False),
        ):
            self.scene([(FLOOR, CLAY), *lamps(count)], camera="Under", spp=1, depth=1)
            if sampler:
                self.sampled_by(sampler)
            self.assertEqual(self.needs_tree(), needed, (count, sampler))
        self.scene([(FLOOR, CLAY)], camera="Under", spp=1, depth=1)
        self.sampled_by("tree")
        self.assertFalse(self.needs_tree())

    def test_the_scene_with_few_lamps_is_the_same_with_the_code_of_a_tree(self):
        self.scene([(FLOOR, CLAY), *lamps(3)], camera="Under", spp=4, depth=1)
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q", "--keep=lights")
        self.assert_same_bits("a.exr", "b.exr")

    def test_an_unknown_sampler(self):
        self.scene([(FLOOR, CLAY)])
        self.sampled_by("random")
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "a.exr"),
            "E0805",
            "`lightSampler` is `auto`, `power`, `tree`, not `random`",
        )
        self.sampled_by(3)
        self.diagnose("render", "scene.json", "-o", "a.exr")


if __name__ == "__main__":
    unittest.main()
