"""Launches of `rtslc run`: their sizes and dimensions, and several of them."""

import json
import struct
import unittest

from harness import USAGE
from numpy_files import npy, read_npy
from output_case import PATHS, OutputCase


class Launches(OutputCase):
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


if __name__ == "__main__":
    unittest.main()
