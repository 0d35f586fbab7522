"""What the tests of printed C++ share: running programs, and the options with which both compilers
have no warnings."""
import subprocess
import sys

WARNINGS = "-Wall -Wextra -Wpedantic -Werror -Wconversion".split()


def run(*words, **more):
    """What the program writes to standard output; the test ends where it fails."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stdout[-3000:]}{done.stderr[-6000:]}")
    return done.stdout


def compiled_with(source):
    """How programs of the build tree find the headers."""
    return ["-std=c++17", *WARNINGS, "-I", source, "-I", f"{source}/include"]


def linked_with(library):
    return ["-L", library, "-lrtsl", f"-Wl,-rpath,{library}"]


def built_with(source, library):
    """How they find the library, too."""
    return [*compiled_with(source), *linked_with(library)]


def precompiled_header(compiler, level, flags, folder):
    """The options that use `rtsl/shader.h` precompiled with these flags, for files that define no
    macro before it: parsing the header takes most of the time of compiling a small program."""
    name = "shader.h.gch" if compiler == "g++" else "shader.h.pch"
    made = folder / f"{compiler}{level}" / "rtsl" / name
    if not made.exists():
        made.parent.mkdir(parents=True)
        source = made.parent / "precompiled.h"
        source.write_text("#include <rtsl/shader.h>\n")
        run(compiler, "-x", "c++-header", source, "-o", made, level, *flags)
    return ["-I", made.parent.parent] if compiler == "g++" else ["-include-pch", made]


def same_picture(rtslc, ours, theirs):
    run(rtslc, "compare", ours, theirs, "--threshold", "0")
