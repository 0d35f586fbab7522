#!/usr/bin/env python3
"""make-sky.py: writes sky.raw, the light of a room from all directions, as 256 x 128 colors of 16
bits: dark walls, a window with the sky in it, a row of warm lamps, and a pale floor."""
import math
import pathlib
import struct

WIDTH, HEIGHT = 256, 128


def wrapped(angle):
    """In (-180, 180]."""
    return (angle + 180) % 360 - 180


def light(longitude, latitude):
    """Radiance from a direction in degrees; longitude 0 is -z, latitude 90 straight up."""
    wall = 0.06 + 0.05 * math.cos(math.radians(latitude))
    color = [wall, 0.95 * wall, 0.85 * wall]
    if latitude < -8:  # the floor
        pale = 0.16 * (1 + 0.3 * math.sin(0.3 * longitude) * math.sin(0.4 * latitude))
        color = [pale, 0.9 * pale, 0.75 * pale]
    # A window of two by three panes.
    x, y = wrapped(longitude + 60) / 26, (latitude - 24) / 22
    if abs(x) < 1 and abs(y) < 1:
        bar = min(abs(x), 1 - abs(x)) < 0.05 or min(abs(y - 0.33), abs(y + 0.33), 1 - abs(y)) < 0.05
        sky = 7 + 5 * (y + 1)
        color = [0.05] * 3 if bar else [0.75 * sky, 0.9 * sky, 1.1 * sky]
    # Lamps under the ceiling.
    for lamp in range(5):
        across = wrapped(longitude - 60 - 14 * lamp)
        if across**2 + (latitude - 38) ** 2 < 7:
            color = [120, 78, 36]
    return color


def main():
    texels = []
    for row in range(HEIGHT):  # from the lowest on
        for column in range(WIDTH):
            longitude = 360 * ((column + 0.5) / WIDTH - 0.5)
            latitude = 180 * ((row + 0.5) / HEIGHT - 0.5)
            texels += [*light(longitude, latitude), 1.0]
    path = pathlib.Path(__file__).resolve().parent / "sky.raw"
    path.write_bytes(struct.pack(f"<{len(texels)}e", *texels))


main()
