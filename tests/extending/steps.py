"""The code between the steps of docs/extending.md, and a copy of the tree with it."""

import os
import re
import shutil
import sys
import textwrap
from pathlib import Path

SOURCE = Path(__file__).resolve().parent.parent.parent
DOCUMENT = "docs/extending.md"

BLOCK = r"(\s*)```(?:cpp|cmake|tablegen)\n(.*?)\n\s*```$"
INSERTION = re.compile(
    r"^\s*(?:\d+\. )?`([^`]+)`, (after|before|in place of) `([^\n]+)`:\n" + BLOCK, re.M | re.S
)
NEW_FILE = re.compile(r"here `([^`]+)`:\n" + BLOCK, re.M | re.S)
PATH = re.compile(r"`((?:[\w.-]+/)+[\w.-]*)`")


def insert(tree, path, where, anchor, code):
    lines = (tree / path).read_text().split("\n")
    found = [i for i, line in enumerate(lines) if anchor in line]
    if len(found) != 1:
        sys.exit(f"{DOCUMENT} names `{anchor}` of {path}, which stands there {len(found)} times")
    at = found[0]
    if where == "in place of":
        lines[at] = lines[at].replace(anchor, code)
    else:
        lines[at + (where == "after") : at + (where == "after")] = code.split("\n")
    (tree / path).write_text("\n".join(lines))


def require_files(text, new_files):
    missing = [
        path
        for path in PATH.findall(text)
        if "NAME" not in path and path not in new_files and not (SOURCE / path).exists()
    ]
    if missing:
        sys.exit(f"{DOCUMENT} names what does not exist: " + ", ".join(missing))


def follow(tree):
    """Copies the tree, without its tests, and inserts the code of all steps; a build folder that is
    there stays. Returns the files that were changed, and those that are new."""
    text = (SOURCE / DOCUMENT).read_text()
    new_files = {path: textwrap.dedent(code) for path, _, code in NEW_FILE.findall(text)}
    insertions = INSERTION.findall(text)
    if len(insertions) < 8 or not new_files:
        sys.exit(f"{DOCUMENT} has lost its code, or {__file__} cannot read it any more")
    require_files(text, new_files)
    for path in tree.glob("*"):
        if path.is_dir() and path.name != "build":
            shutil.rmtree(path)
    shutil.copytree(
        SOURCE,
        tree,
        dirs_exist_ok=True,
        ignore=lambda at, names: [n for n in names if n in ("build", ".git", "tests")],
    )
    for path, where, anchor, _, code in insertions:
        insert(tree, path, where, anchor, textwrap.dedent(code))
    for path, code in new_files.items():
        (tree / path).write_text(code + "\n")
    for path in [path for path, *_ in insertions] + list(new_files):
        set_time(tree, path)
    return [path for path, *_ in insertions], list(new_files)


def set_time(tree, path):
    """Gives a file of the copy the time of what it is made of: a second build has little to do."""
    made_of = [SOURCE / DOCUMENT, SOURCE / path]
    newest = max(of.stat().st_mtime_ns for of in made_of if of.exists())
    os.utime(tree / path, ns=(newest, newest))
