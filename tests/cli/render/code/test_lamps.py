"""The lamps of a small scene, whose table is in its code: which of them have parts."""

import json
import unittest

from exr_files import channels
from harness import Case

SHADERS = """
import std.sampling;
class Balls : rt_Primitive { // in a row
  void intersect() {
    vec3 from = rt_RayOrigin - vec3(0.9 * float(rt_PrimitiveIndex), 0.0, 0.0);
    float a = dot(rt_RayDirection, rt_RayDirection), b = dot(from, rt_RayDirection);
    float square = b * b - a * (dot(from, from) - 0.09);
    if (square > 0.0)
      hit((-b - sqrt(square)) / a);
  }
  void computeBounds() {
    vec3 middle = vec3(0.9 * float(rt_PrimitiveIndex), 0.0, 0.0);
    rt_BoundMin = middle - vec3(0.3);
    rt_BoundMax = middle + vec3(0.3);
  }
  void computeNormal() {
    rt_GeometricNormal = rt_HitPoint - vec3(0.9 * float(rt_PrimitiveIndex), 0.0, 0.0);
  }
  void generateSample() {
    rt_GeometricNormal = sampleSphere(vec2(rand(), rand()));
    rt_HitPoint = vec3(0.9 * float(rt_PrimitiveIndex), 0.0, 0.0) + 0.3 * rt_GeometricNormal;
    rt_PDF = 1.0 / (4.0 * 3.1415927 * 0.09);
  }
  void samplePDF() { rt_PDF = 1.0 / (4.0 * 3.1415927 * 0.09); }
};
"""

BALL = {"class": "Sphere", "center": [-2, 2, 0], "radius": 0.5}
SQUARE = {"class": "Parallelogram", "constructor": [[1, 2, -1], [1, 0, 0], [0, 0.5, 1]]}
FLOOR = {"class": "Parallelogram", "constructor": [[-4, 0, -4], [0, 0, 8], [8, 0, 0]]}
TURNED = {"rotate": [0, 30, 70], "scale": [1, 2, 0.5], "translate": [1, 0.5, 0]}
MOVING = {"keys": [{"translate": [0, 0, 0]}, {"translate": [1, 0.5, 0]}]}


def lamp(geometry, **more):
    return {**geometry, "material": "glow", **more}


BALL_LAMP, SQUARE_LAMP = (lamp({"primitive": shape}) for shape in (BALL, SQUARE))
MESH_LAMP = lamp({"mesh": "wedge.obj"})
MESH_CLAY = {**MESH_LAMP, "material": "clay"}
SEVERAL = lamp({"primitive": {"class": "Balls"}}, count=3)

# Lamps, and whether each is one primitive.
KINDS = {
    "one primitive": ([BALL_LAMP], True),
    "two primitives": ([BALL_LAMP, SQUARE_LAMP], True),
    "turned and moving ones": (
        [{**BALL_LAMP, "transform": TURNED}, {**SQUARE_LAMP, "transform": MOVING}],
        True,
    ),
    "primitives beside a mesh": ([MESH_CLAY, BALL_LAMP, SQUARE_LAMP], True),
    "a mesh": ([MESH_LAMP], False),
    "a primitive and a mesh": ([SQUARE_LAMP, {**MESH_LAMP, "transform": TURNED}], False),
    "several primitives in one object": ([SEVERAL], False),
    "these and others": ([BALL_LAMP, SEVERAL, {**SEVERAL, "transform": TURNED}], False),
}


class Lamps(Case):
    def scene(self, lamps):
        self.write("Balls.rtsl", SHADERS)
        self.write(
            "wedge.obj",
            "v -1 1.2 0\nv 0 1.2 0\nv -0.5 2 0\nv -0.5 1.5 1\nf 1 2 3\nf 1 4 2\nf 2 4 3\n",
        )
        nodes = {f"lamp{number}": one for number, one in enumerate(lamps)}
        nodes["floor"] = {"primitive": FLOOR, "material": "clay"}
        nodes["all"] = {"children": sorted(nodes)}
        scene = {
            "rtsl": 1,
            "import": ["std", "Balls.rtsl"],
            "camera": {
                "class": "PerspectiveCamera",
                "constructor": {"eye": [0, 3, 8], "target": [0, 1, 0], "up": [0, 1, 0]},
                "fieldOfView": 50,
            },
            "materials": {
                "clay": {"class": "Lambert", "reflectance": 0.7},
                "glow": {"class": "Emitter", "radiance": [9, 3, 1], "isTwoSided": True},
            },
            "nodes": nodes,
            "root": "all",
            "render": {"engine": "path", "size": [16, 12], "spp": 8, "depth": 4},
        }
        self.write("scene.json", json.dumps(scene))

    def test_pictures_do_not_depend_on_what_is_known_of_lamps(self):
        for number, (kind, (lamps, are_whole)) in enumerate(KINDS.items()):
            with self.subTest(kind):
                self.scene(lamps)
                code, _ = self.run_rtslc("compile", "scene.json", "--emit=ssa")
                self.assertIn("rtsl.emitters = ", code)
                self.assertEqual("rtsl.whole_emitters" in code, are_whole)
                for way in ([], ["--trace=split"] if number % 2 else ["--target=host-megakernel"]):
                    self.run_rtslc("render", "scene.json", "-o", "known.exr", "-q", *way)
                    self.run_rtslc(
                        "render", "scene.json", "-o", "kept.exr", "-q", "--keep=lights", *way
                    )
                    self.assert_same_bits("known.exr", "kept.exr", way)
                lit = channels((self.folder / "known.exr").read_bytes())["G"]
                self.assertGreater(sum(value != 0 for value in lit), len(lit) // 4)


if __name__ == "__main__":
    unittest.main()
