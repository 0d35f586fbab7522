"""The library's primitives in scenes of any size: each size gives the picture of size 1, and what
is too large for floats is named."""

import json
import unittest

from exr_files import channels
from harness import Case

LAMBERT = {"class": "Lambert"}


def made(name, *arguments):
    return {"class": name, "constructor": list(arguments)}


def primitives(s):
    """Of size s, around the origin."""
    return [
        made("Disk", [0, 0, 0], [0, 0.4, 1], s, 0.5 * s),
        made("Torus", [0, 0, 0], [0, 1, 0.2], 0.8 * s, 0.3 * s),
        made("Cone", [-s, 0, 0], [s, 0.3 * s, 0], 0.4 * s, 0),
        made("Cylinder", [-s, 0, 0], [s, 0.3 * s, 0], 0.4 * s),
        made("Capsule", [-s, 0, 0], [s, 0.3 * s, 0], 0.4 * s),
        made("Parallelogram", [-s, -s, 0], [2 * s, 0, 0.3 * s], [0, 2 * s, 0.1 * s]),
        {
            "class": "HeightField",
            "low": [-s, -s, -s],
            "high": [s, s, s],
            "heights": [[0, 1], [1, 0]],
        },
        {
            "class": "Curve",
            "points": [
                [-s, 0, 0, 0.2 * s],
                [0, s, 0, 0.3 * s],
                [s, 0, 0, 0.1 * s],
                [s, -s, 0, 0.1 * s],
            ],
        },
        {"class": "Sphere", "center": [0, 0, 0], "radius": s},
        {"class": "Box", "low": [-s, -s, -s], "high": [s, s, s]},
        {
            "class": "Quadric",
            "coefficients": [1 / s**2, 0.5 / s**2, 0.7 / s**2],
            "level": 1,
            "extent": [s, s, s],
        },
    ]


class Sizes(Case):
    def render(self, s, shapes, *options):
        """The primitives side by side, 3 apart."""
        objects = [
            {
                "primitive": shape,
                "material": LAMBERT,
                "transform": {"translate": [3 * s * (i % 4 - 1.5), 3 * s * (i // 4 - 1), 0]},
            }
            for i, shape in enumerate(shapes)
        ]
        scene = {
            "rtsl": 1,
            "import": ["std"],
            "camera": {
                **made("PerspectiveCamera", [4 * s, 3 * s, 15 * s], [0, 0, 0], [0, 1, 0]),
                "fieldOfView": 44,
            },
            "objects": objects,
            "lights": [{"class": "DistantLight", "direction": [1, 2, 3]}],
            "render": {"size": [96, 72], "spp": 1},
        }
        picture, error = self.render_scene(scene, "-q", *options)
        return picture, error

    def assert_alike(self, first, second):
        said, _ = self.run_rtslc("compare", first, second, "--json", status=None)
        self.assertLess(json.loads(said)["rmse"], 1e-5)

    def test_all_sizes_give_the_same_picture(self):
        ordinary, _ = self.render(1, primitives(1))
        for size in (1e-16, 1e-9, 1e-5, 1e5, 1e9, 1e16):
            with self.subTest(size):
                picture, error = self.render(size, primitives(size))
                self.assertEqual(error, "")
                self.assert_alike(ordinary, picture)

    def test_what_reaches_too_far_is_named(self):
        box = {"class": "Box", "low": [-1e19] * 3, "high": [1e19] * 3}  # compares coordinates alone
        _, error = self.render(1, [{"class": "Sphere", "center": [0, 0, 0], "radius": 1e18}, box])
        self.assertEqual(error.count("warning["), 1, error)
        self.assertIn(
            "primitive `Sphere (objects.0)` reaches 1e+18 from the origin: beyond 1e+17", error
        )

    def test_forms_times_any_number_are_the_same_quadric(self):
        def scaled(k):
            return {"class": "Quadric", "coefficients": [k, 0.5 * k, 0.7 * k], "level": 0.8 * k}

        ordinary, _ = self.render(1, [scaled(1)])
        for factor in (1e-37, 1e-25, 1e-18, 1e-14, 1e14, 1e18, 1e38):
            with self.subTest(factor):
                picture, error = self.render(1, [scaled(factor)])
                self.assertEqual(error, "")
                self.assert_alike(ordinary, picture)

    def test_a_height_field_without_height_is_a_rectangle(self):
        flat = {
            "class": "HeightField",
            "low": [-1, 0.3, -1],
            "high": [1, 0.3, 1],
            "heights": [[0, 1], [1, 0]],
        }
        field, error = self.render(1, [flat])
        self.assertEqual(error, "")
        rectangle, _ = self.render(1, [made("Parallelogram", [-1, 0.3, 1], [2, 0, 0], [0, 0, -2])])
        self.assert_alike(rectangle, field)
        self.assertGreater(sum(word != 0 for word in channels(field.read_bytes())["R"]), 20)


if __name__ == "__main__":
    unittest.main()
