"""What NVIDIA's `ptxas` makes of PTX, where it is installed."""

import dataclasses
import pathlib
import re
import shutil
import struct
import subprocess
import tempfile

PTXAS = shutil.which("ptxas") or shutil.which("/usr/local/cuda/bin/ptxas")
# "Function properties for NAME", the line with its memory and, for a kernel, one more.
PROPERTIES = re.compile(
    r"roperties for (?P<name>[\w$]+)\n\s*\d+ bytes stack frame, "
    r"(?P<stores>\d+) bytes spill stores, (?P<loads>\d+) bytes spill loads\n"
    r"(?:[^\n]*Used (?P<registers>\d+) registers"
    r"(?:[^\n]* (?P<stack>\d+) bytes cumulative stack)?)?"
)
INSTRUCTION_BYTES = 16  # of every GPU since sm_70


@dataclasses.dataclass
class MachineCode:
    """Of a kernel with the functions that it may call; bytes are those of a thread."""

    instructions: int  # with the up to seven at the end that never run
    registers: int
    stack_bytes: int
    spill_store_bytes: int
    spill_load_bytes: int


def release():
    """Another release makes other code of the same PTX."""
    text = subprocess.run([PTXAS, "--version"], capture_output=True, text=True, check=True).stdout
    return re.search(r"release ([\d.]+)", text)[1]


def assemble(ptx, kernel, architecture, max_registers):
    with tempfile.TemporaryDirectory() as folder:
        source, binary = (pathlib.Path(folder) / name for name in ("a.ptx", "a.cubin"))
        source.write_text(ptx)
        command = [PTXAS, "-v", f"-arch={architecture}", f"-maxrregcount={max_registers}"]
        done = subprocess.run([*command, source, "-o", binary], capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"ptxas rejects the PTX of {kernel}:\n{done.stderr[:2000]}")
        code_bytes = section_sizes(binary.read_bytes())[".text." + kernel]
    return code_in_log(done.stderr, kernel, code_bytes // INSTRUCTION_BYTES)


def code_in_log(log, kernel, instructions):
    found = {one["name"]: one for one in PROPERTIES.finditer(log)}
    whole = found[kernel]
    parts = [whole] + [one for one in found.values() if one["registers"] is None]
    return MachineCode(
        instructions,
        int(whole["registers"]),
        int(whole["stack"] or 0),
        *(sum(int(one[key]) for one in parts) for key in ("stores", "loads")),
    )


def section_sizes(elf):
    """The bytes of each section of a little-endian ELF file of 64 bits."""
    (table,) = struct.unpack_from("<Q", elf, 40)
    entry_size, count, names = struct.unpack_from("<HHH", elf, 58)
    # name, kind, flags, address, position and size
    headers = [struct.unpack_from("<IIQQQQ", elf, table + i * entry_size) for i in range(count)]
    texts = headers[names][4]
    name = lambda at: elf[at : elf.index(b"\0", at)].decode()
    return {name(texts + header[0]): header[5] for header in headers}
