"""The engine `path` as a whole: the same bits on all paths, its options, and the engine `classic`
with its materials."""

import json
import unittest

from path_case import BALL, FLOOR, SHADERS, WAYS, PathCase


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


class Options(PathCase):
    def test_members_of_the_engine(self):
        self.scene(
            [(BALL, {"class": "Own", "albedo": 0.5, "glow": 1})],
            depth=50,
            spp=1,
            rayGeneration={"class": "PathTracer", "bounces": 0},
        )
        self.assert_gray(1.0, 1e-6)

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

    def test_the_color_of_the_background_with_the_engine_programs(self):
        """Rays of the library's path tracers meet it, however they are chosen."""
        for tracer in ("PathTracer", "VolumeTracer"):
            self.scene([], spp=1, background=0.75, rayGeneration={"class": tracer})
            self.assertEqual(
                self.mean("--set", "render.engine=programs", "--set", "import.4=std.engines"),
                [0.75] * 3,
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


if __name__ == "__main__":
    unittest.main()
