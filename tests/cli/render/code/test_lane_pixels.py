"""Short shaders, of which a lane renders whole pixels: it adds the samples itself, and the sums are
those of lanes that take samples."""

import json
import unittest

from harness import Case

LANES = "--target=host-megakernel"

# A picture without rays, in which one sample in eight is bad, and all of a column.
SHADER = """
class Speckles : rt_RayGeneration {
  public float zero = 0.0;

  void generate() {
    color c = color(rand(), rt_ScreenCoord.x, rt_ScreenCoord.y * rand());
    if (rand() < 0.125 || rt_LaunchIndex.x == 7u)
      c = c / color(zero);
    rt_SampleColor = c;
  }
};
"""


class LanePixels(Case):
    def setUp(self):
        super().setUp()
        self.write("Speckles.rtsl", SHADER)
        scene = {
            "rtsl": 1,
            "import": ["Speckles.rtsl"],
            "rayGeneration": {"class": "Speckles"},
            "render": {"engine": "programs", "size": [43, 29]},  # not whole tiles
        }
        self.write("scene.json", json.dumps(scene))

    def render(self, name, *options):
        arguments = ("scene.json", "-o", name, "--json", "-Wno-not-finite")
        counts = json.loads(self.run_rtslc("render", *arguments, *options)[0])
        return {
            key: counts[key]
            for key in ("samples", "samplesNotFinite", "pixelsWithoutSample", "notFinite")
        }

    def compare(self, *options):
        counts = self.render("one.exr", *options)
        self.assertEqual(counts, self.render("other.exr", LANES, *options))
        self.assert_same_bits("one.exr", "other.exr")
        return counts

    def test_that_lanes_take_pixels(self):
        out, _ = self.run_rtslc("explain", "scene.json", "--gpu", "--json")
        self.assertEqual(json.loads(out)["maxRegisters"], 64)  # of no others

    def test_sums_and_counts(self):
        for options in (
            ("--spp=1",),
            ("--spp=7",),
            ("--spp=9", "--threads=1", "-O0"),
            ("--spp=5", "--crop=3,4,20,11"),
            ("--spp=6", "--color=spectral:5"),
        ):
            with self.subTest(options=options):
                counts = self.compare(*options)
                self.assertGreater(counts["samplesNotFinite"], 0)
                self.assertGreater(counts["pixelsWithoutSample"], 0)

    def test_a_rendering_that_goes_on(self):
        self.render("one.exr", "--spp=11")
        for spp in (3, 4, 11):
            self.render("other.exr", LANES, f"--spp={spp}", "--checkpoint=a.ckpt")
        self.assert_same_bits("one.exr", "other.exr")

    def test_samples_in_two_halves(self):
        self.compare("--noise=0.2", "--spp=64")

    def test_fewer_pixels_than_lanes(self):
        self.compare("--size=2x1", "--spp=9")


if __name__ == "__main__":
    unittest.main()
