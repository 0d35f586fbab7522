"""What can be counted in PTX, as LLVM writes it."""

import dataclasses
import re

# The beginning of a function that has a body; the name stands after its result, if it has one.
FUNCTION = re.compile(
    r"^(?:\.visible |\.weak )?\.(?P<kind>entry|func)\s+(?:\([^)]*\)\s+)?(?P<name>[\w$]+)"
    r"[^{};]*\{\n(?P<body>.*?)^\}$",
    re.MULTILINE | re.DOTALL,
)
LOCAL_MEMORY = re.compile(r"^\t\.local .*\[(\d+)\];$", re.MULTILINE)
BLOCK = re.compile(r"^(?:\$L__BB|// %bb\.)")
# LLVM states the depth of a loop at each of its blocks, `Depth=2`, and at the first one that of the
# loops within it, `Depth 3`.
DEPTH = re.compile(r"Depth=(\d+)")
REGISTERS = re.compile(r"^// rtslc: .*-maxrregcount=(\d+)", re.MULTILINE)


@dataclasses.dataclass
class Function:
    name: str
    is_kernel: bool
    local_bytes: int
    instructions: list[int]  # by the number of loops that they are in

    def instructions_within(self, loops):
        """Of at least so many loops, one in another."""
        return sum(self.instructions[loops:])


def functions_of(ptx):
    return [
        Function(
            found["name"],
            found["kind"] == "entry",
            sum(map(int, LOCAL_MEMORY.findall(found["body"]))),
            instructions_by_depth(found["body"]),
        )
        for found in FUNCTION.finditer(ptx)
    ]


def instructions_by_depth(body):
    counts, depth = [0], 0
    for line in body.splitlines():
        if BLOCK.match(line):
            depth = 0
        code, _, comment = line.partition("//")
        for nested in DEPTH.findall(comment):
            depth = max(depth, int(nested))
        if re.match(r"\t[^.{}]", code):  # directives and braces are no instructions
            counts.extend([0] * (depth + 1 - len(counts)))
            counts[depth] += 1
    return counts


def registers_of(ptx):
    """How many a thread may have: the last line of what rtslc prints for a scene."""
    return int(REGISTERS.search(ptx)[1])
