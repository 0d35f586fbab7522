"""What ends recursion: the scene's depth limit, chance, the weight of a ray, or the depth that a
shader requests."""

import json
import unittest

from harness import EXAMPLES, Case

SHADERS = """
struct Path { color light; float weight; };

class Eye : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0);
    rt_RayDirection = vec3(rt_ScreenCoord - vec2(0.5), 1.0);
  }
};

class PathEye : rt_RayGeneration {
  void generate() {
    Path path = Path(color(0.0), 1.0);
    trace(vec3(0.0), vec3(rt_ScreenCoord - vec2(0.5), 1.0), 0.0, 1e30, path);
    rt_SampleColor = path.light;
  }
};

// The ball is around the eye: no ray misses it.
class Endless : rt_Material {
  void shade() { rt_SampleColor = 0.5 * trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal)) + color(0.5); }
};

class Roulette : rt_Material {
  void shade() {
    if (rand() < 0.25)
      rt_SampleColor = color(1.0);
    else
      rt_SampleColor = 0.75 * trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal));
  }
};

class Shallow : rt_Material {
  void shade() {
    rt_SampleColor = color(1.0);
    if (rt_Depth < 3)
      rt_SampleColor = 0.75 * trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal));
  }
};

class Fading : rt_Material {
  void closestHit(inout Path path) {
    path.weight *= 0.5;
    if (path.weight < 0.01)
      path.light = color(path.weight);
    else
      trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal), 0.0, 1e30, path);
  }
};
"""

WAYS = (
    ["--trace=recurse", "--traversal=device"],
    ["--trace=split", "--traversal=device"],
    ["--target=host-megakernel"],
)
ENDLESS = "each material of this scene sends another ray"


class DepthLimits(Case):
    def setUp(self):
        super().setUp()
        self.write("shaders.rtsl", SHADERS)

    def scene(self, material, depth):
        eye = (
            {"engine": "programs", "rayGeneration": {"class": "PathEye"}}
            if material == "Fading"
            else {"engine": "classic", "camera": {"class": "Eye"}}
        )
        scene = {
            "rtsl": 1,
            "import": ["shaders.rtsl", str(EXAMPLES / "glass" / "Sphere.rtsl")],
            "objects": [
                {
                    "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 2},
                    "material": {"class": material},
                }
            ],
            "render": {"engine": eye.pop("engine"), "size": [8, 8], "spp": 2, "depth": depth},
            **eye,
        }
        self.write("scene.json", json.dumps(scene))

    def overflows(self, material, depth):
        """How many of the 128 samples met the limit: the same on each way, with the same
        picture."""
        self.scene(material, depth)
        counts = []
        for i, way in enumerate(WAYS):
            out, error = self.run_rtslc(
                "render", "scene.json", "-o", f"{i}.exr", "--json", "--exceptions", *way
            )
            counts.append(json.loads(out).get("exceptions", {}).get("stackOverflow", 0))
            self.assertEqual(ENDLESS in error, material == "Endless", error)
            self.assert_same_bits("0.exr", f"{i}.exr")
        self.assertEqual(len(set(counts)), 1, counts)
        return counts[0]

    def explained(self, material, depth=8):
        self.scene(material, depth)
        return self.run_rtslc("explain", "--states", "scene.json")[0]

    def test_the_scene_limits_depth(self):
        self.assertEqual(self.overflows("Endless", 0), 128)
        self.assertEqual(self.overflows("Endless", 9), 128)
        self.assertEqual(self.overflows("Endless", 256), 128)
        text = self.explained("Endless", 9)
        self.assertIn("traces on every path: ends at the depth limit", text)
        self.assertRegex(
            text, r"stack: 10 levels of \d+ bytes for rays as deep as 9, more if that is larger"
        )

    def test_a_shader_that_always_traces_is_a_warning_at_compile_time(self):
        self.scene("Endless", 5)
        for command in (["compile", "--emit=ptx"], ["explain", "--states"]):
            _, error = self.run_rtslc(command[0], "scene.json", "-o", "out", *command[1:])
            self.assertIn(f"{ENDLESS} on every path: `Endless`", error)
            self.assertIn("warning[W2801]", error)
            self.assertIn("[-Wscene]", error)
        _, error = self.run_rtslc("compile", "scene.json", "-o", "out", "--emit=ptx", "-Wno-scene")
        self.assertEqual(error, "")

    def test_chance_limits_depth(self):
        self.assertEqual(self.overflows("Roulette", 200), 0)
        self.assertGreater(self.overflows("Roulette", 1), 0)
        self.assertIn("traces depending on rand()", self.explained("Roulette"))

    def test_the_weight_of_a_ray_limits_depth(self):
        self.assertEqual(self.overflows("Fading", 6), 0)
        self.assertEqual(self.overflows("Fading", 5), 128)
        text = self.explained("Fading")
        self.assertIn("traces depending on its payload", text)
        self.assertIn("recursion runs as a loop", text)
        self.assertIn("stack: 1 level of", text)  # that of `generate`

    def test_a_shader_limits_depth(self):
        self.assertEqual(self.overflows("Shallow", 3), 0)
        self.assertEqual(self.overflows("Shallow", 2), 128)
        self.assertIn("traces depending on rt_Depth", self.explained("Shallow"))


if __name__ == "__main__":
    unittest.main()
