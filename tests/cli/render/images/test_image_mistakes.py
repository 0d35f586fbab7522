"""Descriptions and files of images that are wrong."""

import json
import os
import random
import struct
import subprocess
import unittest
import zlib

from harness import RTSLC, SECONDS, bounded
from image_case import ImageCase
from image_files import png, hdr, tiff


class Mistakes(ImageCase):
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
            class Hung : rt_Material {
              public rt_Texture file;
              void shade() { rt_SampleColor = file.lookup(); }
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
                        "file": {"class": "Wall", "constructor": {"raw": "raw"}, "file": "slices"},
                        "hung": {"class": "Hung"},
                    },
                    "nodes": {
                        "wall": {"mesh": "wall.obj", "material": "file"},
                        "hung": {"mesh": "wall.obj", "material": "hung"},
                        "named": {"child": "hung", "variables": {"file": "slices"}},
                        "raw": {"children": ["wall", "named"]},
                    },
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

    def test_files_that_only_claim_to_be_large(self):
        """Just below the limit of 8 GiB, of which they have nothing: no memory is requested for
        them, so that all is well with 2 GiB."""
        small = tiff(2, 2, lambda x, y: (0.5, 0.5, 0.5), "f", 3)
        size = struct.pack("<I", 2)
        header = struct.pack(">IIBBBBB", 46000, 46000, 8, 6, 0, 0, 0)
        chunk = b"IHDR" + header
        files = {
            "large.png": png(2, 2, lambda x, y: (0, 0, 0))[:12]
            + chunk
            + struct.pack(">I", zlib.crc32(chunk))
            + png(2, 2, lambda x, y: (0, 0, 0))[33:],
            "large.hdr": hdr(0, 0, None).replace(b"-Y 0 +X 0", b"-Y 40000 +X 17000") + bytes(64),
            "large.tga": struct.pack("<BBB9xHHBB", 0, 0, 2, 65000, 33000, 32, 0) + bytes(64),
            "large.tif": small.replace(
                struct.pack("<HHI", 256, 4, 1) + size, struct.pack("<HHII", 256, 4, 1, 33000)
            ).replace(
                struct.pack("<HHI", 257, 4, 1) + size, struct.pack("<HHII", 257, 4, 1, 21000)
            ),
        }
        # JPEG 2000 is decoded when it is opened; this is beyond the limit, and known before.
        code = struct.pack(">HHHH8IH", 0xFF4F, 0xFF51, 47, 0, *(100000, 100000, 0, 0) * 2, 3)
        boxes = struct.pack(">I4sI", 12, b"jP  ", 0x0D0A870A) + b"\0\0\0\x14ftypjp2 \0\0\0\0jp2 "
        for name, start in (("large.j2k", b""), ("large.jp2", boxes + b"\0\0\0\0jp2c")):
            self.write(name, start + code + 3 * b"\7\1\1")
            self.scene({"class": "Plain", "image": {"file": name}})
            self.assert_message(
                self.diagnose("check", "scene.json", prepare=bounded),
                "E0805",
                f"the image `{name}` of 100000 x 100000 pixels is too large",
            )
        for name, data in files.items():
            self.write(name, data)
            self.scene({"class": "Plain", "image": {"file": name}})
            messages = self.diagnose("check", "scene.json", prepare=bounded)
            self.assert_message(messages, "E0905", f"cannot read `{name}`")
            if not name.endswith(".png"):
                size = f"a file of {len(data)} bytes"
                self.assert_message(messages, "E0905", size)

    def test_strips_of_more_rows_than_the_image(self):
        """They are common, as long as they do not ask for gigabytes."""
        plain = tiff(2, 2, lambda x, y: (0.5, 0.5, 0.5), "f", 3)
        data = zlib.compress(plain[200:])
        size, packed = (struct.pack("<HHII", 279, 4, 1, n) for n in (48, len(data)))
        deflated = [struct.pack("<HHII", 259, 3, 1, kind) for kind in (1, 8)]
        small = plain[:200].replace(*deflated).replace(size, packed) + data
        self.scene({"class": "Plain", "image": {"file": "image.tif"}})
        for rows, is_fine in ((65535, True), (0xFFFFFFFF, True), (1157627907, False)):
            tall = struct.pack("<HHII", 278, 4, 1, rows)
            self.write("image.tif", small.replace(struct.pack("<HHII", 278, 4, 1, 2), tall))
            if is_fine:
                self.run_rtslc("check", "scene.json")
                continue
            messages = self.diagnose("check", "scene.json", prepare=bounded)
            text = "cannot read `image.tif`: its strips have 1157627907 rows, and the image 2"
            self.assert_message(messages, "E0905", text)

    def test_more_pixels_than_memory(self):
        """The file has them, in a hole."""
        width = 3 << 28
        head = tiff(1, 1, lambda x, y: (0, 0, 0), "B", 1)
        for old, new in ((256, width), (279, 3 * width)):
            size = struct.pack("<I", 1 if old == 256 else 3)
            head = head.replace(
                struct.pack("<HHI", old, 4, 1) + size, struct.pack("<HHII", old, 4, 1, new)
            )
        self.write("large.tif", head)
        os.truncate(self.folder / "large.tif", 200 + 3 * width)
        self.scene({"class": "Plain", "image": {"file": "large.tif"}})
        self.assert_message(
            self.diagnose("check", "scene.json", prepare=bounded),
            "E1001",
            f"not enough memory for the image `large.tif` of {width} x 1 pixels",
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
