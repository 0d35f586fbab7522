"""How long small jobs take from the shell: the whole process, nothing subtracted."""

import os
from pathlib import Path

from . import process
from .statistics import summarise

MATERIAL = Path(__file__).resolve().parent.parent / "inputs" / "RoughMetal.rtsl"


def commands(build):
    """Name, arguments, and the limit in seconds where the project has set one."""
    rtslc = str(build / "bin" / "rtslc")
    return [
        ("true", ["/bin/true"], None),  # what any process costs here
        ("rtslc --help", [rtslc, "--help"], 0.010),
        ("rtslc check", [rtslc, "check", str(MATERIAL)], 0.015),
        ("rtslc compile --emit=llvm", [rtslc, "compile", str(MATERIAL), "--emit=llvm", "-o", "-"], None),
    ]


def measure(build, count):
    listed = commands(build)
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
    parser = subcommands.add_parser("startup", parents=[common], help="whole processes of small jobs")
    parser.add_argument("--runs", type=int, default=50, help="runs of each command (default: 50)")
    parser.set_defaults(parts=[part])


def part(options):
    """Name, measured report, and how to show it."""
    return "startup", measure(options.build, max(1, getattr(options, "runs", 50))), show
