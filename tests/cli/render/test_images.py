"""Images: sampler2D and sampler3D against an oracle in double precision, on every path, and image
files that are wrong."""

import json
import math
import os
import random
import struct
import subprocess
import unittest
import zlib

from harness import RTSLC, SECONDS, Case
from image_files import png, hdr, tiff
from image_oracle import Oracle, decode_srgb, encode_srgb

RTSL_RUN = os.environ["RTSL_RUN"]

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
    print(image.levels(), image.sample(rt_ScreenCoord));
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


def numbers_of(line):
    return [
        float(n)
        for n in line.split(": ", 1)[1]
        .replace("vec4(", "")
        .replace("ivec2(", "")
        .replace("ivec3(", "")
        .replace(")", "")
        .replace(",", " ")
        .split()
    ]


class Images(Case):
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

    def png_cases(self):
        wraps = ["repeat", "mirror", "clamp", "black"]
        kinds = [
            (channels, bits, filter)
            for channels in (1, 2, 3, 4)
            for bits in (8, 16)
            for filter in ("nearest", "bilinear", "trilinear", "anisotropic")
        ]
        for number, (channels, bits, filter) in enumerate(kinds):
            most = 2**bits - 1
            width, height = 3 + number % 6, 2 + number % 5
            pixel = self.integers(width, height, channels, most, number)
            file = f"{number}.png"
            self.write(file, png(width, height, pixel, bits, channels))
            wrap = [wraps[number % 4], wraps[number // 4 % 4]]
            space = "linear" if number % 3 == 0 else "srgb" if number % 3 == 1 else "auto"
            encoded = space != "linear"
            yield (
                self.png_oracle(pixel, (width, height), channels, most, encoded, wrap, filter),
                {"file": file, "wrap": wrap, "filter": filter, "colorSpace": space},
                # a mean that is nearly halfway between two codes may be rounded the other way
                0.006 if bits == 8 and filter in ("trilinear", "anisotropic") else 0.00003,
            )

    def png_oracle(self, pixel, size, channels, most, encoded, wrap, filter):
        is_alpha = lambda c: channels in (2, 4) and c == channels - 1
        decode = lambda values: [
            v / most if is_alpha(c) or not encoded else decode_srgb(v / most)
            for c, v in enumerate(values)
        ]

        def rounded(texel):
            if encoded and most == 65535:
                return texel
            code = [v if not encoded or c == 3 else encode_srgb(v) for c, v in enumerate(texel)]
            back = [round(c * most) / most for c in code]
            return tuple(v if not encoded or c == 3 else decode_srgb(v) for c, v in enumerate(back))

        return Oracle(
            (*size, 1),
            lambda x, y, z: self.as_color(decode(pixel(x, size[1] - 1 - y))),
            [*wrap, "clamp"],
            filter,
            round_level=rounded,
        )

    def test_channels_bits_filters_and_wraps(self):
        self.check(list(self.png_cases()), 2)

    def test_an_image_alone(self):
        """Its properties are constants of the program."""
        for case in list(self.png_cases())[3::5]:
            self.check([case], 2)

    def test_formats_of_files(self):
        pixel = self.integers(5, 4, 3, 255)
        cases = []

        def add(name, data, texel, tolerance=0.00002):
            if data:
                self.write(name, data)
            image = {"file": name, "filter": "bilinear", "colorSpace": "auto"}
            cases.append((Oracle((5, 4, 1), texel, ["repeat"] * 3, "bilinear"), image, tolerance))

        add(
            "radiance",
            hdr(5, 4, lambda x, y: (*pixel(x, y), 130)),
            lambda x, y, z: (*((v + 0.5) / 64 for v in pixel(x, 3 - y)), 1.0),
            0.005,
        )
        add(
            "tiff",
            tiff(5, 4, pixel, "H", 1),
            lambda x, y, z: (*(v / 65535 for v in pixel(x, 3 - y)), 1.0),
        )
        add(
            "tiff of floats",
            tiff(5, 4, lambda x, y: [v * 1e20 for v in pixel(x, y)], "f", 3),
            lambda x, y, z: (*(v * 1e20 for v in pixel(x, 3 - y)), 1.0),
        )
        self.write_exr("exr", 5, 4, 0.25)
        add("exr", None, lambda x, y, z: (0.25, 0.25, 0.25, 1.0))
        self.check(cases, 2)

    def test_raw_texels(self):
        forms = {
            "unorm8": ("B", 255),
            "unorm16": ("H", 65535),
            "float16": ("e", 1),
            "float32": ("f", 1),
        }
        cases = []
        for number, (name, (form, one)) in enumerate(forms.items()):
            for channels in (1, 2, 4):
                chance = random.Random(number)
                raw = [
                    chance.randrange(one + 1) if one > 1 else chance.randrange(-64, 64) / 16
                    for _ in range(4 * 3 * 5 * channels)
                ]
                file = f"{name}{channels}.raw"
                self.write(file, struct.pack(f"<{len(raw)}{form}", *raw))
                texels = {
                    (x, y, z): self.as_color(
                        [v / one for v in raw[((z * 3 + y) * 4 + x) * channels :][:channels]]
                    )
                    for x in range(4)
                    for y in range(3)
                    for z in range(5)
                }
                wrap = ["repeat", "mirror", "black"]
                cases.append(
                    (
                        Oracle(
                            (4, 3, 5),
                            lambda x, y, z, texels=texels: texels[x, y, z],
                            wrap,
                            "bilinear",
                        ),
                        {
                            "raw": file,
                            "size": [4, 3, 5],
                            "format": name,
                            "channels": channels,
                            "filter": "bilinear",
                            "wrap": wrap,
                        },
                        0.00003,
                    )
                )
        self.check(cases, 3)

    def test_all_numbers_of_8_and_16_bits(self):
        """Each is the quotient by the largest one, correctly rounded."""
        self.write(
            "all.rtsl",
            """
            class All : rt_RayGeneration {
              public sampler2D small;
              public sampler2D large;
              void generate() {
                int wrong = 0;
                for (int i = 0; i < 256; ++i)
                  wrong += small.load(ivec2(i, 0)) == vec4(vec3(float(i)), 255.0) / 255.0 ? 0 : 1;
                for (int i = 0; i < 65536; ++i)
                  wrong += large.load(ivec2(i & 255, i >> 8)) == vec4(vec3(float(i)), 65535.0) / 65535.0 ? 0 : 1;
                print(wrong);
              }
            };""",
        )
        for channels in (1, 4):
            small = b"".join(bytes([i, i, i, 255] if channels == 4 else [i]) for i in range(256))
            large = b"".join(
                struct.pack("<4H", i, i, i, 65535) if channels == 4 else struct.pack("<H", i)
                for i in range(65536)
            )
            self.write("small.raw", small)
            self.write("large.raw", large)
            self.scene(
                {
                    "class": "All",
                    "small": {
                        "raw": "small.raw",
                        "size": [256, 1],
                        "format": "unorm8",
                        "channels": channels,
                    },
                    "large": {
                        "raw": "large.raw",
                        "size": [256, 256],
                        "format": "unorm16",
                        "channels": channels,
                    },
                },
                shaders="all.rtsl",
            )
            self.assertEqual(self.printed(), [[0]])

    def test_slices_and_their_levels(self):
        pixels = [self.integers(6, 5, 1, 255, z) for z in range(3)]
        for z in range(3):
            self.write(f"{z}.png", png(6, 5, pixels[z], 8, 1))
        rounded = lambda texel: tuple(round(v * 255) / 255 for v in texel)
        oracle = Oracle(
            (6, 5, 3),
            lambda x, y, z: self.as_color([pixels[z](x, 4 - y)[0] / 255]),
            ["clamp"] * 3,
            "trilinear",
            round_level=rounded,
        )
        self.check(
            [
                (
                    oracle,
                    {
                        "slices": ["0.png", "1.png", "2.png"],
                        "wrap": "clamp",
                        "colorSpace": "linear",
                    },
                    0.006,
                )
            ],
            3,
        )

    def test_double_and_fast(self):
        pixel = self.integers(7, 6, 4, 255)
        self.write("image.png", png(7, 6, pixel, 8, 4))
        oracle = Oracle(
            (7, 6, 1),
            lambda x, y, z: tuple(v / 255 for v in pixel(x, 5 - y)),
            ["repeat"] * 3,
            "bilinear",
        )
        image = {"file": "image.png", "filter": "bilinear", "colorSpace": "linear"}
        self.check([(oracle, image, 0.00003)], 2, options=["--fp=fast"])
        self.check([(oracle, image, 0.000003)], 2, options=["--fp=double"])

    # What a program needs

    def test_levels_are_made_only_where_they_are_read(self):
        self.write("image.png", png(8, 8, self.integers(8, 8, 3, 255)))
        self.scene({"class": "Plain", "image": {"file": "image.png"}})
        self.assertEqual(self.printed()[0][0], 1)
        self.scene(
            {
                "class": "Probe2D",
                "images": [{"file": "image.png"}],
                "uv": [],
                "dx": [],
                "dy": [],
                "lod": [],
                "at": [],
            }
        )
        self.assertEqual(self.printed()[0][2], 4)

    def test_what_images_have_in_common_is_constant(self):
        self.write("image.png", png(8, 8, self.integers(8, 8, 3, 255)))
        image = {"file": "image.png", "filter": "bilinear"}
        self.scene({"class": "Show", "image": image})
        text, _ = self.run_rtslc("explain", "scene.json", "--json", "--no-savings")
        left_out = {
            (item["item"], entry["subject"])
            for item in json.loads(text)["items"]
            for entry in item["entries"]
            if not entry["needed"]
        }
        for member in ("format", "channels", "filter", "wrapU", "width"):
            self.assertIn(("parameters", f"sampler2D.{member}"), left_out)

    def test_equal_images_are_one_object(self):
        self.write("image.png", png(2, 2, lambda x, y: (255, 0, 0)))
        image = {"file": "image.png"}
        self.scene(
            {"class": "Bindless", "images": [image, dict(image), {**image, "wrap": "clamp"}]}
        )
        self.assertEqual(self.printed(), [[0, 1], [1, 1], [2, 1], [0]])

    def test_a_hundred_images_by_index(self):
        images = {}
        for i in range(100):
            self.write(f"{i}.png", png(1 + i % 3, 1 + i % 2, lambda x, y: (i, i, i)))
            images[f"image{i}"] = {
                "file": f"{i}.png",
                "colorSpace": "linear",
                "filter": ["nearest", "trilinear"][i % 2],
            }
        self.scene({"class": "Bindless", "images": list(images)}, images=images)
        printed = self.printed()
        self.assertEqual([int(line[0]) for line in printed[:100]], list(range(100)))
        for i in range(100):
            self.assertAlmostEqual(printed[i][1], i / 255, delta=1e-6)
        self.assertEqual(printed[100], [0])

    # Extreme cases

    def test_extreme_coordinates(self):
        pixel = self.integers(4, 4, 3, 255)
        self.write("image.png", png(4, 4, pixel))
        strange = [1e7, -1e7, 3.4e38, -3.4e38, 1e-45, -1e-45, 0.9999999, -0.0]
        uv = [[a, b] for a in strange for b in strange]
        same = [[0.0, 0.0]] * len(uv)
        images = [
            {"file": "image.png", "wrap": wrap, "filter": filter}
            for wrap in ("repeat", "mirror", "clamp", "black")
            for filter in ("nearest", "anisotropic")
        ]
        self.scene(
            {
                "class": "Probe2D",
                "images": images,
                "uv": uv,
                "dx": uv,
                "dy": same,
                "lod": [c[0] for c in uv],
                "at": [[2147483647, -2147483648]] * len(uv),
            }
        )
        lines = [line for line in self.printed() if len(line) == 20]
        self.assertEqual(len(lines), len(images) * len(uv))
        for line in lines:
            self.assertTrue(all(0 <= v <= 1 for v in line), line)

    def test_coordinates_that_are_no_numbers_count_as_zero(self):
        self.write("image.png", png(4, 4, self.integers(4, 4, 3, 255)))
        self.write(
            "nan.rtsl",
            """
            class Strange : rt_RayGeneration {
              public sampler2D image;
              public float zero = 0.0;
              void generate() {
                float nan = zero / zero, infinite = 1.0 / zero;
                print(image.sample(vec2(nan, infinite)) - image.sample(vec2(0.0)));
                print(image.sample(vec2(-infinite, 0.5), nan) - image.sample(vec2(0.0, 0.5)));
                print(image.sampleGrad(vec2(0.25), vec2(nan), vec2(1.0)) - image.sample(vec2(0.25)));
                print(image.sample(vec2(0.25), infinite) - image.sample(vec2(0.25), 2.0));
                print(image.sampleGrad(vec2(0.25), vec2(1e30), vec2(1e30)) - image.sample(vec2(0.25), 2.0));
                print(image.sampleGrad(vec2(0.25), vec2(0.0), vec2(0.0)) - image.sample(vec2(0.25)));
              }
            };""",
        )
        self.scene(
            {"class": "Strange", "image": {"file": "image.png", "filter": "anisotropic"}},
            shaders="nan.rtsl",
        )
        for options in ([], ["--fp=fast"], ["--fp=double"]):
            for line in self.printed("-Wno-all", *options):
                for value in line:
                    self.assertAlmostEqual(value, 0, delta=1e-6, msg=(options, line))

    def test_long_and_tiny_images_and_great_texels(self):
        for width, height in ((1, 1), (1, 16384), (16384, 1)):
            texels = [1e30 if i == 7 % (width * height) else 0.0 for i in range(width * height)]
            self.write("image.raw", struct.pack(f"<{len(texels)}f", *texels))
            uv = [[0.5, 0.5], [7.5 / 16384, 7.5 / 16384]]
            self.scene(
                {
                    "class": "Probe2D",
                    "images": [{"raw": "image.raw", "size": [width, height]}],
                    "uv": uv,
                    "dx": [[1e6, 0], [0, 1e6]],
                    "dy": [[0, 1e6]] * 2,
                    "lod": [20, 20],
                    "at": [[7, 7]] * 2,
                }
            )
            lines = self.printed()
            mean = 1e30 / (width * height)
            for line in lines[1:]:
                self.assertAlmostEqual(line[4], mean, delta=1e-6 * mean)  # level 20: the last
                self.assertAlmostEqual(line[8], mean, delta=1e-6 * mean)  # minified by 1e6 and more
                self.assertEqual(line[12], 1e30)
            self.assertAlmostEqual(lines[2][0], 1e30, delta=1e27)  # in the middle of the texel

    def test_texels_that_are_not_finite_count_as_zero(self):
        self.write("image.raw", struct.pack("<4f", math.inf, math.nan, 1.0, -math.inf))
        self.scene({"class": "Plain", "image": {"raw": "image.raw", "size": [2, 2]}})
        output, error = self.run_rtslc("render", "scene.json", "--print", "-q", "-o", "x.exr")
        self.assertIn("3 numbers of the image are not finite, and count as 0", error)
        values = {v for line in output.splitlines() for v in numbers_of(line)[1:4]}
        self.assertTrue(all(0 <= v <= 1 for v in values), values)

    # Paths

    def test_every_path_gives_the_same_bits(self):
        self.write("image.png", png(13, 9, self.integers(13, 9, 4, 255), 8, 4))
        for filter in ("nearest", "anisotropic"):  # which blends levels, and texels of each
            self.scene(
                {
                    "class": "Show",
                    "lod": 1.3,
                    "image": {"file": "image.png", "filter": filter, "wrap": ["mirror", "black"]},
                },
                render={"engine": "programs", "size": [40, 30], "spp": 2},
            )
            pictures = set()
            for options in (
                [],
                ["--trace=recurse"],
                ["--target=host-megakernel"],
                ["--traversal=device"],
                ["--threads=1"],
                ["-O0"],
                ["--keep=all"],
            ):
                self.run_rtslc("render", "scene.json", "-q", "-o", "x.exr", *options)
                pictures.add((self.folder / "x.exr").read_bytes())
            self.run_rtslc("pack", "scene.json", "-q", "-o", "x.rtslpkg")
            done = subprocess.run(
                [RTSL_RUN, "x.rtslpkg", "--target=host", "-q", "-o", "x.exr"],
                cwd=self.folder,
                timeout=SECONDS,
                stderr=subprocess.PIPE,
            )
            self.assertEqual(done.returncode, 0, done.stderr)
            pictures.add((self.folder / "x.exr").read_bytes())
            self.assertEqual(len(pictures), 1, filter)

    # What is wrong

    def wrong(self, image, code, containing, **more):
        """One message, at the image or within it."""
        text = json.dumps({"class": "Plain", "image": image})
        self.scene({"class": "Plain", "image": image}, **more)
        self.assertIn(text, (self.folder / "scene.json").read_text())
        messages = self.diagnose("render", "scene.json", "-o", "x.exr")
        self.assert_message(messages, code, containing, line=1, file="scene.json")
        self.assertFalse((self.folder / "x.exr").exists())

    def test_wrong_descriptions(self):
        self.write("image.png", png(2, 2, lambda x, y: (0, 0, 0)))
        self.write("image.raw", bytes(15))
        self.wrong({"file": "image.png", "filter": "trilinaer"}, "E0805", "`filter` is `nearest`")
        self.wrong({"file": "image.png", "wrap": ["clamp"]}, "E0804", "`wrap` takes 1 or 2 names")
        self.wrong({"file": "image.png", "colour": "srgb"}, "E0802", "has no key `colour`")
        self.wrong(
            {"file": "image.png", "anisotropy": 0},
            "E0805",
            "`anisotropy` must be between 1 and 256",
        )
        self.wrong(
            {"size": [2, 2]},
            "E0803",
            "is a `sampler2D`: an image needs a `file`, `slices` or `raw`",
        )
        self.wrong({"class": "sampler2D", "file": 5}, "E0804", "`file` is a string, not a number")
        self.wrong({"raw": "image.raw"}, "E0803", "a raw image needs a `size`")
        self.wrong(
            {"raw": "image.raw", "size": [2, 2], "channels": 3}, "E0805", "`channels` is 1, 2 or 4"
        )
        self.wrong(
            {"raw": "image.raw", "size": [2, 2]},
            "E0905",
            "15 bytes, and 2 x 2 x 1 texels of 4 bytes take 16",
        )
        self.wrong({"raw": "image.raw", "size": [2147483647, 2147483647]}, "E0805", "too large")
        self.wrong({"slices": ["image.png"]}, "E0811", "takes a `sampler2D`, not a `sampler3D`")
        self.wrong({"class": "sampler3D", "slices": []}, "E0805", "at least one slice")
        self.wrong(
            "wood",
            "E0806",
            "no image, texture or material is named `wood`",
            images={"would": {"file": "image.png"}},
        )
        self.wrong({"class": "sampler2D"}, "E0803", "needs a `file`")
        self.write_exr("image.exr", 2, 2, 1.0)
        self.wrong({"file": "image.exr", "colorSpace": "srgb"}, "E0808", "floating point")

    def test_names_that_are_keys_of_images_too(self):
        self.write(
            "named.rtsl",
            """
            class Flat : rt_Texture { public float raw = 0.5; void lookup() { rt_TextureColor = color(raw); } };
            class Wall : rt_Material {
              public rt_Texture file;
              private rt_Texture other;
              void constructor(rt_Texture raw) { other = raw; }
              void shade() { rt_SampleColor = file.lookup() + other.lookup(); }
            };
            class Eye : rt_Camera { void generateRay() { rt_RayOrigin = vec3(0.0, 0.0, 5.0); rt_RayDirection = vec3(0.0, 0.0, -1.0); } };""",
        )
        self.write("wall.obj", "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n")
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["named.rtsl"],
                    "camera": {"class": "Eye"},
                    "textures": {"raw": {"class": "Flat"}, "slices": {"class": "Flat"}},
                    "materials": {
                        "file": {"class": "Wall", "constructor": {"raw": "raw"}, "file": "slices"}
                    },
                    "nodes": {"raw": {"mesh": "wall.obj", "material": "file"}},
                    "roots": {"file": "raw"},
                    "render": {"size": [2, 2], "spp": 1},
                }
            ),
        )
        self.run_rtslc("render", "scene.json", "-q", "-o", "x.exr")

    def test_all_mistakes_in_one_run(self):
        image = {"file": "image.png", "filter": "no", "wrap": 5, "colorSpace": "no", "x": 1}
        self.scene({"class": "Plain", "image": image})
        self.assertEqual(len(self.diagnose("render", "scene.json", "-o", "x.exr")), 4)

    def test_wrong_files(self):
        good = png(40, 30, self.integers(40, 30, 3, 255))
        self.wrong({"file": "none.png"}, "E0900", "there is no file `none.png`")
        self.wrong({"file": "."}, "E0901", "is a folder")
        self.write("image.png", b"")
        self.wrong({"file": "image.png"}, "E0905", "cannot read `image.png`")
        self.write("image.png", b"no image at all" * 100)
        self.wrong({"file": "image.png"}, "E0905", "cannot read `image.png`")
        self.write("image.png", good[: len(good) // 2])
        self.wrong({"file": "image.png"}, "E0905", "cannot read `image.png`")
        huge = good[:16] + struct.pack(">II", 2**30, 2**30) + good[24:29]
        self.write("image.png", huge + struct.pack(">I", zlib.crc32(huge[12:29])) + good[33:])
        self.assertTrue(self.diagnose_any("image.png"))
        self.write("small.png", png(2, 2, lambda x, y: (0, 0, 0)))
        self.write("large.png", good)
        self.scene(
            {
                "class": "Probe3D",
                "images": [{"slices": ["small.png", "large.png"]}],
                "uvw": [],
                "dx": [],
                "lod": [],
                "at": [],
            }
        )
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "x.exr"),
            "E0905",
            "differs from the first slice",
        )

    def diagnose_any(self, file):
        self.scene({"class": "Plain", "image": {"file": file}})
        return self.diagnose("render", "scene.json", "-o", "x.exr")

    def test_inputs_are_not_overwritten(self):
        self.write_exr("image.exr", 2, 2, 0.5)
        before = (self.folder / "image.exr").read_bytes()
        self.scene({"class": "Plain", "image": {"file": "image.exr"}})
        self.assert_message(self.diagnose("render", "scene.json", "-o", "image.exr"), "E0965")
        self.assertEqual((self.folder / "image.exr").read_bytes(), before)

    def test_damaged_files_never_crash(self):
        chance = random.Random(5)
        files = [
            png(9, 7, self.integers(9, 7, 3, 255)),
            hdr(9, 7, lambda x, y: (x, y, 1, 128)),
            tiff(9, 7, self.integers(9, 7, 3, 255), "H", 1),
        ]
        images = {}
        for i in range(60):
            data = bytearray(files[i % len(files)])
            for _ in range(chance.randrange(1, 6)):
                data[chance.randrange(len(data))] = chance.randrange(256)
            self.write(
                f"{i}.image", bytes(data[: chance.randrange(len(data))] if i % 4 == 0 else data)
            )
            images[f"image{i}"] = {"file": f"{i}.image"}
        self.scene({"class": "Bindless", "images": list(images)}, images=images)
        done = subprocess.run(
            [RTSLC, "render", "scene.json", "-q", "-o", "x.exr"],
            cwd=self.folder,
            timeout=SECONDS,
            stderr=subprocess.PIPE,
        )
        self.assertIn(done.returncode, (0, 1), done.stderr[-2000:])


if __name__ == "__main__":
    unittest.main()
