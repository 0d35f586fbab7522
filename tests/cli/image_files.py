"""Writes small image files of given pixels."""

import struct
import zlib


def png(width, height, pixel, bits=8, channels=3):
    """A PNG file of integers; `pixel(x, y)` from the top left."""
    color_type = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    form = ">%d%s" % (channels, "B" if bits == 8 else "H")
    rows = b"".join(
        b"\0" + b"".join(struct.pack(form, *pixel(x, y)) for x in range(width))
        for y in range(height)
    )

    def chunk(name, data):
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    header = struct.pack(">IIBBBBB", width, height, bits, color_type, 0, 0, 0)
    return (
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", header)
        + chunk(b"IDAT", zlib.compress(rows))
        + chunk(b"IEND", b"")
    )


def hdr(width, height, pixel):
    """A Radiance file; `pixel` gives mantissas and an exponent."""
    header = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (height, width)
    return header + b"".join(bytes(pixel(x, y)) for y in range(height) for x in range(width))


def tiff(width, height, pixel, form, sample_format):
    """A little-endian TIFF of three channels, not compressed; `form` is the letter of struct."""
    data = b"".join(
        struct.pack("<3" + form, *pixel(x, y)) for y in range(height) for x in range(width)
    )
    bits = 8 * struct.calcsize(form)
    entries = [
        (256, 4, 1, width),
        (257, 4, 1, height),
        (258, 3, 3, 8),
        (259, 3, 1, 1),
        (262, 3, 1, 2),
        (273, 4, 1, 200),
        (277, 3, 1, 3),
        (278, 4, 1, height),
        (279, 4, 1, len(data)),
        (339, 3, 3, 14),
    ]
    directory = (
        struct.pack("<H", len(entries))
        + b"".join(struct.pack("<HHII", *e) for e in entries)
        + struct.pack("<I", 0)
    )
    head = (
        b"II*\0"
        + struct.pack("<I", 20)
        + struct.pack("<3H", *[bits] * 3)
        + struct.pack("<3H", *[sample_format] * 3)
    )
    return (head + directory).ljust(200, b"\0") + data
