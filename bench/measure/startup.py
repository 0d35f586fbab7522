"""How long small jobs take from the shell: the whole process, nothing subtracted."""

import os
import shutil
import tempfile
from pathlib import Path

from . import process
from .options import add_benchmark, add_count
from .statistics import summarise

MATERIAL = Path(__file__).resolve().parent.parent / "inputs" / "RoughMetal.rtsl"


def long_material():
    """A material of 500 lines with ten traces: coats one upon the other, each of which weakens and
    tints what comes through the one below."""
    lines = [
        "class Coats : rt_Material;",
        "",
        "public float strength = 0.5;",
        "",
        "void shade() {",
        "  color sum = color(0.0);",
        "  vec3 n = normalize(rt_ShadingNormal);",
        "  vec3 d = rt_RayDirection;",
        "  float w = strength;",
    ]
    for coat in range(10):
        lines += [
            f"  float a{coat} = dot(d, n) * {coat + 1}.5 + w;",
            f"  vec3 t{coat} = d + n * a{coat};",
        ]
        for step in range(43):
            lines.append(
                f"  t{coat} = t{coat} * 0.75 + vec3(a{coat}, w, {step}.25) * sin(a{coat} + "
                f"{step}.0);"
                if step % 4 == 0
                else f"  a{coat} = a{coat} * w + {step}.125;"
            )
        lines += [
            f"  sum += w * trace(rt_HitPoint, t{coat});",
            f"  w *= 0.5 + 0.25 * a{coat};",
            f"  d = reflect(t{coat}, n);",
        ]
    lines += [""] * (498 - len(lines)) + ["  rt_SampleColor = sum;", "}"]
    return "\n".join(lines) + "\n"


def other_compilers(folder):
    """What others take to compile the same material, where they are installed."""
    nvcc = shutil.which("nvcc") or shutil.which("/usr/local/cuda/bin/nvcc")
    glslang = shutil.which("glslangValidator")
    found = []
    if nvcc:
        source = MATERIAL.with_suffix(".cu")
        found.append(
            ("nvcc --ptx", [nvcc, "--ptx", str(source), "-o", str(folder / "nvcc.ptx")], None)
        )
    if glslang:
        source = MATERIAL.with_suffix(".rchit")
        found.append(
            (
                "glslangValidator",
                [glslang, "--target-env", "vulkan1.2", str(source), "-o", str(folder / "out.spv")],
                None,
            )
        )
    return found


def commands(build, folder):
    """Name, arguments, and the limit in seconds where the project has set one."""
    rtslc = str(build / "bin" / "rtslc")
    long_file = folder / "Coats.rtsl"
    long_file.write_text(long_material(), encoding="utf-8")

    def emit(stage, file, limit=None):
        return [rtslc, "compile", str(file), f"--emit={stage}", "-o", "-"], limit

    return [
        ("true", ["/bin/true"], None),  # what any process costs here
        ("rtslc --help", [rtslc, "--help"], 0.010),
        ("rtslc check", [rtslc, "check", str(MATERIAL)], 0.015),
        ("rtslc compile --emit=cpp", *emit("cpp", MATERIAL, 0.025)),
        ("rtslc compile --emit=llvm", *emit("llvm", MATERIAL)),
        ("rtslc compile --emit=ptx", *emit("ptx", MATERIAL, 0.040)),
        ("--emit=ssa, 500 lines", *emit("ssa", long_file)),
        ("--emit=split, 500 lines", *emit("split", long_file)),
    ] + other_compilers(folder)


def measure(build, count):
    with tempfile.TemporaryDirectory() as folder:
        return measure_in(Path(folder), build, count)


def measure_in(folder, build, count):
    listed = commands(build, folder)
    runs = {name: [] for name, _, _ in listed}
    failures = {}
    for round_ in range(-3, count):  # three rounds to warm the caches
        for name, arguments, _ in listed:
            if name in failures:
                continue
            try:
                run = process.run(arguments, keep_output=False)
            except process.Failed as failure:
                failures[name] = str(failure)
                continue
            if round_ >= 0:
                runs[name].append(run)
    results = []
    for name, _, limit in listed:
        if name in failures:
            results.append({"command": name, "failed": failures[name]})
            continue
        results.append(
            {
                "command": name,
                "limit": limit,
                "wall": summarise([run.wall for run in runs[name]]).as_json(),
                "processor": summarise([run.user + run.system for run in runs[name]]).as_json(),
            }
        )
    return {
        "input": os.path.relpath(MATERIAL, MATERIAL.parents[2]),
        "lines": len(MATERIAL.read_text(encoding="utf-8").splitlines()),
        "commands": results,
    }


def show(report):
    print(f"whole process, on {report['input']} ({report['lines']} lines); milliseconds")
    print(f"{'':28}{'median':>8}{'min':>8}{'max':>8}{'limit':>8}")
    for result in report["commands"]:
        if "failed" in result:
            print(f"{result['command']:28}failed: {result['failed']}")
            continue
        wall = result["wall"]
        limit = f"{result['limit'] * 1e3:.0f}" if result["limit"] else ""
        times = "".join(f"{wall[key] * 1e3:8.2f}" for key in ("median", "min", "max"))
        print(f"{result['command']:28}{times}{limit:>8}")


def add(subcommands, common):
    summary = "whole processes of small jobs"
    parser = add_benchmark(subcommands, common, "startup", summary, part)
    add_count(parser, "--runs", 50, "runs of each command")


def part(options):
    """Name, measured report, and how to show it."""
    return "startup", measure(options.build, getattr(options, "runs", 50)), show
