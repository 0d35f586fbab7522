#!/usr/bin/env python3
"""fast.py RTSLC SOURCE LIBRARY-FOLDER CPP-RENDER: C++ of --fp=fast differs from strict C++ in last
digits alone, and strict C++ keeps its bits in a program that has both."""
import json
import pathlib
import shutil
import sys
import tempfile

from programs import built_with, run, same_picture

rtslc, source, library, render = sys.argv[1:]
glass = pathlib.Path(source, "examples/glass")
shaders = sorted(glass.glob("*.rtsl"))
FLAGS = ["-march=x86-64-v3", "-fPIC", "-shared", *built_with(source, library)]


def difference(a, b):
    """The root of the mean squared difference of two pictures, which must be small."""
    return json.loads(run(rtslc, "compare", a, b, "--json", "--threshold", "1e-3"))["rmse"]


with tempfile.TemporaryDirectory(prefix="rtsl-fast-") as name:
    folder = pathlib.Path(name)
    pictures = {}
    picture = ["--size", "96x54", "--spp", "4"]
    run(rtslc, "render", glass / "scene.json", "-o", folder / "jit.exr", *picture)
    scene = json.loads((glass / "scene.json").read_text())
    scene["import"] = [str(glass / file) for file in scene["import"]]
    for item in scene["objects"]:
        if "mesh" in item:
            item["mesh"] = str(glass / item["mesh"])
    scene["render"].update(size=[96, 54], spp=4)
    (folder / "scene.json").write_text(json.dumps(scene))
    for compiler in filter(shutil.which, ("g++", "clang++-22")):
        # Each in one program with the other, whose functions come first: without optimisation all
        # are called by name.
        for mode, other, flags in (("strict", "fast", "-O0"), ("fast", "strict", "-O2")):
            run(
                rtslc,
                "compile",
                *shaders,
                "--emit=cpp",
                f"--fp={mode}",
                "-o",
                folder / "shaders.cpp",
            )
            run(
                rtslc,
                "compile",
                *shaders,
                "--emit=cpp",
                f"--fp={other}",
                "-o",
                folder / "other.cpp",
            )
            run(
                compiler,
                folder / "other.cpp",
                folder / "shaders.cpp",
                "-o",
                folder / "shaders.so",
                flags,
                *FLAGS,
            )
            pictures[mode] = folder / f"{mode}.exr"
            run(render, folder / "shaders.so", folder / "scene.json", pictures[mode])
        same_picture(rtslc, pictures["strict"], folder / "jit.exr")
        apart = difference(pictures["fast"], folder / "jit.exr")
        print(f"{compiler}: fast and strict are {apart:.2g} apart (RMSE)")
        assert apart > 0
