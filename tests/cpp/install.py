#!/usr/bin/env python3
"""install.py CMAKE BUILD SOURCE CC: installs into a folder, and builds the example and a C program from there alone."""
import os
import pathlib
import subprocess
import sys
import tempfile

cmake, build, source, cc = sys.argv[1:]


def run(*words, **more):
    done = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, **more)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stdout[-6000:]}")
    return done.stdout


with tempfile.TemporaryDirectory(prefix="rtsl-install-") as name:
    folder = pathlib.Path(name)
    prefix = folder / "prefix"
    run(cmake, "--install", build, "--prefix", prefix)
    for expected in ("share/man/man1/rtslc.1", "share/bash-completion/completions/rtslc", "share/zsh/site-functions/_rtslc",
                     "include/rtsl/shader.h", "include/rtsl/rtsl.h"):
        assert (prefix / expected).exists(), expected

    # find_package and rtsl_add_shaders, with shaders of our own copy so that one can change.
    glass = folder / "glass"
    glass.mkdir()
    for shader in pathlib.Path(source, "examples/glass").glob("*.rtsl"):
        (glass / shader.name).write_text(shader.read_text())
    example = folder / "build"
    run(cmake, "-S", f"{source}/examples/cpp-api", "-B", example, f"-DCMAKE_PREFIX_PATH={prefix}", f"-DGLASS={glass}",
        "-DCMAKE_BUILD_TYPE=Release")
    run(cmake, "--build", example)
    picture = folder / "glass.png"
    run(example / "cpp-api", f"{source}/examples/glass/knot.obj", picture, "48", "1")
    assert picture.stat().st_size > 500
    first = (example / "glass.cpp").read_text()
    text = (glass / "Sky.rtsl").read_text()
    (glass / "Sky.rtsl").write_text(text.replace("0.25, 0.45, 0.8", "0.5, 0.25, 0.125"))
    run(cmake, "--build", example)
    assert (example / "glass.cpp").read_text() != first, "a changed shader was not compiled again"

    # pkg-config and C.
    environment = dict(os.environ, PKG_CONFIG_PATH=":".join(str(p.parent) for p in prefix.rglob("rtsl.pc")))
    flags = run("pkg-config", "--cflags", "--libs", "rtsl", env=environment).split()
    library = next(prefix.rglob("librtsl.so")).parent
    run(cc, "-std=c99", "-Wall", "-Wextra", "-pedantic", "-Werror", f"{source}/tests/cpp/scene.c", "-o", folder / "c-api",
        *flags, f"-Wl,-rpath,{library}")
    assert "no shaders" in run(folder / "c-api")
