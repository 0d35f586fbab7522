"""rtslc trace: hits of random rays against those of an oracle in exact arithmetic, on every path,
and files that are wrong."""

import random
import struct
import unittest
from fractions import Fraction

from harness import USAGE, Case
from numpy_files import npy

PATHS = (
    [],
    ["--traversal=device"],
    ["--trace=recurse"],
    ["--target=host-megakernel"],
    ["-O0"],
    ["--pixels-in-turns=4"],
)


def read_hits(path):
    """(t, triangle, u, v) of each ray."""
    data = path.read_bytes()
    length = struct.unpack("<H", data[8:10])[0]
    header = eval(data[10 : 10 + length])  # a literal
    assert header["descr"] == [
        ("t", "<f4"),
        ("triangle", "<i4"),
        ("u", "<f4"),
        ("v", "<f4"),
    ], header
    hits = [
        struct.unpack_from("<fiff", data, 10 + length + 16 * i) for i in range(header["shape"][0])
    ]
    assert len(data) == 10 + length + 16 * len(hits)
    return hits


def read_bools(path):
    data = path.read_bytes()
    return [bool(byte) for byte in data[10 + struct.unpack("<H", data[8:10])[0] :]]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def nearest(triangles, ray):
    """The nearest hit of a ray (origin, tmin, direction, tmax), and how far from an edge or from
    another hit it is: exact."""
    origin, tmin, direction, tmax = ray[:3], ray[3], ray[4:7], ray[7]
    hits, doubt = [], Fraction(1)
    for number, (a, b, c) in enumerate(triangles):
        e, f, s = ([x - y for x, y in zip(p, a)] for p in (b, c, origin))
        p = cross(direction, f)
        determinant = dot(e, p)
        if determinant == 0:
            continue
        q = cross(s, e)
        u, v, t = (x / determinant for x in (dot(s, p), dot(direction, q), dot(f, q)))
        inside = min(u, v, 1 - u - v)
        if inside > -Fraction(1, 10**4) and tmin < t < tmax:
            doubt = min(doubt, abs(inside))
            if inside >= 0:
                hits.append((t, number, u, v))
    hits.sort()
    return (hits[0] if hits else None), doubt


class Trace(Case):
    def setUp(self):
        super().setUp()
        random.seed(7)
        points = [[random.uniform(-1, 1) for _ in range(3)] for _ in range(60)]
        faces = [random.sample(range(60), 3) for _ in range(40)]
        single = lambda x: struct.unpack("f", struct.pack("f", x))[0]
        points = [[single(x) for x in p] for p in points]
        self.write(
            "soup.obj",
            "".join("v %r %r %r\nvt %r %r\n" % (*p, p[0], p[1]) for p in points)
            + "".join("f " + " ".join(f"{i + 1}/{i + 1}" for i in face) + "\n" for face in faces),
        )
        self.triangles = [[[Fraction(x) for x in points[i]] for i in face] for face in faces]
        self.rays = []
        for _ in range(200):
            origin = [random.uniform(-2, 2) for _ in range(3)]
            to = [random.uniform(-0.7, 0.7) for _ in range(3)]
            direction = [b - a for a, b in zip(origin, to)]
            self.rays.append(
                [
                    single(x)
                    for x in (
                        *origin,
                        random.choice([0, 0, 0.5, 1]),
                        *direction,
                        random.choice([1e30, 1e30, 0.9]),
                    )
                ]
            )
        self.write("rays.npy", npy("f", [200, 8], [x for ray in self.rays for x in ray]))

    def test_hits_are_those_of_exact_arithmetic(self):
        first = None
        for options in PATHS:
            self.run_rtslc(
                "trace", "soup.obj", "--rays", "rays.npy", "--out", "hits.npy", "-q", *options
            )
            hits = read_hits(self.folder / "hits.npy")
            first = first or hits
            self.assertEqual(hits, first, options)
            self.run_rtslc(
                "trace",
                "soup.obj",
                "--rays",
                "rays.npy",
                "--any",
                "--out",
                "any.npy",
                "-q",
                *options,
            )
            self.assertEqual(
                read_bools(self.folder / "any.npy"),
                [triangle >= 0 for _, triangle, _, _ in first],
                options,
            )
        compared = 0
        for ray, (t, triangle, u, v) in zip(self.rays, first):
            expected, doubt = nearest(self.triangles, [Fraction(x) for x in ray])
            if doubt < Fraction(1, 10**5):
                continue  # rounding decides
            compared += 1
            if not expected:
                self.assertEqual((t, triangle), (-1, -1), ray)
                continue
            self.assertEqual(triangle, expected[1], ray)
            for found, exact in ((t, expected[0]), (u, expected[2]), (v, expected[3])):
                self.assertLess(
                    abs(Fraction(found) - exact), Fraction(1, 10**5) * max(1, exact), ray
                )
        self.assertGreater(compared, 150)
        self.assertGreater(sum(hit[1] >= 0 for hit in first), 60)

    def test_rays_of_six_numbers_and_of_csv(self):
        lines = [ray[:3] + ray[4:7] for ray in self.rays]
        self.write("lines.npy", npy("f", [200, 6], [x for line in lines for x in line]))
        self.write("doubles.npy", npy("d", [200, 6], [x for line in lines for x in line]))
        self.write(
            "lines.csv",
            "ox,oy,oz,dx,dy,dz\n" + "".join(",".join(map(repr, line)) + "\n" for line in lines),
        )
        self.write(
            "all.npy",
            npy(
                "f",
                [200, 8],
                [x for line in lines for x in (*line[:3], 0.0, *line[3:], 3.4028235e38)],
            ),
        )
        for name in ("all.npy", "lines.npy", "doubles.npy", "lines.csv"):
            self.run_rtslc("trace", "soup.obj", "--rays", name, "--out", name + ".hits", "-q")
            self.assert_same_bits("all.npy.hits", name + ".hits", name)
        self.assertEqual((self.folder / "all.npy.hits").stat().st_size, 16 * 200)

    def test_rays_of_columns(self):
        lines = [ray[:3] + ray[4:7] for ray in self.rays]
        self.write("all.npy", npy("f", [200, 6], [x for line in lines for x in line]))
        self.run_rtslc("trace", "soup.obj", "--rays", "all.npy", "--out", "wanted.npy", "-q")
        # In another order than in the file, among others, and with lists.
        self.write(
            "some.csv",
            "dx,dy,dz,weight,ox,oy,oz\n"
            + "".join(",".join(map(repr, (*line[3:], 7, *line[:3]))) + "\n" for line in lines),
        )
        names = ("nx", "ny", "nz", "x", "y", "z")
        header = "".join(f"property float {name}\n" for name in names)
        rows = "".join(" ".join(map(repr, (*line[3:], *line[:3]))) + "\n" for line in lines)
        self.write(
            "points.ply",
            f"ply\nformat ascii 1.0\nelement vertex 200\n{header}element face 1\n"
            "property list uchar int vertex_indices\n"
            f"end_header\n{rows}3 0 1 2\n",
        )
        self.write(
            "rays.ply",
            "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nelement ray 200\n"
            f"{header}end_header\n{rows}",
        )
        in_order = "x,y,z,nx,ny,nz"
        for options in (
            ["some.csv", "--columns", "ox,oy,oz,dx,dy,dz"],
            ["points.ply", "--columns", in_order],
            ["rays.ply", "--element", "ray", "--columns", in_order],
        ):
            self.run_rtslc("trace", "soup.obj", "--rays", *options, "--out", "found.npy", "-q")
            self.assert_same_bits("found.npy", "wanted.npy", options)
        # All columns, in the order of the file: other rays.
        self.run_rtslc("trace", "soup.obj", "--rays", "points.ply", "--out", "found.npy", "-q")
        self.assertNotEqual(
            (self.folder / "found.npy").read_bytes(), (self.folder / "wanted.npy").read_bytes()
        )
        for options, code, containing in (
            (["some.csv", "--columns", "ox,oy,oz,dx,dy,dw"], "E0806", "`dw`"),
            (["points.ply", "--columns", "x,y,z,nx,ny,q"], "E0806", "`q`"),
            (["points.ply", "--columns", "x,y,z"], "E0906", "has the shape (200, 3)"),
            (["points.ply", "--element", "edge"], "E0806", "`edge`"),
            (["all.npy", "--columns", "x"], "E0906", "`--columns` is for .csv and .ply"),
        ):
            self.assert_message(
                self.diagnose("trace", "soup.obj", "--rays", *options, "--out", "hits.npy"),
                code,
                containing,
            )
        self.assert_message(
            self.diagnose(
                "trace",
                "soup.obj",
                "--rays",
                "points.ply",
                "--columns",
                in_order,
                "--out",
                "points.ply",
            ),
            "E0965",
            "is an input",
        )

    def test_what_is_wrong(self):
        for name, content, code, containing in (
            (
                "a.npy",
                npy("f", [3, 7], [0.0] * 21),
                "E0906",
                "rays have 6 numbers, origin and direction, or 8",
            ),
            ("b.npy", npy("f", [6], [0.0] * 6), "E0906", "has the shape (6)"),
            ("c.npy", npy("f", [0, 6], []), "E0906", "`c.npy` has no rays"),
            ("d.npy", npy("f", [3, 6], [0.0] * 18)[:-4], "E0906", "it is truncated"),
            ("e.bin", b"", "E0906", "is neither .npy, .csv nor .ply"),
            ("f.csv", "1,2,3,4,5,6\n1,2,3\n", "E0906", "line 2 has 3 columns"),
        ):
            self.write(name, content)
            self.assert_message(
                self.diagnose("trace", "soup.obj", "--rays", name, "--out", "hits.npy"),
                code,
                containing,
            )
        self.assert_message(
            self.diagnose("trace", "soup.obj", "--rays", "none.npy"), "E0900", "none.npy"
        )
        missing = self.diagnose("trace", "none.obj", "--rays", "rays.npy")
        self.assert_message(missing, "E0900", "none.obj")
        self.assertNotIn("--set", missing)
        self.assert_message(
            self.diagnose("trace", "soup.obj", "--rays", "rays.npy", "--out", "rays.npy"),
            "E0965",
            "is an input",
        )
        self.assert_message(
            self.diagnose("trace", "soup.obj", "--rays", "rays.npy", "--out", "soup.obj"),
            "E0965",
            "is an input",
        )
        self.assertFalse((self.folder / "hits.npy").exists())
        self.run_rtslc("trace", "soup.obj", status=USAGE)

    def test_rays_that_are_not_finite_hit_nothing(self):
        nan, inf = float("nan"), float("inf")
        rays = [
            [0, 0, 5, nan, 0, -1],
            [0, 0, 5, 0, 0, 0],
            [inf, 0, 5, 0, 0, -1],
            [0, 0, 5, 0, 0, -inf],
        ]
        self.write("bad.npy", npy("f", [4, 6], [x for ray in rays for x in ray]))
        for options in PATHS:
            self.run_rtslc(
                "trace", "soup.obj", "--rays", "bad.npy", "--out", "hits.npy", "-q", *options
            )
            self.assertEqual(read_hits(self.folder / "hits.npy"), [(-1, -1, 0, 0)] * 4, options)
            self.run_rtslc(
                "trace", "soup.obj", "--rays=bad.npy", "--any", "--out=any.npy", "-q", *options
            )
            self.assertEqual(read_bools(self.folder / "any.npy"), [False] * 4, options)


if __name__ == "__main__":
    unittest.main()
