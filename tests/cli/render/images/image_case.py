"""Scenes whose shaders print what they read from an image."""

import json
import random
import struct

from harness import Case, numbers_of

PROBES = """
class Probe2D : rt_RayGeneration {
  public sampler2D images[];
  public vec2 uv[];
  public vec2 dx[];
  public vec2 dy[];
  public float lod[];
  public ivec2 at[];
  void generate() {
    for (int number = 0; number < images.length(); ++number) {
      sampler2D image = images[number];
      print(image.size(), image.levels(), image.size(1));
      for (int i = 0; i < uv.length(); ++i)
        print(image.sample(uv[i]), image.sample(uv[i], lod[i]), image.sampleGrad(uv[i], dx[i], dy[i]),
              image.load(at[i]), image.load(at[i], 1));
    }
  }
};
class Probe3D : rt_RayGeneration {
  public sampler3D images[];
  public vec3 uvw[];
  public vec3 dx[];
  public float lod[];
  public ivec3 at[];
  void generate() {
    for (int number = 0; number < images.length(); ++number) {
      sampler3D image = images[number];
      print(image.size(), image.levels(), image.size(1));
      for (int i = 0; i < uvw.length(); ++i)
        print(image.sample(uvw[i]), image.sample(uvw[i], lod[i]), image.sampleGrad(uvw[i], dx[i], vec3(0.0)),
              image.load(at[i]), image.load(at[i], 1));
    }
  }
};
// A picture of its image.
class Show : rt_RayGeneration {
  public sampler2D image;
  public float lod = 0.0;
  void generate() {
    vec4 value = image.sample(3.0 * rt_ScreenCoord - 1.0) + image.sample(rt_ScreenCoord, lod) +
                 image.sampleGrad(rt_ScreenCoord, vec2(0.4 * rt_ScreenCoord.x, 0.1), vec2(0.0, 0.3));
    rt_SampleColor = color(value.r, value.g, value.b) * value.a;
  }
};
// Reads level 0 alone.
class Plain : rt_RayGeneration {
  public sampler2D image;
  void generate() {
    print(image.levels(), image.finest(rt_ScreenCoord));
  }
};
// Some channels of images.
class Channels : rt_RayGeneration {
  public sampler2D red;
  public sampler2D alpha;
  public sampler2D blueAndAlpha;
  public sampler2D greens[2];
  public sampler2D sizeOnly;
  public sampler2D redAndGreen;
  public sampler2D passed;
  public optional sampler2D missing;
  float redOf(sampler2D image, vec2 uv) { return image.sample(uv).r; }
  void generate() {
    vec2 uv = 3.0 * rt_ScreenCoord - 1.0;
    float lod = 4.0 * rt_ScreenCoord.x;
    ivec2 at = ivec2(rt_LaunchIndex.xy);
    vec4 value = 0.5 * blueAndAlpha.sample(uv, lod);
    rt_SampleColor =
        color(red.sample(uv).r + 2.0 * red.load(at, 1).x + 4.0 * alpha.sample(uv, lod).a,
              value.b + 2.0 * value.wz.x + 4.0 * redOf(passed, uv) + float(sizeOnly.size().x),
              greens[at.x & 1].sampleGrad(uv, vec2(0.1, 0.0), vec2(0.0, 0.4)).g +
                  2.0 * dot(redAndGreen.sample(uv).rg, vec2(1.0, 4.0)) +
                  (missing ? missing.sample(uv).b : 7.0));
  }
};
// Images by an index.
class Bindless : rt_RayGeneration {
  public sampler2D images[];
  public optional sampler2D missing;
  void generate() {
    for (int i = 0; i < images.length(); ++i)
      print(i, images[i].sample(vec2(0.5)).r);
    print(missing ? 1.0 : missing.sample(vec2(0.5)).r);
  }
};
"""


class ImageCase(Case):
    def setUp(self):
        super().setUp()
        self.write("probes.rtsl", PROBES)

    def scene(self, generation, shaders="probes.rtsl", **more):
        scene = {
            "rtsl": 1,
            "import": [shaders],
            "rayGeneration": generation,
            "render": {"engine": "programs", "size": [1, 1], "spp": 1},
        }
        scene.update(more)
        return self.write("scene.json", json.dumps(scene))

    def printed(self, *options):
        output, _ = self.run_rtslc("render", "scene.json", "--print", "-q", "-o", "x.exr", *options)
        return [numbers_of(line) for line in output.splitlines()]

    def check(self, cases, axes, seed=1, count=40, options=()):
        """Random lookups, some far outside of [0, 1], against oracles: a list of (oracle, image,
        tolerance), the latter as a part of the largest texel."""
        chance = random.Random(seed)
        single = lambda x: struct.unpack("<f", struct.pack("<f", x))[0]
        vector = lambda low, high: [single(chance.uniform(low, high)) for _ in range(axes)]
        p = [vector(-2.5, 3.5) if i % 3 else vector(0, 1) for i in range(count)]
        dx = [
            [single(c * 10 ** chance.uniform(-3, 1)) for c in vector(-1, 1)] for _ in range(count)
        ]
        dy = [
            [single(c * 10 ** chance.uniform(-3, 0)) for c in vector(-1, 1)] for _ in range(count)
        ]
        lod = [single(chance.uniform(-1, 6)) for _ in range(count)]
        at = [[chance.randrange(-2, 12) for _ in range(axes)] for _ in range(count)]
        generation = {
            "class": f"Probe{axes}D",
            "images": [image for _, image, _ in cases],
            "dx": dx,
            "lod": lod,
            "at": at,
        }
        generation["uv" if axes == 2 else "uvw"] = p
        if axes == 2:
            generation["dy"] = dy
        self.scene(generation)
        lines = iter(self.printed(*options))
        for oracle, image, tolerance in cases:
            one = min(1, len(oracle.sizes) - 1)
            self.assertEqual(
                next(lines),
                [*oracle.sizes[0][:axes], len(oracle.levels), *oracle.sizes[one][:axes]],
            )
            largest = max(abs(v) for texel in oracle.levels[0].values() for v in texel)
            for i in range(count):
                expected = [
                    *oracle.sample(p[i]),
                    *oracle.sample(p[i], lod[i]),
                    *oracle.sample_grad(p[i], dx[i], dy[i] if axes == 2 else [0.0] * 3),
                    *oracle.load(at[i]),
                    *oracle.load(at[i], 1),
                ]
                for j, (got, wanted) in enumerate(zip(next(lines), expected)):
                    self.assertAlmostEqual(
                        got,
                        wanted,
                        delta=tolerance * largest,
                        msg=(image, i, j // 4, p[i], dx[i], dy[i], lod[i]),
                    )
        self.assertIsNone(next(lines, None))

    def integers(self, width, height, channels, most, seed=0):
        chance = random.Random(seed)
        values = {
            (x, y): [chance.randrange(most + 1) for _ in range(channels)]
            for x in range(width)
            for y in range(height)
        }
        return lambda x, y: values[x, y]

    @staticmethod
    def as_color(values):
        """As a texel: grey is red, green and blue, and without alpha it is 1."""
        if len(values) <= 2:
            return (values[0],) * 3 + ((values[1],) if len(values) == 2 else (1.0,))
        return tuple(values) if len(values) == 4 else (*values, 1.0)

    # Files
