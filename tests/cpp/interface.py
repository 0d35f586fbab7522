#!/usr/bin/env python3
"""interface.py SOURCE: docs/cpp-interface.md shows the example as it is, and says for each key of
the scene schema how a program says the same; tests call every function."""
import json
import pathlib
import re
import sys

source = pathlib.Path(sys.argv[1])
page = (source / "docs/cpp-interface.md").read_text()
header = (source / "include/rtsl/rtsl.h").read_text()


def keys_of(schema):
    """The keys of a scene file: of the scene itself, and those of definitions after their names."""
    found = set()

    def walk(node, name):
        if isinstance(node, list):
            for element in node:
                walk(element, name)
        if not isinstance(node, dict):
            return
        for key, value in node.items():
            if key == "properties":
                for one, content in value.items():
                    found.add((*name, one))
                    walk(content, (*name, one))
            elif key == "$defs":
                for one, content in value.items():
                    walk(content, (one,))
            elif key not in ("if", "then", "else"):  # conditions on keys that are listed elsewhere
                walk(value, name)

    walk(schema, ())
    return {".".join(name) for name in found}


def check_table():
    keys = keys_of(json.loads((source / "docs/scene-schema.json").read_text()))
    rows = re.findall(r"^\| (`.*?) \| (.*) \|$", page, re.MULTILINE)
    listed = [key for names, _ in rows for key in re.findall(r"`([^`]+)`", names)]
    assert sorted(listed) == sorted(keys), set(listed) ^ keys
    for names, way in rows:
        mentioned = re.findall(r"`([Rr]tsl\w+)`", way)
        missing = [one for one in mentioned if not re.search(rf"\b{one}\b", header)]
        assert not missing, (names, missing)
        assert mentioned or way.startswith("left out: "), names


def check_program():
    for file in ("main.cpp", "CMakeLists.txt"):
        text = (source / "examples/cpp-api" / file).read_text()
        assert f"\n{text}```\n" in page, f"docs/cpp-interface.md shows another {file}"


def check_calls():
    """Every function is called by a test in C or C++, or by an example, which tests run."""
    files = [*source.glob("tests/cpp/**/*.c*"), *source.glob("examples/c*-api/*.c*")]
    called = set(re.findall(r"\b(rtsl[A-Z]\w*)\(", "".join(file.read_text() for file in files)))
    declared = set(re.findall(r"\b(rtsl[A-Z]\w*)\(", header))
    assert declared and declared <= called, declared - called


check_table()
check_program()
check_calls()
