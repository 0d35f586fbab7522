"""Footprints of rays: their cones, and the part of a surface that a cone covers."""

import json
import math
import unittest

from footprint_case import PLANE, WAYS, FootprintCase, add, cross, dot, unit

STATE = """
class Tells : rt_Material {
  void shade() {
    print(rt_ConeWidth, rt_ConeSpread, rt_dPdx, rt_dPdy, rt_dUVdx, rt_dUVdy, rt_dUVWdx, rt_dUVWdy,
          rt_RayDirection, rt_HitDistance, normalize(rt_GeometricNormal), rt_dPdu, rt_dPdv);
    rt_SampleColor = color(rt_ConeWidth, rt_dUVdx.x + rt_dUVdy.y, rt_dUVWdx.z);
  }
};
class Mirror : rt_Material {
  void shade() {
    rt_SampleColor = trace(rt_HitPoint, reflect(rt_RayDirection, normalize(rt_GeometricNormal)));
  }
};
"""
PARTS = (1, 1, 3, 3, 2, 2, 3, 3, 3, 1, 3, 3, 3)  # components of what Tells prints


class Footprints(FootprintCase):
    def told(self, *options):
        """What Tells prints, in its parts."""
        for line in self.printed(*options):
            parts = []
            for count in PARTS:
                parts.append(line[0] if count == 1 else line[:count])
                line = line[count:]
            yield parts

    def expect_footprint(self, told, spread, width, to_object=lambda v: v):
        (cone, gain, px, py, ux, uy, wx, wy, direction, t, normal, pu, pv) = told
        self.assert_close(gain, spread)
        self.assert_close(cone, width + spread * t * math.sqrt(dot(direction, direction)))
        d = unit(direction)
        across = unit(cross(normal, d))
        along = cross(across, normal)
        stretch = min(1 / abs(dot(normal, d)), 1024)
        self.assert_close(px, [cone * stretch * x for x in along])
        self.assert_close(py, [cone * x for x in across])
        for p, uv in ((px, ux), (py, uy)):
            self.assert_close(add([uv[0] * x for x in pu], pv, uv[1]), p, 1e-3)
        self.assert_close(wx, to_object(px))
        self.assert_close(wy, to_object(py))

    def test_footprints_on_a_plane(self):
        width, height = 3, 2
        for corner, a, b in (
            ([-3, -3, 0], [6, 0, 0], [0, 6, 0]),
            ([-30, -30, -0.5], [60, 0, 0], [3, 60, 0.9]),  # not a right angle
            ([-9e5, -1e4, -1e6], [2e6, 0, 0], [0, 2e6, 0]),
            ([-50, 1.2, -60], [100, 0, 0], [0, 0, 60]),  # grazing
        ):
            plane = {"class": "Parallelogram", "constructor": [corner, a, b]}
            self.scene(STATE, [{"primitive": plane, "material": {"class": "Tells"}}])
            count = 0
            for told in self.told():
                d = told[8]
                sines = [
                    math.sqrt(dot(normal, normal) / dot(d, d) / dot(e, e))
                    for e in (add(d, [0.4 / width, 0, 0]), add(d, [0, 0.2 / height, 0]))
                    for normal in [cross(d, e)]
                ]
                self.expect_footprint(told, math.sqrt(sines[0] * sines[1]), 0)
                count += 1
            self.assertGreater(count, 1)

    def test_footprints_follow_transforms(self):
        transform = [{"scale": [2, 0.5, 1]}, {"rotate": [0, 20, 0]}]
        square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 4 0\nvt 4 2\nvt 0 2\n"
        square += "f 1/1 2/2 3/3 4/4\n"
        self.write("square.obj", square)
        cosine, sine = math.cos(math.radians(20)), math.sin(math.radians(20))

        def to_object(v):
            return [
                (cosine * v[0] - sine * v[2]) / 2,
                v[1] / 0.5,
                sine * v[0] + cosine * v[2],
            ]

        # A mesh with one instance is moved, so that its object space is world space.
        for primitive, back in (({"primitive": PLANE}, to_object), ({"mesh": "square.obj"}, list)):
            material = {"class": "Tells"}
            self.scene(STATE, [{**primitive, "material": material, "transform": transform}])
            told = list(self.told())
            self.assertGreater(len(told), 3)
            for one in told:
                self.expect_footprint(one, one[1], 0, back)

    def test_cones_of_cameras(self):
        wall = {"class": "Parallelogram", "constructor": [[-50, -50, -3], [100, 0, 0], [0, 100, 0]]}
        objects = [{"primitive": wall, "material": {"class": "Tells"}}]
        view = {"eye": [0, 0, 2], "target": [0, 0, 0], "up": [0, 1, 0]}
        size = (40, 40)
        half = math.tan(math.radians(20))
        # The width on the wall, 5 away, in the middle of the picture.
        for camera, expected in (
            (
                {"class": "PerspectiveCamera", "constructor": view, "fieldOfView": 40},
                10 * half / 40,
            ),
            ({"class": "OrthographicCamera", "constructor": view, "height": 3}, 3 / 40),
            ({"class": "FisheyeCamera", "constructor": view, "fieldOfView": 180}, 5 * math.pi / 40),
        ):
            self.scene(STATE, objects, size, camera)
            middle = min(self.told(), key=lambda told: abs(told[8][0]) + abs(told[8][1]) + told[9])
            self.assert_close(middle[0], expected, 0.02, camera["class"])
        self.assertEqual(list(self.told())[0][1] > 0, True)

    def test_cameras_print_once(self):
        shaders = (
            STATE
            + """
class Talks : Eye {
  void generateRay() { Eye::generateRay(); print(7, rand()); }
};
"""
        )
        plane = {"class": "Parallelogram", "constructor": [[-9, -9, 0], [20, 0, 0], [0, 20, 0]]}
        objects = [{"primitive": plane, "material": {"class": "Tells"}}]
        self.scene(shaders, objects, (2, 1), {"class": "Talks"})
        for way in ([], ["--target=host-megakernel"]):
            self.assertEqual(len([line for line in self.printed(*way) if line[0] == 7]), 2)

    def test_cones_of_rays_that_shaders_send(self):
        """A mirror at 45 degrees, and what it shows."""
        objects = [
            {
                "primitive": {
                    "class": "Parallelogram",
                    "constructor": [[-5, -5, -5], [10, 0, 0], [0, 10, 10]],
                },
                "material": {"class": "Mirror"},
            },
            {
                "primitive": {
                    "class": "Parallelogram",
                    "constructor": [[-50, -7, -50], [100, 0, 0], [0, 0, 100]],
                },
                "material": {"class": "Tells"},
            },
        ]
        self.scene(STATE, objects)
        told = list(self.told())
        self.assertEqual(len(told), 6)
        for one in told:
            self.assertGreater(one[0], one[1] * one[9] * 1.1)  # wider than from the mirror alone
            to_mirror = one[0] - one[1] * one[9] * math.sqrt(dot(one[8], one[8]))
            self.expect_footprint(one, one[1], to_mirror)
        self.same_bits()

    SENDS = """
struct Told { vec2 cone; };
class Tells : rt_Material {
  void closestHit(inout Told told) { told.cone = vec2(rt_ConeWidth, rt_ConeSpread); }
};
class Sends : rt_RayGeneration {
  void generate() {
    Told told = Told(vec2(7.0));
    vec3 origin = vec3(0.0, 0.0, float(1u + rt_LaunchIndex.x));
    trace(origin, vec3(0.0, 0.0, -2.0), 0.0, 1e30, told);
    vec2 before = told.cone;
    rt_ConeWidth = 0.25;
    rt_ConeSpread = 0.125;
    trace(origin, vec3(0.0, 0.0, -2.0), 0.0, 1e30, told);
    vec2 first = told.cone;
    rt_ConeSpread *= 2.0;
    trace(origin, vec3(0.0, 0.0, -2.0), 0.0, 1e30, told);
    print(before, first, told.cone, rt_ConeWidth);
    rt_SampleColor = color(first.x, told.cone.x, told.cone.y);
  }
};
"""

    def test_generate_says_which_cones_its_rays_have(self):
        floor = {"class": "Parallelogram", "constructor": [[-5, -5, 0], [10, 0, 0], [0, 10, 0]]}
        self.scene(
            self.SENDS,
            [{"primitive": floor, "material": {"class": "Tells"}}],
            rayGeneration={"class": "Sends"},
            render={"engine": "programs", "size": [3, 1], "spp": 1, "depth": 2},
        )
        lines = self.printed()
        self.assertEqual(len(lines), 3)
        for i, line in enumerate(lines):
            far = 1 + i
            expected = [0, 0, 0.25 + 0.125 * far, 0.125, 0.25 + 0.25 * far, 0.25, 0.25]
            self.assertEqual(line, expected)
        self.same_bits([*WAYS, ["--keep=outputs"]])

    def test_generate_may_write_cones_that_nobody_reads(self):
        self.scene(
            "class Sends : rt_RayGeneration { void generate() { rt_ConeWidth = 1.0; "
            "rt_SampleColor = trace(vec3(0.0, 0.0, 2.0), vec3(0.0, 0.0, -1.0)); } };"
            "class Plain : rt_Material { void shade() { rt_SampleColor = color(0.5); } };",
            [{"primitive": PLANE, "material": {"class": "Plain"}}],
            rayGeneration={"class": "Sends"},
            render={"engine": "programs", "size": [3, 1], "spp": 1},
        )
        said, _ = self.run_rtslc("explain", "scene.json", "--json", "--no-savings")
        self.assertIn(("footprints of rays", False), list(self.items(json.loads(said))))
        self.same_bits([[], ["--keep=outputs"], ["--keep=outputs", "--target=host-megakernel"]])

    def test_strange_surfaces_have_no_footprint(self):
        self.write(
            "flat.obj",
            "v -3 -3 0\nv 3 -3 0\nv 0 3 0\nvt 0.5 0.5\nvt 0.5 0.5\nvt 0.5 0.5\nf 1/1 2/2 3/3\n",
        )
        self.write(
            "line.obj",
            "v -3 -3 0\nv 3 -3 0\nv 0 3 0\nvt 0 0\nvt 1 1\nvt 2 2\nf 1/1 2/2 3/3\n",
        )
        for mesh in ("flat.obj", "line.obj"):
            self.scene(STATE, [{"mesh": mesh, "material": {"class": "Tells"}}])
            for told in self.told():
                self.assertGreater(told[0], 0)
                self.assertEqual(told[4:6], [[0, 0], [0, 0]])
        # A plane that is seen from within, and numbers at the ends of the range.
        for scale, distance in ((1e-18, 1e-18), (1e18, 1e18), (1.0, 1e-30)):
            plane = {
                "class": "Parallelogram",
                "constructor": [
                    [-scale, -scale, -distance],
                    [2 * scale, 0, 0],
                    [0, 2 * scale, 0],
                ],
            }
            camera = {"class": "Eye", "eye": [0, 0, 0], "forward": [0, 0, -1]}
            self.scene(STATE, [{"primitive": plane, "material": {"class": "Tells"}}], camera=camera)
            for told in self.told():
                for number in [told[0]] + [x for part in told[2:8] for x in part]:
                    self.assertTrue(math.isfinite(number), (scale, distance, told))


if __name__ == "__main__":
    unittest.main()
