"""`--exposure` and `--tone`: PNG pictures are what the functions of std.tonemapping would make of
the light, which EXR files keep."""

import json
import unittest

from harness import DIAGNOSED, USAGE, Case

RAMP = """import std.tonemapping;
class Ramp : rt_RayGeneration;
public float stops = 0.0;
public int curve = 0;
void generate() {
  vec2 at = vec2(rt_LaunchIndex.xy) / vec2(rt_LaunchSize.xy);
  color light = exposed(exp2(8.0 * at.x - 6.0) * color(1.0, at.y, 0.2), stops);
  rt_SampleColor = curve == 1 ? reinhard(light, 4.0) : curve == 2 ? filmic(light) : light;
}
"""


class Tones(Case):
    def setUp(self):
        super().setUp()
        self.write("Ramp.rtsl", RAMP)

    def ramp(self, output, *options, **members):
        scene = {
            "rtsl": 1,
            "import": ["Ramp.rtsl"],
            "rayGeneration": {"class": "Ramp", **members},
            "render": {"engine": "programs", "size": [64, 32], "spp": 2},
        }
        self.write("scene.json", json.dumps(scene))
        self.run_rtslc("render", "scene.json", "-q", "-o", output, *options)

    def test_they_are_those_of_the_library(self):
        self.ramp("plain.png")
        for curve, name in enumerate(("linear", "reinhard", "filmic")):
            for stops in (-1.5, 1):
                with self.subTest(name=name, stops=stops):
                    self.ramp("a.png", "--tone", name, "--exposure", str(stops))
                    self.ramp("b.png", curve=curve, stops=stops)
                    self.run_rtslc("compare", "a.png", "b.png", "--threshold=0.001")
                    self.run_rtslc(
                        "compare", "a.png", "plain.png", "--threshold=0.01", status=DIAGNOSED
                    )

    def test_packages_have_them_too(self):
        options = ["--tone=filmic", "--exposure=-1.5"]
        self.ramp("a.png", *options)
        self.run_rtslc("pack", "scene.json", "-o", "ramp.rtslpkg", "-q")
        run = ["ramp.rtslpkg", "--target=host", "-q"]
        self.run_package(*run, "-o", "b.png", *options)
        self.assert_same_bits("a.png", "b.png")
        for bad in (["-o", "a.exr", "--tone=filmic"], ["--out", "a=a.npy", "--exposure=1"]):
            _, error = self.run_package(*run, *bad, status=USAGE)
            self.assertIn(bad[-1].split("=")[0], error)

    def test_bad_values(self):
        for options in (
            ["--tone=aces"],
            ["--exposure=bright"],
            ["--exposure=inf"],
            ["--tone=filmic", "--format=exr"],
            ["--exposure=1", "-o", "a.exr"],
        ):
            with self.subTest(options=options):
                output = [] if "-o" in options else ["-o", "a.png"]
                _, error = self.run_rtslc("render", "Ramp.rtsl", *output, *options, status=USAGE)
                self.assertIn(options[0].split("=")[0], error)


if __name__ == "__main__":
    unittest.main()
