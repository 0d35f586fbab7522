"""Methods that trace and are called through references: recursion of objects, with frames of its own on the machine."""

import json
import os
import subprocess
import unittest

from harness import EXAMPLES, Case

SHADERS = """
struct Light { color sum; float weights[3]; int count; };

class Eye : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0);
    rt_RayDirection = vec3(rt_ScreenCoord - vec2(0.5), 1.0);
  }
};

class Filter : rt_Texture {
  color follow(vec3 o, vec3 d, bool twice, inout Light light) {
    light.weights[light.count % 3] += 0.25;
    light.count += 1;
    return trace(o, d);
  }
  float size() { return 0.5; }
};

// Each tint asks the one inside of it, some twice and in a loop, and traces for itself in between.
class Tint : Filter {
  public Filter inner;
  public Filter others[2];
  public color tint = color(0.5, 0.7, 0.9);
  public int rounds = 1;
  color follow(vec3 o, vec3 d, bool twice, inout Light light) {
    color sum = color(0.0);
    for (int i = 0; i < rounds; ++i) {
      Light mine = light;
      float share = 1.0 / float(i + 2);
      color first = inner.follow(o, d + vec3(0.0, share, 0.0), !twice, mine);
      color own = twice && i == 0 ? trace(o, -d) : color(share);
      sum += tint * first * others[i % 2].follow(o, d, twice, light) + share * own * mine.weights[i % 3];
      light.sum += mine.sum + own;
      if (light.count > 40)
        break;
    }
    return sum + color(rand() * size());
  }
};

class Mirror : rt_Material {
  public Filter filter;
  void shade() {
    Light light = Light(color(0.0), float[](1.0, 2.0, 3.0), 0);
    vec3 d = reflect(rt_RayDirection, rt_ShadingNormal);
    color c = filter.follow(rt_HitPoint, d, rt_Depth < 2, light);
    rt_SampleColor = 0.5 * c + 0.1 * light.sum + color(float(light.count) * light.weights[1] * 0.001);
  }
};

class Sky : rt_Miss {
  public Filter filter;
  void miss() {
    rt_SampleColor = color(0.5) + 0.25 * vec3color(rt_RayDirection);
  }
  color vec3color(vec3 v) { vec3 n = normalize(v); return color(abs(n.x), abs(n.y), abs(n.z)); }
};
"""

WAYS = (["--trace=recurse", "--traversal=device"], ["--trace=split", "--traversal=device"], ["--target=host-megakernel"])


class CallFrames(Case):
    def setUp(self):
        super().setUp()
        self.write("shaders.rtsl", SHADERS)

    def scene(self, chain, depth=3, rounds=2, branches=True):
        """Tints in a chain of this length, the last with a filter that only traces inside."""
        textures = {"t0": {"class": "Filter"}}
        for i in range(1, chain + 1):
            textures[f"t{i}"] = {"class": "Tint", "inner": f"t{i - 1}", "others": [f"t{max(i - 2, 0)}" if branches else "t0", "t0"],
                                 "rounds": rounds}
        scene = {"rtsl": 1, "import": ["shaders.rtsl", str(EXAMPLES / "glass" / "Sphere.rtsl")],
                 "camera": {"class": "Eye"}, "textures": textures,
                 "materials": {"mirror": {"class": "Mirror", "filter": f"t{chain}"}},
                 "objects": [{"primitive": {"class": "Sphere", "center": [0, 0, 4], "radius": 2}, "material": "mirror"},
                             {"primitive": {"class": "Sphere", "center": [3, 2, 0], "radius": 1}, "material": "mirror"}],
                 "background": {"class": "Sky", "filter": "t0"},
                 "render": {"engine": "classic", "size": [8, 8], "spp": 1, "depth": depth}}
        self.write("scene.json", json.dumps(scene))

    def test_engines_agree(self):
        for chain, depth in ((0, 2), (3, 2), (4, 1)):
            self.scene(chain, depth)
            for i, way in enumerate(WAYS):
                self.run_rtslc("render", "scene.json", "-o", f"{i}.exr", *way)
                self.run_rtslc("compare", "0.exr", f"{i}.exr", "--threshold", "0")

    def test_a_long_chain(self):
        self.scene(40, 0, rounds=1, branches=False)
        for i, way in enumerate(WAYS):
            self.run_rtslc("render", "scene.json", "-o", f"{i}.exr", *way)
            self.run_rtslc("compare", "0.exr", f"{i}.exr", "--threshold", "0")

    def test_a_package_holds_them(self):
        self.scene(3, 2)
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg")
        self.run_rtslc("render", "scene.json", "-o", "0.exr", "--target=host-megakernel")
        subprocess.run([os.environ["RTSL_RUN"], "x.rtslpkg", "-o", "1.exr", "--target=host"], cwd=self.folder, check=True)
        self.run_rtslc("compare", "0.exr", "1.exr", "--threshold", "0")

    def test_the_bound_of_the_stack_counts_them(self):
        self.scene(3, 2)
        text, _ = self.run_rtslc("explain", "--states", "scene.json")
        self.assertIn("call of dispatch.Filter.follow at shaders.rtsl:", text)
        self.assertRegex(text, r"stack: \d+ bytes more a level for each object in the scene's longest chain of references")
        report = json.loads(self.run_rtslc("explain", "--states", "--json", "scene.json")[0])
        [filter_] = [function for function in report["functions"] if function["name"] == "dispatch.Filter.follow"]
        self.assertEqual(report["stack"]["levelBytesAReference"], (filter_["frameSize"] + 7) // 8 * 8)
        self.assertEqual({trace.get("callee") for trace in filter_["traces"]}, {None, "dispatch.Filter.follow"})

    def test_cpp_is_printed_with_calls(self):
        text, _ = self.run_rtslc("compile", "shaders.rtsl", "--emit=cpp")
        self.assertRegex(text, r"Color follow\(State &rt, .*\) const override")
        self.assertNotIn("enum class Step", text)
        _, error = self.run_rtslc("compile", "shaders.rtsl", "--emit=cpp", "--trace=split", "-o", "x.cpp", status=1)
        self.assertIn("called through a reference, in C++ with states, is not supported yet", error)


if __name__ == "__main__":
    unittest.main()
