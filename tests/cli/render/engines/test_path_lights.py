"""The engine `path`: how it finds lights, lamps and the sky. The light of most scenes is known."""

import json
import math
import pathlib
import statistics
import struct
import unittest

from exr_files import channels
from path_case import FLOOR, PathCase


class Lights(PathCase):
    def test_a_point_light(self):
        """Irradiance intensity * pi / h^2 on a floor below it, by the convention of LightColor."""
        self.scene(
            [(FLOOR, {"class": "Own", "albedo": 0.5})],
            camera="Down",
            lights=[{"class": "PointLight", "position": [0, 3, 0], "intensity": 9}],
        )
        self.assert_gray(0.5, 0.002)

    def test_a_square_light_however_it_is_found(self):
        """The form factor of a square of side 2 at height 1, seen from below its middle."""
        a = 1 / math.sqrt(2)
        factor = 4 / (2 * math.pi) * 2 * a * math.atan(a)
        corner, side1, side2 = [-1, 1, -1], [2, 0, 0], [0, 0, 2]
        vertices = [corner, [1, 1, -1], [1, 1, 1], [-1, 1, 1], [0.5, 1, -0.5]]
        triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]]  # of different sizes
        for light in (
            {"class": "RectangleLight", "corner": corner, "side1": side1, "side2": side2},
            {"class": "MeshLight", "vertices": vertices, "triangles": triangles},
            {"class": "MeshLight", "vertices": [vertices[i] for three in triangles for i in three]},
        ):
            with self.subTest(light=light):
                self.scene(
                    [(FLOOR, {"class": "Own", "albedo": 0.5})],
                    camera="Down",
                    spp=256,
                    lights=[{**light, "radiance": 2, "isTwoSided": True}],
                )
                self.assert_gray(0.5 * 2 * factor, 0.01)
        lamp = {"class": "Emitter", "radiance": 2, "isTwoSided": True}
        square = {"class": "Parallelogram", "constructor": [corner, side1, side2]}
        self.scene(
            [(FLOOR, {"class": "Own", "albedo": 0.5}), (square, lamp)], camera="Under", spp=256
        )
        self.assert_gray(0.5 * 2 * factor, 0.01)
        self.scene([(FLOOR, {"class": "Blind"}), (square, lamp)], camera="Under", spp=1024)
        self.assert_gray(0.5 * 2 * factor, 0.01)
        # As a mesh of two triangles of another size, and as a node with a transform that shears and
        # mirrors.
        self.write("square.obj", "v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3\nf 1 3 4\n")
        for transform in (
            {"scale": 2, "translate": corner},
            {"matrix": [-2, 0, 0, 0, 5, 3, 7, 0, 0, 0, 2, 0, 1, 1, -1, 1]},
        ):
            for geometry in (
                {"mesh": "square.obj"},
                {
                    "primitive": {
                        "class": "Parallelogram",
                        "constructor": [[0, 0, 0], [0, 0, 1], [1, 0, 0]],
                    }
                },
            ):
                with self.subTest(transform=transform, geometry=geometry):
                    self.scene(
                        [(FLOOR, {"class": "Own", "albedo": 0.5})],
                        camera="Under",
                        spp=256,
                        nodes={"lamp": {**geometry, "material": lamp, "transform": transform}},
                        root="lamp",
                    )
                    self.assert_gray(0.5 * 2 * factor, 0.01)

    def test_a_light_in_a_node_shines_where_a_lamp_in_its_place_does(self):
        """Also where the transform mirrors: on the floor, or on neither side of it."""
        corner, side1, side2 = [-1, 0, -1], [2, 0, 0], [0, 0, 2]
        square = {"class": "Parallelogram", "constructor": [corner, side1, side2]}
        light = {"class": "RectangleLight", "corner": corner, "side1": side1, "side2": side2}
        kinds = (
            {"light": light},
            {"primitive": square, "material": {"class": "Emitter"}},
        )
        for scale, isLit in (
            ([1, 1, 1], True),
            ([-1, 1, 1], True),
            ([1, -1, 1], False),
            ([-1, -1, 1], False),
        ):
            means = []
            for kind in kinds:
                self.scene(
                    [(FLOOR, {"class": "Own", "albedo": 0.5})],
                    camera="Under",
                    nodes={"lamp": {**kind, "transform": {"scale": scale, "translate": [0, 1, 0]}}},
                    root="lamp",
                )
                means.append(self.mean()[0])
            with self.subTest(scale=scale):
                self.assertEqual(means[1] > 0, isLit)
                self.assertAlmostEqual(*means, delta=0.02 * means[1])

    def test_lights_without_an_area_or_a_direction_send_out_nothing(self):
        """And each is named, with what is wrong; those that have both are not."""
        lines = [[0, 1, 0], [1, 1, 0], [3, 1, 0]]
        flat = [
            ("it has no triangles", {"class": "MeshLight"}),
            ("all of its triangles are lines or points", {"class": "MeshLight", "vertices": lines}),
            (
                "all of its triangles are lines or points",
                {"class": "MeshLight", "vertices": lines, "triangles": [[0, 1, 2], [1, 1, 2]]},
            ),
            (
                "its sides are parallel",
                {"class": "RectangleLight", "side1": [0.1, 0.3, 0.7], "side2": [0.3, 0.9, 2.1]},
            ),
            ("one of its sides is 0", {"class": "RectangleLight", "side1": [0, 0, 0]}),
            ("its radius is 0", {"class": "DiskLight", "radius": 0}),
            ("its radius is 0", {"class": "SphereLight", "radius": 0}),
        ]
        dark = [
            *((f"it has no area: {why}", light) for why, light in flat),
            ("its `normal` is 0", {"class": "DiskLight", "normal": [0, 0, 0]}),
            ("its `direction` is 0", {"class": "DistantLight", "direction": [0, 0, 0]}),
            ("its `direction` is 0", {"class": "SpotLight", "direction": [0, 0, 0]}),
            ("its `angle` is 0", {"class": "SpotLight", "angle": 0}),
            ("its `toSun` is 0", {"class": "SunLight", "toSun": [0, 0, 0]}),
        ]
        lit = [
            {"class": "DistantLight", "direction": [0, 1e-30, 0]},
            {"class": "SpotLight"},
            {"class": "SunLight"},
            {"class": "RectangleLight"},
            {"class": "DiskLight"},
            {"class": "SphereLight"},
            {"class": "MeshLight", "vertices": [*lines[:2], [0, 0, 1]]},
            {"class": "PointLight"},
        ]
        place = {"center": [0, 3, 0], "corner": [0, 3, 0], "position": [0, 3, 0]}
        self.scene(
            [(FLOOR, {"class": "Own", "albedo": 0.5})],
            camera="Down",
            spp=1,
            lights=[light for _, light in dark],
            background=0.25,
            variables=place,
        )
        self.assert_gray(0.5 * 0.25, 1e-6)
        lights = [*(light for _, light in dark), *lit]
        self.scene([], lights=lights, spp=1, variables=place)
        text = (self.folder / "scene.json").read_text()
        for command in (["check"], ["render", "-o", "a.exr", "-q"]):
            _, error = self.run_rtslc(*command, "scene.json", "--diagnostics=json")
            found = [d for d in json.loads(error)["diagnostics"] if d["code"] == "W2800"]
            self.assertEqual(
                [d["message"] for d in found],
                [
                    f"the light `{light['class']} (lights.{i})` sends out nothing: {why}"
                    for i, (why, light) in enumerate(dark)
                ],
            )
            for diagnostic, (_, light) in zip(found, dark):
                begin, end = (diagnostic["range"][at]["offset"] for at in ("begin", "end"))
                self.assertEqual(text[begin:end], light["class"])

    def test_many_lights(self):
        """Of more than four lights four are chosen; the mean is that of all."""
        lights = [
            {"class": "PointLight", "position": [0, 1 + i, 0], "intensity": (1 + i) ** 2}
            for i in range(10)
        ]
        self.scene(
            [(FLOOR, {"class": "Own", "albedo": 1})], camera="Down", lights=lights, depth=1, spp=256
        )
        self.assert_gray(10.0, 0.01)


class Skies(PathCase):
    def test_the_sky_however_it_is_found(self):
        """As a light, and as the background that the floor's own directions meet."""
        sky = {"toSun": [0.4, 0.5, 0], "turbidity": 4, "scale": 0.2}
        floor = [(FLOOR, {"class": "Own", "albedo": 0.5})]
        self.scene(floor, camera="Down", spp=256, lights=[{"class": "SkyLight", **sky}])
        found = self.mean()
        self.write("sky.rtsl", "import std.backgrounds;\nclass Sky : DaylightSky {};\n")
        scene = json.loads(pathlib.Path(self.folder, "scene.json").read_text())
        scene["import"].append("std.backgrounds")
        del scene["lights"]
        scene["background"] = {"class": "DaylightSky", **sky}
        self.write("scene.json", json.dumps(scene))
        for one, other in zip(found, self.mean()):
            self.assertAlmostEqual(one, other, delta=0.02 * other)

    def test_the_sun_fades_as_its_way_through_the_air_gets_longer(self):
        """By Beer's law, and blue fades most."""

        def lit(angle):
            """The optical mass (Kasten 1965), and the logarithms of the sun's light there."""
            cosine = math.cos(math.radians(angle))
            sun = {"class": "SunLight", "toSun": [math.sin(math.radians(angle)), cosine, 0]}
            floor = [(FLOOR, {"class": "Own", "albedo": 1})]
            self.scene(floor, camera="Down", spp=1, lights=[{**sun, "angle": 0}])
            mass = 1 / (cosine + 0.15 * (93.885 - angle) ** -1.253)
            return mass, [math.log(c / cosine) for c in self.mean()]

        (mass0, light0), (mass1, light1), (mass2, light2) = lit(0), lit(60), lit(80)
        slopes = [(b - a) / (mass1 - mass0) for a, b in zip(light0, light1)]
        for slope, a, b in zip(slopes, light1, light2):
            self.assertAlmostEqual((b - a) / (mass2 - mass1), slope, delta=1e-3 * abs(slope))
        self.assertLess(slopes[2], slopes[1])
        self.assertLess(slopes[1], slopes[0])
        self.assertLess(slopes[0], 0)


class Lamps(PathCase):
    """Surfaces that shine, to which the engine sends rays and which its paths meet."""

    def test_a_lamp_among_many(self):
        """Lamps are chosen by their power: of a thousand only the bright one matters, and it is
        found."""
        dim = [
            (
                {"class": "Sphere", "center": [x, 40, z], "radius": 0.01},
                {"class": "Emitter", "radiance": 1e-4},
            )
            for x in range(-16, 16)
            for z in range(-16, 16)
        ]
        bright = (
            {"class": "Sphere", "center": [0, 3, 0], "radius": 0.1},
            {"class": "Emitter", "radiance": 900},
        )
        self.scene(
            [(FLOOR, {"class": "Own", "albedo": 1}), bright, *dim], camera="Under", depth=1, spp=16
        )
        # The irradiance of a ball of radius r at distance d: pi L (r / d)^2.
        self.assert_gray(900 * (0.1 / 3) ** 2, 0.02)

    def test_both_ways_find_the_same_light(self):
        """The path tracer with and without its search for surfaces that shine; the second needs
        many more samples."""
        objects = [
            (
                {"class": "Sphere", "center": [0, 0, 0], "radius": 3},
                {"class": "Own", "albedo": 0.5},
            ),
            (
                {"class": "Sphere", "center": [1, 1, 1], "radius": 0.8},
                {"class": "Emitter", "radiance": 2},
            ),
            (
                {"class": "Sphere", "center": [-1, 0, 1.5], "radius": 0.7},
                {"class": "Conductor", "alpha": 0.3},
            ),
            ({"class": "Sphere", "center": [0.8, -1, 1.5], "radius": 0.6}, {"class": "Plastic"}),
        ]
        self.scene(objects, spp=128)
        both = self.mean()
        self.write_plain_tracer()
        self.scene(objects, spp=4096, rayGeneration={"class": "PathTracer", "bounces": 64})
        found = self.mean(
            "--set",
            "render.engine=programs",
            "--set",
            'import=["std.primitives", "std.materials", "shaders.rtsl", "PathTracer.rtsl"]',
        )
        for one, other in zip(both, found):
            self.assertAlmostEqual(one, other, delta=0.01 * other)

    def test_both_heuristics_find_the_same_light(self):
        """A floor under a large lamp, which both ways find well. All pixels see the same, and the
        means differ by at most 4.5 standard errors, which are less than 3 percent."""
        lamp = {"class": "Sphere", "center": [0, 3, 0], "radius": 2}
        estimates = []
        for heuristic in (1, 2):
            self.scene(
                [(FLOOR, {"class": "Lambert"}), (lamp, {"class": "Emitter"})],
                camera="Under",
                spp=256,
                rayGeneration={"class": "PathTracer", "bounces": 1, "heuristic": heuristic},
            )
            self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
            bits = channels((self.folder / "a.exr").read_bytes())["R"]
            estimates.append(struct.unpack(f"<{len(bits)}f", struct.pack(f"<{len(bits)}I", *bits)))
        self.assertNotEqual(*estimates)
        means = [statistics.fmean(values) for values in estimates]
        error = math.hypot(*(statistics.stdev(v) / math.sqrt(len(v)) for v in estimates))
        self.assertLess(4.5 * error, 0.03 * means[1])
        self.assertAlmostEqual(*means, delta=4.5 * error)

    def test_lamps_need_no_search(self):
        """From an Emitter no light is searched for. A lamp of the same kind that has a density, so
        that it is, has the same picture."""
        self.write(
            "searching.rtsl",
            """
import std.materials;
class Searching : Emitter {
  void evaluatePDF() { rt_PDF = 0.0; }
};
""",
        )
        pictures = []
        for name in ("Emitter", "Searching"):
            lamp = {"class": name, "radiance": 4, "isTwoSided": True}
            self.scene(
                [
                    (FLOOR, {"class": "Lambert"}),
                    ({"class": "Sphere", "center": [0, 4, 3], "radius": 1}, lamp),
                ],
                spp=16,
                **{"import": ["std.primitives", "std.materials", "shaders.rtsl", "searching.rtsl"]},
            )
            pictures.append(f"{name}.exr")
            self.run_rtslc("render", "scene.json", "-o", pictures[-1], "-q", self.level)
        self.assert_same_bits(*pictures)


if __name__ == "__main__":
    unittest.main()
