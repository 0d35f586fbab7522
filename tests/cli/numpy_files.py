"""Files of NumPy, which buffers are read from and written to."""

import struct


def npy(form, shape, numbers, order="False", version=1, descr=None):
    """A file of NumPy. `descr`: another type of elements, or that of structs, a list."""
    kinds = {
        "f": "<f4",
        "d": "<f8",
        "e": "<f2",
        "i": "<i4",
        "q": "<i8",
        "I": "<u4",
        "Q": "<u8",
        "h": "<i2",
        "H": "<u2",
        "b": "|i1",
        "B": "|u1",
        "?": "|b1",
    }
    name = descr or kinds[form]
    text = "{'descr': %s, 'fortran_order': %s, 'shape': (%s), }" % (
        name if name.startswith("[") else f"'{name}'",
        order,
        ", ".join(map(str, shape)) + ("," if len(shape) == 1 else ""),
    )
    length = struct.pack("<H" if version == 1 else "<I", len(text) + 1)
    return (
        b"\x93NUMPY"
        + bytes([version, 0])
        + length
        + text.encode()
        + b"\n"
        + struct.pack(f"<{len(numbers)}{form}", *numbers)
    )


def read_npy(path):
    """Shape and numbers of a file of NumPy."""
    data = path.read_bytes()
    length = struct.unpack("<H", data[8:10])[0]
    header = eval(data[10 : 10 + length])  # a literal
    form = {"<f4": "f", "<i4": "i", "<u4": "I", "|b1": "?"}[header["descr"]]
    numbers = data[10 + length :]
    return header["shape"], struct.unpack(
        f"<{len(numbers) // struct.calcsize(form)}{form}", numbers
    )
