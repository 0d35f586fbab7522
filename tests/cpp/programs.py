"""What the tests of printed C++ share: running programs, and the options with which both compilers have no warnings."""
import subprocess
import sys

WARNINGS = "-Wall -Wextra -Wpedantic -Werror -Wconversion".split()


def run(*words, **more):
    """What the program writes to standard output; the test ends where it fails."""
    done = subprocess.run([str(word) for word in words], capture_output=True, text=True, **more)
    if done.returncode:
        sys.exit(f"{' '.join(map(str, words))}\n{done.stdout[-3000:]}{done.stderr[-6000:]}")
    return done.stdout


def built_with(source, library):
    """How programs of the build tree find the headers and the library."""
    return ["-std=c++17", *WARNINGS, "-I", source, "-I", f"{source}/include", "-L", library, "-lrtsl", f"-Wl,-rpath,{library}"]


def same_picture(rtslc, ours, theirs):
    run(rtslc, "compare", ours, theirs, "--threshold", "0")
