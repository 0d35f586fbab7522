"""--fp=double: what is folded, and what the scene sets, is computed in double; --keep changes no
picture."""

import json
import unittest

from harness import EXAMPLES, Case, deep

SHADERS = """
const float thickness = 1.0e-6;
const float folded = (1.0 - exp(-thickness)) / thickness;

float meanTransmittance(float tau) { return (1.0 - exp(-tau)) / tau; }

class Eye : rt_Camera {
  void generateRay() { rt_RayOrigin = vec3(0.0); rt_RayDirection = vec3(rt_ScreenCoord - 0.5, 1.0); }
};

// A medium so thin that single precision loses it. The table has to be in memory, where the index is not known.
class Thin : rt_Miss {
  public float tau = 1.0;
  public int index = 0;
  public float table[4] = float[](0.1, 0.3, 0.7, 0.9);

  void miss() {
    float parts[4] = float[](table[0] / 3.0, table[1] / 3.0, table[2] / 3.0, table[3] / 3.0);
    print((1.0 - exp(-tau)) / tau, meanTransmittance(tau), folded);
    rt_SampleColor = color((1.0 - exp(-tau)) / tau, parts[index] * 3.0, folded);
  }
};
"""

SCENE = {
    "rtsl": 1,
    "import": ["thin.rtsl"],
    "camera": {"class": "Eye"},
    "background": {"class": "Thin", "tau": 1e-6, "index": 2},
    "objects": [],
    "render": {"size": [4, 3], "spp": 2},
}
ITEMS = [
    "classes",
    "methods",
    "states",
    "dispatch",
    "outputs",
    "attributes",
    "parameters",
    "buffers",
    "images",
    "bindless",
    "lights",
    "transforms",
    "roots",
    "counts",
    "selectors",
    "motion",
    "masks",
    "back-faces",
    "events",
    "meshes",
    "mesh-attributes",
    "all",
]


class Double(Case):
    def setUp(self):
        super().setUp()
        self.write("thin.rtsl", SHADERS)
        self.write("scene.json", json.dumps(SCENE))

    def picture(self, scene, *options):
        self.run_rtslc(
            "render", scene, "-o", "picture.exr", "--size", "24x14", "--spp", "1", *options
        )
        return (self.folder / "picture.exr").read_bytes()

    def test_nothing_is_folded_in_single_precision(self):
        out, _ = self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "a.exr",
            "--fp=double",
            "--quiet",
            "--print",
            "--spp",
            "1",
            "--size",
            "1x1",
        )
        numbers = [float(word) for word in out.split()[-3:]]
        for number in numbers:  # what the scene sets, the same in a function, and a constant
            self.assertAlmostEqual(number, 0.9999995, delta=6e-8)

    @deep
    def test_keeping_changes_no_picture(self):
        self.level = "-O0"  # what is kept is decided before machine code is optimised
        scenes = ("scene.json", EXAMPLES / "glass" / "scene.json")
        pairs = [(scene, mode) for mode in ("strict", "double") for scene in scenes]
        for number, (scene, mode) in enumerate(pairs):
            expected = self.picture(scene, f"--fp={mode}")
            for item in ITEMS[number % 3 :: 3]:  # each in one pair at least
                with self.subTest(scene=str(scene), mode=mode, item=item):
                    self.assertEqual(
                        self.picture(scene, f"--fp={mode}", f"--keep={item}"), expected
                    )

    def test_what_is_kept_moves_roundings_alone_in_fast_mode(self):
        expected = EXAMPLES / "glass" / "scene.json"
        self.picture(expected, "--fp=fast")
        (self.folder / "picture.exr").rename(self.folder / "fast.exr")
        self.picture(expected, "--fp=fast", "--keep=all")
        self.run_rtslc(
            "compare", "fast.exr", "picture.exr", "--metric", "rmse", "--threshold", "1e-3"
        )


if __name__ == "__main__":
    unittest.main()
