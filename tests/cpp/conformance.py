#!/usr/bin/env python3
"""Runs the language's tests of the JIT on printed C++, and compares bit for bit.

    conformance.py RTSLC TEST-LOWER SOURCE-FOLDER LIBRARY-FOLDER [all]

TEST-LOWER runs hundreds of small programs with its JIT and, asked by RTSL_RECORD, writes down what
went in and what came out. Each program is printed as C++; all of them make one file, which is
compiled without warnings by each compiler that is there and must give the same bits (two NaN count
as the same). With most options it is some of the programs; with `all` it is all of them.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

from programs import built_with

# Compiler, options, and which programs: each n-th.
SAMPLES = [
    ("g++", "-O2", 2),
    ("clang++-22", "-O0", 1),
    ("g++", "-O0", 16),
    ("clang++-22", "-O2", 16),
    ("g++", "-O3 -march=native", 16),
    ("clang++-22", "-O3 -march=native", 16),
]
ALL = [(compiler, flags, 1) for compiler, flags, _ in SAMPLES]

HARNESS = """
#include <cstdio>

namespace {

struct Words { unsigned x[16], n[16], u[16]; };

bool isNan(unsigned bits) { return (bits & 0x7fffffffu) > 0x7f800000u; }

template <typename T>
void fill(rtsl::array<T, 16> &to, const unsigned *from) {
  for (int i = 0; i < 16; ++i)
    to[i] = rtsl::bitsAs<T>(from[i]);
}
template <typename T>
bool same(const rtsl::array<T, 16> &values, const unsigned *expected, const char *name, const char *kind) {
  for (int i = 0; i < 16; ++i) {
    const unsigned bits = rtsl::bitsAs<unsigned>(values[i]);
    const bool bothNan = kind[0] == 'f' && isNan(bits) && isNan(expected[i]);
    if (bits != expected[i] && !bothNan) {
      std::printf("%s: %s %d is %08x and not %08x\\n", name, kind, i, bits, expected[i]);
      return false;
    }
  }
  return true;
}

using F = rtsl::array<float, 16>;
using I = rtsl::array<int, 16>;
using U = rtsl::array<unsigned, 16>;
RtslLaunch launch{};
RtslState state{};
rtsl::State<3> &rt() {
  state.launch = &launch;
  return rtsl::stateOf<3>(&state);
}
[[maybe_unused]] void invoke(void (*run)(F &, I &, U &), F &x, I &n, U &u) { run(x, n, u); }
[[maybe_unused]] void invoke(void (*run)(rtsl::State<3> &, F &, I &, U &), F &x, I &n, U &u) { run(rt(), x, n, u); }
[[maybe_unused]] void invoke(void (*run)(F &), F &x, I &, U &) { run(x); }
[[maybe_unused]] void invoke(void (*run)(rtsl::State<3> &, F &), F &x, I &, U &) { run(rt(), x); }

template <typename Run>
int check(const char *name, Run run, const Words &before, const Words &after) {
  F x{};
  I n{};
  U u{};
  fill(x, before.x);
  fill(n, before.n);
  fill(u, before.u);
  state = RtslState{};
  invoke(run, x, n, u);
  return same(x, after.x, name, "float") && same(n, after.n, name, "int") && same(u, after.u, name, "uint") ? 0 : 1;
}

} // namespace
"""


def read(record):
    """The programs, each with its calls: [(source, [(before, after)])]."""
    programs, at = {}, 0
    calls, call = None, {}
    while at < len(record):
        end = record.index("\n", at)
        line = record[at:end]
        at = end + 1
        words = line.split(" ")
        if words[0] == "source":
            size = int(words[1])
            source = record.encode()[len(record[:at].encode()) :][:size].decode()
            at += len(source) + 1
            calls = programs.setdefault(source, [])
            call = {}
        else:
            call[words[0], words[1]] = words[2:]
            isLast = (
                words[0] == "after"
                and ("before", "int" if words[1] == "float" else words[1]) not in call
                or (words[0], words[1]) == ("after", "uint")
            )
            if isLast:
                calls.append(call)
                call = {}
    return list(programs.items())


def table(call, when):
    rows = [call.get((when, kind), ["0"] * 16) for kind in ("float", "int", "uint")]
    return (
        "{" + ", ".join("{" + ", ".join(f"0x{word}u" for word in row) + "}" for row in rows) + "}"
    )


def write_program(path, programs, folder):
    """One program of all that were printed, with their calls. Gives the number of calls."""
    texts, checks, tables = [], [], []
    for name, calls in programs:
        texts.append((folder / f"{name}.cpp").read_text().replace("#include <rtsl/shader.h>\n", ""))
        for call in calls:
            checks.append(
                f'  failures += check("{name}", {name}::run, calls[{len(tables)}][0], '
                f"calls[{len(tables)}][1]);"
            )
            tables.append("{" + table(call, "before") + ", " + table(call, "after") + "}")
    path.write_text(
        "#include <rtsl/shader.h>\n"
        + "\n".join(texts)
        + HARNESS
        + f"static const Words calls[{len(tables)}][2] = {{\n"
        + ",\n".join(tables)
        + "};\n"
        + "int main() {\n  int failures = 0;\n"
        + "\n".join(checks)
        + '\n  std::printf("%d failures\\n", failures);\n  return failures != 0;\n}\n'
    )
    return len(tables)


def main():
    rtslc, lower, source, library = sys.argv[1:5]
    is_all = "all" in sys.argv[5:]
    folder = pathlib.Path(tempfile.mkdtemp(prefix="rtsl-cpp-"))
    try:
        record = folder / "record"
        subprocess.run(
            [lower, "--gtest_brief=1", "--gtest_filter=-Examples.*"],
            env=dict(os.environ, RTSL_RECORD=str(record)),
            check=True,
            stdout=subprocess.DEVNULL,
        )
        recorded = read(record.read_text())
        if len(recorded) < 100:
            sys.exit(f"only {len(recorded)} programs were recorded")
        programs, sources = [], {}
        for i, (text, calls) in enumerate(recorded):
            done = subprocess.run(
                [rtslc, "compile", "-", "--emit=cpp", "-o", str(folder / f"t{i}.cpp")],
                input=text.encode(),
                capture_output=True,
            )
            if done.returncode:
                sys.exit(f"rtslc failed on\n{text}\n{done.stderr.decode()}")
            programs.append((f"t{i}", calls))
            sources[f"t{i}"] = text
        tried = 0
        for compiler, flags, part in ALL if is_all else SAMPLES:
            if not shutil.which(compiler):
                sys.exit(f"{compiler} is not installed: make dependencies installs it")
            chosen = programs[::part]
            whole, program = folder / "all.cpp", folder / "all"
            count = write_program(whole, chosen, folder)
            built = subprocess.run(
                [
                    compiler,
                    str(whole),
                    "-o",
                    str(program),
                    *flags.split(),
                    *built_with(source, library),
                ],
                capture_output=True,
                text=True,
            )
            if built.returncode:
                shutil.copy(whole, "/tmp/conformance-failed.cpp") if os.environ.get(
                    "KEEP"
                ) else None
                sys.exit(f"{compiler} {flags} refuses the C++:\n{built.stderr[:6000]}")
            ran = subprocess.run([str(program)], capture_output=True, text=True)
            print(
                f"{compiler} {flags}: {len(chosen)} programs, {count} calls, "
                f"{ran.stdout.strip()[-2000:]}",
                flush=True,
            )
            if ran.returncode:
                for line in ran.stdout.splitlines()[:3]:
                    name = line.split(":")[0]
                    if name in sources:
                        print(f"{name} was\n{sources[name]}")
                        print("and is\n" + (folder / f"{name}.cpp").read_text())
                sys.exit(1)
            tried += 1
        if not tried:
            sys.exit("no compiler is installed")
    finally:
        if not os.environ.get("KEEP"):
            shutil.rmtree(folder)


main()
