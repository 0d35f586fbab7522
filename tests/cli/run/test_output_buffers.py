"""Output buffers: what `rtslc run` writes to them, on every path, with elements of every type."""

import math
import os
import struct
import subprocess
import unittest

from harness import FINE, RTSLC
from numpy_files import npy, read_npy
from output_case import PATHS, OutputCase


class OutputBuffers(OutputCase):
    def test_every_path_writes_the_same_bits(self):
        self.scene()
        first = None
        outputs = ["distance", "normal", "path", "histogram", "most"]
        for way, options in PATHS.items():
            self.run_rtslc(
                "run",
                "scene.json",
                "-q",
                "-o",
                "picture.exr",
                "--out=cells=cells.raw",
                *options,
                *(f"--out={name}={name}.npy" for name in outputs),
            )
            files = {
                path.name: path.read_bytes()
                for path in self.folder.iterdir()
                if path.suffix in (".npy", ".raw", ".exr")
            }
            first = first or files
            for name in files:
                self.assertEqual(files[name], first[name], f"{name}: {way}")
        shape, distance = read_npy(self.folder / "distance.npy")
        self.assertEqual(shape, (6, 8))
        self.assertTrue(any(x > 0 for x in distance) and any(x < 0 for x in distance))
        _, histogram = read_npy(self.folder / "histogram.npy")
        self.assertEqual(histogram[0], 2 * sum(x < 0 for x in distance))
        self.assertGreaterEqual(sum(histogram), 2 * 48)
        _, most = read_npy(self.folder / "most.npy")
        every = [(x, y) for x in range(8) for y in range(6)]
        xor = 0
        for x, y in every:
            xor ^= 1 << (x + y)
        self.assertEqual(most, (7 * 7 + 5, 0, 0xFF, 0xFFFFFFFF & ~0x3F, xor, 9, 77))
        cells = struct.unpack("<" + 48 * "fi2i", (self.folder / "cells.raw").read_bytes())
        self.assertEqual(cells[0::4], distance)
        self.assertEqual(
            [(cells[4 * i + 2], cells[4 * i + 3]) for i in range(48)],
            [(i % 8, i // 8) for i in range(48)],
        )

    def test_printed_cpp_writes_the_same(self):
        """As rtslc prints it: elements are assigned where they lie, and the state machine keeps
        what it read."""
        for way in ("recurse", "split"):
            text, _ = self.run_rtslc("compile", "probe.rtsl", "--emit=cpp", f"--trace={way}")
            self.assertIn("rtsl::OutputBuffer<float, 2> distance{};", text)
            self.assertIn("distance.at(rt, ", text)
            self.assertIn("rtsl::atomicAdd(histogram.at(rt, bin(x)), n);", text)

    def test_elements_of_every_type(self):
        found = self.one(
            """
            uint i = rt_LaunchIndex.x;
            f[i] = 0.1 + float(i); n[i] = -3 + int(i); u[i] = 4000000000u + i; b[i] = i == 1u;
            v[i] = vec3(1.5, float(i), -0.0); m[i] = mat2(1.0, 2.0, 3.0, float(i)); c[i] = color(0.25, 0.5, float(i));
            pair[i][0] = 7.0; pair[i][1] = float(i); bv[i] = bvec2(i == 0u, true); deep[1][i][0] = int(i) + 1;""",
            "public out float f[]; public out int n[]; public out uint u[]; public out bool b[]; "
            "public out vec3 v[]; public out mat2 m[]; "
            "public out color c[]; public out float pair[][2]; public out bvec2 bv[]; public inout "
            "int deep[][][];",
            size=(3, 1),
            values='{"deep": {"size": [2, 3, 1]}}',
        )
        single = lambda x: struct.unpack("f", struct.pack("f", x))[0]
        self.assertEqual(found["f"], ((3,), tuple(single(single(0.1) + i) for i in range(3))))
        self.assertEqual(found["n"], ((3,), (-3, -2, -1)))
        self.assertEqual(found["u"], ((3,), (4000000000, 4000000001, 4000000002)))
        self.assertEqual(found["b"], ((3,), (False, True, False)))
        self.assertEqual(found["v"], ((3, 3), (1.5, 0, 0, 1.5, 1, 0, 1.5, 2, 0)))
        self.assertEqual(math.copysign(1, found["v"][1][2]), -1)
        self.assertEqual(found["m"], ((3, 2, 2), (1, 2, 3, 0, 1, 2, 3, 1, 1, 2, 3, 2)))
        self.assertEqual(found["c"], ((3, 3), (0.25, 0.5, 0, 0.25, 0.5, 1, 0.25, 0.5, 2)))
        self.assertEqual(found["pair"], ((3, 2), (7, 0, 7, 1, 7, 2)))
        self.assertEqual(found["bv"], ((3, 2), (True, True, False, True, False, True)))
        self.assertEqual(found["deep"], ((2, 3, 1), (0, 0, 0, 1, 2, 3)))

    def test_indices_are_clamped_and_empty_buffers_ignored(self):
        found = self.one(
            "int i = -5 - int(rt_LaunchIndex.x); a[i] = 1; a[100] = 2; none[0] = 3; none[1] += "
            "none[0] + 1; atomicAdd(none[0], 4);"
            "a[1] = none.length() + none[7] + atomicAdd(none[3], 1);",
            "public inout int a[]; public inout int none[];",
            values='{"a": [9, 9, 9], "none": []}',
        )
        self.assertEqual(found["a"], ((3,), (1, 0, 2)))
        self.assertEqual(found["none"], ((0,), ()))

    def test_nothing_is_written_after_an_exception(self):
        self.scene(
            start={"class": "Late", "a": [0, 0], "n": [0]},
            size=(2, 1),
            **{"import": ["late.rtsl"], "objects": [], "materials": {}},
        )
        self.write(
            "late.rtsl",
            """class Late : rt_RayGeneration {
  public inout int a[]; public inout int n[];
  void generate() {
    int i = int(rt_LaunchIndex.x);
    a[i] = 1;
    atomicAdd(n[0], 1);
    if (i == 0) { int far[2]; far[i + 5 * a.length()] = 3; a[i] += far[1]; }
    a[i] += 10;
    atomicAdd(n[0], 100);
  }
};""",
        )
        for way, options in PATHS.items():
            self.run_rtslc("run", "scene.json", "-q", "--out=a=a.csv", "--out=n=n.csv", *options)
            ended = "--exceptions" in options
            self.assertEqual((self.folder / "a.csv").read_text().split()[1], "11", way)
            self.assertEqual(
                (self.folder / "n.csv").read_text(), "102\n" if ended else "202\n", way
            )
            self.assertEqual(
                (self.folder / "a.csv").read_text().split()[0], "1" if ended else "14", way
            )
        for options in (["--trace=recurse"], ["--target=host-megakernel"], ["-O0"]):
            self.run_rtslc("run", "scene.json", "-q", "--exceptions", "--out=n=n.csv", *options)
            self.assertEqual((self.folder / "n.csv").read_text(), "102\n", options)

    def test_atomic_functions_have_a_value_after_an_exception(self):
        """That of the element, which stays: a program that waits for a value goes on."""
        self.scene(
            start={"class": "After", "n": [41234]},
            size=(1, 1),
            **{"import": ["after.rtsl"], "objects": [], "materials": {}},
        )
        self.write(
            "after.rtsl",
            """class After : rt_RayGeneration {
  public inout int n[];
  void generate() {
    int far[2]; far[5 * n.length()] = 3;
    print(atomicAdd(n[0], 100), atomicExchange(n[0], 7), atomicCompSwap(n[0], 41234, 8), n[0]);
  }
};""",
        )
        for options in ([], ["--trace=recurse"], ["-O0"], ["--target=host-megakernel"]):
            said, _ = self.run_rtslc(
                "run", "scene.json", "--json", "--print", "--exceptions", "--out=n=n.csv", *options
            )
            self.assertIn("41234 41234 41234 41234", said, options)
            self.assertEqual((self.folder / "n.csv").read_text(), "41234\n", options)

    def test_samples_come_one_after_the_other(self):
        found = self.one(
            "last[rt_LaunchIndex.x] = last[rt_LaunchIndex.x] * 2 + 1;",
            "public inout int last[];",
            size=(3, 1),
            render={"engine": "programs", "size": [3], "spp": 4},
        )
        self.assertEqual(found["last"], ((3,), (15, 15, 15)))

    def test_buffers_come_from_files(self):
        self.scene()
        self.write("start.npy", npy("i", [6], [100, 0, 0, 0, 0, 0]))
        self.write("path.npy", npy("f", [6, 8, 4], [1.0] * 192))
        self.run_rtslc(
            "run",
            "scene.json",
            "-q",
            "--in=histogram=start.npy",
            "--in=path=path.npy",
            "--out=histogram=h.csv",
        )
        added = [int(line) for line in (self.folder / "h.csv").read_text().split()]
        self.run_rtslc("run", "scene.json", "-q", "--out=histogram=h.csv")
        plain = [int(line) for line in (self.folder / "h.csv").read_text().split()]
        self.assertEqual(added, [plain[0] + 100] + plain[1:])

    def test_csv_and_the_summary(self):
        self.scene()
        _, error = self.run_rtslc("run", "scene.json", "--out=distance=d.csv", "--out=normal=n.csv")
        rows = (self.folder / "d.csv").read_text().splitlines()
        self.assertEqual((len(rows), {row.count(",") for row in rows}), (6, {7}))
        rows = (self.folder / "n.csv").read_text().splitlines()
        self.assertEqual((len(rows), {row.count(",") for row in rows}), (48, {2}))
        self.assertIn("float[][] distance, 6 x 8: d.csv", error)
        self.assertIn("int[] histogram, 6: not written, `--out histogram=FILE` does", error)

    def test_elements_are_written_from_where_they_lie(self):
        """Without a copy of them: they take their 48 MB once, when they are read."""
        start = {"class": "Probe", "histogram": "histogram", "most": "most"}
        self.scene(start={**start, "distance": {"size": [3000, 4000]}})
        most = []
        for out in ([], ["--out=distance=d.npy"], ["--out=distance=d.raw"]):
            process = subprocess.Popen([RTSLC, "run", "scene.json", "-q", *out], cwd=self.folder)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            self.assertEqual(process.returncode, FINE)
            most.append(usage.ru_maxrss)  # KiB
        for kibibytes in most[1:]:
            self.assertLess(kibibytes - most[0], 72 << 10, most)


if __name__ == "__main__":
    unittest.main()
