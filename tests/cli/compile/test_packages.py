"""rtslc pack and rtsl-run: the same picture without the compiler, and every package and device that
is not as it must be is refused with a reason."""

import json
import os
import subprocess
import unittest

from harness import (
    DIAGNOSED,
    FAULTS_OF_DEVICES,
    FINE,
    INTERNAL,
    LITTLE_MEMORY,
    RTSL_RUN,
    UNUSABLE_DEVICES,
    USAGE,
    Case,
    example_scenes,
)
from numpy_files import npy

SMALL = ("--size", "32x18", "--spp", "2")


class Packages(Case):
    @classmethod
    def setUpClass(cls):
        cls.packed = None

    def package(self):
        """The bytes of the glass scene's package, made once."""
        if Packages.packed is None:
            self.glass_scene()
            self.run_rtslc("pack", "scene.json", "-o", "glass.rtslpkg")
            Packages.packed = (self.folder / "glass.rtslpkg").read_bytes()
        return Packages.packed

    def render(self, *arguments, status=FINE, fake="", content=None):
        """rtsl-run on the package, or on other bytes."""
        self.write("x.rtslpkg", self.package() if content is None else content)
        out, error = self.run_package(
            "x.rtslpkg", "-o", "out.exr", *arguments, status=status, fake=fake
        )
        if status != FINE:
            self.assertNotEqual(error, "")
        return out, error

    def test_the_host_renders_the_bits_of_rtslc(self):
        self.glass_scene()
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "--target=host-megakernel", *SMALL)
        self.render("--target=host", *SMALL, "--compare", "a.exr")
        self.render("--target=host", *SMALL, "--threads", "1", "--compare", "a.exr")
        _, error = self.render(
            "--target=host", *SMALL, "--seed", "5", "--compare", "a.exr", status=DIAGNOSED
        )
        self.assertIn("pixels differ from `a.exr`", error)

    def test_every_example_can_be_packed(self):
        scenes = example_scenes(part=1, parts=6)
        self.assertGreaterEqual(len(scenes), 2)
        for scene in scenes:
            self.run_rtslc(
                "render", str(scene), "-o", "a.exr", "-O0", "--target=host-megakernel", *SMALL
            )
            self.run_rtslc("pack", str(scene), "-o", "example.rtslpkg", "-O0", "--quiet")
            content = (self.folder / "example.rtslpkg").read_bytes()
            self.render("--target=host", *SMALL, "--compare", "a.exr", content=content)

    def test_packing_gives_the_same_bytes_on_every_run(self):
        self.glass_scene()
        self.run_rtslc("pack", "scene.json", "-o", "again.rtslpkg", "--quiet")
        self.assertEqual((self.folder / "again.rtslpkg").read_bytes(), self.package())

    def test_it_reports_as_json(self):
        out, error = self.render("--target=host", *SMALL, "--json")
        figures = json.loads(out)
        self.assertEqual(
            (figures["size"], figures["spp"], figures["frameBytes"]), ([32, 18], 2, 28)
        )
        self.assertNotIn("rendered in", error)

    def test_buffers_are_written_and_read(self):
        """The bits of `rtslc run`, for the scene's own inputs and for others of another length."""
        self.write(
            "steps.rtsl",
            """struct Cell { float share; ivec2 at; };
class Steps : rt_RayGeneration {
  public float origins[];
  public out Cell cells[];
  public inout int counts[];
  void generate() {
    uint i = rt_LaunchIndex.x;
    cells[i] = Cell(origins[i] + rand(), ivec2(int(i), origins.length()));
    atomicAdd(counts[i % uint(counts.length())], 1);
  }
};""",
        )
        scene = {
            "rtsl": 1,
            "import": ["steps.rtsl"],
            "buffers": {"starts": {"buffer": "starts.npy"}},
            "rayGeneration": {
                "class": "Steps",
                "origins": "starts",
                "counts": {"size": [2]},
            },
            "render": {"engine": "programs", "size": "origins"},
        }
        self.write("scene.json", json.dumps(scene))
        self.write("starts.npy", npy("f", (3,), [0.5, 1, 2]))
        self.write("more.npy", npy("d", (5,), [1, 2, 3, 4, 5]))
        several = {**scene, "render": {**scene["render"], "spp": 3}}
        self.write("several.json", json.dumps(several))
        self.run_rtslc("pack", "several.json", "-o", "x.rtslpkg", "-q")
        self.run_rtslc("run", "several.json", "-q", "--out=counts=counts.csv")
        expected = (self.folder / "counts.csv").read_bytes()
        self.run_alone("--out=counts=counts.csv", "--target=host", "-q")
        self.assertEqual((self.folder / "counts.csv").read_bytes(), expected)

        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
        for inputs in ([], ["--in=starts=more.npy"], ["--in=origins=more.npy"]):
            outputs = ["--out=cells=cells.npy", "--out=counts=counts.csv"]
            self.run_rtslc("run", "scene.json", "-q", *inputs, *outputs)
            expected = [(self.folder / name).read_bytes() for name in ("cells.npy", "counts.csv")]
            done = self.run_alone(*inputs, *outputs, "--target=host", "-q")
            self.assertEqual(done.stderr, b"")
            for name, content in zip(("cells.npy", "counts.csv"), expected):
                self.assertEqual((self.folder / name).read_bytes(), content, (name, inputs))
        self.assertIn(b"counts`", self.run_alone("--out=count=a.npy", status=1).stderr)
        self.assertIn(
            b"the launch only reads this buffer",
            self.run_alone("--out=origins=a.npy", "--target=host", status=1).stderr,
        )
        self.assertIn(
            b"`--in nothing`: the package has no buffer of this name; it has",
            self.run_alone("--in=nothing=more.npy", "--out=cells=a.npy", status=1).stderr,
        )
        self.assertIn(
            b"`more.npy` is an input and would be overwritten",
            self.run_alone(
                "--in=origins=more.npy", "--out=cells=more.npy", "--target=host", status=1
            ).stderr,
        )
        self.write("bad.npy", npy("f", (2, 2), [1, 2, 3, 4]))
        self.assertIn(
            b"`--in origins` is a `float[]`",
            self.run_alone("--in=origins=bad.npy", "--out=cells=a.npy", status=1).stderr,
        )
        for name, content, expected in (
            ("none.npy", npy("f", (0,), []), "`none.npy` has no elements for the buffer `starts`"),
            ("none.raw", b"", "it needs 1 to 268435456"),
            ("odd.raw", bytes(6), "one of `--in origins`, a `float[]`, has 4 bytes"),
        ):
            self.write(name, content)
            done = self.run_alone(f"--in=starts={name}", "--out=cells=a.npy", status=1)
            self.assertIn(expected, done.stderr.decode())
        self.assertFalse((self.folder / "a.npy").exists())
        self.assertIn(b"--out, a buffer, is required", self.run_alone(status=2).stderr)
        for bad in ("--out=cells", "--in==x", "--out=cells=a --out=cells=b"):
            self.run_alone(*bad.split(), status=2)
        self.assertNotIn("a.npy", self.files())

    def test_launches_of_three_dimensions(self):
        """Of the scene's size and of another one: the bits of `rtslc run`. A buffer of fewer
        dimensions cannot have an element for each index."""
        declared = {
            "volume": "float cells[][][]",
            "plane": "float cells[][]",
            "row": "float cells[]",
        }
        index = {"volume": "[i.z][i.y][i.x]", "plane": "[i.y][i.x]", "row": "[i.x]"}
        sizes = {"volume": [4, 3, 2], "plane": [4, 3], "row": [4]}
        for name, member in declared.items():
            self.write(
                "cells.rtsl",
                f"class Cells : rt_RayGeneration {{ public out {member}; void generate() {{ "
                f"uvec3 i = rt_LaunchIndex; cells{index[name]} = rand() + float(i.z); }} }};",
            )
            scene = {
                "rtsl": 1,
                "import": ["cells.rtsl"],
                "rayGeneration": {"class": "Cells"},
                "render": {"engine": "programs", "size": sizes[name], "spp": 1},
            }
            self.write("scene.json", json.dumps(scene))
            self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
            for size in ("4x3x2", "2x5x3", "7x2", "5x1"):
                numbers = [int(number) for number in size.split("x")]
                dimensions = 3 if len(numbers) == 3 else 2 if numbers[1] > 1 else 1
                arguments = ("--size", size, "--target=host", "-q", "--out=cells=packed.npy")
                if dimensions > len(sizes[name]):
                    said = self.run_alone(*arguments, status=DIAGNOSED).stderr
                    self.assertIn(b"the launch cannot have more dimensions", said)
                    self.assertNotIn("packed.npy", self.files())
                    continue
                self.run_alone(*arguments)
                self.run_rtslc(
                    "run", "scene.json", "-q", f"--set=render.size={numbers}", "--out=cells=a.npy"
                )
                self.assertEqual(
                    (self.folder / "packed.npy").read_bytes(),
                    (self.folder / "a.npy").read_bytes(),
                    (name, size),
                )
                (self.folder / "packed.npy").unlink()
        for bad in ("4x3x", "4x3x0", "4x3x2x1", "x3x2", "4x65536x65536", "4x 3"):
            said = self.run_alone("--size", bad, "--out=cells=a.npy", status=USAGE).stderr
            self.assertIn(b"--size", said)

    def run_alone(self, *arguments, status=FINE):
        """rtsl-run on the package, without a picture."""
        done = subprocess.run(
            [RTSL_RUN, "x.rtslpkg", *arguments], cwd=self.folder, capture_output=True
        )
        self.assertEqual(done.returncode, status, done.stderr)
        return done

    def test_needs_no_compiler(self):
        done = subprocess.run(
            [os.environ["READELF"], "-d", RTSL_RUN], stdout=subprocess.PIPE, text=True, check=True
        )
        libraries = [line for line in done.stdout.splitlines() if "NEEDED" in line]
        self.assertTrue(libraries)
        for unwanted in ("LLVM", "MLIR", "embree", "assimp", "cuda"):
            self.assertFalse([line for line in libraries if unwanted in line], libraries)
        self.assertLess(os.path.getsize(RTSL_RUN), 8 << 20)

    def test_damaged_packages_are_refused(self):
        whole = self.package()
        # Of a small package the unit tests change every byte.
        for place in (
            list(range(0, 256, 16))
            + list(range(256, len(whole), len(whole) // 10))
            + [len(whole) - 1]
        ):
            damaged = bytearray(whole)
            damaged[place] ^= 0x20
            _, error = self.render(
                "--target=host", *SMALL, content=bytes(damaged), status=DIAGNOSED
            )
            self.assertIn("`x.rtslpkg` is", error)
        for length in (0, 7, 63, 64, 1000, len(whole) - 1):
            self.render("--target=host", *SMALL, content=whole[:length], status=DIAGNOSED)
        self.assertNotIn("out.exr", self.files())

    def test_foreign_and_newer_packages_are_refused(self):
        _, error = self.render("--target=host", content=b"\x7fELF" + bytes(1000), status=DIAGNOSED)
        self.assertIn("is not a package of rtslc", error)
        newer = bytearray(self.package())
        newer[8] = 200
        _, error = self.render("--target=host", content=bytes(newer), status=DIAGNOSED)
        self.assertIn("use a newer rtsl-run", error)

    def test_bad_arguments(self):
        self.render("--target=toaster", status=USAGE)
        self.render("--target=host", "--size", "0x9", status=USAGE)
        self.render("--target=host", "--depth", "100000", status=USAGE)

    def test_the_gpu_is_handed_the_whole_scene(self):
        out, _ = self.render("--target=gpu", *SMALL, "--seed", "3", "--json")
        self.assertEqual(json.loads(out)["blocks"], 5)  # of 128 threads, for 576 pixels
        # What the stand-in paints: x, y and the seed.
        (self.folder / "out.exr").rename(self.folder / "first.exr")
        self.render("--target=gpu", *SMALL, "--seed", "3", "--compare", "first.exr")

    def test_what_is_wrong_with_a_gpu_is_said(self):
        for fake, text in [*UNUSABLE_DEVICES.items(), LITTLE_MEMORY]:
            with self.subTest(fake=fake):
                _, error = self.render("--target=gpu", *SMALL, fake=fake, status=DIAGNOSED)
                self.assertIn(text, error)
                self.assertEqual(len(error.splitlines()), 1 if "memory" in text else 2, error)
        for fake, text in FAULTS_OF_DEVICES.items():
            with self.subTest(fake=fake):
                _, error = self.render("--target=gpu", *SMALL, fake=fake, status=INTERNAL)
                self.assertIn(text, error)
        self.assertNotIn("out.exr", self.files())

    def test_a_missing_driver_is_said(self):
        (self.folder / "libcuda.so.1").write_text("no driver")
        self.write("x.rtslpkg", self.package())
        _, error = self.run_with_fake_driver(
            [RTSL_RUN, "x.rtslpkg", "-o", "out.exr", "--target=gpu"],
            status=DIAGNOSED,
            folder=self.folder,
        )
        self.assertIn("there is no CUDA driver", error)
        self.assertIn("--target=host", error)


if __name__ == "__main__":
    unittest.main()
