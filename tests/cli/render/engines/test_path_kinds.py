"""Limits of the engine `path` for each kind of scattering: diffuse, glossy, transmission."""

import unittest

from path_case import BALL, FLOOR, WAYS, PathCase

LAMP = (
    {"class": "Sphere", "center": [0, 3, 0], "radius": 0.5},
    {"class": "Emitter", "radiance": 4},
)


class Kinds(PathCase):
    def limited(self, objects, spp=64, depth=20, lights=(), **limits):
        self.scene(
            objects,
            camera="Under",
            spp=spp,
            depth=depth,
            background=[0.25] * 3,
            lights=lights,
            rayGeneration={"class": "PathTracer", "bounces": depth, **limits},
        )

    def test_diffuse_reflections_are_counted(self):
        """In an oven each reflection adds a term, as with a limit for all of them."""
        for most in (0, 1, 3):
            self.scene(
                [(BALL, {"class": "Own", "albedo": 0.5, "glow": 1})],
                depth=20,
                spp=16,
                rayGeneration={"class": "PathTracer", "bounces": 20, "diffuse": most},
            )
            self.assert_gray(sum(0.5**i for i in range(most + 1)), 1e-5)

    def test_light_that_is_searched_for_counts_too(self):
        """Without diffuse reflections a floor is black; one more, and it is lit by the lamp alone,
        however its light is found."""
        lights = [{"class": "PointLight", "position": [0, 3, 0], "intensity": 9}]
        for objects, given in (([LAMP], []), ([], lights)):
            floor = (FLOOR, {"class": "Own", "albedo": 0.5})
            self.limited([floor, *objects], diffuse=0, lights=given)
            self.assertEqual(self.mean(), [0, 0, 0])
            self.limited([floor, *objects], diffuse=1, lights=given, spp=256)
            one = self.mean()[0]
            self.limited([floor, *objects], depth=1, lights=given, spp=256)
            self.assertAlmostEqual(self.mean()[0], one, delta=0.02 * one)

    def test_mirrors_and_highlights_are_glossy(self):
        for material in (
            {"class": "Mirror"},
            {"class": "Conductor", "eta": 1, "k": 1e4, "alpha": 0.01},
        ):
            with self.subTest(material=material):
                self.limited([(FLOOR, material)], glossy=0)
                self.assertLess(self.mean()[0], 0.0075)  # the tails of a highlight are not counted
                self.limited([(FLOOR, material)], diffuse=0, transmission=0)
                self.assert_gray(0.25, 0.03)

    def test_transmission(self):
        """Through a pane; what it reflects is glossy."""
        pane = (
            {"class": "Parallelogram", "constructor": [[-9, 0.2, -9], [0, 0, 18], [18, 0, 0]]},
            {"class": "ThinGlass"},
        )
        shining = (FLOOR, {"class": "Emitter", "radiance": 1, "isTwoSided": True})
        self.limited([pane, shining], spp=256)
        both = self.mean()[0]
        self.limited([pane, shining], spp=256, transmission=0)
        reflected = self.mean()[0]
        self.limited([pane, shining], spp=256, glossy=0)
        passed = self.mean()[0]
        self.assertTrue(0.01 < reflected < 0.04 and 0.85 < passed < 0.97, (reflected, passed))
        self.assertAlmostEqual(both, reflected + passed, delta=0.02)

    def test_both_ways_to_find_light_agree(self):
        """A glossy surface: the share of a lamp that is searched for and that of one that is met by
        chance are cut alike."""
        pictures = []
        for most in (0, 1):
            self.limited([(FLOOR, {"class": "Plastic"}), LAMP], depth=1, spp=256, diffuse=most)
            pictures.append(self.mean()[0])
        self.assertLess(pictures[0], pictures[1])
        self.limited([(FLOOR, {"class": "Plastic"}), LAMP], depth=1, spp=256)
        self.assertAlmostEqual(self.mean()[0], pictures[1], delta=0.01 * pictures[1])

    def test_limits_that_are_not_reached_change_nothing(self):
        objects = [(FLOOR, {"class": "Plastic"}), (BALL, {"class": "Dielectric"}), LAMP]
        self.limited(objects, spp=4, depth=9)
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        self.limited(objects, spp=4, depth=9, diffuse=9, glossy=10, transmission=11)
        self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q")
        self.assert_same_bits("a.exr", "b.exr")
        self.limited(objects, spp=4, depth=9, diffuse=1, glossy=2, transmission=2)
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        for way in WAYS:
            self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q", *way)
            self.assert_same_bits("a.exr", "b.exr", way)


if __name__ == "__main__":
    unittest.main()
