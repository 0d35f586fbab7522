#!/usr/bin/env python3
"""Writes the meshes of this example: a flag at three times, and a blade of the fan.

usage: make-meshes.py
"""

import math
import pathlib

HERE = pathlib.Path(__file__).resolve().parent
COLUMNS, ROWS = 24, 12


def flag(phase):
    """2.4 x 1.5, held at x = 0, with waves that grow to the right."""
    lines = []
    for j in range(ROWS + 1):
        for i in range(COLUMNS + 1):
            u, v = i / COLUMNS, j / ROWS
            depth = 0.38 * u * math.sin(7.0 * u - phase + 0.6 * v)
            lines.append(f"v {2.4 * u - 0.1 * u * u:.4f} {1.5 * v - 0.15 * u:.4f} {depth:.4f}")
    for j in range(ROWS + 1):
        for i in range(COLUMNS + 1):
            lines.append(f"vt {i / COLUMNS:.4f} {j / ROWS:.4f}")
    for j in range(ROWS):
        for i in range(COLUMNS):
            a = j * (COLUMNS + 1) + i + 1
            b, c, d = a + 1, a + COLUMNS + 2, a + COLUMNS + 1
            lines.append(f"f {a}/{a} {b}/{b} {c}/{c} {d}/{d}")
    return lines


def blade():
    """From the hub at the origin along x, 1 long, twisted."""
    lines, steps, across = [], 12, 6
    for i in range(steps + 1):
        r = 0.15 + 0.85 * i / steps
        width = 0.34 * math.sin(math.pi * min(1, 0.25 + 0.85 * i / steps)) + 0.05
        pitch = math.radians(35 - 15 * i / steps)
        for j in range(across + 1):
            s = width * (2 * j / across - 1)
            lines.append(f"v {r:.4f} {s * math.cos(pitch):.4f} {s * math.sin(pitch):.4f}")
    for i in range(steps):
        for j in range(across):
            a = i * (across + 1) + j + 1
            lines.append(f"f {a} {a + 1} {a + across + 2} {a + across + 1}")
    return lines


def main():
    for number, phase in enumerate((0.0, 0.7, 1.4)):
        (HERE / f"flag-{number}.obj").write_text("\n".join(flag(phase)) + "\n")
    (HERE / "blade.obj").write_text("\n".join(blade()) + "\n")


if __name__ == "__main__":
    main()
