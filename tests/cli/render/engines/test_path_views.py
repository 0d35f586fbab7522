"""The engine `path`: bad input, and the views, which show what the first ray hits."""

import json
import math
import unittest

from path_case import FLOOR, SHADERS, PathCase


class BadInput(PathCase):
    def test_lamps_without_area(self):
        """They light nothing, and spoil nothing."""
        lamp = {"class": "Emitter", "radiance": 5, "isTwoSided": True}
        flat = {"class": "Parallelogram", "constructor": [[-1, 3, -1], [2, 0, 0], [4, 0, 0]]}
        self.write("flat.obj", "v 0 3 0\nv 1 3 0\nv 2 3 0\nf 1 2 3\n")
        self.scene(
            [
                (FLOOR, {"class": "Own"}),
                (flat, lamp),
                ({"class": "Disk", "constructor": [[0, 3, 0], [0, 1, 0], 0, 0]}, lamp),
                ({"class": "Sphere", "center": [0, 3, 0], "radius": 0}, lamp),
            ],
            camera="Under",
            background=1.0,
            nodes={"sliver": {"mesh": "flat.obj", "material": lamp}},
            root="sliver",
            spp=16,
        )
        out, _ = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--json")
        self.assertEqual(json.loads(out)["samplesNotFinite"], 0)
        self.assert_gray(0.5, 0.01)

    def test_the_brightest_lamp_is_found(self):
        """Its power is more than a float can hold; light is proportional to the radiance, sample by
        sample."""
        means = []
        for glow in (1.0, 2.0**125):
            self.scene(
                [
                    (FLOOR, {"class": "Own"}),
                    (
                        {"class": "Sphere", "center": [0, 3, 0], "radius": 0.5},
                        {"class": "Own", "glow": glow},
                    ),
                ],
                camera="Under",
                spp=4,
            )
            means.append(self.mean()[0] / glow)
        self.assertGreater(means[0], 0.001)
        self.assertAlmostEqual(means[1], means[0], delta=1e-4 * means[0])

    def test_lamps_that_are_too_bright(self):
        """Samples that are not finite are left out, and counted."""
        self.scene(
            [
                (FLOOR, {"class": "Own"}),
                (
                    {"class": "Sphere", "center": [0, 3, 0], "radius": 0.5},
                    {"class": "Own", "glow": 3e38},
                ),
            ],
            camera="Under",
            background=1.0,
            spp=64,
        )
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", "-Wno-all")
        for component in self.mean("-Wno-all"):
            self.assertTrue(math.isfinite(component))

    def test_a_bsdf_that_is_no_number(self):
        """The samples are left out, with a warning that names the line."""
        text = (
            SHADERS
            + """
class Broken : Own {
  public float zero = 0.0;
  void BSDF() {
    rt_BSDFValue = color(zero / zero);
  }
};
"""
        )
        self.write("shaders.rtsl", text)
        line = 1 + text.split("\n").index("    rt_BSDFValue = color(zero / zero);")
        self.scene(
            [(FLOOR, {"class": "Broken"})],
            camera="Under",
            lights=[{"class": "PointLight", "position": [0, 3, 0]}],
            spp=1,
            size=(4, 4),
        )
        out, error = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--json")
        self.assertEqual(json.loads(out)["samplesNotFinite"], 16)
        self.assertIn(f"shaders.rtsl:{line}:", error)


class Views(PathCase):
    def test_what_they_show(self):
        """Of a ball of radius 2 around the origin, from the origin and from a point above a
        floor."""
        own = {"class": "Own", "albedo": 0.25}
        self.scene([(FLOOR, own)], camera="Down", spp=16, size=(4, 4))
        for engine, expected in (
            ("normals", [0.5, 1, 0.5]),
            ("depth", [5, 5, 5]),
            ("albedo", [0.25] * 3),
            ("occlusion", [1, 1, 1]),
        ):
            with self.subTest(engine=engine):
                for one, wanted in zip(self.mean("--set", f"render.engine={engine}"), expected):
                    self.assertAlmostEqual(one, wanted, delta=1e-3)
        self.scene(
            [(FLOOR, {"class": "Alone", "albedo": 0.25})], camera="Down", spp=4096, size=(4, 4)
        )
        self.assert_gray(0.25, 0.02, "--set", "render.engine=albedo")
        # Half of the directions of a floor below a half-infinite ceiling are open; with a short
        # reach all are.
        ceiling = {
            "class": "Parallelogram",
            "constructor": [[0, 1, -1e4], [1e4, 0, 0], [0, 0, 2e4]],
        }
        self.scene([(FLOOR, own), (ceiling, own)], camera="Under", spp=4096, size=(4, 4))
        self.assert_gray(0.5, 0.02, "--set", "render.engine=occlusion")
        self.assert_gray(
            1.0,
            1e-6,
            "--set",
            "render.engine=occlusion",
            "--set",
            'rayGeneration={"class": "OcclusionView", "reach": 0.5}',
        )

    def test_materials_that_the_albedo_does_not_see_are_named(self):
        """Once, where their author has written them, also as a layer; not those that only shine."""
        text = """
class Flat : rt_Material { void shade() { rt_SampleColor = color(1.0); } };
class Lamp : rt_Material { void emission() { rt_EmissionColor = color(1.0); } };
"""
        self.write("flat.rtsl", text)
        self.scene([(FLOOR, {"class": "Flat"}), (FLOOR, {"class": "Lamp"})], spp=1, size=(4, 4))
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"].append("flat.rtsl")
        self.write("scene.json", json.dumps(scene))
        for options in (["--set", "render.engine=albedo"], ["--aov", "albedo,normal,depth"]):
            with self.subTest(options=options):
                _, error = self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", *options)
                self.assertIn("flat.rtsl:2:7: warning[W2701]", error)
                self.assertIn("`Flat`, which does not define `sampleBSDF`, nor `BSDF`", error)
                self.assertEqual(error.count("warning["), 1, error)

    def test_ids_differ(self):
        """Of seven balls, of which one after the other is in front of the camera and the rest
        behind it."""
        means = set()
        for seen in range(7):
            self.scene(
                [
                    (
                        {
                            "class": "Sphere",
                            "center": [0, 0.1 if i == seen else 20, 0],
                            "radius": 0.5,
                        },
                        {"class": "Shines"},
                    )
                    for i in range(7)
                ],
                camera="Down",
                spp=1,
                size=(4, 4),
            )
            means.add(tuple(self.mean("--set", "render.engine=id")))
        self.assertEqual(len(means), 7)

    def test_every_path_gives_the_same_bits(self):
        self.scene(
            [
                (FLOOR, {"class": "Lambert"}),
                ({"class": "Sphere", "center": [0, 1, 2], "radius": 1}, {"class": "Gold"}),
                ({"class": "Sphere", "center": [0, 1, 8], "radius": 4}, {"class": "Alone"}),
            ],
            camera="Inside",
            spp=4,
        )
        for engine in ("normals", "depth", "id", "albedo", "occlusion"):
            self.run_rtslc(
                "render", "scene.json", "-o", "a.exr", "-q", "--set", f"render.engine={engine}"
            )
            for way in (["--trace=recurse"], ["--target=host-megakernel"]):
                with self.subTest(engine=engine, way=way):
                    self.run_rtslc(
                        "render",
                        "scene.json",
                        "-o",
                        "b.exr",
                        "-q",
                        "--set",
                        f"render.engine={engine}",
                        *way,
                    )
                    self.run_rtslc("compare", "a.exr", "b.exr", "--threshold", "0")


if __name__ == "__main__":
    unittest.main()
