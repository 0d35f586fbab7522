"""Scenes of a few primitives, which need no tree on the host: the bits are those of trees."""

import json
import random
import struct
import unittest

from exr_files import channels
from harness import Case

WAYS = (
    ("--keep=tree",),
    ("--traversal=device",),
    ("--trace=split",),
    ("--target=host-megakernel",),
)


class Lists(Case):
    def scene(self, count, camera=(0, 0, 9), clay="Lambert", kinds=3, moves=True, **render):
        """A heap of so many primitives of up to three kinds, some of which are moved, around a
        lamp."""
        dice = random.Random(count)

        def one(number):
            place = [dice.uniform(-2, 2) for _ in range(3)]
            classes = (
                {"class": "Sphere", "center": place, "radius": dice.uniform(0.2, 1)},
                {"class": "Parallelogram", "constructor": [place, [1, 0.3, 0], [0, 1, 0.5]]},
                {"class": "Box", "low": place, "high": [x + 0.7 for x in place]},
            )
            made = {"primitive": classes[number % kinds], "material": "clay"}
            if moves and number % 4 == 3:
                made["transform"] = {"scale": [1, 0.5, 2], "rotate": [0, 20 * number, 0]}
            return made

        lamp = {"class": "Sphere", "center": [0, 4, 2], "radius": 0.5}
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["std"],
                    "camera": {
                        "class": "PerspectiveCamera",
                        "constructor": {"eye": camera, "target": [0, 0, 0], "up": [0, 1, 0]},
                    },
                    "materials": {
                        "clay": {"class": clay},
                        "lamp": {"class": "Emitter", "radiance": 9},
                    },
                    "objects": [
                        {"primitive": lamp, "material": "lamp"},
                        *(one(number) for number in range(count - 1)),
                    ],
                    "lights": [{"class": "PointLight", "position": [3, 5, 4]}],
                    "background": 0.1,
                    "render": {"engine": "path", "size": [24, 24], "spp": 4, **render},
                }
            ),
        )

    def change_scene(self, imported, **parts):
        """Gives the scene classes of a file, and other parts."""
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"].append(imported)
        self.write("scene.json", json.dumps({**scene, **parts}))

    def render(self, picture, *arguments):
        out, _ = self.run_rtslc(
            *("render", "scene.json", "-o", picture, "-q", "-O0", "--json", *arguments)
        )
        return json.loads(out)

    def ptx(self, *arguments):
        out, _ = self.run_rtslc("compile", "scene.json", "--emit=ptx", "-o", "-", *arguments)
        return out

    def test_every_way_gives_the_same_bits(self):
        for count in (1, 8, 13, 32, 33):
            self.scene(count)
            self.render("a.exr")
            for way in WAYS if count in (1, 13) else WAYS[:1]:
                self.render("b.exr", *way)
                self.assert_same_bits("a.exr", "b.exr", (count, way))

    def test_other_engines_and_precisions(self):
        self.scene(13)
        for arguments in (("--engine=classic",), ("--fp=double",), ("--engine=occlusion",)):
            self.render("a.exr", *arguments)
            self.render("b.exr", "--keep=tree", *arguments)
            self.assert_same_bits("a.exr", "b.exr", arguments)

    def test_fast_programs_for_gpus_test_all_primitives(self):
        """In an unrolled loop, where what a ray leaves comes last. Its copies of `intersect` may be
        rounded otherwise than that for a tree."""
        for count, clay, kinds in ((13, "Lambert", 2), (13, "Dielectric", 1), (7, "Conductor", 2)):
            self.scene(count, clay=clay, kinds=kinds, moves=False, spp=16)
            self.assertNotIn("listed_boxes", self.ptx("--fp=fast"), (count, clay))
            way = ("--target=host-megakernel", "--fp=fast")
            self.render("list.exr", *way)
            self.render("tree.exr", *way, "--keep=tree")
            self.run_rtslc("compare", "tree.exr", "list.exr", "--threshold", "1e-3")

    def test_programs_for_gpus_that_test_boxes(self):
        """Strict ones, and where an `intersect` has a loop, takes many instructions, has a space of
        its own, or may raise an exception."""
        for kinds, moves, *arguments in (
            (2, False, "--fp=strict"),
            (3, False, "--fp=fast"),
            (2, True, "--fp=fast"),
            (2, False, "--fp=fast", "--exceptions"),
        ):
            self.scene(7, kinds=kinds, moves=moves)
            self.assertIn("listed_boxes", self.ptx(*arguments), (kinds, moves, arguments))

    def test_hits_outside_of_their_boxes(self):
        """A plane whose box lies before another plane, which it is behind. With --fp=fast its hits
        count where they are."""
        self.write(
            "planes.rtsl",
            "class Plane : rt_Primitive {\n"
            "  public float z = 0.0;\n"
            "  public float low = 0.0;\n"
            "  public float high = 0.0;\n"
            "  void intersect() { hit((z - rt_RayOrigin.z) / rt_RayDirection.z); }\n"
            "  void computeNormal() { rt_GeometricNormal = vec3(0.0, 0.0, 1.0); }\n"
            "  void computeBounds() {\n"
            "    rt_BoundMin = vec3(-9.0, -9.0, low);\n"
            "    rt_BoundMax = vec3(9.0, 9.0, high);\n"
            "  }\n"
            "};\n",
        )
        self.scene(3)
        objects = [
            {"primitive": {"class": "Plane"}, "material": "clay"},
            {"primitive": {"class": "Plane", "z": -1, "low": 1, "high": 2}, "material": "lamp"},
        ]
        self.change_scene("planes.rtsl", objects=objects)
        lamp = struct.unpack("<I", struct.pack("<f", 9))[0]
        for way in ((), ("--target=host-megakernel",)):
            self.render("strict.exr", *way)
            self.render("fast.exr", "--fp=fast", *way)
            strict, fast = (
                channels((self.folder / name).read_bytes())["G"]
                for name in ("strict.exr", "fast.exr")
            )
            self.assertEqual(set(strict), {lamp}, way)
            self.assertNotIn(lamp, fast, way)

    def test_rays_in_the_planes_of_sides(self):
        """Distances to these sides are 0 times an infinite inverse, of either sign."""
        self.write(
            "planes.rtsl",
            "class InPlanes : rt_Camera {\n"
            "  void generateRay() {\n"
            "    float sign = rt_ScreenCoord.x < 0.5 ? -1.0 : 1.0;\n"
            "    rt_RayOrigin = vec3(floor(12.0 * rt_ScreenCoord) * 0.5 - vec2(3.0), 9.0 * sign);\n"
            "    rt_RayDirection = vec3(sign * 0.0, rand() < 0.5 ? 0.0 : -0.0, -sign);\n"
            "  }\n"
            "};\n",
        )
        self.scene(3)
        dice = random.Random(1)
        lows = [[dice.randrange(-5, 5) / 2 for _ in range(3)] for _ in range(20)]
        objects = [
            {
                "primitive": {"class": "Box", "low": low, "high": [x + 0.5 for x in low]}
                if number % 2
                else {"class": "Parallelogram", "constructor": [low, [1, 0, 0], [0, 0.5, 0]]},
                "material": {"class": "Emitter", "radiance": 1 + number, "isTwoSided": True},
            }
            for number, low in enumerate(lows)
        ]
        self.change_scene("planes.rtsl", camera={"class": "InPlanes"}, objects=objects)
        self.render("a.exr")
        for way in WAYS[:2]:
            self.render("b.exr", *way)
            self.assert_same_bits("a.exr", "b.exr", way)
        values = set(channels((self.folder / "a.exr").read_bytes())["G"])
        self.assertGreater(len(values), 10)

    def test_no_ray_is_fitted_to_embree(self):
        """Rays whose directions are so short that Embree would get scaled ones."""
        self.write(
            "short.rtsl",
            "class Short : rt_Camera {\n"
            "  void generateRay() {\n"
            "    rt_RayOrigin = vec3(4.0 * rt_ScreenCoord - vec2(2.0), 9.0);\n"
            "    rt_RayDirection = vec3(0.0, 0.0, -1e-12);\n"
            "  }\n"
            "};\n",
        )
        self.scene(13)
        self.change_scene("short.rtsl", camera={"class": "Short"})
        self.assertEqual(self.render("a.exr")["rescaledRays"], 0)
        self.assertEqual(self.render("b.exr", "--keep=tree")["rescaledRays"], 24 * 24 * 4)
        self.assert_same_bits("a.exr", "b.exr")


if __name__ == "__main__":
    unittest.main()
