#!/usr/bin/env python3
"""reference.py [--check]: writes the tables of docs/library.md from the comments of library/std.

With --check it only fails if they are out of date."""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENT = ROOT / "docs/library.md"
BEGIN, END = "<!-- reference: begin -->\n", "<!-- reference: end -->\n"
MEMBER = re.compile(
    r"^ *public (optional )?([\w\[\]]+) (\w+(?:\[\])*)(?: in ([\[(].*?[\])]))?(?: = (.*?))?;"
    r"(?: +// (.*))?$"
)
FUNCTION = re.compile(r"((?:^// .*\n)+)^(\w+ \w+\([^)]*\)) \{", re.M)


def prose(comment):
    """The text of comment lines, with paragraphs."""
    lines = [line[2:].strip() for line in comment.strip().split("\n")]
    return re.sub(r"\n\n+", "\n\n", "\n".join(lines)).strip().replace("<", "&lt;")


def members(text):
    """The public members, each with its comment: what follows it on its line, and the lines below
    that go on in the same column."""
    lines = text.split("\n")
    for i, line in enumerate(lines):
        found = MEMBER.match(line)
        if not found:
            continue
        optional, kind, name, values, default, comment = found.groups()
        column = line.find("//")
        for below in lines[i + 1 :] if comment else []:
            if below[:column].strip() or not below.startswith("// ", column):
                break
            comment += " " + below[column + 3 :].strip()
        given = f"`{default}`" if default else "none" if optional or "[]" in name else "required"
        values = f"`{values}`" if values else ""
        yield f"| `{name}` | `{kind}` | {values} | {given} | {comment or ''} |"


def class_section(path):
    text = path.read_text()
    head = re.search(
        r"((?:^//.*\n)+)(?=(?:\n|import .*\n)*(?://.*\n|struct (?:.*\n)*?\};\n|\n|import "
        r".*\n)*(?:default )?class )",
        text,
        re.M,
    )
    base = re.search(r"^(?:default )?class \w+(?: : (\w+))?", text, re.M).group(1)
    constructor = re.search(r"void constructor\((.*?)\) \{", text, re.S)
    yield f"### {path.stem}\n"
    if (ROOT / f"docs/library/{path.stem}.png").exists():
        yield f"![{path.stem}](library/{path.stem}.png)\n"
    yield prose(head.group(1)) + "\n"
    yield (f"A class of `{base}`." if base else "A [helper class](language.md#8-classes).") + (
        f" Constructor: `{' '.join(constructor.group(1).split())}`." if constructor else ""
    ) + "\n"
    rows = list(members(text))
    if rows:
        yield "| parameter | type | range | default | |\n|---|---|---|---|---|"
        yield from rows
        yield ""


def reference():
    library = ROOT / "library/std"
    # std.images has the built-in types sampler2D and sampler3D, which docs/language.md describes.
    for folder in sorted(
        path for path in library.iterdir() if path.is_dir() and path.name != "images"
    ):
        yield f"## std.{folder.name}\n"
        for path in sorted(folder.glob("*.rtsl")):
            yield from class_section(path)
    yield "## Modules of functions\n"
    for path in sorted(library.glob("*.rtsl")):
        text = path.read_text()
        yield f"### std.{path.stem}\n"
        yield prose(re.match(r"(?://.*\n)+", text).group(0)) + "\n"
        for comment, signature in FUNCTION.findall(text):
            yield f"- `{signature}`: " + " ".join(prose(comment).split())
        yield ""


def main():
    text = DOCUMENT.read_text()
    before, after = text[: text.index(BEGIN)] + BEGIN, text[text.index(END) :]
    renewed = before + "\n".join(reference()) + "\n" + after
    if "--check" in sys.argv:
        if renewed != text:
            print("docs/library.md is out of date: run docs/library/reference.py")
        return renewed != text
    DOCUMENT.write_text(renewed)
    return 0


sys.exit(main())
