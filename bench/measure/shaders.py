"""Shaders that rtslc prints as C++ beside the same shaders written by hand: processor time of a call."""

import json
import shutil
import subprocess
import tempfile
from pathlib import Path

from . import process
from .statistics import summarise

ROOT = Path(__file__).resolve().parent.parent.parent
BY_HAND = ROOT / "bench" / "shaders"
SHADERS = ("NoiseTexture", "Ggx", "Julia", "Dielectric")
COMPILERS = ("g++", "clang++-22")
FLAGS = ("-std=c++17", "-O3", "-march=x86-64-v3")


def compile_all(compiler, sources, folder, library):
    """One program of generated code and code by hand, compiled with the same flags. Contraction is the compiler's
    default by hand; generated code switches it off for itself."""
    objects = []
    for source in sources:
        target = folder / f"{compiler}-{source.parent.name}-{source.stem}.o"
        command = [compiler, *FLAGS, "-I", str(ROOT), "-I", str(ROOT / "include"), "-c", str(source), "-o", str(target)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise process.Failed(f"{compiler} refuses {source}:\n{done.stderr}")
        objects.append(str(target))
    program = folder / f"shaders-{compiler}"
    subprocess.run([compiler, *objects, "-o", str(program), "-L", str(library), "-lrtsl", f"-Wl,-rpath,{library}"], check=True)
    return program


def measure(build, rounds):
    results = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        generated = folder / "generated"
        generated.mkdir()
        for shader in SHADERS:
            process.run([str(build / "bin" / "rtslc"), "compile", str(ROOT / "docs" / "cpp-output" / f"{shader}.rtsl"),
                         "--emit=cpp", "--trace=recurse", "-o", str(generated / f"{shader}.cpp")])
        sources = sorted(generated.glob("*.cpp")) + sorted(BY_HAND.glob("*.cpp"))
        for compiler in COMPILERS:
            if not shutil.which(compiler):
                results.append({"compiler": compiler, "failed": "not installed"})
                continue
            program = compile_all(compiler, sources, folder, build / "lib")
            for line in process.run([str(program), str(rounds)]).output.splitlines():
                run = json.loads(line)
                ratios = [hand / ours for hand, ours in zip(run["byHand"], run["generated"])]
                results.append(
                    {
                        "compiler": compiler,
                        "shader": run["shader"],
                        "difference": run["difference"],
                        "byHand": summarise(run["byHand"]).as_json(),
                        "generated": summarise(run["generated"]).as_json(),
                        "ratio": summarise(ratios).as_json(),
                    }
                )
    return {"flags": " ".join(FLAGS), "rounds": rounds, "results": results}


def show(report):
    print(f"printed C++ beside C++ by hand, {report['flags']}; nanoseconds of processor time a call, medians of "
          f"{report['rounds']} rounds")
    print(f"{'':32}{'by hand':>9}{'printed':>9}{'speed':>8}  {'interval':16}{'answers differ by':>18}")
    for result in report["results"]:
        if "failed" in result:
            print(f"{result['compiler']:12}{result['failed']}")
            continue
        low, high = result["ratio"]["interval"]
        print(f"{result['compiler']:12}{result['shader']:20}{result['byHand']['median']:9.1f}"
              f"{result['generated']['median']:9.1f}{result['ratio']['median']:8.2f}  {low:.2f} to {high:.2f}"
              f"{result['difference']:22.1e}")


def add(subcommands, common):
    parser = subcommands.add_parser("shaders", parents=[common], help="printed C++ beside C++ by hand")
    parser.add_argument("--rounds", type=int, default=20, help="rounds of each shader (default: 20)")
    parser.set_defaults(parts=[part])


def part(options):
    """Name, measured report, and how to show it."""
    return "shaders", measure(options.build, max(1, getattr(options, "rounds", 20))), show
