#!/usr/bin/env python3
"""Asks of printed C++ what the tests of the language asked of the JIT, bit for bit.

    conformance.py RTSLC TEST-LOWER SOURCE-FOLDER LIBRARY-FOLDER [all]

TEST-LOWER runs hundreds of small programs with its JIT and, asked by RTSL_RECORD, writes down what went in and what came
out. Each program is printed as C++; all of them make one file, which is compiled without warnings by each compiler that is
there and must give the same bits (two NaN count as the same). With `all` every combination of options is tried.
"""
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

WARNINGS = "-Wall -Wextra -Wpedantic -Werror -Wconversion".split()
OPTIONS = [("g++", ["-O0"]), ("g++", ["-O2"]), ("clang++-22", ["-O0"]), ("clang++-22", ["-O2"])]
MORE_OPTIONS = [(compiler, ["-O3", "-march=native"]) for compiler in ("g++", "clang++-22")]
CALLS_A_PROGRAM = 40

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
            source = record.encode()[len(record[:at].encode()):][:size].decode()
            at += len(source) + 1
            calls = programs.setdefault(source, [])
            call = {}
        else:
            call[words[0], words[1]] = words[2:]
            isLast = words[0] == "after" and ("before", "int" if words[1] == "float" else words[1]) not in call \
                or (words[0], words[1]) == ("after", "uint")
            if isLast and len(calls) < CALLS_A_PROGRAM:
                calls.append(call)
                call = {}
    return list(programs.items())


def table(call, when):
    rows = [call.get((when, kind), ["0"] * 16) for kind in ("float", "int", "uint")]
    return "{" + ", ".join("{" + ", ".join(f"0x{word}u" for word in row) + "}" for row in rows) + "}"


def main():
    rtslc, lower, source, library = sys.argv[1:5]
    options = OPTIONS + (MORE_OPTIONS if "all" in sys.argv[5:] else [])
    folder = pathlib.Path(tempfile.mkdtemp(prefix="rtsl-cpp-"))
    try:
        record = folder / "record"
        subprocess.run([lower, "--gtest_brief=1", "--gtest_filter=-Examples.*"], env=dict(os.environ, RTSL_RECORD=str(record)),
                       check=True, stdout=subprocess.DEVNULL)
        programs = read(record.read_text())
        if len(programs) < 100:
            sys.exit(f"only {len(programs)} programs were recorded")
        texts, checks, tables = [], [], []
        count = 0
        for i, (text, calls) in enumerate(programs):
            done = subprocess.run([rtslc, "compile", "-", "--emit=cpp", "-o", str(folder / f"t{i}.cpp")],
                                  input=text.encode(), capture_output=True)
            if done.returncode:
                sys.exit(f"rtslc failed on\n{text}\n{done.stderr.decode()}")
            printed = (folder / f"t{i}.cpp").read_text()
            texts.append(printed.replace("#include <rtsl/shader.h>\n", ""))
            for call in calls:
                tables.append("{" + table(call, "before") + ", " + table(call, "after") + "}")
                checks.append(f'  failures += check("t{i}", t{i}::run, calls[{count}][0], calls[{count}][1]);')
                count += 1
        whole = folder / "all.cpp"
        whole.write_text("#include <rtsl/shader.h>\n" + "\n".join(texts) + HARNESS
                         + f"static const Words calls[{count}][2] = {{\n" + ",\n".join(tables) + "};\n"
                         + "int main() {\n  int failures = 0;\n" + "\n".join(checks)
                         + '\n  std::printf("%d failures\\n", failures);\n  return failures != 0;\n}\n')
        tried = 0
        for compiler, flags in options:
            if not shutil.which(compiler):
                print(f"{compiler} is not installed: skipped")
                continue
            program = folder / "all"
            built = subprocess.run([compiler, "-std=c++17", *flags, *WARNINGS, "-I", source, "-I", f"{source}/include",
                                    str(whole), "-o", str(program), "-L", library, "-lrtsl", f"-Wl,-rpath,{library}"],
                                   capture_output=True, text=True)
            if built.returncode:
                shutil.copy(whole, "/tmp/conformance-failed.cpp") if os.environ.get("KEEP") else None
                sys.exit(f"{compiler} {flags} refuses the C++:\n{built.stderr[:6000]}")
            ran = subprocess.run([str(program)], capture_output=True, text=True)
            print(f"{compiler} {' '.join(flags)}: {len(programs)} programs, {count} calls, {ran.stdout.strip()[-2000:]}")
            if ran.returncode:
                for line in ran.stdout.splitlines()[:3]:
                    name = line.split(":")[0]
                    if name[1:].isdigit():
                        print(f"{name} was\n{programs[int(name[1:])][0]}")
                        print("and is\n" + (folder / f"{name}.cpp").read_text())
                sys.exit(1)
            tried += 1
        if not tried:
            sys.exit("no compiler is installed")
    finally:
        if not os.environ.get("KEEP"):
            shutil.rmtree(folder)


main()
