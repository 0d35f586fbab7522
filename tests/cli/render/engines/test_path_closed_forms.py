"""The engine `path`: scenes of one material whose light is known."""

import unittest

from path_case import BALL, FLOOR, PathCase


class ClosedForms(PathCase):
    def test_a_surface_that_shines(self):
        self.scene([(BALL, {"class": "Shines"})], spp=1)
        self.assert_gray(0.75, 1e-6)

    def test_an_oven(self):
        """In a closed surface of albedo a that sends out e, the radiance is e / (1 - a)
        everywhere."""
        for albedo in (0.3, 0.8):
            self.scene(
                [(BALL, {"class": "Own", "albedo": albedo, "glow": 0.5})], depth=200, spp=256
            )
            self.assert_gray(0.5 / (1 - albedo), 0.02)

    def test_bounces_end(self):
        """After n rays only the first n + 1 terms of the series are there."""
        for bounces in (0, 1, 2):
            self.scene([(BALL, {"class": "Own", "albedo": 0.5, "glow": 1})], depth=bounces, spp=4)
            self.assert_gray(sum(0.5**i for i in range(bounces + 1)), 1e-5)

    def test_a_furnace(self):
        """A floor that reflects all light, below a sky of 1."""
        for material in (
            {"class": "Mirror"},
            {"class": "Own", "albedo": 1},
            {"class": "Lambert", "reflectance": 1},
            {"class": "OrenNayar", "reflectance": 1, "sigma": 0},
            {"class": "Conductor", "eta": 1, "k": 1e4, "alpha": 0},
        ):
            with self.subTest(material=material):
                self.scene([(FLOOR, material)], camera="Down", background=1.0)
                self.assert_gray(1.0, 0.002)

    def test_materials_that_lose_nothing(self):
        """A ball of them cannot be told from a sky of 1; those of metal and lacquer lose some
        light, and gain none."""
        white = {"class": "Lambert", "reflectance": 1}
        mirror = {"class": "Conductor", "eta": 1, "k": 1e4, "alpha": 0}
        lossless = [
            {"class": "Dielectric"},
            {"class": "ThinGlass"},
            {"class": "Cutout", "material": white, "opacity": 0.4},
            {"class": "Cutout", "material": mirror, "opacity": 0.7},
            {"class": "MixMaterial", "first": white, "second": mirror},
            {
                "class": "MixMaterial",
                "first": {"class": "Dielectric"},
                "second": white,
                "amount": 0.3,
            },
            {"class": "TwoSided", "front": white, "back": mirror},
        ]
        lossy = [
            {"class": "Gold", "alpha": 0.3},
            {"class": "Conductor", "eta": 1, "k": 1e4, "alpha": 0.5},
            {"class": "Plastic", "reflectance": 1},
            {"class": "Velvet"},
            {"class": "Ward"},
            {"class": "Principled", "baseColor": 1},
            {"class": "Principled", "baseColor": 1, "specularColor": [5, 0.5, 100]},
            {"class": "Principled", "baseColor": 1, "specularColor": 25, "transmission": 0.5},
            {"class": "OrenNayar", "reflectance": 1},
        ]
        for material in lossless + lossy:
            with self.subTest(material=material):
                self.scene(
                    [({"class": "Sphere", "center": [0.1, 0.2, 5.3], "radius": 2}, material)],
                    background=1.0,
                    depth=200,
                    spp=64,
                )
                if material in lossless:
                    self.assert_gray(1.0, 0.005)
                else:
                    for component in self.mean():
                        self.assertTrue(0.6 < component < 1.01, component)

    def test_colors_of_what_is_reflected_straight_on(self):
        """By a surface of index 1.5, which reflects 0.04 there without a color."""
        material = {
            "class": "Principled",
            "baseColor": 0,
            "roughness": 0.1,
            "specular": 0.5,
            "specularColor": [2, 0.5, 50],
        }
        image = {"class": "Solid", "value": [1, 1, 0.25]}
        for maps, blue in (({}, 1), ({"specularColorMap": image}, 0.5)):
            self.scene(
                [(FLOOR, {**material, **maps})],
                camera="Down",
                background=1.0,
                spp=16,
                **{"import": ["std", "shaders.rtsl"]},
            )
            for component, expected in zip(self.mean(), (0.04, 0.01, 0.5 * blue)):
                self.assertAlmostEqual(component, expected, delta=0.03 * expected)


if __name__ == "__main__":
    unittest.main()
