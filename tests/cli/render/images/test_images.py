"""Images: sampler2D and sampler3D against an oracle in double precision, on every path, and image
files that are wrong."""

import json
import math
import random
import re
import struct
import unittest

from harness import numbers_of
from image_case import ImageCase
from image_files import hdr, jpeg, png, tiff
from image_oracle import Oracle, decode_srgb, encode_srgb


class Images(ImageCase):
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
        block = lambda x, y: pixel(x // 8, y // 8)
        self.write("jpeg", jpeg(24, 16, block))
        cases.append(
            (
                Oracle(
                    (24, 16, 1),
                    lambda x, y, z: (*(decode_srgb(v / 255) for v in block(x, 15 - y)), 1.0),
                    ["repeat"] * 3,
                    "bilinear",
                ),
                {"file": "jpeg", "filter": "bilinear"},
                0.01,  # a code or two: luma and chroma are rounded
            )
        )
        rows = b"".join(bytes(pixel(x, y)) for y in range(4) for x in range(5))
        add(
            "portable pixmap",
            b"P6 5 4 255\n" + rows,
            lambda x, y, z: (*(decode_srgb(v / 255) for v in pixel(x, 3 - y)), 1.0),
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

    def test_channels_are_kept_only_where_they_are_read(self):
        names = ("red", "alpha", "blueAndAlpha", "sizeOnly", "redAndGreen", "passed")
        for bits, channels in ((8, 4), (16, 4), (8, 2)):
            texels = self.integers(9, 7, channels, 2**bits - 1)
            self.write("image.png", png(9, 7, texels, bits, channels))
            image = {"file": "image.png"}
            generation = {
                "class": "Channels",
                # Equal images would be one.
                **{name: {**image, "anisotropy": i + 1} for i, name in enumerate(names)},
                "greens": ["first", "second"],
            }
            images = {"first": {**image, "wrap": "clamp"}, "second": {**image, "wrap": "mirror"}}
            self.expect_the_bits_of_all_channels(generation, images)
        self.assertEqual(
            self.channels_left_out(),
            {
                "red": "r",
                "alpha": "a",
                "blueAndAlpha": "b, a",
                "greens": "g",
                "sizeOnly": None,
                "redAndGreen": "r, g",
                "missing": None,
            },
        )
        # An image that two members share has what either of them reads.
        self.expect_the_bits_of_all_channels({**generation, "red": "first"}, images)

    def expect_the_bits_of_all_channels(self, generation, images):
        render = {"engine": "programs", "size": [12, 8], "spp": 1}
        self.scene(generation, images=images, render=render)
        for name, options in (("kept.exr", ["--keep=images"]), ("read.exr", [])):
            self.run_rtslc("render", "scene.json", "-q", "-o", name, "-O1", *options)
        self.assert_same_bits("read.exr", "kept.exr")

    def channels_left_out(self):
        text, _ = self.run_rtslc("explain", "scene.json", "--json", "--no-savings")
        found = {}
        for item in json.loads(text)["items"]:
            for entry in item["entries"]:
                if entry["subject"].startswith("channels of Channels."):
                    read = re.fullmatch("nothing but (.*) is read", entry["reason"])
                    found[entry["subject"].split(".")[1]] = read[1] if read else None
        return found

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
            self.assertIn(("images", f"sampler2D.{member}"), left_out)

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

    def test_numbers_of_texels_and_levels_are_clamped(self):
        """Whether indices are checked, not checked, or exceptions where they are out of range."""
        self.write(
            "far.rtsl",
            """
            class Far : rt_RayGeneration {
              public sampler2D image;
              public sampler3D volume;
              public int high = 2147483647;
              void generate() {
                int low = -high;
                print(image.load(ivec2(high, low), low) - image.load(ivec2(3, 0), 0));
                print(image.load(ivec2(high, low), high) - image.load(ivec2(0), 2));
                print(volume.load(ivec3(high, low, high), low) - volume.load(ivec3(3, 0, 1), 0));
                print(volume.load(ivec3(high, low, high), high) - volume.load(ivec3(0), 2));
              }
            };""",
        )
        self.write("image.png", png(4, 4, self.integers(4, 4, 3, 255)))
        image = {"filter": "trilinear"}
        self.scene(
            {
                "class": "Far",
                "image": {**image, "file": "image.png"},
                "volume": {**image, "slices": ["image.png", "image.png"]},
            },
            shaders="far.rtsl",
        )
        for options in ([], ["--unchecked"], ["--exceptions"]):
            self.assertEqual(self.printed(*options), [[0, 0, 0, 0]] * 4, options)

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
        self.assertIn(
            "numbers of the image that are not finite (3 of them) count as 0; the first, -inf, is "
            "the grey of the texel at (1, 0) from the upper left corner [-Wscene]\n",
            error,
        )
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
            self.run_package("x.rtslpkg", "--target=host", "-q", "-o", "x.exr")
            pictures.add((self.folder / "x.exr").read_bytes())
            self.assertEqual(len(pictures), 1, filter)

    # What is wrong


if __name__ == "__main__":
    unittest.main()
