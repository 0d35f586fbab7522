"""Local variables that stay alive over `trace` need stack for each ray that is under way: it is
there, or refused with its size."""

import json
import resource
import unittest

from harness import DIAGNOSED, Case, deep

MIB = 1 << 20

SHADERS = """
struct Path {{ float light; }};

class Eye : rt_Camera {{
  void generateRay() {{
    float w[{eye}];
    for (int i = 0; i < {eye}; i += 1024)
      w[i] = rand();
    rt_RayOrigin = vec3(0.0, 0.0, 0.01 * w[int(rand() * 64.0) * 1024]);
    rt_RayDirection = vec3(rt_ScreenCoord - vec2(0.5), 1.0);
  }}
}};

// The ball is around the eye: no ray misses it.
class Wide : rt_Material {{
  private float made = 0.0;
  void constructor(float start) {{
    float w[{made}];
    w[int(start)] = 1.0;
    for (int i = 0; i < {made}; i += 1024)
      made = made + w[i];
  }}
  void shade() {{
    float w[{shade}];
    for (int i = 0; i < {shade}; i += 1024)
      w[i] = rand();
    color c = trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal));
    float s = 0.0;
    for (int i = 0; i < {shade}; i += 1024)
      s += w[i];
    rt_SampleColor = 0.5 * c + color(made + s);
  }}
}};

class Ball : rt_Primitive {{
  void computeBounds() {{
    float w[{bounds}];
    w[int(rt_BoundMin.x)] = 2.0;
    float r = 0.0;
    for (int i = 0; i < {bounds}; i += 1024)
      r += w[i];
    rt_BoundMin = vec3(-2.0);
    rt_BoundMax = vec3(max(r, 2.0));
  }}
  void intersect() {{
    float w[{intersect}];
    for (int i = 0; i < {intersect}; i += 1024)
      w[i] = rt_RayOrigin.x;
    float b = dot(rt_RayOrigin, rt_RayDirection), a = dot(rt_RayDirection, rt_RayDirection);
    float q = sqrt(max(b * b - a * (dot(rt_RayOrigin, rt_RayOrigin) - 4.0), 0.0));
    if (!hit((-b - q) / a) && w[0] == rt_RayOrigin.x)
      hit((-b + q) / a);
  }}
  void computeNormal() {{ rt_GeometricNormal = rt_HitPoint; }}
}};
"""
SMALL = {"eye": 65536, "made": 1024, "shade": 1024, "bounds": 1024, "intersect": 1024}
FLOATS = MIB // 4
WAYS = (
    [],
    ["--threads", "1"],
    ["--traversal=device"],
    ["-O", "0"],
    ["--trace=split"],
    ["--target=host-megakernel"],
)


class Stack(Case):
    def scene(self, depth, **sizes):
        self.write("shaders.rtsl", SHADERS.format(**{**SMALL, **sizes}))
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["shaders.rtsl"],
                    "camera": {"class": "Eye"},
                    "objects": [
                        {
                            "primitive": {"class": "Ball"},
                            "material": {"class": "Wide", "constructor": [3]},
                        }
                    ],
                    "render": {"engine": "classic", "size": [3, 2], "spp": 1, "depth": depth},
                }
            ),
        )

    def render(self, picture, *arguments, **more):
        return self.run_rtslc(
            "render", "scene.json", "-o", picture, "-q", "-Wno-all", *arguments, **more
        )

    @deep
    def test_large_variables_and_deep_rays(self):
        for depth, sizes in (
            (8, {"shade": FLOATS}),
            (200, {"shade": FLOATS // 16}),
            (256, {"shade": FLOATS // 4}),
            (1, {"eye": 12 * FLOATS}),
            (1, {"intersect": 12 * FLOATS}),
            (1, {"made": 12 * FLOATS}),
            (1, {"bounds": 12 * FLOATS}),
            (3, {name: 6 * FLOATS for name in SMALL}),
        ):
            self.scene(depth, **sizes)
            for i, way in enumerate(WAYS):
                with self.subTest(depth=depth, sizes=sizes, way=way):
                    self.render(f"{i}.exr", *way)
                    self.run_rtslc("compare", "0.exr", f"{i}.exr")

    def test_packages(self):
        self.scene(8, shade=FLOATS, eye=12 * FLOATS, intersect=12 * FLOATS)
        self.render("a.exr", "--target=host-megakernel")
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q", "-Wno-all")
        self.run_package("x.rtslpkg", "--target=host", "-o", "b.exr", "--compare", "a.exr")

    def test_a_small_limit_of_the_shell_does_not_matter(self):
        def little_stack():
            resource.setrlimit(resource.RLIMIT_STACK, (512 << 10, 512 << 10))

        self.scene(8, shade=FLOATS)
        for way in WAYS:
            with self.subTest(way=way):
                self.render("a.exr", *way, prepare=little_stack)

    def test_what_cannot_be_had_is_refused_with_its_size(self):
        def little_memory():
            resource.setrlimit(resource.RLIMIT_AS, (2 << 30, 2 << 30))

        self.scene(256, shade=15 * FLOATS)
        _, error = self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "a.exr",
            "-q",
            "-Wno-all",
            status=DIAGNOSED,
            prepare=little_memory,
        )
        self.assertRegex(
            error,
            r"E1001\]: the rays of one sample take (38|39)\d\d\.\d MiB of stack, and there is not "
            r"enough memory: "
            "reduce the depth limit or the local variables of shaders",
        )
        self.assertNotIn("a.exr", self.files())


if __name__ == "__main__":
    unittest.main()
