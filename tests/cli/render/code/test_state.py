"""State of a ray that is never written: no picture depends on its value (docs/language.md,
state.holds)."""

import json
import unittest

from harness import Case, example_scenes

PATTERNS = ("leave", "bytes", "nan")
WAYS = {
    "recursion": ["--traversal=device"],
    "Embree": [],
    "states": ["--trace=split", "--traversal=device", "-O1"],
    "the GPU's program": ["--target=host-megakernel", "-O0"],
    "everything kept": ["--target=host-megakernel", "--keep=all", "-O0"],
    "keeping, in recursion": ["--keep=all", "--traversal=device", "-O1"],
    "double": ["--fp=double", "-O1"],
    "unoptimised": ["-O", "0", "--traversal=device"],
}
IN_EVERY_EXAMPLE = ("recursion", "Embree", "states")
IN_TURN = tuple(way for way in WAYS if way not in IN_EVERY_EXAMPLE)

CAMERA = """
class Eye : rt_Camera;
void generateRay() {
  rt_RayOrigin = vec3(4.0 * rt_ScreenCoord - 2.0, 5.0 + rt_du + rt_dv + rt_Epsilon + 1.0 / rt_HitDistance);
  rt_RayDirection = vec3(0.0, 0.0, -1.0);
}
"""

# A material whose helper calls that of another, and a background with an environment map.
SHADERS = """
class Ball : rt_Primitive {
  public vec3 center;
  void computeBounds() { rt_BoundMin = center - vec3(1.0); rt_BoundMax = center + vec3(1.0); }
  void intersect() {
    vec3 c = 0.5 * (rt_BoundMin + rt_BoundMax), f = rt_RayOrigin - c;
    float b = dot(f, rt_RayDirection), d = b * b - dot(rt_RayDirection, rt_RayDirection) * (dot(f, f) - 1.0);
    if (d > 0.0) hit((-b - sqrt(d)) / dot(rt_RayDirection, rt_RayDirection));
  }
  void computeNormal() { rt_GeometricNormal = rt_HitPoint - center; }
};
class Base : rt_Material {
  public color c = color(0.5);
  color eval() { return c; }
  void shade() { rt_SampleColor = c; }
};
class Coat : rt_Material {
  public Base below;
  color twice() { color a = below.eval(); return 2.0 * a; }
  void shade() { rt_SampleColor = twice(); }
};
class Map : rt_Texture {
  void lookup() { rt_TextureColor = color(rt_TextureUV.x, rt_TextureUV.y, rt_TextureUVW.z + rt_dPdu.x + rt_dtdv + rt_du); }
};
class Sky : rt_Miss {
  public rt_Texture map;
  public bool sets;
  void miss() {
    if (sets) rt_TextureUV = 0.125 * rt_RayOrigin.xy + vec2(0.5);
    rt_SampleColor = color(0.25) + map.lookup();
  }
};
"""

# Which pixel it is: read at any depth, by materials, a light and the background.
LAUNCH = """
class Mirror : rt_Material {
  float column() { return float(rt_LaunchIndex.x) / float(rt_LaunchSize.x); }
  void shade() {
    color light = color(column());
    illuminance (rt_HitPoint) light += rt_LightColor;
    rt_SampleColor = light + 0.5 * trace(rt_HitPoint, rt_ShadingNormal);
  }
};
class Row : rt_Light {
  void illumination() {
    rt_LightDirection = vec3(0.0, 1.0, 1.0);
    rt_LightColor = color(float(rt_LaunchIndex.y) / float(rt_LaunchSize.y));
  }
};
class Columns : rt_Miss {
  void miss() { rt_SampleColor = color(float(rt_LaunchIndex.x)); }
};
"""


class State(Case):
    def pictures_are_one(self, scene, *options, ways=tuple(WAYS), turn=None):
        """With every pattern; with a `turn`, each way has one of them beside `leave`, the next time
        the other. Gives the pairs of a way and a pattern."""
        first, rendered = None, set()
        for pattern in PATTERNS:
            for number, way in enumerate(ways):
                if turn is not None and pattern == PATTERNS[1 + (turn + number) % 2]:
                    continue
                arguments = WAYS[way]
                if pattern == "leave" and first and way != "double":
                    continue  # no more than a reference: this is how the other tests render
                rendered.add((way, pattern))
                name = f"{pattern} {way}.exr"
                with self.subTest(pattern=pattern, way=way, scene=str(scene)):
                    self.run_rtslc(
                        "render",
                        scene,
                        "-o",
                        name,
                        "-q",
                        f"--undefined={pattern}",
                        *arguments,
                        *options,
                    )
                    if way == "double":  # other roundings: against itself
                        reference = f"leave {way}.exr"
                    else:
                        reference = first = first or name
                    self.assert_same_bits(reference, name)
        return rendered

    def scene(self, sets):
        self.write("eye.rtsl", CAMERA)
        self.write("shaders.rtsl", SHADERS)
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["eye.rtsl", "shaders.rtsl"],
                    "camera": {"class": "Eye"},
                    "textures": {"map": {"class": "Map"}},
                    "objects": [
                        {
                            "primitive": {"class": "Ball", "center": [0, 0, 0]},
                            "material": {"class": "Coat", "below": {"class": "Base"}},
                        }
                    ],
                    "background": {"class": "Sky", "map": "map", "sets": sets},
                    "render": {"engine": "classic", "size": [16, 16], "spp": 1, "depth": 2},
                }
            ),
        )
        return "scene.json"

    def test_helpers_call_other_materials(self):
        self.pictures_are_one(self.scene(sets=False))

    def test_environment_maps_have_the_coordinates_that_miss_writes(self):
        self.pictures_are_one(self.scene(sets=True))

    def test_methods_for_any_ray_read_the_launch(self):
        self.write("eye.rtsl", CAMERA)
        self.write("shaders.rtsl", SHADERS)
        self.write("launch.rtsl", LAUNCH)
        balls = [[-0.8, 0, 0], [0.8, 0.3, 0.2]]
        for turn, reader in enumerate(("Mirror", "Row", "Columns")):
            scene = {
                "rtsl": 1,
                "import": ["eye.rtsl", "shaders.rtsl", "launch.rtsl", "std.materials"],
                "camera": {"class": "Eye"},
                "objects": [
                    {
                        "primitive": {"class": "Ball", "center": center},
                        "material": {"class": "Mirror" if reader == "Mirror" else "Conductor"},
                    }
                    for center in balls
                ],
                "render": {"engine": "classic", "size": [16, 16], "spp": 1, "depth": 3},
            }
            if reader == "Row":
                scene["lights"] = [{"class": "Row"}]
            if reader == "Columns":
                scene["background"] = {"class": "Columns"}
            self.write("scene.json", json.dumps(scene))
            with self.subTest(reader=reader):
                self.pictures_are_one("scene.json", turn=turn)

    def test_examples(self):
        """The ways that differ in how state is stored, in every example; the others in turn, two in
        each."""
        rendered = set()
        for turn, scene in enumerate(example_scenes(part=1, parts=3)):
            others = tuple(IN_TURN[(2 * turn + i) % len(IN_TURN)] for i in range(2))
            rendered |= self.pictures_are_one(
                scene, "--size", "48x27", "--spp", "1", ways=(*IN_EVERY_EXAMPLE, *others), turn=turn
            )
        self.assertLessEqual({(way, pattern) for way in WAYS for pattern in PATTERNS[1:]}, rendered)

    def test_states_are_printed(self):
        self.write("shaders.rtsl", SHADERS)
        mirror = (
            "class Mirror : Coat { void shade() {"
            " rt_SampleColor = trace(rt_HitPoint, rt_GeometricNormal) + twice(); } };"
        )
        self.write("mirror.rtsl", 'import "shaders.rtsl";\n' + mirror)
        out, _ = self.run_rtslc("compile", "mirror.rtsl", "--emit=cpp", "--trace=split")
        self.assertIn("enum class Step", out)


if __name__ == "__main__":
    unittest.main()
