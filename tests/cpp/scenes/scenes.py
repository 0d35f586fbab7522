#!/usr/bin/env python3
"""scenes.py RTSLC SOURCE LIBRARY-FOLDER CPP-RENDER: scenes whose shaders were printed as C++ give the pictures, the printed
lines and the counted exceptions of the compiler's own machine code, to the last bit."""
import json
import pathlib
import shutil
import subprocess
import sys
import tempfile

rtslc, source, library, render = sys.argv[1:]
here = pathlib.Path(__file__).parent
glass = pathlib.Path(source, "examples/glass")
FLAGS = "-std=c++17 -Wall -Wextra -Wpedantic -Werror -Wconversion -fPIC -shared".split()


def sphere(center, radius, material):
    return {"primitive": {"class": "Sphere", "center": center, "radius": radius}, "material": material}


def whitted():
    folder = pathlib.Path(source, "examples/whitted-programs")
    scene = json.loads((folder / "scene.json").read_text())
    scene["import"] = [str(folder / name) for name in scene["import"]]
    scene["render"].update(size=[64, 36], spp=4)
    return scene


def answers(engine):
    scene = {
        "rtsl": 1,
        "import": [str(here / "Answers.rtsl"), str(glass / "Sphere.rtsl"), str(glass / "PinholeCamera.rtsl")],
        "materials": {"sieve": {"class": "Sieve"}, "solid": {"class": "Solid", "scale": 3}},
        "objects": [sphere([0, 0, 0], 1, "sieve"), sphere([0.9, 0.4, -1], 0.8, "solid"), sphere([0.5, -0.7, 0.6], 0.6, "sieve"),
                    sphere([-1, 0.5, 0.2], 0.5, "solid")],
        "background": {"class": "Sky"},
        "render": {"engine": engine, "size": [48, 48], "spp": 4, "depth": 4},
    }
    if engine == "programs":
        scene["rayGeneration"] = {"class": "Eye"}
    else:
        scene["camera"] = {"class": "PinholeCamera",
                           "constructor": [[0, 0, 4], [0, 1, 0], [0, 0, -1], [-0.5, -0.5], [0.5, 0.5], 1]}
    return scene


def events(answered):
    scene = {
        "rtsl": 1,
        "import": [str(here / "Events.rtsl"), str(glass / "Sphere.rtsl")],
        "rayGeneration": {"class": "Eye", "curve": [0.5, 0.25]},
        "objects": [sphere([0, 0, 0], 2, {"class": "Endless"})],
        "render": {"engine": "programs", "size": [4, 4], "spp": 2, "depth": 5},
    }
    if answered:
        scene["exception"] = {"class": "Code"}
    return scene


# Scenes by the shaders that they share, and the options of both compilers.
CASES = [
    ("g++", ["-O2"], [], [whitted()]),
    ("clang++-22", ["-O1"], ["--exceptions"], [answers("programs"), answers("classic")]),
    ("g++", ["-O1"], ["--print"], [events(False)]),
    ("g++", ["-O1"], ["--exceptions"], [events(False), events(True)]),
    ("g++", ["-O1"], ["--unchecked"], [answers("programs")]),
]


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stdout[-2000:]}{done.stderr[-6000:]}")
    return done.stdout


with tempfile.TemporaryDirectory(prefix="rtsl-cpp-") as name:
    folder = pathlib.Path(name)
    for compiler, flags, options, scenes in CASES:
        if not shutil.which(compiler):
            print(f"{compiler} is not installed: skipped")
            continue
        imports = list(dict.fromkeys(file for scene in scenes for file in scene["import"]))
        run(rtslc, "compile", *imports, "--emit=cpp", *options, "-o", folder / "shaders.cpp")
        run(compiler, *FLAGS, *flags, "-I", source, "-I", f"{source}/include", folder / "shaders.cpp", "-o",
            folder / "shaders.so", "-L", library, "-lrtsl", f"-Wl,-rpath,{library}")
        for scene in scenes:
            (folder / "scene.json").write_text(json.dumps(scene))
            events_of = [option for option in options if option in ("--print", "--exceptions")]
            theirs = json.loads(run(rtslc, "render", folder / "scene.json", "-o", folder / "jit.exr", "--json", *events_of))
            ours = json.loads(run(render, folder / "shaders.so", folder / "scene.json", folder / "cpp.exr"))
            run(rtslc, "compare", folder / "cpp.exr", folder / "jit.exr", "--threshold", "0")
            assert ours["printed"] == theirs.get("printed", []), (ours, theirs)
            assert ours.get("exceptions") == theirs.get("exceptions"), (ours, theirs)
            if "--print" in options:
                assert len(ours["printed"]) > 10, ours
            if scene["render"]["size"] == [4, 4] and "--exceptions" in options:
                assert len(ours["exceptions"]) == 3, ours
        assert ("#define RTSL_UNCHECKED" in (folder / "shaders.cpp").read_text()) == ("--unchecked" in options)
