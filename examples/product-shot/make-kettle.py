#!/usr/bin/env python3
"""make-kettle.py: writes kettle.obj, an enamelled kettle: a body and a lid that are turned, a spout
and a handle that are swept along curves. Normals are those of the surfaces."""
import math
import pathlib

AROUND, ALONG = 40, 6  # quads around an axis, and for each piece of a profile or path


class Mesh:
    def __init__(self):
        self.lines, self.count = [], 0

    def grid(self, rows, material):
        """Quads between rows of (point, normal); each row is closed."""
        self.lines.append(f"usemtl {material}")
        first = self.count
        for row in rows:
            for point, normal in row:
                self.lines.append("v {:.4f} {:.4f} {:.4f}".format(*point))
                self.lines.append("vn {:.3f} {:.3f} {:.3f}".format(*normal))
                self.count += 1
        width = len(rows[0])
        for i in range(len(rows) - 1):
            for j in range(width):
                k = (j + 1) % width
                a, b = first + i * width + 1, first + (i + 1) * width + 1
                self.lines.append(
                    "f " + " ".join(f"{n}//{n}" for n in (a + j, a + k, b + k, b + j))
                )


def unit(v):
    length = math.sqrt(sum(x * x for x in v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    )


def spline(points, steps):
    """Points of a Catmull-Rom spline through the given ones, with tangents."""
    ends = [points[0], *points, points[-1]]
    for i in range(len(points) - 1):
        p0, p1, p2, p3 = ends[i : i + 4]
        for step in range(steps + (i == len(points) - 2)):
            t = step / steps
            point = tuple(
                b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a)))
                for a, b, c, d in zip(p0, p1, p2, p3)
            )
            tangent = tuple(
                0.5
                * (c - a + 2 * t * (2 * a - 5 * b + 4 * c - d) + 3 * t * t * (3 * (b - c) + d - a))
                for a, b, c, d in zip(p0, p1, p2, p3)
            )
            yield point, tangent


def turned(mesh, profile, material):
    """A profile of (radius, height), upwards on the outside, about the y axis."""
    rows = []
    for (radius, height), (along, up) in spline(profile, ALONG):
        length = math.hypot(along, up) or 1
        row = []
        for j in range(AROUND):
            c, s = math.cos(2 * math.pi * j / AROUND), math.sin(2 * math.pi * j / AROUND)
            row.append(
                (
                    (radius * c, height, -radius * s),
                    (up / length * c, -along / length, -up / length * s),
                )
            )
        rows.append(row)
    mesh.grid(rows, material)


def swept(mesh, path, radii, material):
    """A tube along a path in the plane z = 0, with a radius at each of its points."""
    rows = []
    points = list(spline(path, ALONG))
    sizes = [r for (r,), _ in spline([(r,) for r in radii], ALONG)]
    for (point, tangent), radius in zip(points, sizes):
        across = unit((tangent[1], -tangent[0], 0))
        side = unit(cross(across, tangent))
        row = []
        for j in range(16):
            c, s = math.cos(2 * math.pi * j / 16), math.sin(2 * math.pi * j / 16)
            normal = tuple(c * a + s * b for a, b in zip(across, side))
            row.append((tuple(p + radius * n for p, n in zip(point, normal)), normal))
        rows.append(row)
    mesh.grid(rows, material)


def main():
    mesh = Mesh()
    # fmt: off
    turned(mesh, [(0.02, 0.0), (0.7, 0.01), (0.98, 0.05), (1.12, 0.3), (1.05, 0.75), (0.8, 1.1),
                  (0.52, 1.27)], "enamel")
    turned(mesh, [(0.52, 1.26), (0.56, 1.28), (0.56, 1.31), (0.51, 1.33)], "steel")
    turned(mesh, [(0.5, 1.32), (0.42, 1.4), (0.2, 1.47), (0.06, 1.49), (0.05, 1.55)], "enamel")
    turned(mesh, [(0.05, 1.54), (0.13, 1.6), (0.15, 1.69), (0.09, 1.76), (0.005, 1.78)], "wood")
    swept(mesh, [(0.85, 0.5, 0), (1.2, 0.62, 0), (1.45, 0.9, 0), (1.72, 1.22, 0)],
          [0.24, 0.2, 0.13, 0.09], "enamel")
    swept(mesh, [(0.6, 1.1, 0), (0.78, 1.45, 0), (0.66, 1.95, 0)], [0.04, 0.035, 0.03], "steel")
    swept(mesh, [(-0.6, 1.1, 0), (-0.78, 1.45, 0), (-0.66, 1.95, 0)], [0.04, 0.035, 0.03], "steel")
    swept(mesh, [(0.72, 1.92, 0), (0.4, 2.12, 0), (0.0, 2.2, 0), (-0.4, 2.12, 0), (-0.72, 1.92, 0)],
          [0.05, 0.085, 0.09, 0.085, 0.05], "wood")
    # fmt: on
    path = pathlib.Path(__file__).resolve().parent / "kettle.obj"
    path.write_text("mtllib kettle.mtl\n" + "\n".join(mesh.lines) + "\n")


main()
