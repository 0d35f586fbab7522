#!/usr/bin/env python3
"""make-smoke.py: writes smoke.raw, a column of smoke that rises, sways and breaks up, as 40 x 64 x
40 densities of 8 bits.

The axis of the column is bent by noise that grows with the height, and its edge frayed by octaves
of noise whose domain is warped by other noise, so that it curls."""
import math
import pathlib

WIDTH, HEIGHT, DEPTH = 40, 64, 40


def hashed(x, y, z, seed):
    h = (x * 0x8DA6B343 ^ y * 0xD8163841 ^ z * 0xCB1AB31F ^ seed * 0x9E3779B9) & 0xFFFFFFFF
    h = (h ^ h >> 16) * 0x7FEB352D & 0xFFFFFFFF
    h = (h ^ h >> 15) * 0x846CA68B & 0xFFFFFFFF
    return (h ^ h >> 16) / 0xFFFFFFFF


def noise(x, y, z, seed):
    """Value noise in [-1, 1]."""
    i, j, k = math.floor(x), math.floor(y), math.floor(z)
    u, v, w = (t * t * (3 - 2 * t) for t in (x - i, y - j, z - k))
    total = 0.0
    for a in (0, 1):
        for b in (0, 1):
            for c in (0, 1):
                weight = (u if a else 1 - u) * (v if b else 1 - v) * (w if c else 1 - w)
                total += weight * hashed(i + a, j + b, k + c, seed)
    return 2 * total - 1


def octaves(x, y, z, seed):
    return sum(0.5**n * noise(x * 2**n, y * 2**n, z * 2**n, seed + n) for n in range(4))


def density(x, y, z):
    """x and z in [-1, 1], y, upward, in [0, 1]."""
    sway = 0.75 * y**1.1
    x -= sway * noise(2.1 * y, 0.3, 0.5, 11)
    z -= sway * noise(2.1 * y, 7.3, 0.5, 12)
    warp = 0.3 + 0.5 * y
    wx = x + warp * 0.35 * noise(2.5 * x, 5 * y, 2.5 * z, 21)
    wz = z + warp * 0.35 * noise(2.5 * x, 5 * y, 2.5 * z, 22)
    radius = 0.09 + 0.45 * y**0.9
    inside = (
        1 - math.hypot(wx, wz) / radius + (0.5 + 0.9 * y) * octaves(4 * wx, 7 * y, 4 * wz, 31) - 0.1
    )
    value = max(0.0, min(1.0, 2.2 * inside)) * (1 - 0.5 * y)
    edge = min(1 - abs(x), 1 - abs(z), 6 * (1 - y))  # nothing at the sides of the box
    return value * max(0.0, min(1.0, 3 * edge))


def main():
    values = bytearray()
    for k in range(DEPTH):
        for j in range(HEIGHT):
            for i in range(WIDTH):
                value = density(
                    2 * (i + 0.5) / WIDTH - 1, (j + 0.5) / HEIGHT, 2 * (k + 0.5) / DEPTH - 1
                )
                values.append(round(255 * value))
    (pathlib.Path(__file__).parent / "smoke.raw").write_bytes(values)


main()
