"""Output buffers: `rtslc run`, on every path, with elements of every type, passes that share
buffers, and what is wrong."""

import json
import math
import os
import re
import struct
import subprocess
import unittest

from harness import DIAGNOSED, EXAMPLES, FINE, RTSLC, USAGE, Case
from numpy_files import npy, read_npy

SHADERS = (EXAMPLES.parent / "tests/cpp/scenes/Outputs.rtsl").read_text()  # of C++ programs too

PATHS = {
    "recursion": ["--trace=recurse", "--traversal=device"],
    "states on Embree": [],
    "states": ["--traversal=device"],
    "the host megakernel": ["--target=host-megakernel"],
    "-O0": ["-O0"],
    "everything kept": ["--keep=all"],
    "one thread": ["--threads=1"],
    "with exceptions": ["--exceptions"],
}
MARKS = [0, 0xFFFFFFFF, 0, 0xFFFFFFFF, 0, 5, 0]


class OutputBuffers(Case):
    def setUp(self):
        super().setUp()
        self.write("probe.rtsl", SHADERS)

    def scene(self, name="scene.json", start=None, size=(8, 6), **changes):
        scene = {
            "rtsl": 1,
            "import": ["probe.rtsl"],
            "buffers": {"histogram": {"size": [6]}, "most": {"buffer": "initial.npy"}},
            "rayGeneration": start or {"class": "Probe", "histogram": "histogram", "most": "most"},
            "materials": {"mirror": {"class": "Mirror"}},
            "objects": [
                {"primitive": {"class": "Ball"}, "material": "mirror"},
                {
                    "primitive": {"class": "Ball", "radius": 0.4},
                    "material": "mirror",
                    "transform": {"translate": [1.2, 0.5, 1]},
                },
            ],
            "render": {"engine": "programs", "size": list(size)},
        }
        scene.update(changes)
        self.write("initial.npy", npy("I", [len(MARKS)], MARKS))
        return self.write(
            name, json.dumps({key: value for key, value in scene.items() if value is not None})
        )

    def one(self, body, members, size=(1, 1), values="", **changes):
        """Runs one class; gives the buffers that were written, by name."""
        self.write(
            "one.rtsl",
            f"class One : rt_RayGeneration {{ {members} void generate() {{ {body} }} }};",
        )
        names = re.findall(r"(?:out|inout) \w+ (\w+)", members)
        self.scene(
            start={"class": "One", **json.loads(values or "{}")},
            size=size,
            **{"import": ["one.rtsl"], "objects": [], "materials": {}, **changes},
        )
        self.run_rtslc("run", "scene.json", "-q", *(f"--out={name}={name}.npy" for name in names))
        return {name: read_npy(self.folder / f"{name}.npy") for name in names}

    def test_launches_of_three_dimensions(self):
        """Every index runs once, on every path, and knows its place; its rays have it, too."""
        self.write(
            "volume.rtsl",
            """
struct Ray { uvec3 at; };
class Volume : rt_RayGeneration {
  public out ivec3 at[][][];
  public out float noise[][][];
  public inout int count[];
  public out vec2 screen[][][];
  void generate() {
    uvec3 i = rt_LaunchIndex;
    Ray ray = Ray(uvec3(0u));
    trace(vec3(0.0), vec3(0.0, 0.0, 1.0), 0.0, 1.0, ray);
    at[i.z][i.y][i.x] = ivec3(ray.at);
    noise[i.z][i.y][i.x] = rand();
    screen[i.z][i.y][i.x] = rt_ScreenCoord * vec2(rt_LaunchSize.xy);
    atomicAdd(count[0], 1);
    atomicAdd(count[1], int(rt_LaunchSize.x + 10u * rt_LaunchSize.y + 100u * rt_LaunchSize.z));
  }
};
class Sky : rt_Miss { void miss(inout Ray ray) { ray.at = rt_LaunchIndex; } };
""",
        )
        self.scene(
            start={"class": "Volume", "count": {"size": [2]}},
            size=(5, 3, 4),
            background={"class": "Sky"},
            **{"import": ["volume.rtsl"], "objects": [], "materials": {}},
        )
        first = None
        names = ("at", "noise", "count", "screen")
        for way, options in PATHS.items():
            self.run_rtslc(
                "run", "scene.json", "-q", *options, *(f"--out={name}={name}.npy" for name in names)
            )
            files = {name: (self.folder / f"{name}.npy").read_bytes() for name in names}
            first = first or files
            self.assertEqual(files, first, way)
        shape, at = read_npy(self.folder / "at.npy")
        self.assertEqual(shape, (4, 3, 5, 3))
        every = [(x, y, z) for z in range(4) for y in range(3) for x in range(5)]
        self.assertEqual(list(at), [number for index in every for number in index])
        self.assertEqual(read_npy(self.folder / "count.npy")[1], (60, 60 * 435))
        self.assertEqual(len(set(read_npy(self.folder / "noise.npy")[1])), 60)
        _, screen = read_npy(self.folder / "screen.npy")
        for i, (x, y, _) in enumerate(every):
            self.assertTrue(x <= screen[2 * i] <= x + 1 and y <= 3 - screen[2 * i + 1] <= y + 1)
        said, _ = self.run_rtslc("run", "scene.json", "--json")
        self.assertEqual(json.loads(said)["launches"][0]["size"], [5, 3, 4])

    def test_bad_sizes_of_three_dimensions(self):
        for size, text in (
            ([5, 3, 0], "the number of slices"),
            ([5, 3, 2.5], "the number of slices"),
            ([70000, 3, 2], "the width"),
            ([1, 65536, 65536], "the launch has 4294967296 rows in all slices"),
            ([65536, 65536, 2], "the launch has 8589934592 launch indices"),
            ([5, 3, 2, 2], "`size`"),
            ([], "`size`"),
        ):
            self.scene(size=size)
            found = self.diagnose("run", "scene.json")
            self.assertEqual(len(found), 1, found)
            self.assertIn(text, found[0]["message"])
            self.assertGreater(found[0]["range"]["begin"]["line"], 0)
        for size in ([0], [0, 3], [5, 0]):
            self.scene(size=size)
            found = self.diagnose("run", "scene.json")
            self.assertEqual(len(found), 1, found)
            self.assertIn("between 1 and", found[0]["message"])
        self.scene(rayGeneration=None, passes=[])
        self.assert_message(
            self.diagnose("run", "scene.json"), "E0805", "`passes` is an empty list"
        )
        # A buffer of two dimensions has no size of its own in such a launch.
        self.write(
            "one.rtsl",
            "class One : rt_RayGeneration { public out float a[][]; "
            "void generate() { a[rt_LaunchIndex.y][rt_LaunchIndex.x] = 1.0; } };",
        )
        self.scene(
            start={"class": "One"},
            size=(2, 2, 2),
            **{"import": ["one.rtsl"], "objects": [], "materials": {}},
        )
        self.assert_message(self.diagnose("run", "scene.json"), "E0815", "needs a size")

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

    def test_samples_come_one_after_the_other(self):
        found = self.one(
            "last[rt_LaunchIndex.x] = last[rt_LaunchIndex.x] * 2 + 1;",
            "public inout int last[];",
            size=(3, 1),
            render={"engine": "programs", "size": [3], "spp": 4},
        )
        self.assertEqual(found["last"], ((3,), (15, 15, 15)))

    def test_a_launch_that_is_repeated_gives_what_it_gave_first(self):
        self.scene(
            start={"class": "Counts", "n": [0]},
            size=(3, 1),
            **{"import": ["counts.rtsl"], "objects": [], "materials": {}},
        )
        self.write(
            "counts.rtsl",
            """class Counts : rt_RayGeneration {
  public inout int n[];
  void generate() { atomicAdd(n[0], 1); print("once"); }
};""",
        )
        for way, options in PATHS.items():
            out, _ = self.run_rtslc(
                "run", "scene.json", "--repeat=5", "--json", "--print", "--out=n=n.csv", *options
            )
            self.assertEqual((self.folder / "n.csv").read_text(), "3\n", way)
            figures = json.loads(out)
            repeats = figures["launches"][0]["repeats"]
            self.assertEqual((len(repeats), sorted(repeats)), (5, repeats), way)
            self.assertEqual(
                [text.split(": ")[1] for text in figures["printed"]], ["once"] * 3, way
            )
        _, error = self.run_rtslc("run", "scene.json", "--repeat=2")
        self.assertRegex(error, r"repeated 2 times: \d+\.\d{3} ms in the median")
        self.assertNotIn("repeats", self.run_rtslc("run", "scene.json", "--json")[0])
        for value in ("-1", "x", "1.5", "1000001"):
            self.assertIn(
                "--repeat",
                self.run_rtslc("run", "scene.json", f"--repeat={value}", status=USAGE)[1],
            )

    def test_passes_share_buffers(self):
        self.write(
            "passes.rtsl",
            """
class Scatter : rt_RayGeneration {
  public inout int counts[];
  public out float seen[];
  void generate() { uint i = rt_LaunchIndex.x; atomicAdd(counts[(i * i) % uint(counts.length())], 1); seen[i] = rand(); }
};
class Sum : rt_RayGeneration {
  public int counts[];
  public float seen[];
  public out int below[];
  public float threshold = 0.5;
  void generate() {
    int sum = 0, few = 0;
    for (int i = 0; i <= int(rt_LaunchIndex.x); ++i) sum += counts[i];
    for (int i = 0; i < seen.length(); ++i) if (seen[i] < threshold) ++few;
    below[rt_LaunchIndex.x] = rt_LaunchIndex.x == 0u ? few : sum;
  }
};
class Double : rt_RayGeneration { public inout int below[]; void generate() { below[rt_LaunchIndex.x] *= 2; } };
""",
        )
        self.scene(
            start=None,
            **{
                "import": ["passes.rtsl"],
                "rayGeneration": None,
                "objects": [],
                "materials": {},
                "buffers": {
                    "counts": [0] * 7,
                    "seen": {"size": [100]},
                    "below": {"size": [7]},
                },
                "passes": [
                    {
                        "rayGeneration": {"class": "Scatter", "counts": "counts", "seen": "seen"},
                        "size": [100],
                    },
                    {
                        "rayGeneration": {
                            "class": "Sum",
                            "counts": "counts",
                            "seen": "seen",
                            "below": "below",
                        },
                        "size": [7],
                    },
                    {"rayGeneration": {"class": "Double", "below": "below"}, "size": [7]},
                ],
                "render": {"seed": 5},
            },
        )
        counts = [0] * 7
        for i in range(100):
            counts[i * i % 7] += 1
        sums = [2 * sum(counts[: i + 1]) for i in range(7)]
        first = None
        for way, options in PATHS.items():
            text, _ = self.run_rtslc(
                "run",
                "scene.json",
                "--json",
                "--out=below=below.npy",
                "--out=seen=seen.npy",
                *options,
            )
            shape, below = read_npy(self.folder / "below.npy")
            _, seen = read_npy(self.folder / "seen.npy")
            first = first or seen
            self.assertEqual(seen, first, way)
            self.assertEqual(list(below), [2 * sum(x < 0.5 for x in seen)] + sums[1:], way)
        report = json.loads(text)
        self.assertEqual(
            [launch["rayGeneration"] for launch in report["launches"]], ["Scatter", "Sum", "Double"]
        )
        self.assertEqual(
            [buffer["name"] for buffer in report["buffers"]], ["below", "counts", "seen"]
        )
        self.assertEqual(
            report["buffers"][0],
            {"name": "below", "type": "int[]", "size": [7], "file": "below.npy"},
        )
        message = self.diagnose("render", "scene.json", "-o", "x.png")[0]["message"]
        self.assertIn("passes", message)
        self.run_rtslc("check", "scene.json")

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

    def test_a_launch_of_one_dimension_may_be_long(self):
        found = self.one(
            "if (rt_LaunchIndex.x % 50000u == 0u) marks[rt_LaunchIndex.x / 50000u] = "
            "rt_LaunchIndex.x + rt_LaunchSize.x;",
            "public out uint marks[];",
            values='{"marks": {"size": [4]}}',
            render={"engine": "programs", "size": [200000]},
        )
        self.assertEqual(found["marks"], ((4,), tuple(200000 + 50000 * i for i in range(4))))

    def test_a_launch_has_the_size_of_a_buffer(self):
        self.write(
            "one.rtsl",
            "class One : rt_RayGeneration { public float a[]; public out float twice[];"
            "  void generate() { twice[rt_LaunchIndex.x] = 2.0 * a[rt_LaunchIndex.x]; } };",
        )
        self.write("a.npy", npy("f", [5], [1, 2, 3, 4, 5.5]))
        self.write("a.csv", "1\n2\n3\n")
        self.write("a.raw", struct.pack("<6f", *range(6)))
        changes = {
            "import": ["one.rtsl"],
            "objects": [],
            "materials": {},
            "render": {"engine": "programs", "size": "a"},
        }
        for start, buffers, option, count in (
            ([1, 2, 3, 4], {}, [], 4),
            ({"buffer": "a.npy"}, {}, [], 5),
            ("b", {"b": {"buffer": "a.csv"}}, [], 3),
            ({"buffer": "a.raw"}, {}, [], 6),
            ("b", {"b": {"buffer": "a.raw"}}, [], 6),
            (None, {}, ["--in=a=a.raw"], 6),
            ("b", {"b": {"size": [7]}}, ["--in=b=a.raw"], 6),
            (None, {}, ["--in=a=a.npy"], 5),
            ("b", {"b": {"size": [7]}}, ["--in=b=a.csv"], 3),
        ):
            self.scene(
                start={"class": "One", **({"a": start} if start else {})},
                **{**changes, "buffers": buffers},
            )
            self.run_rtslc("run", "scene.json", "-q", *option, "--out=twice=t.npy")
            self.assertEqual(read_npy(self.folder / "t.npy")[0], (count,))
        self.scene(start={"class": "One"}, **changes)
        self.assert_message(
            self.diagnose("run", "scene.json", "--out=twice=t.npy"),
            "E0806",
            "`size` is one to three numbers, or the name of a buffer",
        )
        self.scene(start={"class": "One", "a": {"size": [0]}}, **changes)
        self.assert_message(
            self.diagnose("run", "scene.json", "--out=twice=t.npy"), "E0805", "has 0 indices"
        )

    def test_what_is_wrong_in_a_scene(self):
        def refused(containing, code, **changes):
            self.scene(**changes)
            self.assert_message(self.diagnose("run", "scene.json"), code, containing)

        start = {"class": "Probe", "histogram": "histogram", "most": "most"}
        refused(
            "no buffer is named `histogrom`", "E0806", start={**start, "histogram": "histogrom"}
        )
        refused(
            "a `uint[]`, and the buffer `most` a `int[]`",
            "E0804",
            start={**start, "histogram": "most"},
            buffers={"most": {"size": [7]}},
        )
        refused(
            "`size` takes 2 numbers, not 1", "E0804", start={**start, "distance": {"size": [4]}}
        )
        refused("`size` takes 1 to 3 numbers", "E0805", start={**start, "distance": {"size": []}})
        refused(
            "is a list, or has a `size`, or a file",
            "E0803",
            buffers={"histogram": {"shape": [6]}, "most": {"buffer": "initial.npy"}},
        )
        refused("`rayGeneration` or `passes`", "E0802", passes=[{"rayGeneration": start}])
        refused(
            "`width`", "E0802", rayGeneration=None, passes=[{"rayGeneration": start, "width": 3}]
        )
        refused("needs a `rayGeneration`", "E0803", rayGeneration=None, passes=[{"size": [3]}])
        self.write(
            "more.rtsl",
            "class Two : Probe { public inout int again[]; };"
            "class Row : rt_RayGeneration { public out float row[]; "
            "void generate() { row[0] = 1.0; } };",
        )
        more = {"import": ["probe.rtsl", "more.rtsl"]}
        refused(
            "one of them is an output buffer",
            "E0804",
            start={**start, "class": "Two", "again": "histogram"},
            **more,
        )
        refused('needs a size: {"size": [...]}', "E0815", start={"class": "Row"}, **more)

    def test_more_memory_than_there_is(self):
        for size in ([4000000000, 4000000000], [4000000000, 100000]):
            self.scene(
                start={
                    "class": "Probe",
                    "histogram": "histogram",
                    "most": "most",
                    "distance": {"size": size},
                }
            )
            self.assertIn(
                "not enough memory for member `distance`",
                self.diagnose("run", "scene.json")[0]["message"],
            )

    def test_more_memory_than_there_is_together(self):
        """Each of two buffers fits, but not both, which is known before anything runs. Elements
        that nothing writes take no memory."""
        with open("/proc/meminfo") as lines:
            available = next(int(line.split()[1]) for line in lines if "MemAvailable" in line)
        self.write(
            "pair.rtsl",
            "class Pair : rt_RayGeneration { public out float near[][]; "
            "public out float far[][]; void generate() { near[0][0] = far[0][0] = 2.0; } };",
        )
        for share, status in ((0.7, DIAGNOSED), (0.3, FINE)):
            size = {"size": [int(share * available / 1024), 1 << 18]}  # MiB
            self.scene(
                start={"class": "Pair", "near": size, "far": size},
                size=(2, 1),
                **{"import": ["pair.rtsl"], "objects": [], "materials": {}},
            )
            process = subprocess.Popen(
                [RTSLC, "run", "scene.json", "-q"], cwd=self.folder, stderr=subprocess.PIPE
            )
            error = process.stderr.read().decode()
            process.stderr.close()
            _, ended, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(ended)
            self.assertEqual(process.returncode, status, error)
            self.assertLess(usage.ru_maxrss, available // 4)
            if status == DIAGNOSED:
                self.assertRegex(
                    error, "not enough memory for member `far` of .*: .* GiB, beside .* GiB"
                )

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

    def test_what_is_wrong_on_the_command_line(self):
        self.scene()
        self.assert_message(
            self.diagnose("run", "scene.json", "--out=distanse=d.npy"),
            "E0806",
            "no output buffer of this name",
        )
        self.assert_message(
            self.diagnose("run", "scene.json", "--out=distance=no/d.npy"),
            "E0902",
            "cannot write `no/d.npy`",
        )
        self.assertIn(
            "is an input",
            self.diagnose("run", "scene.json", "--out=distance=initial.npy")[0]["message"],
        )
        self.assert_message(
            self.diagnose("run", "scene.json", "--out=distance=d.npy", "--out=cells=c.csv"),
            "E0808",
            "its elements are structs",
        )
        for arguments in (
            ["--out=distance"],
            ["--out==x"],
            ["--out=distance=x.npy", "--out=normal=x.npy"],
            ["--out=distance=x.npy", "--out=distance=y.npy"],
        ):
            self.run_rtslc("run", "scene.json", *arguments, status=USAGE)
        self.assertFalse((self.folder / "d.npy").exists())

    def test_a_full_disk_leaves_nothing(self):
        self.scene()
        _, error = self.run_rtslc("run", "scene.json", "--out=distance=/dev/full", status=DIAGNOSED)
        self.assertIn("/dev/full", error)


if __name__ == "__main__":
    unittest.main()
