"""Rays of any length: a direction times a power of two meets primitives where the direction itself
does, to the bit, because distances along it are exact."""

import json
import os
import struct
import unittest

from exr_files import channels
from harness import Case

SHADERS = """
import std.cameras;

class Lengthened : ViewCamera {
  public float factor = 1.0;
  void generateRay() {
    rt_RayOrigin = position;
    rt_RayDirection = factor * toWorld(vec3(0.4 * pictureCoord(), 1.0));
  }
};
// Where a ray meets a surface, and where its mirror image meets the next one.
class Places : rt_Material {
  public bool isMirror = true;
  void shade() {
    vec3 place = rt_HitPoint + rt_GeometricNormal;
    rt_SampleColor = color(place.x, place.y, place.z);
    if (isMirror && rt_Depth < 1)
      rt_SampleColor += trace(rt_HitPoint, reflect(rt_RayDirection, rt_GeometricNormal));
  }
};
// One that reads all of the state that a ray has.
class Slab : rt_Primitive {
  scratch vec2 place;
  void intersect() {
    float squares = dot(rt_RayDirection, rt_RayDirection);
    vec3 p = rt_RayOrigin + dot(-rt_RayOrigin, rt_RayDirection) / squares * rt_RayDirection;
    float t = (1.0 - rt_RayOrigin.z) * rt_InverseRayDirection.z;
    place = (rt_RayOrigin + t * rt_RayDirection).xy;
    if (t > rt_Epsilon && t < rt_HitDistance && dot(p, p) < 1.0 && max(abs(place)) < 1.0)
      hit(t);
  }
  void computeBounds() {
    rt_BoundMin = vec3(-1.0, -1.0, 0.9);
    rt_BoundMax = vec3(1.0, 1.0, 1.1);
  }
  void computeNormal() { rt_GeometricNormal = normalize(vec3(place, 2.0)); }
};
"""


def made(name, *arguments, **members):
    return {"class": name, "constructor": list(arguments), **members}


PRIMITIVES = [
    {"class": "Sphere", "center": [0, 0, 0], "radius": 0.9},
    {"class": "Box", "low": [-0.5, -0.6, -0.7], "high": [0.8, 0.7, 0.6]},
    made("Capsule", [-0.8, -0.2, 0], [0.7, 0.3, 0.4], 0.4),
    made("Cone", [-0.8, -0.2, 0], [0.7, 0.3, 0.4], 0.7, 0.1),
    made("Cylinder", [-0.8, -0.2, 0], [0.7, 0.3, 0.4], 0.4),
    made("Disk", [0, 0, 0], [0.3, 0.4, 1], 0.9, 0.3),
    made("Parallelogram", [-0.7, -0.6, 0], [1.4, 0, 0.3], [0.1, 1.3, 0.1]),
    made("Torus", [0, 0, 0], [0.3, 0.4, 1], 0.6, 0.3),
    {"class": "Quadric", "coefficients": [1, 2, -1], "level": 0.3},
    {"class": "HeightField", "heights": [[0, 1, 0.3], [0.6, 0.1, 0.9], [0, 0.5, 1]]},
    {
        "class": "Curve",
        "points": [[-1, 0, 0, 0.2], [-0.5, 1, 0.5, 0.3], [0.5, -1, -0.5, 0.1], [1, 0, 0, 0.3]],
    },
    {"class": "DistanceField", "extent": 0.9},
    {"class": "Julia", "extent": 1.5, "iterations": 5},
    {"class": "Mandelbulb", "extent": 1.25, "iterations": 4},
    {"class": "Slab"},
]


# What begins where a ray does, which depends on bounds of errors, and they on the length.
SEARCHED = ("HeightField", "DistanceField", "Julia", "Mandelbulb")


FAR = struct.unpack("<I", struct.pack("<f", 0.25))[0]  # the background's red


def mirrors(primitive):
    return primitive["class"] not in SEARCHED


class RayLengths(Case):
    def render(self, picture, primitives, factor, *options, transform=None, mirrors=mirrors):
        scene = {
            "rtsl": 1,
            "import": ["std.primitives", "shaders.rtsl"],
            "camera": {
                "class": "Lengthened",
                "constructor": [[1, 1.5, 4], [0, 0, 0], [0, 1, 0]],
                "factor": factor,
            },
            "objects": [
                {
                    "primitive": one,
                    "material": {"class": "Places", "isMirror": mirrors(one)},
                    **({"transform": transform} if transform else {}),
                }
                for one in primitives
            ],
            "background": [0.25, 0.5, 0.75],
            "render": {"size": [24, 16], "spp": 1},
        }
        self.write("shaders.rtsl", SHADERS)
        self.write("scene.json", json.dumps(scene))
        self.run_rtslc("render", "scene.json", "-o", picture, "-q", "-O0", *options)

    def test_of_each_primitive(self):
        powers = (40, -67, 120, -40, 67, -110)
        for number, one in enumerate(PRIMITIVES):
            self.render("1.exr", [one], 1)
            with self.subTest(primitive=one["class"]):
                for power in powers if "RTSL_DEEP" in os.environ else powers[number % 2 :: 2]:
                    self.render(f"{power}.exr", [one], 2.0**power)
                    self.assert_same_bits("1.exr", f"{power}.exr")

    def test_in_every_traversal(self):
        """Also below transforms, which change the length, and with hits that lose."""
        more = [one for one in PRIMITIVES if one["class"] not in ("Julia", "Mandelbulb")]
        turned = [{"rotate": {"axis": [1, 2, 3], "angle": 40}}, {"scale": [1, 1.25, 0.75]}]
        for transform in (None, turned):
            self.render("1.exr", more, 1, transform=transform)
            for power in (67, -67):
                for way in (
                    (),
                    ("--traversal=device",),
                    ("--traversal=device", "--trace=recurse"),
                    ("--target=host-megakernel",),
                ):
                    with self.subTest(transform=transform, power=power, way=way):
                        self.render("2.exr", more, 2.0**power, *way, transform=transform)
                        self.assert_same_bits("1.exr", "2.exr")

    def test_where_distances_are_beyond_the_largest_float(self):
        """What is farther away in units of the direction is not met, whatever is tested first."""
        turned = [{"rotate": {"axis": [1, 2, 3], "angle": 40}}, {"scale": [1, 1.25, 0.75]}]
        ways = ((), ("--keep=tree",), ("--traversal=device",), ("--target=host-megakernel",))
        for transform in (None, turned):
            met = []  # the share of colors that are not the background's
            for power in (-124, -126, -128, -141):
                for way in ways:
                    with self.subTest(transform=transform, power=power, way=way):
                        self.render(
                            "2.exr", PRIMITIVES[:7], 2.0**power, *way, transform=transform
                        )
                        if not way:
                            (self.folder / "2.exr").replace(self.folder / "1.exr")
                            continue
                        self.assert_same_bits("1.exr", "2.exr")
                bits = channels((self.folder / "1.exr").read_bytes())["R"]
                met.append(sum(red != FAR for red in bits) / len(bits))
            self.assertGreater(met[0], met[1])
            self.assertGreater(met[1], 0.02)
            self.assertEqual(met[2:], [0, 0])

    def test_below_extreme_transforms(self):
        """Below a large scale every ray of the world is short, and below a small one long."""
        for power in (1, -40, 40):
            ball = {"class": "Sphere", "center": [0, 0, 0], "radius": 0.9 * 2.0**-power}
            self.render(
                f"{power}.exr",
                [ball],
                1,
                transform={"scale": 2.0**power},
                mirrors=lambda primitive: False,
            )
            self.assert_same_bits("1.exr", f"{power}.exr")

    def test_where_hits_are_rejected(self):
        """`anyHit` sees the ray as it was sent, and the hit in its units."""
        shaders = """
        struct Passed { vec3 places; float factor; int count; };
        class Sieve : rt_Material {
          void anyHit(inout Passed passed) {
            vec3 direction = rt_RayDirection / passed.factor;
            float distance = rt_HitDistance * passed.factor;
            vec3 place = rt_RayOrigin + distance * direction;
            passed.places = 0.5 * passed.places + distance * place + direction + rt_GeometricNormal;
            passed.count = passed.count + 1;
            if (passed.count < 4)
              ignoreIntersection();
          }
          void closestHit(inout Passed passed) { passed.places += rt_HitPoint; }
        };
        class Probe : rt_RayGeneration {
          public float factor = 1.0;
          void generate() {
            Passed passed = Passed(vec3(0.25), factor, 0);
            vec3 direction = vec3(rt_ScreenCoord - vec2(0.5), -1.5);
            trace(vec3(0.1, 0.2, 3.0), factor * direction, 0.0, 8.0 / factor, passed);
            rt_SampleColor = color(passed.places.x, passed.places.y, passed.places.z);
          }
        };
        """
        self.write("shaders.rtsl", shaders)

        def render(power, *options):
            scene = {
                "rtsl": 1,
                "import": ["std.primitives", "shaders.rtsl"],
                "rayGeneration": {"class": "Probe", "factor": 2.0**power},
                "objects": [
                    {"primitive": one, "material": {"class": "Sieve"}} for one in PRIMITIVES[:7]
                ],
                "render": {"engine": "programs", "size": [24, 16], "spp": 1},
            }
            self.write("scene.json", json.dumps(scene))
            self.run_rtslc("render", "scene.json", "-o", f"{power}.exr", "-q", "-O0", *options)

        render(0)
        bits = channels((self.folder / "0.exr").read_bytes())["R"]
        self.assertGreater(len(set(bits)), 100)
        for power in (67, -67):
            for way in ((), ("--traversal=device",), ("--target=host-megakernel",)):
                with self.subTest(power=power, way=way):
                    render(power, *way)
                    self.assert_same_bits("0.exr", f"{power}.exr")

    def test_towards_far_light(self):
        """Points are lit by places of a surface that shines, by rays as long as it is far away."""
        pictures = []
        for far in (1e8, 1e11, 1e15):
            scene = {
                "rtsl": 1,
                "import": ["std"],
                "camera": {
                    "class": "PerspectiveCamera",
                    "constructor": [[0, 2, 6], [0, 0, 0], [0, 1, 0]],
                },
                "objects": [
                    {
                        "primitive": {"class": "Box", "low": [-4, -1, -4], "high": [4, 0, 4]},
                        "material": {"class": "Lambert"},
                    },
                    {
                        "primitive": {
                            "class": "Sphere",
                            "center": [3 * far, 4 * far, 3 * far],
                            "radius": 0.5 * far,
                        },
                        "material": {"class": "Emitter", "radiance": 30},
                    },
                ],
                "background": [0, 0, 0],
                "render": {"engine": "path", "size": [12, 8], "spp": 16},
            }
            self.write("scene.json", json.dumps(scene))
            self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", "-O0")
            bits = channels((self.folder / "a.exr").read_bytes())["R"]
            red = struct.unpack(f"<{len(bits)}f", struct.pack(f"<{len(bits)}I", *bits))
            pictures.append(sum(red) / len(red))
        self.assertGreater(pictures[0], 0.05)
        for other in pictures[1:]:
            self.assertAlmostEqual(other, pictures[0], delta=1e-3 * pictures[0])


if __name__ == "__main__":
    unittest.main()
