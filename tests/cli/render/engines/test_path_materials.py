"""The engine `path`: materials that have some of the methods, and those that lean the normal."""

import json
import math
import statistics
import struct
import unittest

from exr_files import channels
from harness import deep
from path_case import BALL, FLOOR, WAYS, PathCase


CLAY = {"class": "Lambert", "reflectance": 0.5}
LEANING = (  # normals that are not those of the surface
    {
        "class": "NormalMap",
        "material": CLAY,
        "slopeU": {"class": "Solid", "value": 0.6},
        "slopeV": {"class": "Solid", "value": -0.3},
    },
    {
        "class": "BumpMap",
        "material": CLAY,
        "height": {"class": "Noise", "scale": 0.7},
        "scale": 0.3,
    },
)


class Methods(PathCase):
    """Materials that have some of the methods."""

    def test_numbers_of_textures_that_are_no_roughness(self):
        """They count as the nearest one, and tiny ones as 0: the picture has the same bits."""
        for name, number, nearest in (
            ("Conductor", 1e-20, 0),
            ("Dielectric", 1e30, 1),
            ("Plastic", -1, 0),
        ):
            means = []
            for value in (number, nearest, 0.3):
                pattern = {"class": "Solid", "value": value}
                self.scene(
                    [(BALL, {"class": name, "alpha": 1, "alphaMap": pattern})],
                    camera="Down",
                    spp=4,
                    size=(8, 8),
                    background={"class": "GradientSky"},
                    **{
                        "import": [
                            "std.materials",
                            "std.primitives",
                            "std.textures",
                            "std.backgrounds",
                            "shaders.rtsl",
                        ]
                    },
                )
                means.append(self.mean())
            self.assertEqual(means[0], means[1], name)
            self.assertNotEqual(means[0], means[2], name)

    def test_a_derived_class_may_add_evaluatePDF(self):
        pictures = []
        for name in ("Own", "Whole"):
            self.scene(
                [
                    (FLOOR, {"class": name}),
                    (
                        {"class": "Sphere", "center": [0, 3, 0], "radius": 0.5},
                        {"class": name, "glow": 1},
                    ),
                ],
                camera="Under",
                spp=4,
            )
            pictures.append(name + ".exr")
            self.run_rtslc("render", "scene.json", "-o", pictures[-1], "-q")
        self.assert_same_bits(*pictures)

    def test_only_shade(self):
        """Its color counts, and its own rays are answered by `shade`."""
        self.scene([(BALL, {"class": "Shaded"})], depth=5, spp=1)
        self.assert_gray(sum(0.25 * 0.5**i for i in range(6)), 1e-5, "-Wno-all")


class DirectionsOfTheEngine(PathCase):
    """Materials with `BSDF` and without `sampleBSDF`, for which the engine draws directions."""

    def assert_estimates(self, expected, *arguments):
        """Pixels are estimates of one number: their mean is within 4 of its standard errors, which
        are below 1 %."""
        self.run_rtslc(
            "render", "scene.json", "-o", "a.exr", "-q", "-Wno-sampling-method", *arguments
        )
        bits = channels((self.folder / "a.exr").read_bytes())["G"]
        values = struct.unpack(f"<{len(bits)}f", struct.pack(f"<{len(bits)}I", *bits))
        mean = statistics.fmean(values)
        error = statistics.stdev(values) / math.sqrt(len(values))
        self.assertLess(error, 0.01 * expected)
        self.assertLess(abs(mean - expected), 4 * error + 1e-6 * expected)

    def test_they_show_the_light_of_closed_forms(self):
        """Of a sky, of a square whose form factor is known, of one that only chance finds, and of a
        closed room; the mesh has normals that lean, of which by symmetry the light of a sky does
        not depend."""
        normals = "".join(f"vn {x} 1 {z}\n" for x in (-1, 1) for z in (-1, 1))
        corners = "v -9 0 -9\nv -9 0 9\nv 9 0 -9\nv 9 0 9\n"
        self.write("lean.obj", corners + normals + "f 1//1 2//2 3//3\nf 3//3 2//2 4//4\n")
        a = 1 / math.sqrt(2)
        factor = 4 / (2 * math.pi) * 2 * a * math.atan(a)
        square = {"class": "Parallelogram", "constructor": [[-1, 1, -1], [2, 0, 0], [0, 0, 2]]}
        lamp = (square, {"class": "Emitter", "radiance": 2, "isTwoSided": True})
        for name in ("Alone", "AloneOpaque"):
            floor = {"class": name}
            with self.subTest(material=name):
                self.scene([(FLOOR, floor)], camera="Down", background=1.0, spp=64)
                self.assert_estimates(0.5)
                self.scene([], camera="Down", background=1.0, spp=256)
                scene = json.loads((self.folder / "scene.json").read_text())
                scene["objects"] = [{"mesh": "lean.obj", "material": floor}]
                self.write("scene.json", json.dumps(scene))
                self.assert_estimates(0.5)
                self.scene([(FLOOR, floor), lamp], camera="Under", spp=256)
                self.assert_estimates(0.5 * 2 * factor)
                self.assert_estimates(0.5 * 2 * factor, "--engine=volume")
                self.scene([(BALL, {"class": name, "glow": 0.5})], camera="Inside", spp=64)
                self.assert_estimates(1.0)

    def test_every_path_gives_the_same_bits(self):
        lamp = {"class": "Sphere", "center": [0, 3, 0], "radius": 0.5}
        objects = [(FLOOR, {"class": "Alone"}), (lamp, {"class": "AloneOpaque", "glow": 1})]
        self.scene(objects, camera="Under", spp=4, depth=4)
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", "-Wno-sampling-method")
        for way in WAYS:
            with self.subTest(way=way):
                self.run_rtslc(
                    "render", "scene.json", "-o", "b.exr", "-q", "-Wno-sampling-method", *way
                )
                self.assert_same_bits("a.exr", "b.exr")

    def test_the_message_says_what_is_missing(self):
        names = (
            "Alone",
            "AloneOpaque",
            "Half",
            "Own",
            "Whole",
            "Mirror",
            "Blind",
            "Shines",
            "Shaded",
        )
        self.scene([(BALL, {"class": name}) for name in (*names, *names)], spp=1)
        for engine in ("path", "volume"):
            _, error = self.run_rtslc("check", "scene.json", f"--set=render.engine={engine}")
            drawn = f"the engine `{engine}` draws directions without knowledge of its `BSDF`"
            self.assertIn(f"`Alone` has no `sampleBSDF`: {drawn}", error)
            self.assertIn(f"`AloneOpaque` has no `sampleBSDF`: {drawn}", error)
            self.assertIn(f"`Half` has no `evaluatePDF`: the engine `{engine}` finds", error)
            self.assertEqual(error.count("warning["), 3, error)
            self.assertEqual(error.count("warning[W2703]"), 3, error)
            self.assertEqual(error.count("behind the surface"), 1, error)  # of Alone

    def test_the_class_that_decides_is_named(self):
        """Methods of classes that derive from it do not count, and are not run."""
        self.scene([(FLOOR, {"class": "AloneSampled"})], camera="Down", background=1.0, spp=64)
        self.assert_estimates(0.5)
        cases = (
            ("AloneSampled", "Alone", "sampleBSDF", "draws directions"),
            ("AloneTwice", "Alone", "sampleBSDF", "draws directions"),
            ("ShinesMore", "Shines", "BSDF", "shows only what it emits"),
            ("ShadedMore", "Shaded", "BSDF", "shows only the color that `shade` gives it"),
        )
        self.scene([(BALL, {"class": name}) for name, *_ in cases], spp=1)
        for engine in ("path", "volume"):
            _, error = self.run_rtslc("check", "scene.json", f"--set=render.engine={engine}")
            _, *warnings = error.split("warning[W2703]: ")
            self.assertEqual(len(warnings), len(cases), error)
            for said, (name, base, method, consequence) in zip(warnings, cases):
                missing = f"`{base}` has no `{method}`: the engine `{engine}` {consequence}"
                self.assertIn(missing, said)
                owner = "AloneSampled" if name == "AloneTwice" else name
                self.assertIn(f"that of `{owner}` does not count", said)
                self.assertNotIn("less noise", said)


class Normals(PathCase):
    def means_of_floor(self, material):
        """The mean colors of a lit floor by the engines `path` and `classic`."""
        lights = [
            {"class": "PointLight", "position": [2, 3, 1], "intensity": 9},
            {"class": "DistantLight", "direction": [-1, 1, 0.5]},
        ]
        self.scene([(FLOOR, material)], camera="Under", depth=1, lights=lights, spp=64)
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"].append("std.textures")
        self.write("scene.json", json.dumps(scene))
        return [self.mean(), self.mean("--set", "render.engine=classic")]

    def test_other_normals_as_in_the_classic_engine(self):
        """What lights send from a surface whose normal a texture leans, and through a cutout."""
        for material in (
            *LEANING,
            {"class": "OrenNayar", "reflectance": 0.5, "sigma": 0.5},
            {"class": "Ward"},
        ):
            with self.subTest(material=material):
                path, classic = self.means_of_floor(material)
                for one, other in zip(path, classic):
                    self.assertAlmostEqual(one, other, delta=2e-4 * other)

    @deep
    def test_a_normal_of_its_own_stays_in_other_materials(self):
        """Materials made of one with a leaning normal look as it does, alone or as a part; half of
        it is half of the way."""
        means = self.means_of_floor
        flat = means(CLAY)
        for leaning in LEANING:
            alone = means(leaning)
            if leaning["class"] == "NormalMap":  # all of it to one side
                self.assertGreater(abs(alone[0][0] - flat[0][0]), 0.01 * flat[0][0])
            half = [[0.5 * (a + b) for a, b in zip(*both)] for both in zip(alone, flat)]
            wrapped = (
                ({"class": "TwoSided", "front": leaning, "back": leaning}, alone),
                ({"class": "Cutout", "material": leaning}, alone),
                ({"class": "NormalMap", "material": leaning}, alone),
                ({"class": "MixMaterial", "amount": 0, "first": leaning, "second": CLAY}, alone),
                (
                    {"class": "MixMaterial", "amount": 0.3, "first": leaning, "second": leaning},
                    alone,
                ),
                (
                    {
                        "class": "MixMaterial",
                        "first": CLAY,
                        "second": {"class": "Cutout", "material": leaning},
                    },
                    half,
                ),
            )
            for material, expected in wrapped if leaning["class"] == "NormalMap" else wrapped[1:2]:
                with self.subTest(material=material):
                    for found, wanted in zip(means(material), expected):
                        for one, other in zip(found, wanted):
                            self.assertAlmostEqual(one, other, delta=2e-3 * other)


if __name__ == "__main__":
    unittest.main()
