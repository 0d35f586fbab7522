"""The engine `path`: pictures of scenes whose light is known, with materials of the library and of
authors."""

import json
import math
import pathlib
import statistics
import struct
import unittest

from exr_files import channels
from harness import EXAMPLES, RTSLC, deep
from path_case import BALL, FLOOR, SHADERS, WAYS, PathCase


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


class ClassicEngine(PathCase):
    """Materials without `shade` in the engine `classic`."""

    def test_it_shows_the_light_that_a_path_gathers_first(self):
        """Emission, and the light of lights with their shadows: here half of the picture."""
        lamp = {"class": "PointLight", "position": [0.5, 3, 0.2], "intensity": [20, 10, 5]}
        screen = {"class": "Parallelogram", "constructor": [[-1, 2, 0], [0, 0, 1], [1.3335, 0, 0]]}
        for material in (
            {"class": "Own", "albedo": 0.6, "glow": [0.1, 0.2, 0.3]},
            {"class": "Whole", "albedo": 0.6},
        ):
            self.scene(
                [(FLOOR, material), (screen, {"class": "Half"})],
                camera="Under",
                lights=[lamp],
                depth=1,
                spp=4,
            )
            self.run_rtslc("render", "scene.json", "-o", "path.exr", "-q")
            for way in ([], ["--trace=split"], ["--target=host-megakernel"]):
                with self.subTest(material=material, way=way):
                    self.run_rtslc(
                        *("render", "scene.json", "-o", "classic.exr", "-q", "--engine=classic"),
                        *("-Wno-shade-method", *way),
                    )
                    out, _ = self.run_rtslc(
                        "compare", "path.exr", "classic.exr", "--json", "--threshold", "10"
                    )
                    figures = json.loads(out)
                    self.assertGreater(figures["means"][0][0], 0.2)
                    self.assertLess(figures["rmse"], 1e-6)

    def test_the_message_says_what_is_missing(self):
        for name, what in (
            ("Own", "what the `BSDF` of `Own` scatters of the lights"),
            ("Shines", "what `Shines` emits"),
            ("Alone", "what the `BSDF` of `Alone` scatters of the lights"),
        ):
            self.scene([(BALL, {"class": name})], spp=1)
            scene = json.loads((self.folder / "scene.json").read_text())
            scene["render"]["engine"] = "classic"
            self.write("scene.json", json.dumps(scene))
            _, error = self.run_rtslc("check", "scene.json")
            self.assertEqual(error.count("W2702"), 1, error)
            self.assertIn(f"`{name}` has no `shade`: the engine `classic` shows {what}", error)
            self.assertIn("the engine `path` shows all of its light", error)
        self.scene([(BALL, {"class": "Shaded"})], spp=1)
        _, error = self.run_rtslc("check", "scene.json", "--set=render.engine=classic")
        self.assertNotIn("W2702", error)


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
                self.scene([(BALL, {"class": name, "glow": 0.5})], camera="Inside", spp=64)
                self.assert_estimates(1.0)

    def test_every_path_and_engine_gives_the_same_bits(self):
        lamp = {"class": "Sphere", "center": [0, 3, 0], "radius": 0.5}
        objects = [(FLOOR, {"class": "Alone"}), (lamp, {"class": "AloneOpaque", "glow": 1})]
        self.scene(objects, camera="Under", spp=4, depth=4)
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", "-Wno-sampling-method")
        for way in (*WAYS, ["--engine=volume"]):
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

    def test_lights_without_an_area_send_out_nothing(self):
        """And each is named, with what is wrong; those that have an area are not."""
        lines = [[0, 1, 0], [1, 1, 0], [3, 1, 0]]
        dark = [
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
        lit = [
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
                    f"the light `{light['class']} (lights.{i})` has no area, and sends out "
                    f"nothing: {why}"
                    for i, (why, light) in enumerate(dark)
                ],
            )
            for diagnostic, (_, light) in zip(found, dark):
                begin, end = (diagnostic["range"][at]["offset"] for at in ("begin", "end"))
                self.assertEqual(text[begin:end], light["class"])

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
        source = (
            pathlib.Path(RTSLC).parent.parent / "share/rtslc/library/std/engines/PathTracer.rtsl"
        ).read_text()
        plain = source.replace("if (illuminate(rt_HitPoint, pathSide()))", "if (false)").replace(
            "pathShare(path, path.density, rt_PDF)", "1.0"
        )
        self.assertEqual(len(plain.split("if (false)")), 2)
        self.write("PathTracer.rtsl", plain)
        self.scene(objects, spp=4096, rayGeneration={"class": "PathTracer", "bounces": 64})
        found = self.mean(
            "--set",
            "render.engine=programs",
            "--set",
            'import=["std.primitives", "std.materials", "shaders.rtsl", "PathTracer.rtsl"]',
        )
        for one, other in zip(both, found):
            self.assertAlmostEqual(one, other, delta=0.01 * other)

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

    def test_densities_of_0_absorb(self):
        """A material whose `sampleBSDF` writes a density of 0, and no value, sends out what shines,
        and no NaN."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Absorbs : Own {
  void sampleBSDF() { rt_LightDirection = normal(); rt_BSDFValue = color(0.0); rt_PDF = 0.0; }
};
""",
        )
        self.scene([(BALL, {"class": "Absorbs", "albedo": 0, "glow": 0.25})], spp=4)
        self.assert_gray(0.25, 1e-6)

    def test_values_that_are_no_numbers_are_left_out(self):
        """A BSDF that is NaN in half of its samples: the picture is that of the others, and the
        message says which line it was."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Broken : Own {
  void sampleBSDF() {
    rt_LightDirection = normal();
    rt_PDF = -1.0;
    float zero = rt_RayDirection.x - rt_RayDirection.x;
    rt_BSDFValue = color(rand() < 0.5 ? zero / zero : 0.0);
  }
};
""",
        )
        self.scene([(BALL, {"class": "Broken", "albedo": 0, "glow": 0.25})], spp=16, depth=2)
        self.assert_gray(0.25, 1e-6)
        _, messages = self.run_rtslc("render", "scene.json", "-o", "a.exr")
        self.assertIn("were infinite or not a number", messages)
        self.assertIn("zero / zero", messages)

    def test_values_below_0_are_left_out(self):
        """A BSDF that is negative in half of its samples: the picture is that of the others, and
        the message says which class it was, with the line of the engine that found it."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Below : Own {
  void sampleBSDF() {
    rt_LightDirection = normal();
    rt_PDF = -1.0;
    rt_BSDFValue = color(rand() < 0.5 ? -0.5 : 0.0);
  }
};
""",
        )
        self.scene([(BALL, {"class": "Below", "albedo": 0, "glow": 0.25})], spp=16, depth=2)
        self.assert_gray(0.25, 1e-6)
        _, messages = self.run_rtslc("render", "scene.json", "-o", "a.exr")
        self.assertIn("were infinite or not a number", messages)
        self.assertIn("min(rt_BSDFValue) < 0.0 ? color(sqrt(-1.0))", messages)
        self.assertRegex(
            messages,
            "W2800.*`sampleBSDF` of `Below` wrote negative values for [0-9]+ of 512 directions",
        )

    def test_values_without_a_density_are_left_out(self):
        """A BSDF with a value for half of the directions that it draws with a density of 0: the
        picture is that of the others, and the message says which class it was, with the line of the
        engine that found it."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Lost : Own {
  void sampleBSDF() {
    rt_LightDirection = normal();
    rt_PDF = 0.0;
    rt_BSDFValue = color(rand() < 0.5 ? 1.0 : 0.0);
  }
};
""",
        )
        self.scene([(BALL, {"class": "Lost", "albedo": 0, "glow": 0.25})], spp=16, depth=2)
        for engine in ("path", "volume"):
            self.assert_gray(0.25, 1e-6, "--engine", engine)
            _, messages = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--engine", engine)
            self.assertRegex(messages, "W2865.*were infinite or not a number", engine)
            self.assertIn("rt_BSDFValue / rt_PDF", messages, engine)
            self.assertRegex(
                messages, "W2800.*`sampleBSDF` of `Lost` drew [0-9]+ of 512 directions", engine
            )

    def test_check_tries_the_methods_of_materials(self):
        """Values below 0, values that are no numbers, and directions without a density."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Below : Own { void BSDF() { rt_BSDFValue = color(rt_LightDirection.x < 0.0 ? -0.5 : 0.5); } };
class NoNumber : Own {
  void sampleBSDF() {
    rt_LightDirection = normal();
    rt_PDF = 1.0;
    rt_BSDFValue = color(0.0 / (rt_BSDFSeed.x < 0.5 ? 0.0 : 1.0));
  }
};
class Lost : Own {
  void sampleBSDF() { rt_LightDirection = normal(); rt_BSDFValue = color(1.0); rt_PDF = 0.0; }
};
class Dark : rt_Material {
  public float sign = 1.0;
  void emission() { rt_EmissionColor = color(sign * sqrt(rt_RayDirection.x)); }
};
""",
        )
        said = {}
        for name in ("Below", "NoNumber", "Lost", "Own"):
            self.scene([(BALL, {"class": name})], spp=1)
            _, said[name] = self.run_rtslc("check", "scene.json")
        self.assertRegex(
            said["Below"], "W2800.*`BSDF` of `Below` wrote negative values for [0-9]+ of 512"
        )
        self.assertIn('"class": "Below"', said["Below"])
        self.assertRegex(
            said["NoNumber"],
            "`sampleBSDF` of `NoNumber` wrote values that are infinite or not a number",
        )
        self.assertRegex(said["Lost"], "`sampleBSDF` of `Lost` drew 512 of 512 directions")
        for sign, what in (
            (-1, "negative values"),
            (1, "values that are infinite or not a number"),
        ):
            self.scene([(BALL, {"class": "Dark", "sign": sign})], spp=1)
            _, error = self.run_rtslc("check", "scene.json")
            self.assertRegex(error, f"W2800.*`emission` of `Dark` wrote {what} for [0-9]+ of 512")
        self.assertEqual(said["Own"], "")

    def test_materials_of_the_library_have_no_such_values(self):
        for example in ("cornell/room.json", "product-shot/scene.json", "metal/scene.json"):
            self.assertEqual(self.run_rtslc("check", EXAMPLES / example)[1], "", example)

    def test_only_shade(self):
        """Its color counts, and its own rays are answered by `shade`."""
        self.scene([(BALL, {"class": "Shaded"})], depth=5, spp=1)
        self.assert_gray(sum(0.25 * 0.5**i for i in range(6)), 1e-5, "-Wno-all")


class Paths(PathCase):
    def test_every_path_gives_the_same_bits(self):
        self.scene(
            [
                (FLOOR, {"class": "Lambert"}),
                (BALL, {"class": "Dielectric"}),
                ({"class": "Sphere", "center": [3, 1, 0], "radius": 1}, {"class": "Gold"}),
                (
                    {"class": "Sphere", "center": [0, 4, 3], "radius": 1},
                    {"class": "Emitter", "radiance": 4},
                ),
            ],
            background=[0.2, 0.3, 0.4],
            spp=8,
            size=(32, 32),
        )
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        for i, way in enumerate(WAYS):
            with self.subTest(way=way):
                self.run_rtslc("render", "scene.json", "-o", f"{i}.exr", "-q", *way)
                self.run_rtslc("compare", "a.exr", f"{i}.exr", "--threshold", "0")

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

    def test_a_package_does_the_same(self):
        """Emitters are found when the package is made."""
        self.scene(
            [
                (FLOOR, {"class": "Lambert"}),
                (
                    {"class": "Sphere", "center": [0, 4, 3], "radius": 1},
                    {"class": "Emitter", "radiance": 4},
                ),
            ],
            camera="Under",
            spp=8,
        )
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
        self.run_package("x.rtslpkg", "--target=host", "-o", "b.exr", "--compare", "a.exr")

    def test_members_of_the_engine(self):
        self.scene(
            [(BALL, {"class": "Own", "albedo": 0.5, "glow": 1})],
            depth=50,
            spp=1,
            rayGeneration={"class": "PathTracer", "bounces": 0},
        )
        self.assert_gray(1.0, 1e-6)

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

    def test_another_ray_generation_is_not_used(self):
        self.write(
            "other.rtsl",
            "class Other : rt_RayGeneration { void generate() { rt_SampleColor = color(9.0); } };",
        )
        self.scene([(BALL, {"class": "Shines"})], spp=1, rayGeneration={"class": "Other"})
        self.assert_gray(
            0.75, 1e-6, "--set", 'import=["std.primitives", "shaders.rtsl", "other.rtsl"]'
        )

    def test_options_of_the_command_line(self):
        """`--engine` and `--depth` do what the scene's keys do."""
        self.scene([(BALL, {"class": "Own", "albedo": 0.5, "glow": 1})], depth=9, spp=4)
        for bounces in (0, 1):
            self.assert_gray(sum(0.5**i for i in range(bounces + 1)), 1e-5, "--depth", bounces)
        _, error = self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", "--depth", "1")
        self.assertEqual(error, "")
        self.assert_gray(0.5, 0.02, "--engine", "albedo", "--spp", "256")
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "b.exr", "--engine", "fast"),
            "E0808",
            "there is no engine `fast`",
        )

    def test_a_camera_is_needed(self):
        self.scene([(BALL, {"class": "Shines"})])
        scene = json.loads((self.folder / "scene.json").read_text())
        del scene["camera"]
        self.write("scene.json", json.dumps(scene))
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "a.exr"), "E0803", "the engine `path`"
        )

    def test_unknown_engines(self):
        self.scene([(BALL, {"class": "Shines"})])
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "a.exr", "--set", "render.engine=bdpt"),
            "E0808",
            "there is no engine `bdpt`; there are `classic`, `programs`, `path`, `volume`, "
            "`occlusion`",
        )

    def test_the_camera_of_an_authors_generate(self):
        """`generate` sees the camera's ray; without a camera it is zero."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Eye : rt_RayGeneration {
  void generate() { rt_SampleColor = color(rt_RayDirection.z, rt_RayOrigin.y, 0.0); }
};
""",
        )
        self.scene([(BALL, {"class": "Shines"})], spp=1, rayGeneration={"class": "Eye"})
        for way in WAYS:
            red, green, _ = self.mean("--set", "render.engine=programs", *way)
            self.assertAlmostEqual(red, 1.0, delta=1e-6)
            self.assertAlmostEqual(green, 0.2, delta=1e-6)
        scene = json.loads((self.folder / "scene.json").read_text())
        del scene["camera"]
        self.write("scene.json", json.dumps(scene))
        self.assertEqual(self.mean("--set", "render.engine=programs"), [0, 0, 0])


if __name__ == "__main__":
    unittest.main()
