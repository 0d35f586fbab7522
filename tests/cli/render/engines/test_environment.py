"""Backgrounds as lights of the engine `path`: images of all directions, and an author's own."""

import json
import math
import struct
import unittest

from path_case import FLOOR, WAYS, PathCase

CLAY = {"class": "Own", "albedo": 0.5}
LAMP = (
    {"class": "Sphere", "center": [0, 3, 0], "radius": 0.5},
    {"class": "Emitter", "radiance": 4},
)

# A sky that is bright within a disk around the zenith, and knows how to find it.
SUN = """
import std.sampling;
class Sun : rt_Miss {
  public float oneMinusCosine = 0.01;
  public color radiance = color(20.0);

  bool isInDisk() { return 1.0 - normalize(rt_RayDirection).y <= oneMinusCosine; }

  void miss() { rt_SampleColor = isInDisk() ? radiance : color(0.1); }
  void sampleDirection() {
    vec3 d = sampleCone(vec2(rand(), rand()), oneMinusCosine);
    rt_RayDirection = 3.0 * vec3(d.x, d.z, -d.y); // of any length
    rt_SampleColor = radiance;
    rt_PDF = 0.15915494 / oneMinusCosine;
  }
  void directionPDF() { rt_PDF = isInDisk() ? 0.15915494 / oneMinusCosine : 0.0; }
};
"""


class EnvironmentCase(PathCase):
    def sky(self, width, height, values, filter="bilinear", wrap=("repeat", "clamp"), **members):
        """An EnvironmentMap; the values are those of texels, from the lower left one."""
        self.write("sky.raw", struct.pack(f"<{width * height}f", *values))
        return {
            "class": "EnvironmentMap",
            "image": {
                "raw": "sky.raw",
                "size": [width, height],
                "filter": filter,
                "wrap": list(wrap),
            },
            **members,
        }

    def lit_floor(self, background, camera="Down", spp=64, objects=(), material=None, **rest):
        self.scene(
            [(FLOOR, material or CLAY), *objects],
            camera=camera,
            spp=spp,
            background=background,
            **rest,
        )
        scene = (
            (self.folder / "scene.json")
            .read_text()
            .replace('"std.lights"', '"std.lights", "std.backgrounds"')
        )
        self.write("scene.json", scene)

    def without_search(self):
        """What the same scene gives if directions are found by the materials alone."""
        self.write_plain_tracer()
        scene = (self.folder / "scene.json").read_text()
        self.write(
            "scene.json",
            scene.replace('"import": [', '"import": ["PathTracer.rtsl", ')
            .replace('"engine": "path"', '"engine": "programs"')
            .replace(
                '"camera":', '"rayGeneration": {"class": "PathTracer", "bounces": 64}, "camera":'
            ),
        )
        return self.mean()


class Images(EnvironmentCase):
    def test_black_but_for_one_texel(self):
        """Of 16 x 8 texels one has 1e30: every sample finds it."""
        width, height, x, y = 16, 8, 5, 6
        values = [0.0] * (width * height)
        values[y * width + x] = 1e30
        low, high = (math.pi * (row / height - 0.5) for row in (y, y + 1))
        # The integral of the cosine to the floor's normal over the texel.
        of_texel = 2 * math.pi / width * (math.sin(high) ** 2 - math.sin(low) ** 2) / 2
        self.lit_floor(self.sky(width, height, values, filter="nearest"), depth=1)
        self.assert_gray(0.5 / math.pi * 1e30 * of_texel, 0.01)
        # Between neighbours its light is a tent over 2 x 2 texels, here by the midpoint rule.
        steps, sum = 400, 0.0
        for i in range(2 * steps):
            v = y - 0.5 + (i + 0.5) / steps
            latitude = math.pi * (v / height - 0.5)
            sum += (1 - abs(v - y - 0.5)) * math.sin(latitude) * math.cos(latitude) / steps
        expected = 0.5 / math.pi * 1e30 * sum * (math.pi / height) * (2 * math.pi / width)
        self.lit_floor(self.sky(width, height, values), depth=1, spp=256)
        self.assert_gray(expected, 0.01)

    def test_a_furnace(self):
        for material in (
            {"class": "Lambert", "reflectance": 1},
            {"class": "Conductor", "eta": 1, "k": 1e4, "alpha": 0},
        ):
            self.lit_floor(self.sky(8, 4, [1.0] * 32), material=material, spp=256)
            self.assert_gray(1.0, 0.01)

    def test_both_ways_find_the_same_light(self):
        """Smooth, glossy and diffuse surfaces and a lamp under a sky with strong contrast, rotated
        and in each wrap."""
        values = [
            0.2 + 5 * math.exp(-((i % 16 - 11) ** 2 + (i // 16 - 5) ** 2)) for i in range(16 * 8)
        ]
        for wrap, material in (
            (("repeat", "clamp"), {"class": "Conductor", "alpha": 0.2}),
            (("black", "black"), {"class": "Plastic"}),
            (("mirror", "mirror"), CLAY),
        ):
            with self.subTest(wrap=wrap, material=material):
                objects = [
                    LAMP,
                    (
                        {"class": "Sphere", "center": [0.6, 0.7, 0], "radius": 0.5},
                        {"class": "Plastic"},
                    ),
                ]
                sky = self.sky(16, 8, values, wrap=wrap, rotation=77.0, scale=[1.0, 0.5, 0.25])
                self.lit_floor(
                    sky, objects=objects, camera="Under", material=material, depth=4, spp=128
                )
                both = self.mean()
                self.lit_floor(
                    sky, objects=objects, camera="Under", material=material, depth=4, spp=1024
                )
                for one, other in zip(both, self.without_search()):
                    self.assertAlmostEqual(one, other, delta=0.015 * other)

    def test_it_finds_more_than_chance_does(self):
        """A small sun in an image: the error of a pixel falls by far."""
        values = [0.01] * (64 * 32)
        values[24 * 64 + 10] = 1000.0
        errors = []
        for search in (True, False):
            self.lit_floor(self.sky(64, 32, values, filter="nearest"), depth=1, spp=16)
            if not search:
                self.without_search()
            for seed in (1, 2):
                self.run_rtslc("render", "scene.json", "-o", f"{seed}.exr", "-q", "--seed", seed)
            out, _ = self.run_rtslc("compare", "1.exr", "2.exr", "--json", status=None)
            errors.append(json.loads(out)["rmse"])
        self.assertLess(errors[0], 0.1 * errors[1], errors)

    def test_a_black_image(self):
        self.lit_floor(self.sky(4, 2, [0.0] * 8), spp=4)
        self.assertEqual(self.mean(), [0, 0, 0])

    def test_radiance_below_0_counts_as_0(self):
        """It is seen by nobody, and reported once."""
        values = [float(i % 3) for i in range(32)]
        values[5] = values[27] = -2.0
        values[6] = -1e30
        for camera in ("Down", "Inside"):
            pictures = []
            for clamped in (False, True):
                sky = self.sky(
                    8, 4, [max(v, 0.0) if clamped else v for v in values], filter="nearest"
                )
                self.lit_floor(sky, camera=camera, spp=16)
                pictures.append(f"{clamped}.exr")
                _, messages = self.run_rtslc("render", "scene.json", "-o", pictures[-1], "-q")
                self.assertEqual(
                    messages.count(
                        "background: 3 texels of the image have colors below 0, the lowest -1e+30; "
                        "the first is at (3, 0) from the upper left corner"
                    ),
                    0 if clamped else 1,
                    messages,
                )
                self.assertEqual(messages.count("warning"), 0 if clamped else 1, messages)
            self.assert_same_bits(*pictures)

    def test_every_path_gives_the_same_bits(self):
        self.lit_floor(
            self.sky(4, 2, [0.1, 0.2, 0.3, 0.4, 5.0, 0.1, 0.1, 0.1]),
            objects=[LAMP],
            camera="Under",
            spp=4,
        )
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        for way in WAYS:
            self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q", *way)
            self.assert_same_bits("a.exr", "b.exr", way)

    def test_only_where_it_is_used(self):
        """The classic engine chooses no directions: nothing of it is in the program."""
        self.lit_floor(self.sky(4, 2, [1.0] * 8), material={"class": "Lambert"}, spp=1)
        for engine, isThere in (("path", True), ("classic", False)):
            out, _ = self.run_rtslc(
                "explain",
                "scene.json",
                "--no-savings",
                "--json",
                "--set",
                f"render.engine={engine}",
            )
            methods = {
                entry["subject"]: entry["needed"]
                for item in json.loads(out)["items"]
                if item["item"] == "methods"
                for entry in item["entries"]
            }
            self.assertEqual(methods["EnvironmentMap.sampleDirection"], isThere)


class OwnSkies(EnvironmentCase):
    def test_a_sun(self):
        """The irradiance of a disk around the zenith, and the sky's around it."""
        self.write("sun.rtsl", SUN)
        self.lit_floor({"class": "Sun"}, depth=1, spp=64)
        scene = (
            (self.folder / "scene.json")
            .read_text()
            .replace('"shaders.rtsl"', '"shaders.rtsl", "sun.rtsl"')
        )
        self.write("scene.json", scene)
        of_disk = math.pi * (1 - 0.99**2)
        self.assert_gray(0.5 / math.pi * (20 * of_disk + 0.1 * (math.pi - of_disk)), 0.005)


if __name__ == "__main__":
    unittest.main()
