#!/usr/bin/env python3
"""make-tiles.py: writes the hundred images of this example, tiles/00.png to tiles/99.png, 64 x 64
pixels each."""
import math
import pathlib
import struct
import zlib

SIZE, SUB = 64, 3
COLORS = [
    (244, 239, 226),
    (24, 62, 122),
    (70, 130, 180),
    (214, 158, 46),
    (196, 92, 52),
    (46, 112, 92),
]


def rings(x, y, k):
    return int(math.hypot(x, y) * (3 + k)) % 2


def arcs(x, y, k):
    near = min(abs(math.hypot(abs(x) - 1, abs(y) - 1) - 1), abs(math.hypot(x, y) - 0.4 - 0.1 * k))
    return 1 if near < 0.1 else 0


def rosette(x, y, k):
    edge = 0.62 + 0.25 * math.cos((4 + 2 * k) * math.atan2(y, x))
    r = math.hypot(x, y)
    return 2 if r < 0.22 else 1 if r < edge else 0


def diamonds(x, y, k):
    d = abs(x) + abs(y)
    return 1 if abs(d - 1) < 0.14 else 2 if d < 0.35 + 0.08 * k else 0


def waves(x, y, k):
    return 1 if math.sin(3 * math.pi * y + 0.9 * math.sin((k + 1) * math.pi * x)) > 0.2 else 0


MOTIFS = [rings, arcs, rosette, diamonds, waves]


def tile(number):
    motif, k = MOTIFS[number % 5], number // 5 % 4
    first = 1 + number // 20
    palette = [COLORS[0], COLORS[first], COLORS[1 + (first + 1 + k) % 5]]
    rows = []
    for y in range(SIZE):
        row = b"\0"
        for x in range(SIZE):
            sums = [0, 0, 0]
            for i in range(SUB):
                for j in range(SUB):
                    u = 2 * (x + (i + 0.5) / SUB) / SIZE - 1
                    v = 2 * (y + (j + 0.5) / SUB) / SIZE - 1
                    sums = [s + c for s, c in zip(sums, palette[motif(u, v, k)])]
            row += bytes(s // SUB**2 for s in sums)
        rows.append(row)
    return b"".join(rows)


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


folder = pathlib.Path(__file__).resolve().parent / "tiles"
folder.mkdir(exist_ok=True)
for number in range(100):
    (folder / f"{number:02}.png").write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", SIZE, SIZE, 8, 2, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(tile(number), 9))
        + chunk(b"IEND", b"")
    )
