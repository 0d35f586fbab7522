"""Shaders that rtslc prints as C++ beside the same shaders written by hand: processor time of a
call."""

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

from . import process
from .options import add_benchmark, add_count
from .statistics import summarise

ROOT = Path(__file__).resolve().parent.parent.parent
BY_HAND = ROOT / "bench" / "shaders"
SHADERS = ("NoiseTexture", "Ggx", "Julia", "Dielectric")
COMPILERS = ("g++", "clang++-22")
FLAGS = ("-std=c++17", "-O3", "-march=x86-64-v3")
# Arithmetic of the printed code, the flags of that by hand beside it, and what they are called.
PAIRINGS = (
    ("strict", ("-ffp-contract=off",), "strict, by hand without contraction"),
    ("fast", (), "--fp=fast, by hand as compilers have it"),
    ("strict", (), "strict, by hand as compilers have it"),
)


def compile_file(compiler, source, target, flags):
    command = [
        compiler,
        *FLAGS,
        *flags,
        "-I",
        str(ROOT),
        "-I",
        str(ROOT / "include"),
        "-c",
        str(source),
        "-o",
        str(target),
    ]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise process.Failed(f"{compiler} refuses {source}:\n{done.stderr}")
    return str(target)


def build_programs(compiler, printed, folder, library):
    """A program a pairing; `printed` has the files of each arithmetic. What both sides call is the
    same object file."""
    shared = [
        compile_file(compiler, BY_HAND / f"{name}.cpp", folder / f"{name}.o", ())
        for name in ("Main", "Surroundings")
    ]
    objects = {}
    for arithmetic, sources in printed.items():
        objects[arithmetic] = [
            compile_file(compiler, source, source.with_suffix(".o"), ()) for source in sources
        ]
    programs = []
    for number, (arithmetic, flags, _) in enumerate(PAIRINGS):
        by_hand = [
            compile_file(
                compiler, BY_HAND / f"{shader}.cpp", folder / f"{shader}.{number}.o", flags
            )
            for shader in SHADERS
        ]
        programs.append(folder / f"shaders{number}")
        subprocess.run(
            [
                compiler,
                *shared,
                *objects[arithmetic],
                *by_hand,
                "-o",
                str(programs[-1]),
                "-L",
                str(library),
                "-lrtsl",
                f"-Wl,-rpath,{library}",
            ],
            check=True,
        )
    return programs


def measure(build, rounds):
    results = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        printed = {"strict": [], "fast": []}
        for arithmetic, sources in printed.items():
            (folder / arithmetic).mkdir()
            for shader in SHADERS:
                sources.append(folder / arithmetic / f"{shader}.cpp")
                process.run(
                    [
                        str(build / "bin" / "rtslc"),
                        "compile",
                        str(ROOT / "docs" / "cpp-output" / f"{shader}.rtsl"),
                        "--emit=cpp",
                        "--trace=recurse",
                        f"--fp={arithmetic}",
                        "-o",
                        str(sources[-1]),
                    ]
                )
        for compiler in COMPILERS:
            if not shutil.which(compiler):
                results.append({"compiler": compiler, "failed": "not installed"})
                continue
            for (_, _, pairing), program in zip(
                PAIRINGS, build_programs(compiler, printed, folder, build / "lib")
            ):
                for line in process.run([str(program), str(rounds)]).output.splitlines():
                    run = json.loads(line)
                    ratios = [hand / ours for hand, ours in zip(run["byHand"], run["generated"])]
                    results.append(
                        {
                            "compiler": compiler,
                            "pairing": pairing,
                            "shader": run["shader"],
                            "difference": run["difference"],
                            "byHand": summarise(run["byHand"]).as_json(),
                            "generated": summarise(run["generated"]).as_json(),
                            "ratio": summarise(ratios).as_json(),
                        }
                    )
    return {"flags": " ".join(FLAGS), "rounds": rounds, "results": results}


def show(report):
    print(
        f"printed C++ beside C++ by hand, {report['flags']}; nanoseconds of processor time a call, "
        "medians of "
        f"{report['rounds']} rounds"
    )
    title = None
    for result in report["results"]:
        if "failed" in result:
            print(f"{result['compiler']}: {result['failed']}")
            continue
        if title != (title := f"{result['compiler']}: {result['pairing']}"):
            print(
                f"\n{title:48}{'by hand':>9}{'printed':>9}{'speed':>8}  "
                f"{'interval':14}{'answers differ by':>18}"
            )
        low, high = result["ratio"]["interval"]
        print(
            f"  {result['shader']:46}{result['byHand']['median']:9.1f}"
            f"{result['generated']['median']:9.1f}"
            f"{result['ratio']['median']:8.2f}  "
            f"{f'{low:.2f} to {high:.2f}':14}{result['difference']:18.1e}"
        )


def add(subcommands, common):
    summary = "printed C++ beside C++ by hand"
    parser = add_benchmark(subcommands, common, "shaders", summary, part)
    add_count(parser, "--rounds", 20, "rounds of each shader")


def part(options):
    """Name, measured report, and how to show it."""
    return "shaders", measure(options.build, getattr(options, "rounds", 20)), show
