"""What --keep keeps changes no picture, also where shaders could see it in the state of a ray."""

import json
import unittest

from exr_files import channels
from harness import Case

SHADERS = """
class Above : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(4.0 * rt_ScreenCoord - vec2(2.0), 5.0);
    rt_RayDirection = vec3(0.0, 0.0, -1.0);
  }
};
class Glow : rt_Material { // shows how rt_PDF begins, and the last light, though it is hidden
  void emission() { rt_EmissionColor = color(1.0); }
  void shade() {
    illuminate(0, rt_HitPoint);
    rt_SampleColor = color(0.5 + 0.25 * rt_PDF) + rt_LightColor;
  }
};
class Sky : rt_Miss { // it can be chosen, but nothing chooses
  void miss() { rt_SampleColor = color(0.125 + rt_PDF); }
  void sampleDirection() {
    rt_RayDirection = vec3(0.0, 0.0, 1.0);
    rt_SampleColor = color(0.125);
    rt_PDF = 1.0;
  }
  void directionPDF() { rt_PDF = 1.0; }
};
struct Sent {
  color seen;
};
class Layer : rt_Material {
  color look() { return color(0.25); }
  void shade() { rt_SampleColor = look(); }
};
class Choosing : Layer { // its `look` is not called
  color look() { return illuminate(rt_HitPoint) ? rt_LightColor : color(0.0); }
  void shade() { rt_SampleColor = color(0.75 + rt_PDF); }
  void closestHit(inout Sent sent) { // no ray carries one
    sent.seen = illuminate(rt_HitPoint) ? rt_LightColor : color(0.0);
  }
};
class Layered : rt_Material {
  public Layer layers[2];
  public optional Choosing other;
  color unused() { return illuminate(rt_HitPoint) ? rt_LightColor : color(0.0); }
  void shade() {
    rt_SampleColor = layers[rt_HitPoint.x < 0.0 ? 0 : 1].look() + color(rt_PDF);
    if (other)
      rt_SampleColor += other.look();
  }
};
// Nothing refers to the object of this class.
class Film : rt_Material {
  void shade() { rt_SampleColor = illuminate(rt_HitPoint) ? rt_LightColor : color(0.0); }
  void transmittance() { rt_SampleColor = color(0.5); }
};
// These have no objects.
class Unmade : Film {};
class Tracer : rt_RayGeneration {
  void generate() {
    Sent sent = Sent(color(0.0));
    trace(rt_RayOrigin, rt_RayDirection, 0.0, 100.0, sent);
    rt_SampleColor = sent.seen;
  }
};
"""

ITEMS = (
    "objects classes methods states dispatch outputs attributes parameters buffers images bindless "
    "lights transforms roots counts selectors motion masks back-faces tree events meshes "
    "mesh-attributes all"
).split()


def square(x, y, material, z=0):
    shape = [[x, y, z], [1.5, 0, 0], [0, 1.5, 0]]
    return {
        "primitive": {"class": "Parallelogram", "constructor": shape},
        "material": material,
    }


class Kept(Case):
    def setUp(self):
        super().setUp()
        self.write("shaders.rtsl", SHADERS)
        self.scene = {
            "rtsl": 1,
            "import": ["shaders.rtsl", "std.primitives", "std.lights"],
            "camera": {"class": "Above"},
            "background": {"class": "Sky"},
            "lights": [{"class": "PointLight", "position": [0, 0, 9], "intensity": [9, 6, 3]}],
            "materials": {
                "plain": {"class": "Layer"},
                "choosing": {"class": "Choosing"},
                "unused": {"class": "Film"},
            },
            "objects": [
                square(-1.8, -1.8, {"class": "Glow"}),
                square(0.2, -1.8, "choosing"),
                square(-1.8, 0.2, {"class": "Layered", "layers": ["plain", "plain"]}),
                square(-9, -9, {"class": "Layer"}, z=8),
            ],
            "render": {"size": [12, 12], "spp": 1, "depth": 2, "seed": 1},
        }
        # A lid between the light and everything that the camera sees.
        self.scene["objects"][-1]["primitive"]["constructor"] = [
            [-9, -9, 8],
            [18, 0, 0],
            [0, 18, 0],
        ]

    def picture(self, name, *arguments):
        self.write("scene.json", json.dumps(self.scene))
        self.run_rtslc("render", "scene.json", "-o", name, "-q", *arguments)
        return self.folder / name

    def test_no_item_changes_the_picture(self):
        for trace in ("recurse", "split"):
            self.picture("plain.exr", f"--trace={trace}")
            for item in ITEMS:
                with self.subTest(trace=trace, item=item):
                    self.picture("kept.exr", f"--trace={trace}", f"--keep={item}")
                    self.assert_same_bits("plain.exr", "kept.exr", item)

    def test_the_picture_would_show_it(self):
        """With a surface that chooses lights, rt_PDF begins as the density; with a material that
        light passes, the light that does not arrive is black."""
        without = channels(self.picture("without.exr").read_bytes())
        self.scene["objects"][1]["material"] = "unused"
        self.assertNotEqual(channels(self.picture("with.exr").read_bytes()), without)


if __name__ == "__main__":
    unittest.main()
