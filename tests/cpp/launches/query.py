#!/usr/bin/env python3
"""query.py RTSLC SOURCE QUERY: the C functions for rays against a mesh find what `rtslc trace`
finds, bit for bit."""
import pathlib
import random
import struct
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from programs import run

rtslc, source, query = sys.argv[1:]
mesh = f"{source}/examples/glass/knot.obj"
RAYS = 20000


def rays():
    numbers = random.Random(3)
    for i in range(RAYS):
        origin = [numbers.uniform(-3, 3) for _ in range(3)]
        to = [numbers.uniform(-1, 1) for _ in range(3)]
        direction = [b - a for a, b in zip(origin, to)]
        if i % 100 == 7:
            direction = [0, 0, 0]
        if i % 100 == 8:
            origin[1] = float("nan")
        end = numbers.choice([3.402823466e38, 0.9, 1.5])
        yield [*origin, numbers.choice([0, 0, 0.3]), *direction, end]


def array_of(path):
    """The elements of a .npy file, as bytes."""
    content = path.read_bytes()
    return content[10 + struct.unpack("<H", content[8:10])[0] :]


with tempfile.TemporaryDirectory(prefix="rtsl-query-") as name:
    folder = pathlib.Path(name)
    content = b"".join(struct.pack("<8f", *ray) for ray in rays())
    (folder / "rays.raw").write_bytes(content)
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({RAYS}, 8), }}"
    header += " " * (117 - len(header)) + "\n"
    npy = b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + content
    (folder / "rays.npy").write_bytes(npy)
    said = run(query, mesh, folder / "rays.raw", folder / "hits.raw", folder / "any.raw")
    trace = (rtslc, "trace", mesh, "--rays", folder / "rays.npy", "-q")
    run(*trace, "--out", folder / "hits.npy")
    run(*trace, "--any", "--out", folder / "any.npy")
    hits = (folder / "hits.raw").read_bytes()
    assert hits == array_of(folder / "hits.npy")
    assert (folder / "any.raw").read_bytes() == array_of(folder / "any.npy")
    found = sum(struct.unpack_from("<i", hits, 16 * i + 4)[0] >= 0 for i in range(RAYS))
    assert RAYS / 10 < found < RAYS * 9 / 10, found
    for line, word in zip(said.splitlines(), ("2 positions", "vertex 1"), strict=True):
        assert word in line, said
