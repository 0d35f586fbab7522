"""Media in the engine `volume`: pictures whose light is known, within what chance allows."""

import json
import math
import statistics
import struct
import unittest

from harness import Case, deep

SLAB = ([-1000, -1000, -1], [1000, 1000, 0])
CUBE = ([-1, -1, -1], [1, 1, 1])
SKY = {"class": "UniformSky"}
CLAY = {"class": "Lambert", "reflectance": 0.5}


class MediaCase(Case):
    def scene(self, medium, box=CUBE, depth=20, spp=64, height=0.5, objects=(), **rest):
        """A box of a medium, seen from above (z) in parallel rays."""
        self.level = "-O0" if spp <= 64 else "-O2"
        boundary = {"class": "MediumBoundary", "interior": "medium"}
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": [
                        "std.cameras",
                        "std.primitives",
                        "std.materials",
                        "std.media",
                        "std.lights",
                        "std.backgrounds",
                    ],
                    "camera": {
                        "class": "OrthographicCamera",
                        "constructor": [[0, 0, 50], [0, 0, 0], [0, 1, 0]],
                        "height": height,
                    },
                    "helpers": {"medium": medium},
                    "objects": [
                        {
                            "primitive": {"class": "Box", "low": box[0], "high": box[1]},
                            "material": boundary,
                        },
                        *objects,
                    ],
                    "render": {"engine": "volume", "size": [16, 16], "spp": spp, "depth": depth},
                    **rest,
                }
            ),
        )

    def mean(self, *arguments):
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", *arguments)
        out, _ = self.run_rtslc("compare", "a.exr", "a.exr", "--json")
        return json.loads(out)["means"][0]

    def estimate(self):
        """The mean color of a gray picture, and a bound of its error: 4.5 standard errors, which
        chance exceeds once in 100 000 pictures."""
        scene = json.loads((self.folder / "scene.json").read_text())
        samples = 16
        while samples < scene["render"]["spp"]:  # when the error is measured
            samples += samples // 4
        out, _ = self.run_rtslc(
            "render", "scene.json", "-o", "a.exr", "--json", "--noise=1e-9", f"--spp={samples}"
        )
        out, document = self.run_rtslc("compare", "a.exr", "a.exr", "--json")[0], json.loads(out)
        means = json.loads(out)["means"][0]
        error = document["noise"] * sum(means) / 3 / math.sqrt(document["pixels"])
        return means, [4.5 * error + 1e-5] * 3

    def estimate_by_seeds(self):
        """The same of colors: the means of eight pictures, which take as many samples together, and
        the interval that Student's t with 7 degrees of freedom leaves once in 10 000 cases."""
        scene = json.loads((self.folder / "scene.json").read_text())
        samples = scene["render"]["spp"] // 8
        pictures = [self.mean(f"--spp={samples}", f"--seed={seed}") for seed in range(8)]
        components = list(zip(*pictures))
        return [statistics.mean(values) for values in components], [
            7.06 * statistics.stdev(values) / math.sqrt(8) + 1e-5 for values in components
        ]

    def assert_color(self, expected, relative):
        """Within chance, which is at most `relative`."""
        is_gray = len(set(expected)) == 1
        means, bounds = self.estimate() if is_gray else self.estimate_by_seeds()
        for one, other, bound in zip(means, expected, bounds):
            self.assertAlmostEqual(one, other, delta=bound)
            self.assertLess(bound, relative * other)

    def grid(self, values, size, **more):
        self.write("grid.raw", struct.pack(f"<{len(values)}f", *values))
        return {
            "class": "GridMedium",
            "density": {"raw": "grid.raw", "size": size, "filter": "bilinear", "wrap": "clamp"},
            **more,
        }


class ClosedForms(MediaCase):
    def test_beers_law(self):
        """Of a sky seen through a medium that only absorbs, by delta tracking; of a light on a
        floor, without noise."""
        absorption = [0.7, 0.1, 1.0]
        self.scene(
            {"class": "HomogeneousMedium", "scattering": 0, "absorption": absorption},
            background=SKY,
            spp=256,
        )
        self.assert_color([math.exp(-2 * a) for a in absorption], 0.1)
        floor = {
            "primitive": {
                "class": "Parallelogram",
                "constructor": [[-9, -9, -3], [18, 0, 0], [0, 18, 0]],
            },
            "material": CLAY,
        }
        self.scene(
            {"class": "HomogeneousMedium", "scattering": 0, "absorption": absorption},
            depth=3,
            spp=256,
            objects=[floor],
            lights=[{"class": "DistantLight", "direction": [0, 0, 1], "irradiance": 4}],
        )
        self.assert_color([2 * math.exp(-4 * a) for a in absorption], 0.12)

    def test_single_scattering_in_a_slab(self):
        """Light that enters at an angle, is scattered once and leaves: an integral of
        exponentials."""
        s, a, g = 0.8, 0.4, 0.5
        for elevation in (90, 40):
            mu = math.sin(math.radians(elevation))
            phase = (1 - g * g) / (4 * math.pi * (1 + g * g + 2 * g * mu) ** 1.5)
            rate = (s + a) * (1 + 1 / mu)
            self.scene(
                {"class": "HomogeneousMedium", "scattering": s, "absorption": a, "anisotropy": g},
                SLAB,
                depth=2,
                spp=1024,
                lights=[
                    {
                        "class": "DistantLight",
                        "direction": [math.cos(math.radians(elevation)), 0, mu],
                        "irradiance": 2,
                    }
                ],
            )
            self.assert_color([s * phase * math.pi * 2 * (1 - math.exp(-rate)) / rate] * 3, 0.01)

    def test_single_scattering_of_colors(self):
        """The same where each color is scattered and absorbed at a rate of its own."""
        scattering, absorption = [0.8, 0.3, 0.6], [0.4, 0.2, 0.9]
        self.scene(
            {"class": "HomogeneousMedium", "scattering": scattering, "absorption": absorption},
            SLAB,
            depth=2,
            spp=4096,
            lights=[{"class": "DistantLight", "direction": [0, 0, 1], "irradiance": 2}],
        )
        expected = []
        for s, a in zip(scattering, absorption):
            rate = 2 * (s + a)
            expected.append(s / (4 * math.pi) * math.pi * 2 * (1 - math.exp(-rate)) / rate)
        self.assert_color(expected, 0.05)

    def test_a_grid(self):
        """Density that rises along z, for all rays alike: what passes depends on its integral
        alone."""
        passes = math.exp(-1.5 * 2 * (0.25 * 0.25 + 0.5 * 0.625 + 0.25 * 1))
        self.scene(
            self.grid([0.25] * 4 + [1.0] * 4, [2, 2, 2], scattering=0, absorption=1.5),
            background=SKY,
            spp=1024,
        )
        self.assert_color([passes] * 3, 0.02)
        # A bound that is far too large costs time and changes nothing.
        self.scene(
            self.grid([0.25] * 4 + [1.0] * 4, [2, 2, 2], scattering=0, absorption=1.5, densest=8),
            background=SKY,
            spp=1024,
        )
        self.assert_color([passes] * 3, 0.02)

    def test_a_furnace(self):
        """A medium that absorbs nothing cannot be told from a sky of 1, however it scatters."""
        for medium in (
            {"class": "HomogeneousMedium", "scattering": 2, "anisotropy": 0.7},
            {"class": "HomogeneousMedium", "scattering": [3, 2.5, 0.5], "anisotropy": 0.3},
            self.grid([0, 1, 0.5, 0.25] * 4, [4, 2, 2], scattering=3, anisotropy=-0.5),
        ):
            self.scene(medium, depth=200, background=SKY, spp=256)
            self.assert_color([1, 1, 1], 0.01)

    def found_in_both_ways(self, center, radius, spp, relative):
        """The light of a lamp, in fog or behind its boundary, that the search and paths find, and
        that of one which no search knows: the color of a ray."""
        self.write(
            "shone.rtsl",
            "class Shone : rt_Material { void shade() { rt_SampleColor = color(9.0); } };",
        )
        fog = {
            "class": "HomogeneousMedium",
            "scattering": [0.5, 0.6, 0.7],
            "absorption": 0.2,
            "anisotropy": 0.3,
        }
        ways = []
        for material in ({"class": "Emitter", "radiance": 9}, {"class": "Shone"}):
            lamp = {"class": "Sphere", "center": center, "radius": radius}
            self.scene(
                fog,
                ([-2, -2, -2], [2, 2, 2]),
                spp=spp,
                height=3,
                objects=[{"primitive": lamp, "material": material}],
                **{"import": ["std", "shone.rtsl"]},
            )
            ways.append(self.estimate_by_seeds())
        (found, bounds), (by_chance, other_bounds) = ways
        for one, other, *both in zip(found, by_chance, bounds, other_bounds):
            self.assertAlmostEqual(one, other, delta=math.hypot(*both))
            self.assertLess(math.hypot(*both), relative * other)
            self.assertLess(both[0], both[1])

    def test_ways_to_find_light_beyond_a_boundary(self):
        self.found_in_both_ways([0, 0.5, 4], 1, 256, 0.2)

    @deep
    def test_ways_to_find_light(self):
        self.found_in_both_ways([0.5, 0.2, 0], 0.25, 4096, 0.12)
        self.found_in_both_ways([0.5, 0.2, 2.5], 0.25, 4096, 0.2)


# Rough glass that sends out what its mirrors lose by masking each other: as the engine draws
# directions, light that would meet a second mirror is lost (microfacet.rtsl). Without that loss it
# cannot be told from a sky of 1, whatever is inside.
WHOLE = """
import std.materials.Dielectric;
class Whole : Dielectric {
  color emitted(vec3 toEye) { return color(1.0) - weight(scatter(toEye, vec2(rand(), rand()))); }
};
"""


def wrappers(material):
    """Materials of the library that are others, here this one."""
    return [
        {"class": "Cutout", "material": material},
        {"class": "NormalMap", "material": material},
        {"class": "BumpMap", "material": material, "height": {"class": "Solid"}},
        {"class": "TwoSided", "front": material, "back": material},
        {"class": "MixMaterial", "first": material, "second": CLAY, "amount": 0},
        {"class": "MixMaterial", "first": CLAY, "second": material, "amount": 1},
    ]


class Boundaries(MediaCase):
    """Every material that lets light through, around a medium."""

    def row(self, medium, materials, **rest):
        """Balls side by side."""
        places = [3 * (i + 1) for i in range(len(materials))]
        self.write("whole.rtsl", WHOLE)
        self.scene(
            medium,
            objects=[
                {"primitive": {"class": "Sphere", "center": [x, 0, 0], "radius": 1}, "material": m}
                for x, m in zip(places, materials)
            ],
            background=SKY,
            camera={
                "class": "OrthographicCamera",
                "constructor": [[places[-1] / 2, 0, 50], [places[-1] / 2, 0, 0], [0, 1, 0]],
                "height": 3,
            },
            **{"import": [*PARTS, "std.media", "std.textures", "whole.rtsl"]},
            **rest,
        )

    def test_nothing_is_lost_but_by_masking(self):
        fog = {"class": "HomogeneousMedium", "scattering": 2, "anisotropy": 0.3}
        white = {"class": "Lambert", "reflectance": 1}
        smooth, *rough = (
            {"class": name, "interior": "medium", **more}
            for name, more in (
                ("Dielectric", {}),
                ("Whole", {"alpha": 0.05}),
                ("Whole", {"alpha": 0.3}),
                ("Whole", {"alpha": 1}),
                ("Whole", {"alpha": 0.3, "index": 1.1}),
            )
        )
        materials = [
            smooth,
            *rough,
            {"class": "MixMaterial", "first": rough[1], "second": white},
            {"class": "MixMaterial", "first": white, "second": smooth},
            {"class": "Cutout", "material": rough[1], "opacity": 0.5},
            {"class": "ThinGlass"},
        ]
        self.row(fog, materials, depth=200, spp=256)
        self.assert_color([1, 1, 1], 0.007)

    def test_the_loss_is_that_without_a_medium(self):
        """In the engine `path`, around nothing and around a medium that does nothing."""
        glass = {"class": "Dielectric", "alpha": 0.3}
        means = []
        for more, engine in (({"interior": "medium"}, "volume"), ({}, "volume"), ({}, "path")):
            self.row({"class": "HomogeneousMedium", "scattering": 0}, [{**glass, **more}], spp=4)
            scene = json.loads((self.folder / "scene.json").read_text())
            del scene["objects"][0]  # the box
            self.write("scene.json", json.dumps(scene))
            means.append(self.mean("--engine", engine))
        self.assertLess(means[0][0], 0.97)
        self.assertEqual(means, [means[0]] * 3)

    def test_points_of_a_lamp_on_both_sides_of_a_boundary(self):
        """A medium that lets nothing through leaves what the surface reflects, as glass does in the
        engine `path` that lets nothing through. Both draw the same numbers."""
        means = []
        for more, engine in (({"interior": "medium"}, "volume"), ({"transmission": 1e-30}, "path")):
            glass = {"class": "Dielectric", "alpha": 0.5, **more}
            self.row({"class": "HomogeneousMedium", "absorption": 1e4}, [glass])
            scene = json.loads((self.folder / "scene.json").read_text())
            del scene["objects"][0]  # the box
            del scene["background"]
            scene["import"] = ["std"]
            scene["camera"]["constructor"] = [[3, 0, 50], [3, 0, 0], [0, 1, 0]]
            lamp = {"center": [1.3, 0.5, 0.5], "radius": 0.8, "radiance": 30}
            scene["lights"] = [{"class": "SphereLight", **lamp}]
            self.write("scene.json", json.dumps(scene))
            means.append(self.mean("--engine", engine)[0])
        self.assertGreater(means[0], 0.02)
        self.assertAlmostEqual(*means, delta=1e-3 * means[0])

    def test_all_of_them_bound_it(self):
        """Beer's law through boxes one behind the other that do not bend light: a material that
        forgets what its part has inside shows more."""
        glass = {"class": "Dielectric", "index": 1, "alpha": 0.3, "interior": "medium"}
        boxes = [
            {
                "primitive": {"class": "Box", "low": [-1, -1, z], "high": [1, 1, z + 0.5]},
                "material": material,
            }
            for z, material in enumerate([glass, *wrappers(glass)], start=2)
        ]
        self.scene(
            {"class": "HomogeneousMedium", "scattering": 0, "absorption": 0.2},
            depth=40,
            objects=boxes,
            background=SKY,
            **{"import": [*PARTS, "std.media", "std.textures"]},
        )
        self.assert_color([math.exp(-0.2 * (2 + 0.5 * len(boxes)))] * 3, 0.05)


# A medium of an author whose members have no ranges.
FREE = """
import std.media.Medium;
import std.phase;
class Free : Medium {
  public color lost = color(1.0), kept = color(1.0);
  public float g = 0.0;
  Coefficients at(vec3 p) { return Coefficients(kept, kept + lost); }
  float most() { return max(kept + lost); }
  float phase(float cosine) { return phaseHenyeyGreenstein(cosine, g); }
  vec3 deflect(vec3 before, vec2 seed) { return deflected(before, seed, g); }
};
"""
PARTS = ["std.cameras", "std.primitives", "std.materials", "std.backgrounds"]


class ImpossibleMedia(MediaCase):
    def free(self, kept, lost, g=0, **rest):
        self.write("free.rtsl", FREE)
        medium = {"class": "Free", "kept": kept, "lost": lost, "g": g}
        self.scene(medium, background=SKY, **{"import": [*PARTS, "free.rtsl"]}, **rest)

    def reported(self, size="4x4"):
        """The samples that are not finite, and how many of all they are."""
        out, _ = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--json", "--size", size)
        document = json.loads(out)
        return document["samplesNotFinite"], document["samples"]

    def test_a_line_of_too_many_steps_ends(self):
        """A step of 1e-30 through a grid that is empty where the ray begins: the ray would never
        leave."""
        self.scene(self.grid([1, 1, 0, 0], [1, 1, 4], scattering=1e30), spp=1, background=SKY)
        bad, all_of_them = self.reported("2x2")
        self.assertEqual(bad, all_of_them)

    def test_impossible_coefficients_are_reported(self):
        for kept, lost in ((-1, 0), (0.5, -1), (-1, 3), (3e38, 3e38)):
            self.free(kept, lost, spp=1)
            bad, all_of_them = self.reported()
            self.assertGreater(bad, all_of_them / 2, (kept, lost))

    def test_any_anisotropy_is_one_of_the_range(self):
        """All light that goes in comes out."""
        for anisotropy in (-1, 1, 1e30):
            self.free(2, 0, anisotropy, depth=200)
            self.assert_color([1, 1, 1], 0.01)

    def test_the_library_states_ranges(self):
        for member, value in (("scattering", -1), ("absorption", -1), ("anisotropy", 1)):
            self.scene({"class": "HomogeneousMedium", member: value}, background=SKY)
            self.assert_message(self.diagnose("check", "scene.json"), "E0805", f"`{member}`")


class Scenes(MediaCase):
    def test_every_path_gives_the_same_bits(self):
        glass = {
            "primitive": {"class": "Sphere", "center": [0, 0, 2], "radius": 0.8},
            "material": {
                "class": "Dielectric",
                "interior": {"class": "HomogeneousMedium", "absorption": [1, 0.2, 0.1]},
            },
        }
        self.scene(
            self.grid([0, 1, 0.5, 0.25] * 4, [4, 2, 2]),
            background=SKY,
            spp=4,
            objects=[glass],
            height=3,
            lights=[{"class": "PointLight", "position": [3, 1, 2], "intensity": 9}],
        )
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q")
        for way in (
            ["--trace=split"],
            ["--traversal=device"],
            ["--target=host-megakernel"],
            ["--keep=all"],
            ["--threads", "1"],
        ):
            self.run_rtslc("render", "scene.json", "-o", "b.exr", "-q", *way)
            self.assert_same_bits("a.exr", "b.exr", way)

    def test_what_the_camera_is_in(self):
        """Fog between the camera and a wall, given as the engine's `medium`."""
        wall = {
            "primitive": {"class": "Box", "low": [-9, -9, 40], "high": [9, 9, 41]},
            "material": {"class": "Emitter", "radiance": 3},
        }
        self.scene(
            {"class": "HomogeneousMedium", "scattering": 0, "absorption": 0.1},
            objects=[wall],
            spp=256,
            rayGeneration={"class": "VolumeTracer", "medium": "medium"},
        )
        self.assert_color([3 * math.exp(-0.9)] * 3, 0.03)

    def test_media_are_inside_each_other(self):
        """A box of nothing in a box of fog: rays are in the fog again behind it."""
        hole = {
            "primitive": {"class": "Box", "low": [-0.9, -0.9, -0.5], "high": [0.9, 0.9, 0.5]},
            "material": {"class": "MediumBoundary"},
        }
        self.scene(
            {"class": "HomogeneousMedium", "scattering": 0, "absorption": 0.7},
            objects=[hole],
            background=SKY,
            spp=512,
        )
        self.assert_color([math.exp(-0.7)] * 3, 0.02)

    def test_other_engines_see_no_medium(self):
        self.scene({"class": "HomogeneousMedium", "scattering": 9}, background=SKY, spp=4)
        for engine in ("path", "classic"):
            self.assertEqual(self.mean("--engine", engine), [1, 1, 1])

    def test_the_depth_is_that_of_the_path(self):
        """Two boundaries are two rays; lights are seen through more of them."""
        self.scene({"class": "HomogeneousMedium", "scattering": 0}, background=SKY, spp=1)
        for depth, seen in ((1, 0), (2, 1)):
            self.assertEqual(self.mean("--depth", depth), [seen] * 3)


if __name__ == "__main__":
    unittest.main()
