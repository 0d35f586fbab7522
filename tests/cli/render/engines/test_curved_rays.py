"""Media with a gradient of the index: curves that are known, and pictures through them."""

import json
import unittest
from math import log

from harness import Case
from numpy_files import read_npy

SHADERS = """
import std.media.IndexField;

// The squared index goes from 1 (above) to `below` within about `width` of the plane y = 0.
class Step : IndexField {
  public float width;
  public float below = 2.25;

  vec3 squaredGradient(vec3 p) {
    float e = exp(-abs(p.y) / width);
    return vec3(0.0, -0.5 * (below - 1.0) / width * e / ((1.0 + e) * (1.0 + e)), 0.0);
  }
  float longestStep(vec3 p, vec3 v) { return 0.5 * max(width, 0.5 * abs(p.y)) / max(abs(v.y), 1e-6); }
};

// Luneburg's lens, of squared index 2 - r^2.
class Lens : IndexField {
  vec3 squaredGradient(vec3 p) { return -p; }
};

// Rays from above or below, with the component x of their velocity from 0.1 to 0.9 of the index: the last y of the velocity,
// the estimated error, the steps.
class Snell : rt_RayGeneration {
  public IndexField field;
  public float from = 5.0;
  public float index = 1.0;
  public float tolerance = 1e-5;
  public out vec3 results[];

  void generate() {
    int i = int(rt_LaunchIndex.x);
    float x = 0.1 + 0.8 * (float(i) + 0.5) / float(results.length());
    CurvedRay ray = field.start(vec3(0.0, from, 0.0), vec3(x, -sign(from) * sqrt(1.0 - x * x), 0.0), index);
    int steps = 0;
    while (abs(ray.point.y) < 5.1 && steps < 100000) {
      field.advance(ray, tolerance, 1e-6);
      ++steps;
    }
    results[i] = vec3(ray.velocity.y, ray.error, float(steps));
  }
};

// Parallel rays into the lens: the distance at which they pass the point where they meet, and the estimated error.
class Focus : rt_RayGeneration {
  public IndexField field;
  public float tolerance = 1e-5;
  public out vec2 results[];

  void generate() {
    int i = int(rt_LaunchIndex.x);
    float x = 0.95 * (float(i) + 0.5) / float(results.length());
    CurvedRay ray = field.start(vec3(x, 0.0, -sqrt(1.0 - x * x)), vec3(0.0, 0.0, 1.0), 1.0);
    vec3 focus = vec3(0.0, 0.0, 1.0);
    float nearest = 9.0;
    for (int k = 0; k < 10000 && ray.point.z < 1.0 && ray.point.x > -0.1; ++k) {
      ray.step = min(ray.step, 0.02);
      vec3 from = ray.point;
      field.advance(ray, tolerance, 1e-6);
      vec3 chord = ray.point - from;
      float along = clamp(dot(focus - from, chord) / dot(chord, chord), 0.0, 1.0);
      nearest = min(nearest, distance(from + along * chord, focus));
    }
    results[i] = vec2(nearest, ray.error);
  }
};

// Rays that look down by a slope from 0.001 to 0.006: the lowest height.
class Turning : rt_RayGeneration {
  public IndexField field;
  public out float results[];

  void generate() {
    int i = int(rt_LaunchIndex.x);
    float slope = 0.001 + 0.005 * (float(i) + 0.5) / float(results.length());
    CurvedRay ray = field.start(vec3(0.0, 3.0, 0.0), vec3(0.0, -slope, -1.0), 1.0);
    for (int k = 0; k < 10000 && ray.velocity.y < 0.0; ++k)
      field.advance(ray, 1e-7, 1e-4);
    results[i] = ray.point.y;
  }
};
"""


class CurvedCase(Case):
    def run_rays(self, generation, field, count=16, **members):
        self.write("shaders.rtsl", SHADERS)
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["std.media", "shaders.rtsl"],
                    "helpers": {"field": field},
                    "rayGeneration": {"class": generation, "field": "field", **members},
                    "render": {"engine": "programs", "size": [count]},
                }
            ),
        )
        self.run_rtslc("run", "scene.json", "--out", "results=results.npy", "-q")
        shape, numbers = read_npy(self.folder / "results.npy")
        width = shape[1] if len(shape) > 1 else 1
        return [numbers[i : i + width] for i in range(0, len(numbers), width)]


class Curves(CurvedCase):
    def slopes(self, count):
        return [0.1 + 0.8 * (i + 0.5) / count for i in range(count)]

    def test_refraction_in_a_gradient_of_any_thickness(self):
        """Along the gradient only: the other component of the velocity stays constant, and the
        index determines the last one."""
        steps = []
        for width in (0.1, 1e-2, 1e-4):
            results = self.run_rays("Snell", {"class": "Step", "width": width})
            for x, (y, error, count) in zip(self.slopes(16), results):
                exact = -((2.25 - x * x) ** 0.5)
                self.assertAlmostEqual(y, exact, delta=1e-4, msg=(width, x))
                self.assertLess(error, 1e-3)
                self.assertLess(count, 1000)
            steps.append(max(count for _, _, count in results))
        self.assertLess(
            steps[-1], 20 * steps[0]
        )  # the logarithm of the thickness, not its reciprocal

    def test_total_reflection(self):
        """From the dense side a ray at a small angle comes back as steep as it went."""
        for width in (1e-2, 1e-4):
            results = self.run_rays(
                "Snell", {"class": "Step", "width": width}, **{"from": -5.0, "index": 1.5}
            )
            for x, (y, _, _) in zip(self.slopes(16), results):
                square = 2.25 * (1 - x * x)
                exact = (square - 1.25) ** 0.5 if square > 1.25 else -(square**0.5)
                if abs(square - 1.25) > 0.02:
                    self.assertAlmostEqual(y, exact, delta=2e-3, msg=(width, x))

    def test_a_lens(self):
        """All rays meet in a point, within the allowed error; a smaller tolerance reduces it."""
        largest = []
        for tolerance in (1e-2, 1e-4):
            results = self.run_rays("Focus", {"class": "Lens"}, tolerance=tolerance)
            for missed, error in results:
                self.assertLess(missed, 2 * error + 1e-4)
            largest.append(max(error for _, error in results))
        self.assertLess(largest[1], 0.5 * largest[0] + 1e-5)

    def test_where_a_ray_over_hot_ground_turns(self):
        """At an index equal to the cosine of the first angle:
        thickness * log(2 |difference| / slope^2)."""
        results = self.run_rays(
            "Turning", {"class": "LayeredAir", "thickness": 0.2, "difference": -3e-5}
        )
        for i, (height,) in enumerate(results):
            slope = 0.001 + 0.005 * (i + 0.5) / 16
            exact = 0.2 * log(2 * 3e-5 / slope**2)
            self.assertAlmostEqual(height, exact, delta=0.01, msg=slope)


class Pictures(CurvedCase):
    def scene(self, engine, **air):
        self.level = "-O0"
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
                        "std.engines",
                        "std.backgrounds",
                        "std.lights",
                    ],
                    "camera": {
                        "class": "PerspectiveCamera",
                        "constructor": [[0, 1.4, 0], [0, 1.2, -400], [0, 1, 0]],
                        "fieldOfView": 2,
                    },
                    "helpers": {"air": {"class": "LayeredAir", **air}},
                    "rayGeneration": {"class": "CurvedTracer", "field": "air", "reach": 2000},
                    "objects": [
                        {
                            "primitive": {
                                "class": "Box",
                                "low": [-900, -1, -3000],
                                "high": [900, 0, 9],
                            },
                            "material": {"class": "Lambert"},
                        },
                        {
                            "primitive": {
                                "class": "Box",
                                "low": [-2, 1, -520],
                                "high": [2, 3, -510],
                            },
                            "material": {"class": "Emitter", "radiance": [9, 0, 0]},
                        },
                    ],
                    "lights": [{"class": "DistantLight"}],
                    "background": {"class": "UniformSky"},
                    "render": {"engine": engine, "size": [24, 24], "spp": 4, "depth": 4},
                }
            ),
        )

    def render(self, name, *arguments):
        self.run_rtslc("render", "scene.json", "-o", name, "-q", *arguments)

    def test_without_a_gradient_it_is_the_classic_picture(self):
        self.scene("classic", difference=0)
        self.render("a.exr", "--seed", "1")
        self.scene("programs", difference=0)
        self.render("b.exr", "--seed", "1")
        out, _ = self.run_rtslc("compare", "a.exr", "b.exr", "--json", status=None)
        self.assertLess(json.loads(out)["pixelsThatDiffer"], 12)

    def test_a_mirage(self):
        """Ground far away shows the sky and the lamp a second time."""
        self.scene("programs", difference=0)
        self.render("a.exr")
        self.scene("programs", thickness=0.12)
        self.render("b.exr")
        means = []
        for name in ("a.exr", "b.exr"):
            out, _ = self.run_rtslc("compare", name, name, "--json")
            means.append(json.loads(out)["means"][0])
        self.assertGreater(means[1][0], 1.1 * means[0][0], means)

    def test_every_path_gives_the_same_bits(self):
        self.scene("programs")
        self.render("a.exr")
        for way in (
            ["--trace=split"],
            ["--traversal=device"],
            ["--target=host-megakernel"],
            ["--keep=all"],
            ["--threads", "1"],
        ):
            self.render("b.exr", *way)
            self.assert_same_bits("a.exr", "b.exr", way)


if __name__ == "__main__":
    unittest.main()
