"""Buffers from files: .npy, .csv, .ply and bytes, as members of every type, and files that are
wrong."""

import json
import random
import struct
import unittest

from harness import Case
from numpy_files import npy

SHADERS = """
class Show : rt_RayGeneration {
  public float numbers[];
  public float table[][];
  public float block[][][];
  public vec3 points[];
  public mat2 turns[];
  public float pairs[][2];
  public int whole[];
  public uint positive[];
  public bool yes[];
  public color tints[];
  public color shades[];
  void generate() {
    for (int i = 0; i < numbers.length(); ++i) print(0, numbers[i]);
    for (int i = 0; i < table.length(); ++i) for (int j = 0; j < table[i].length(); ++j) print(1, i, j, table[i][j]);
    for (int i = 0; i < block.length(); ++i) for (int j = 0; j < block[i].length(); ++j)
      for (int k = 0; k < block[i][j].length(); ++k) print(2, i, j, k, block[i][j][k]);
    for (int i = 0; i < points.length(); ++i) print(3, points[i]);
    for (int i = 0; i < turns.length(); ++i) print(4, turns[i][0], turns[i][1]);
    for (int i = 0; i < pairs.length(); ++i) print(5, pairs[i][0], pairs[i][1]);
    for (int i = 0; i < whole.length(); ++i) print(6, whole[i]);
    for (int i = 0; i < positive.length(); ++i) print(7, positive[i]);
    for (int i = 0; i < yes.length(); ++i) print(8, yes[i] ? 1 : 0);
    for (int i = 0; i < tints.length(); ++i) print(9, luminance(tints[i]));
    for (int i = 0; i < shades.length(); ++i) print(10, luminance(shades[i]));
  }
};
class Objects : rt_RayGeneration { public rt_Texture textures[]; void generate() { } };
struct Corner { ivec2 at; bool used; };
struct Cell { float shape; Corner corners[2]; };
class Structs : rt_RayGeneration {
  public Cell cells[][][];
  public Corner pairs[][2];
  void generate() {
    for (int i = 0; i < cells.length(); ++i) for (int j = 0; j < cells[i].length(); ++j)
      for (int k = 0; k < cells[i][j].length(); ++k) {
        Cell c = cells[i][j][k];
        print(i, j, k, c.shape, c.corners[0].at.x, c.corners[0].at.y, c.corners[1].at.y, c.corners[1].used ? 1 : 0);
      }
    for (int i = 0; i < pairs.length(); ++i) print(pairs[i][0].at.x, pairs[i][1].at.y);
  }
};
"""
CORNER = "[('at', '<i4', (2,)), ('used', '<u4')]"
CELL = f"[('shape', '<f4'), ('corners', {CORNER}, (2,))]"


class Buffers(Case):
    PLY = (
        "ply\nformat %s 1.0\nelement cone 1\nproperty list uchar float heights\n"
        "property double tilt\nelement vertex 2\nproperty float x\n"
        "property float y\nproperty double z\nproperty uchar shade\nproperty int id\n"
        "element face 1\nproperty list uchar int corners\n"
        "end_header\n"
    )

    def setUp(self):
        super().setUp()
        self.write("show.rtsl", SHADERS)

    def scene(self, **members):
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["show.rtsl"],
                    "rayGeneration": {"class": "Show", **members},
                    "render": {"engine": "programs", "size": [1, 1], "spp": 1},
                }
            ),
        )

    def printed(self, *options):
        output, _ = self.run_rtslc(
            "render", "scene.json", "--print", "-q", "-o", "x.exr", "-Wno-all", *options
        )
        for name in ("vec2", "vec3"):
            output = output.replace(name + "(", "")
        return [
            [float(n) for n in line.split(": ", 1)[1].replace(")", "").replace(",", " ").split()]
            for line in output.splitlines()
        ]

    def test_every_type_as_a_list_and_as_a_file(self):
        chance = random.Random(1)
        numbers = lambda count: [chance.randrange(-64, 64) / 16 for _ in range(count)]

        def nested(flat, *sizes):
            part = len(flat) // sizes[0]
            return (
                flat
                if len(sizes) == 1
                else [nested(flat[i * part : (i + 1) * part], *sizes[1:]) for i in range(sizes[0])]
            )

        shapes = {
            "numbers": (5,),
            "table": (3, 4),
            "block": (2, 3, 2),
            "points": (4, 3),
            "turns": (3, 2, 2),
            "pairs": (3, 2),
            "tints": (4, 3),
        }
        lists, files = {}, {}
        for member, shape in shapes.items():
            count = 1
            for size in shape:
                count *= size
            flat = numbers(count)
            lists[member] = nested(flat, *shape)
            self.write(
                f"{member}.npy",
                npy("f" if len(files) % 2 else "d", shape, flat, version=1 + len(files) % 3),
            )
            files[member] = {"buffer": f"{member}.npy"}
        lists.update(
            whole=[-5, 7, 2147483647, -2147483648],
            positive=[0, 4294967295],
            yes=[True, False, True],
            shades=[0.25, 0.5],
        )
        self.write("whole.npy", npy("q", (4,), lists["whole"]))
        self.write("positive.npy", npy("I", (2,), lists["positive"]))
        self.write("yes.npy", npy("?", (3,), lists["yes"]))
        self.write("shades.npy", npy("e", (2,), lists["shades"]))
        files.update(
            {
                member: {"buffer": f"{member}.npy"}
                for member in ("whole", "positive", "yes", "shades")
            }
        )
        for color in ("rgb", "spectral:5"):
            self.scene(**lists)
            expected = self.printed(f"--color={color}")
            self.assertEqual({line[0] for line in expected}, set(range(11)))
            self.scene(**files)
            for options in ([], ["--target=host-megakernel"]):
                self.assertEqual(self.printed(f"--color={color}", *options), expected)

    def test_columns_of_csv(self):
        self.write("points.csv", "time, x,y , z\r\n0,1,2,3\n\n1,-4.5,5e-1,6\n")
        self.scene(
            points={"buffer": "points.csv", "columns": ["z", "x", "y"]},
            numbers={"buffer": "points.csv", "columns": ["time"]},
            table={"buffer": "points.csv"},
        )
        self.assertEqual(
            self.printed(),
            [
                [0, 0],
                [0, 1],
                *[
                    [1, i, j, v]
                    for i, row in enumerate([[0, 1, 2, 3], [1, -4.5, 0.5, 6]])
                    for j, v in enumerate(row)
                ],
                [3, 3, 1, 2],
                [3, 6, -4.5, 0.5],
            ],
        )
        self.write("plain.csv", "\ufeff1,2\n3,4\n")  # with a byte order mark
        self.scene(table={"buffer": "plain.csv"})
        self.assertEqual([line[3] for line in self.printed()], [1, 2, 3, 4])

    def test_columns_of_ply(self):
        rows = [(1, 2, 3, 255, -7), (-4.5, 0.5, 6, 0, 70000)]
        files = {
            "ascii": b"2 1 2 0.75\n"
            + b"".join(" ".join(map(str, row)).encode() + b"\n" for row in rows)
            + b"3 0 1 1\n"
        }
        for name, order in (("binary_little_endian", "<"), ("binary_big_endian", ">")):
            files[name] = (
                struct.pack(order + "B2fd", 2, 1, 2, 0.75)
                + b"".join(struct.pack(order + "2fdBi", *row) for row in rows)
                + struct.pack(order + "B3i", 3, 0, 1, 1)
            )
        for name, body in files.items():
            self.write("points.ply", (self.PLY % name).encode() + body)
            self.scene(
                points={"buffer": "points.ply", "columns": ["z", "x", "y"]},
                whole={"buffer": "points.ply", "columns": ["id"]},
                positive={"buffer": "points.ply", "element": "vertex", "columns": ["shade"]},
                table={"buffer": "points.ply"},
                numbers={"buffer": "points.ply", "element": "cone"},
            )
            self.assertEqual(
                self.printed(),
                [
                    [0, 0.75],
                    *[[1, i, j, v] for i, row in enumerate(rows) for j, v in enumerate(row)],
                    [3, 3, 1, 2],
                    [3, 6, -4.5, 0.5],
                    [6, -7],
                    [6, 70000],
                    [7, 255],
                    [7, 0],
                ],
                name,
            )

    def test_wrong_columns_of_ply(self):
        good = self.PLY % "ascii" + "2 1 2 0.75\n1 2 3 255 -7\n4 5 6 0 70000\n3 0 1 1\n"
        self.write("points.ply", good)
        self.wrong(
            "numbers",
            {"buffer": "points.ply", "columns": ["w"]},
            "E0806",
            "has no column `w`; it has `x`, `y`, `z`, `shade`, `id`",
        )
        self.wrong(
            "numbers",
            {"buffer": "points.ply", "element": "edge"},
            "E0806",
            "has no element `edge`; it has `cone`, `vertex`, `face`",
        )
        self.wrong(
            "numbers",
            {"buffer": "points.ply", "element": "cone", "columns": ["heights"]},
            "E0808",
            "is a list",
        )
        self.wrong("numbers", {"buffer": "points.ply"}, "E0804", "has the shape (2, 5)")
        self.wrong(
            "positive", {"buffer": "points.ply", "columns": ["id"]}, "E0805", "from 0 to 4294967295"
        )
        self.write("points.ply", good[:-3])
        self.wrong(
            "points",
            {"buffer": "points.ply", "columns": ["x", "y", "z"]},
            "E0906",
            "truncated or damaged in element 1 of 1 of `face`",
        )
        self.write("points.ply", good.replace("255", "256"))
        self.wrong(
            "points",
            {"buffer": "points.ply", "columns": ["x", "y", "z"]},
            "E0906",
            "`256` in line 16 is not a valid value of `shade`",
        )
        self.write("points.ply", b"solid")
        self.wrong("points", {"buffer": "points.ply"}, "E0906", "not a .ply file")
        self.wrong(
            "numbers",
            {"buffer": "numbers.raw", "element": "vertex"},
            "E0802",
            "`element` is for .ply files",
        )
        self.wrong(
            "numbers",
            {"buffer": "numbers.raw", "columns": ["x"]},
            "E0802",
            "`columns` is for .csv and .ply files",
        )
        self.wrong(
            "points",
            {"buffer": "points.ply", "shape": [2]},
            "E0802",
            "`shape` is for files without a format",
        )

    def test_launch_of_the_size_of_a_ply(self):
        self.write(
            "count.rtsl",
            "class Count : rt_RayGeneration { public float xs[]; void generate() { uint i = "
            "rt_LaunchIndex.x; print(i, xs[i]); } };",
        )
        self.write(
            "xs.ply",
            "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nend_header\n5 6 7\n",
        )
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["count.rtsl"],
                    "rayGeneration": {"class": "Count", "xs": {"buffer": "xs.ply"}},
                    "render": {"engine": "programs", "size": "xs", "spp": 1},
                }
            ),
        )
        self.assertEqual(self.printed(), [[0, 5], [1, 6], [2, 7]])

    def test_bytes(self):
        self.write("numbers.raw", struct.pack("<4f", 1, 2, 3, 4))
        self.scene(
            numbers={"buffer": "numbers.raw"},
            table={"buffer": "numbers.raw", "shape": [2, 2]},
            whole={"buffer": "numbers.raw"},
        )
        self.assertEqual(
            self.printed(),
            [
                [0, 1],
                [0, 2],
                [0, 3],
                [0, 4],
                [1, 0, 0, 1],
                [1, 0, 1, 2],
                [1, 1, 0, 3],
                [1, 1, 1, 4],
                *[[6, v] for v in struct.unpack("<4i", struct.pack("<4f", 1, 2, 3, 4))],
            ],
        )

    def test_empty(self):
        self.write("none.npy", npy("f", (0,), []))
        self.write("none.raw", b"")
        self.write("none.csv", "x\n")
        for name in ("none.npy", "none.raw", "none.csv"):
            self.scene(numbers={"buffer": name})
            self.assertEqual(self.printed(), [])
        for shape in ((5, 0), (0, 5)):
            self.write("rows.npy", npy("f", shape, []))
            self.scene(table={"buffer": "rows.npy"})
            self.assertEqual(self.printed(), [])

    def test_inputs_are_not_overwritten(self):
        self.write("numbers.exr", struct.pack("<4f", 1, 2, 3, 4))
        self.scene(numbers={"buffer": "numbers.exr"})
        self.assert_message(self.diagnose("render", "scene.json", "-o", "numbers.exr"), "E0965")
        self.assertEqual(len((self.folder / "numbers.exr").read_bytes()), 16)

    def wrong(self, member, value, code, containing):
        self.scene(**{member: value})
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "x.exr", "-Wno-all"),
            code,
            containing,
            line=1,
            file="scene.json",
        )
        self.assertFalse((self.folder / "x.exr").exists())

    def test_wrong_files(self):
        good = npy("f", (4,), [1, 2, 3, 4])
        for name, data, code, containing in (
            ("a.npy", b"", "E0906", "not a .npy file"),
            ("a.npy", b"PK" + bytes(50), "E0906", "not a .npy file"),
            ("a.npy", good[:9], "E0906", "not a .npy file"),
            ("a.npy", good[:30], "E0906", "truncated"),
            ("a.npy", good[:-1], "E0906", "truncated"),
            ("a.npy", good + b"x", "E0906", "longer than its header"),
            ("a.npy", npy("f", (2**62, 8), []), "E0906", "truncated"),
            ("a.npy", npy("f", (4,), [1, 2, 3, 4], descr=">f4"), "E0906", "not little-endian"),
            ("a.npy", npy("f", (4,), [1, 2, 3, 4], descr="<c8"), "E0906", "not little-endian"),
            ("a.npy", good.replace(b"'shape': (4,)", b"'shape': [4 ]"), "E0906", "no shape"),
            (
                "a.npy",
                good.replace(b"'shape': (4,)", b"'shape': (x,)"),
                "E0906",
                "not a list of numbers",
            ),
            (
                "a.npy",
                npy("f", (2, 2), [1, 2, 3, 4]),
                "E0804",
                "is a `float[]`, which takes the shape (n), and",
            ),
            ("a.npy", npy("d", (1,), [1e39]), "E0805", "the largest float"),
            ("a.csv", b"x,y\n1,2\n", "E0804", "has the shape (1, 2)"),
            ("a.csv", b"x\n1\n2,3\n", "E0906", "line 3 has 2 columns, not 1"),
            ("a.csv", b"x\n1\nfish\n", "E0906", "`fish` in line 3 is not a number"),
            ("a.raw", b"12345", "E0906", "5 bytes"),
        ):
            self.write(name, data)
            self.wrong("numbers", {"buffer": name}, code, containing)
        self.wrong("numbers", {"buffer": "none.npy"}, "E0900", "none.npy")
        self.write("a.npy", npy("f", (2, 2), [1, 2, 3, 4], order="True"))
        self.wrong("table", {"buffer": "a.npy"}, "E0906", "Fortran order")
        self.wrong("whole", {"buffer": "b.npy", "column": []}, "E0802", "has no key `column`")
        self.write("a.npy", npy("f", (1,), [1.5]))
        self.wrong("whole", {"buffer": "a.npy"}, "E0805", "takes whole numbers")
        self.write("a.npy", npy("i", (1,), [-1]))
        self.wrong("positive", {"buffer": "a.npy"}, "E0805", "from 0 to 4294967295")
        self.write("a.csv", "x,y\n1,2\n")
        self.wrong(
            "numbers",
            {"buffer": "a.csv", "columns": ["z"]},
            "E0806",
            "no column `z`; it has `x`, `y`",
        )
        self.write("a.raw", bytes(16))
        self.wrong("table", {"buffer": "a.raw"}, "E0804", "`shape` takes 2 sizes")
        self.wrong(
            "table",
            {"buffer": "a.raw", "shape": [3, 3]},
            "E0906",
            "3 x 3 elements of 4 bytes take 36",
        )

    def structs(self, **members):
        self.scene(**members)
        path = self.folder / "scene.json"
        path.write_text(path.read_text().replace('"class": "Show"', '"class": "Structs"'))

    def test_structs(self):
        cells = [struct.pack("<f2iI2iI", i / 2, i, 2, 7, 8, 9 - i, 3 * (i % 2)) for i in range(6)]
        self.write("cells.npy", npy("f", (1, 3, 2), [], descr=CELL) + b"".join(cells))
        self.write("cells.raw", b"".join(cells))
        corners = [struct.pack("<2iI", i, -i, 1) for i in range(6)]
        self.write("pairs.raw", b"".join(corners))
        expected = [[0, i // 2, i % 2, i / 2, i, 2, 9 - i, i % 2] for i in range(6)]
        for file in ({"buffer": "cells.npy"}, {"buffer": "cells.raw", "shape": [1, 3, 2]}):
            self.structs(cells=file, pairs={"buffer": "pairs.raw"})
            for options in ([], ["--target=host-megakernel"]):
                self.assertEqual(
                    self.printed(*options), expected + [[0, -1], [2, -3], [4, -5]], file
                )

    def test_wrong_structs(self):
        self.write("a.npy", npy("f", (2, 2, 2), range(8)))
        self.write("a.csv", "x\n1\n")
        for member, value, code, containing in (
            (
                "cells",
                {"buffer": "a.npy"},
                "E0906",
                f"its elements are '<f4', not the structs {CELL}",
            ),
            ("cells", {"buffer": "a.csv"}, "E0808", "its elements are structs"),
        ):
            self.structs(**{member: value})
            self.assert_message(
                self.diagnose("render", "scene.json", "-o", "x.exr"), code, containing, line=1
            )
        self.write("a.npy", npy("f", (2,), [], descr=CORNER) + bytes(24))
        self.scene(numbers={"buffer": "a.npy"})
        messages = self.diagnose("render", "scene.json", "-o", "x.exr", "-Wno-all")
        self.assert_message(
            messages, "E0906", f"its elements are {CORNER}, not little-endian integers or floats"
        )
        self.structs(pairs={"buffer": "a.npy"})
        messages = self.diagnose("render", "scene.json", "-o", "x.exr", "-Wno-all")
        self.assert_message(
            messages, "E0804", "the shape (n, 2) of structs, and `a.npy` has the shape (2)"
        )

    def test_what_takes_no_file(self):
        self.write("a.npy", npy("f", (1,), [1]))
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": ["show.rtsl"],
                    "rayGeneration": {"class": "Objects", "textures": {"buffer": "a.npy"}},
                    "render": {"engine": "programs", "size": [1, 1]},
                }
            ),
        )
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "x.exr"), "E0808", "a file cannot hold"
        )


if __name__ == "__main__":
    unittest.main()
