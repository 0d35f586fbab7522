#!/usr/bin/env python3
"""Writes knot.obj: a trefoil knot as a tube of triangles, with normals and texture coordinates."""

import math

ALONG, AROUND, TUBE, SIZE = 128, 16, 0.28, 0.38


def curve(s):
    """The trefoil (2, 3) torus knot at parameter s in [0, 2 pi), as a point."""
    r = 2 + math.cos(3 * s)
    return (SIZE * r * math.cos(2 * s), SIZE * r * math.sin(2 * s), -SIZE * math.sin(3 * s))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def frame(s):
    """Two unit vectors across the curve: away from the knot's axis, and the rest of a right-handed
    frame."""
    tangent = unit(sub(curve(s + 1e-4), curve(s - 1e-4)))
    p = curve(s)
    away = (p[0], p[1], 0.0)
    along = sum(a * t for a, t in zip(away, tangent))
    u = unit(tuple(a - along * t for a, t in zip(away, tangent)))
    return u, cross(tangent, u)


with open("knot.obj", "w") as out:
    out.write("# a trefoil knot, written by make-knot.py\n")
    for i in range(ALONG):
        s = 2 * math.pi * i / ALONG
        centre, (u, v) = curve(s), frame(s)
        for j in range(AROUND):
            angle = 2 * math.pi * j / AROUND
            n = tuple(math.cos(angle) * a + math.sin(angle) * b for a, b in zip(u, v))
            out.write("v %.5f %.5f %.5f\n" % tuple(c + TUBE * k for c, k in zip(centre, n)))
            out.write("vn %.4f %.4f %.4f\n" % n)
            out.write("vt %.4f %.4f\n" % (i / ALONG, j / AROUND))
    for i in range(ALONG):
        for j in range(AROUND):
            a = i * AROUND + j + 1
            b = i * AROUND + (j + 1) % AROUND + 1
            c = (i + 1) % ALONG * AROUND + (j + 1) % AROUND + 1
            d = (i + 1) % ALONG * AROUND + j + 1
            out.write("f %d/%d/%d %d/%d/%d %d/%d/%d\n" % (a, a, a, c, c, c, d, d, d))
            out.write("f %d/%d/%d %d/%d/%d %d/%d/%d\n" % (a, a, a, b, b, b, c, c, c))
