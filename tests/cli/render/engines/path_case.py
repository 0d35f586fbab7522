"""Scenes for tests of the engine `path`."""

import json
import pathlib

from harness import RTSLC, WAYS, Case

# A diffuse surface, without emission and evaluatePDF.
DIFFUSE = """\
  public float albedo = 0.5;
  public color glow = color(0.0);

  vec3 normal() { return faceforward(rt_GeometricNormal, rt_RayDirection, rt_GeometricNormal); }

  void BSDF() {
    rt_BSDFValue = color(dot(rt_LightDirection, normal()) > 0.0 ? albedo * 0.31830989 : 0.0);
  }
  void sampleBSDF() {
    vec3 n = normal();
    vec3 u = perpendicularTo(n);
    float r = sqrt(rt_BSDFSeed.x), a = 2.0 * rt_BSDFSeed.y;
    rt_LightDirection = r * cospi(a) * u + r * sinpi(a) * cross(n, u) + sqrt(1.0 - rt_BSDFSeed.x) * n;
    rt_PDF = dot(rt_LightDirection, n) * 0.31830989;
    rt_BSDFValue = color(albedo * 0.31830989);
  }
"""

SHADERS = """
// An author's material, with the sampling methods alone: a diffuse surface that may shine.
class Own : rt_Material {
// DIFFUSE
  void emission() { rt_EmissionColor = glow; }
  void evaluatePDF() { rt_PDF = max(dot(rt_LightDirection, normal()), 0.0) * 0.31830989; }
};
// The same in two classes, of which the first has no evaluatePDF. No ray is sent to light that this
// surface does not reflect, which must not show.
class Half : rt_Material {
// DIFFUSE
};
class Whole : Half {
  bool isTransmissive() { return false; }
  void emission() { rt_EmissionColor = glow; }
  void evaluatePDF() { rt_PDF = max(dot(rt_LightDirection, normal()), 0.0) * 0.31830989; }
};
// One that says nothing of directions, and one that lets no light through.
class Alone : rt_Material {
  public float albedo = 0.5;
  public color glow = color(0.0);
  void BSDF() {
    vec3 n = faceforward(rt_GeometricNormal, rt_RayDirection, rt_GeometricNormal);
    rt_BSDFValue = color(dot(rt_LightDirection, n) > 0.0 ? albedo * 0.31830989 : 0.0);
  }
  void emission() { rt_EmissionColor = glow; }
};
class AloneOpaque : Alone {
  bool isTransmissive() { return false; }
};
// Ones whose methods do not count, because the first class decides.
class AloneSampled : Alone {
  void sampleBSDF() { rt_BSDFValue = color(0.0); }
};
class AloneTwice : AloneSampled {};
// A mirror that has no more than it needs.
class Mirror : rt_Material {
  void sampleBSDF() {
    rt_LightDirection = reflect(normalize(rt_RayDirection), normalize(rt_GeometricNormal));
    rt_BSDFValue = color(1.0);
    rt_PDF = -1.0;
  }
};
// A diffuse surface without evaluatePDF.
class Blind : rt_Material {
  void sampleBSDF() {
    vec3 n = faceforward(rt_GeometricNormal, rt_RayDirection, rt_GeometricNormal);
    vec3 u = perpendicularTo(n);
    float r = sqrt(rt_BSDFSeed.x), a = 2.0 * rt_BSDFSeed.y;
    rt_LightDirection = r * cospi(a) * u + r * sinpi(a) * cross(n, u) + sqrt(1.0 - rt_BSDFSeed.x) * n;
    rt_PDF = dot(rt_LightDirection, n) * 0.31830989;
    rt_BSDFValue = color(0.5 * 0.31830989);
  }
};
class Shines : rt_Material {
  void emission() { rt_EmissionColor = color(0.75); }
};
class Shaded : rt_Material {
  void shade() { rt_SampleColor = color(0.25) + 0.5 * trace(rt_HitPoint, reflect(rt_RayDirection, rt_GeometricNormal)); }
};
class ShinesMore : Shines {
  void BSDF() { rt_BSDFValue = color(0.3); }
};
class ShadedMore : Shaded {
  void BSDF() { rt_BSDFValue = color(0.3); }
};
class Inside : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.1, 0.2, 0.3);
    rt_RayDirection = vec3(2.0 * rt_ScreenCoord - vec2(1.0), 1.0);
  }
};
class Under : rt_Camera { // close to the floor, below lamps
  void generateRay() {
    rt_RayOrigin = vec3(0.0, 0.5, 0.0);
    rt_RayDirection = vec3(0.02 * rt_ScreenCoord.x - 0.01, -1.0, 0.02 * rt_ScreenCoord.y - 0.01);
  }
};
class Down : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0, 5.0, 0.0);
    rt_RayDirection = vec3(0.02 * rt_ScreenCoord.x - 0.01, -1.0, 0.02 * rt_ScreenCoord.y - 0.01);
  }
};
""".replace(
    "// DIFFUSE\n", DIFFUSE
)

BALL = {"class": "Sphere", "center": [0, 0, 0], "radius": 2}
FLOOR = {"class": "Parallelogram", "constructor": [[-1000, 0, -1000], [0, 0, 2000], [2000, 0, 0]]}


class PathCase(Case):
    def setUp(self):
        super().setUp()
        self.write("shaders.rtsl", SHADERS)

    def scene(self, objects, camera="Inside", spp=64, depth=64, size=(16, 16), **rest):
        # Pictures do not depend on the level of optimisation: without it, few samples take less
        # time in all.
        self.level = "-O0" if spp * size[0] * size[1] <= 1 << 14 else "-O2"
        listed = [{"primitive": primitive, "material": material} for primitive, material in objects]
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["std.primitives", "std.materials", "std.lights", "shaders.rtsl"],
                    "camera": {"class": camera},
                    "objects": listed,
                    **rest,
                    "render": {"engine": "path", "size": size, "spp": spp, "depth": depth},
                }
            ),
        )

    def write_plain_tracer(self):
        """PathTracer.rtsl, which finds directions by the materials alone."""
        source = (
            pathlib.Path(RTSLC).parent.parent / "share/rtslc/library/std/engines/PathTracer.rtsl"
        ).read_text()
        plain = source.replace("if (illuminate(rt_HitPoint, pathSide()))", "if (false)").replace(
            "pathShare(path, path.density, rt_PDF)", "1.0"
        )
        self.assertEqual(len(plain.split("if (false)")), 2)
        self.write("PathTracer.rtsl", plain)

    def mean(self, *arguments):
        """Of red, green and blue."""
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", self.level, *arguments)
        out, _ = self.run_rtslc("compare", "a.exr", "a.exr", "--json")
        return json.loads(out)["means"][0]

    def assert_gray(self, expected, relative, *arguments):
        for component in self.mean(*arguments):
            self.assertAlmostEqual(component, expected, delta=relative * expected)
