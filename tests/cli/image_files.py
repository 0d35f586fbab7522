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


def jpeg(width, height, pixel):
    """A baseline JPEG file of three channels: each block of 8 by 8 pixels has one color, that of
    its upper left pixel, within a rounding error."""
    bits = ""
    before = [0, 0, 0]
    for y in range(0, height, 8):
        for x in range(0, width, 8):
            red, green, blue = pixel(x, y)
            luma = 0.299 * red + 0.587 * green + 0.114 * blue
            for i, value in enumerate((luma, (blue - luma) / 1.772, (red - luma) / 1.402)):
                mean = round(8 * (value - 128 if i == 0 else value))  # of a block: 8 times its mean
                change, before[i] = mean - before[i], mean
                size = abs(change).bit_length()
                bits += f"{size:04b}"
                if size:
                    bits += f"{change if change > 0 else change + 2**size - 1:0{size}b}"
                bits += "0"  # no other frequencies
    bits += "1" * (-len(bits) % 8)
    data = bytes(int(bits[i : i + 8], 2) for i in range(0, len(bits), 8))

    def segment(marker, content):
        return bytes([0xFF, marker]) + struct.pack(">H", 2 + len(content)) + content

    components = b"".join(bytes([i, 0x11, 0]) for i in (1, 2, 3))  # none has fewer pixels
    return (
        b"\xff\xd8"
        + segment(0xE0, b"JFIF\0\x01\x01" + bytes([0, 0, 1, 0, 1, 0, 0]))
        + segment(0xDB, b"\0" + bytes([1] * 64))  # nothing is quantised but by rounding
        + segment(0xC0, struct.pack(">BHHB", 8, height, width, 3) + components)
        + segment(0xC4, b"\x00" + bytes([0, 0, 0, 12] + [0] * 12) + bytes(range(12)))  # 4 bits each
        + segment(0xC4, b"\x10" + bytes([1] + [0] * 15) + b"\0")
        + segment(0xDA, bytes([3, 1, 0, 2, 0, 3, 0, 0, 63, 0]))
        + data.replace(b"\xff", b"\xff\0")
        + b"\xff\xd9"
    )
