#!/usr/bin/env python3
"""install.py CMAKE BUILD SOURCE CC CXX: installs into a folder, and builds the examples of the
interfaces for C++ and C, and another C program, from there alone."""
import json
import os
import pathlib
import sys
import tempfile

from programs import run, same_picture

cmake, build, source, cc, cxx = sys.argv[1:]

with tempfile.TemporaryDirectory(prefix="rtsl-install-") as name:
    folder = pathlib.Path(name)
    prefix = folder / "prefix"
    run(cmake, "--install", build, "--prefix", prefix)
    for expected in (
        "share/man/man1/rtslc.1",
        "share/bash-completion/completions/rtslc",
        "share/zsh/site-functions/_rtslc",
        "include/rtsl/shader.h",
        "include/rtsl/rtsl.h",
        "share/rtslc/library/std/cameras/PinholeCamera.rtsl",
        "share/rtslc/library/templates/material.rtsl",
        "share/rtslc/library/templates/scene.json",
        "share/rtslc/library/preview/material.json",
    ):
        assert (prefix / expected).exists(), expected
    # Where rtsl_add_shaders finds modules of the library.
    package = next(prefix.rglob("rtslConfig.cmake")).read_text()
    assert 'RTSL_LIBRARY "${PACKAGE_PREFIX_DIR}/share/rtslc/library"' in package, package

    # find_package and rtsl_add_shaders, with shaders of our own copy so that one can change.
    glass = folder / "glass"
    glass.mkdir()
    for shader in pathlib.Path(source, "examples/glass").glob("*.rtsl"):
        (glass / shader.name).write_text(shader.read_text())
    sky = glass / "Sky.rtsl"
    palette = glass / "palette.inc"
    palette.write_text("#define ZENITH color(0.25, 0.45, 0.8)\n")
    sky.write_text(
        '#include "palette.inc"\n' + sky.read_text().replace("color(0.25, 0.45, 0.8)", "ZENITH")
    )
    example = folder / "build"
    run(
        cmake,
        "-S",
        f"{source}/examples/cpp-api",
        "-B",
        example,
        f"-DCMAKE_PREFIX_PATH={prefix}",
        f"-DGLASS={glass}",
        "-DCMAKE_BUILD_TYPE=Debug",
        "-GNinja",
    )
    run(cmake, "--build", example)
    picture = folder / "glass.png"
    run(example / "cpp-api", f"{source}/examples/glass/knot.obj", picture, "48", "1")
    assert picture.stat().st_size > 500

    generated = next(example.rglob("glass.cpp"))

    def builds_anew():
        """Does a build compile the shaders again? That shows in the file's time, for it is written
        anew even if it is the same."""
        before = generated.stat().st_mtime_ns
        run(cmake, "--build", example, "--target", generated.relative_to(example))
        return generated.stat().st_mtime_ns != before

    first = generated.read_text()
    assert "0.45f" in first
    assert not builds_anew(), "nothing has changed"
    palette.write_text("#define ZENITH color(0.5, 0.625, 0.75)\n")
    assert builds_anew(), "an included file has changed"
    second = generated.read_text()
    assert "0.45f" not in second and "0.625f" in second
    palette.touch()
    assert builds_anew(), "an included file was touched"
    sky.write_text(sky.read_text().replace("0.9, 0.95, 1.0", "0.5, 0.25, 0.125"))
    assert (
        builds_anew() and generated.read_text() != second
    ), "a changed shader was not compiled again"

    # The same for the example in C, with the shaders beside it.
    turntable = folder / "c-build"
    run(
        cmake,
        "-S",
        f"{source}/examples/c-api",
        "-B",
        turntable,
        f"-DCMAKE_PREFIX_PATH={prefix}",
        "-DCMAKE_BUILD_TYPE=Debug",
    )
    run(cmake, "--build", turntable)
    run(turntable / "c-api", f"{source}/examples/glass/knot.obj", folder, "2", "48")
    assert len(list(folder.glob("*.png"))) == 3, "two frames, and the picture of the other example"

    # pkg-config and C.
    environment = dict(
        os.environ, PKG_CONFIG_PATH=":".join(str(p.parent) for p in prefix.rglob("rtsl.pc"))
    )
    headers = run("pkg-config", "--cflags", "rtsl", env=environment).split()
    flags = run("pkg-config", "--cflags", "--libs", "rtsl", env=environment).split()
    library = next(prefix.rglob("librtsl.so")).parent
    installed = prefix / "bin/rtslc"
    scene = {
        "rtsl": 1,
        "import": [
            f"{source}/tests/cpp/scenes/Events.rtsl",
            f"{source}/examples/glass/Sphere.rtsl",
        ],
        "rayGeneration": {"class": "Eye", "curve": [0.5, 0.25]},
        "exception": {"class": "Code"},
        "objects": [
            {
                "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 2},
                "material": {"class": "Endless"},
            }
        ],
        "render": {"engine": "programs", "size": [4, 4], "spp": 2, "depth": 5},
    }
    (folder / "scene.json").write_text(json.dumps(scene))
    run(
        installed,
        "compile",
        *scene["import"],
        "--emit=cpp",
        "--print",
        "--exceptions",
        "-o",
        folder / "events.cpp",
    )
    run(
        cc,
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-pedantic",
        "-Werror",
        "-c",
        f"{source}/tests/cpp/scene.c",
        "-o",
        folder / "c.o",
        *headers,
    )
    run(
        cxx,
        "-std=c++17",
        folder / "events.cpp",
        folder / "c.o",
        "-o",
        folder / "c-api",
        *flags,
        f"-Wl,-rpath,{library}",
    )
    # The installed program finds the installed library.
    view = folder / "View.rtsl"
    view.write_text("import std.cameras;\nclass View : PerspectiveCamera { };\n")
    run(
        installed,
        "compile",
        view,
        "--emit=cpp",
        "-o",
        folder / "view.cpp",
        "-MD",
        "-MF",
        folder / "view.d",
    )
    assert (
        f"{prefix.resolve()}/share/rtslc/library/std/cameras/PerspectiveCamera.rtsl"
        in (folder / "view.d").read_text()
    )

    printed = run(folder / "c-api", folder / "c.exr").splitlines()
    said = json.loads(
        run(
            installed,
            "render",
            folder / "scene.json",
            "-o",
            folder / "jit.exr",
            "--json",
            "--print",
            "--exceptions",
        )
    )
    same_picture(installed, folder / "c.exr", folder / "jit.exr")
    assert printed == 2 * said["printed"], (printed, said)
    mistakes = run(folder / "c-api").splitlines()
    for line, word in zip(
        mistakes,
        (
            "no shaders",
            "Nobody",
            "nothing",
            "Code",
            "reference 0",
            "not finite",
            "nowhere.obj",
            "no mesh number 7",
            "rt_Selector",
            "member `center` of `Sphere` is read, but not set",
            "has 2 values, and `the mesh` has 3 vertices",
            "no selection number 5",
            "holds no primitives",
        ),
        strict=True,
    ):
        assert word in line, mistakes
