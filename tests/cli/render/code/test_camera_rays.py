"""A camera that leaves RayDirection zero sends no ray: the sample is black, in every engine and on
every path, and nothing is reported."""

import json
import unittest

import exr_files
from harness import Case

SHADERS = """
// No ray in the left half.
class Eye : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(2.0 * rt_ScreenCoord - vec2(1.0), 5.0);
    if (rt_ScreenCoord.x >= 0.5)
      rt_RayDirection = vec3(0.0, 0.0, -1.0);
  }
};

struct Seen { color light; };

class Own : rt_RayGeneration {
  void generate() {
    Seen seen;
    trace(rt_RayOrigin, rt_RayDirection, 0.0, 100.0, seen);
    rt_SampleColor = seen.light + color(0.25);
  }
};
class Sky : rt_Miss {
  void miss() { rt_SampleColor = color(1.0); }
  void miss(inout Seen seen) { seen.light = color(1.0); }
};
class Surface : rt_Material {
  void shade() { rt_SampleColor = color(1.0); }
  void closestHit(inout Seen seen) { seen.light = color(1.0); }
};
"""
HOST = "--target=host-megakernel"
WAYS = (
    ["--trace=split"],
    ["--traversal=device"],
    ["--exceptions"],
    ["--undefined=nan"],
    [HOST],
    [HOST, "--organisation=wavefront"],
    [HOST, "--organisation=persistent"],
)
ENGINES = ("path", "volume", "normals", "depth", "occlusion", "id", "albedo")
SIZE = 8


class CameraRays(Case):
    def scene(self, engine, material="Lambert", **camera):
        self.write("shaders.rtsl", SHADERS)
        scene = {
            "rtsl": 1,
            "import": ["shaders.rtsl", "std"],
            "camera": camera or {"class": "Eye"},
            "background": {"class": "Sky"},
            "objects": [
                {
                    "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 1.2},
                    "material": {"class": material},
                }
            ],
            "render": {"engine": engine, "size": [SIZE, SIZE], "spp": 2},
        }
        if engine == "programs":
            scene["rayGeneration"] = {"class": "Own"}
        self.write("scene.json", json.dumps(scene))

    def columns(self, *arguments):
        """The columns that are black all over."""
        out, error = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--json", *arguments)
        figures = json.loads(out)
        self.assertEqual((figures["badRays"], figures["samplesNotFinite"]), (0, 0))
        self.assertEqual(error, "")
        colors = exr_files.channels((self.folder / "a.exr").read_bytes())
        rows = [
            [any(colors[name][y * SIZE + x] for name in "RGB") for x in range(SIZE)]
            for y in range(SIZE)
        ]
        return [x for x in range(SIZE) if not any(row[x] for row in rows)]

    def test_every_engine(self):
        for engine in ENGINES:
            with self.subTest(engine=engine):
                self.scene(engine)
                self.assertEqual(self.columns("-O0"), [0, 1, 2, 3])

    def test_every_path(self):
        for engine in ("classic", "programs"):
            self.scene(engine, "Surface")
            for way in WAYS:
                with self.subTest(engine=engine, way=way):
                    self.assertEqual(self.columns("-O0", *way), [0, 1, 2, 3])

    def test_fisheye_pictures_are_black_outside_of_their_circle(self):
        view = [[0, 0, 5], [0, 0, 0], [0, 1, 0]]
        self.scene("classic", "Surface", **{"class": "FisheyeCamera", "constructor": view})
        wide = ["--set=render.size=[8,4]", "-O0"]
        out, error = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--json", *wide)
        self.assertEqual((json.loads(out)["badRays"], error), (0, ""))
        colors = exr_files.channels((self.folder / "a.exr").read_bytes())["R"]
        self.assertEqual([x for x in range(SIZE) if colors[SIZE + x]], [2, 3, 4, 5])

    def test_check_finds_the_classes_of_all_cameras(self):
        """Only those files of a module are read that are named, and a program has one camera."""
        self.scene("path")
        scene = json.loads((self.folder / "scene.json").read_text())
        view = [[0, 0, 5], [0, 0, 0], [0, 1, 0]]
        del scene["camera"]
        scene["cameras"] = {
            "front": {"class": "PerspectiveCamera", "constructor": view},
            "wide": {"class": "FisheyeCamera", "constructor": view},
        }
        self.write("scene.json", json.dumps(scene))
        self.assertEqual(self.run_rtslc("check", "scene.json"), ("", ""))
        self.write("scene.json", json.dumps(scene).replace("FisheyeCamera", "FisheyCamera"))
        self.assert_message(
            self.diagnose("check", "scene.json"), "E0810", "no class is named `FisheyCamera`"
        )

    def test_a_direction_that_is_no_number_is_still_a_bad_ray(self):
        self.scene("classic", "Surface")
        self.write("shaders.rtsl", SHADERS.replace("vec3(0.0, 0.0, -1.0)", "vec3(sqrt(-1.0))"))
        out, _ = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--json", "-O0")
        self.assertEqual(json.loads(out)["badRays"], SIZE * SIZE)


if __name__ == "__main__":
    unittest.main()
