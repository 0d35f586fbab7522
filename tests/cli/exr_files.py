"""Reads the EXR files that rtslc writes: 32-bit floats, ZIP compression, any channels, one part."""

import struct
import zlib

LINES = 16  # of a block


def header(data):
    """The attributes by name, and where they end."""
    found, at = {}, 8
    while data[at]:
        name, at = data[at : data.index(0, at)].decode(), data.index(0, at) + 1
        at = data.index(0, at) + 1
        size = struct.unpack_from("<i", data, at)[0]
        found[name] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return found, at + 1


def attributes(data):
    return header(data)[0]


def channel_names(attribute):
    names, at = [], 0
    while attribute[at]:
        end = attribute.index(0, at)
        names.append(attribute[at:end].decode())
        at = end + 17  # its type and sampling
    return names


def unpacked(packed):
    """A block: differences of bytes, those with an even index first."""
    differences = zlib.decompress(packed)
    summed = bytearray(differences[:1])
    for difference in differences[1:]:
        summed.append((summed[-1] + difference - 128) % 256)
    half = (len(summed) + 1) // 2
    flat = bytearray(len(summed))
    flat[0::2], flat[1::2] = summed[:half], summed[half:]
    return bytes(flat)


def channels(data):
    """The bits of the pixels of each channel, row by row."""
    found, at = header(data)
    left, top, right, bottom = struct.unpack("<4i", found["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    names = channel_names(found["channels"])
    words = {name: [] for name in names}
    blocks = (height + LINES - 1) // LINES
    for block, offset in enumerate(struct.unpack_from(f"<{blocks}q", data, at)):
        first, size = struct.unpack_from("<ii", data, offset)
        assert first == top + LINES * block, first
        lines = min(LINES, height - LINES * block)
        packed, length = data[offset + 8 : offset + 8 + size], lines * width * len(names) * 4
        flat = packed if size == length else unpacked(packed)
        numbers = struct.unpack(f"<{length // 4}I", flat)
        for part in range(lines * len(names)):
            words[names[part % len(names)]] += numbers[part * width : (part + 1) * width]
    return words
