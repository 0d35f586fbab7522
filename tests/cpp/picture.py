#!/usr/bin/env python3
"""picture.py RTSLC GLASS PROGRAM...: each program's picture is that of the scene file, to the last
bit."""
import pathlib
import subprocess
import sys
import tempfile

from programs import run, same_picture

rtslc, glass, *programs = sys.argv[1:]
with tempfile.TemporaryDirectory(prefix="rtsl-cpp-") as folder:
    ours, theirs = (str(pathlib.Path(folder) / name) for name in ("cpp.exr", "jit.exr"))
    run(rtslc, "render", f"{glass}/scene.json", "-o", theirs, "--size", "96x54", "--spp", "4", "-q")
    for program in programs:
        run(program, f"{glass}/knot.obj", ours, "96", "4")
        same_picture(rtslc, ours, theirs)
        # Without its mesh there is a message and no picture.
        done = subprocess.run(
            [program, "nowhere.obj", f"{folder}/none.png"], capture_output=True, text=True
        )
        assert done.returncode == 1 and "nowhere.obj" in done.stderr, done
        assert not pathlib.Path(folder, "none.png").exists()
