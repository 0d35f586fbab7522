"""What continuations cost: bytes saved at each trace beside plain liveness, and instructions beside
saving all that is live."""

import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from statistics import median

from . import process
from .options import add_benchmark, add_size

ROOT = Path(__file__).resolve().parent.parent.parent
SCENES = sorted((ROOT / "examples").glob("*/scene.json"))

# What states keep over a trace.
WAYS = {"live": ["--save=live"], "needed": ["--save=needed"]}


def saved_bytes(build, scene):
    """Bytes alive and saved at each trace of the scene's program."""
    run = process.run([str(build / "bin" / "rtslc"), "explain", "--states", "--json", str(scene)])
    report = json.loads(run.output)
    traces = [
        {
            "function": function["name"],
            "location": trace["location"],
            "live": trace["liveBytes"],
            "saved": trace["savedBytes"],
            "cost": trace["extra"]["cost"],
            "plainCost": trace["extraOfPlainLiveness"]["cost"],
        }
        for function in report["functions"]
        for trace in function["traces"]
    ]
    return {"traces": traces, "frame": report["frameSize"], "stack": report["stack"]}


def count_instructions(program, package, samples, size, folder):
    """What callgrind counts in a whole run with one thread."""
    out = folder / "callgrind.out"
    command = [
        "valgrind",
        "--tool=callgrind",
        f"--callgrind-out-file={out}",
        str(program),
        str(package),
        "--target=host",
        "--threads",
        "1",
        "--size",
        size,
        "--spp",
        str(samples),
        "-q",
        "-o",
        str(folder / "x.exr"),
    ]
    done = subprocess.run(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    found = re.search(r"^summary: (\d+)", out.read_text(), re.MULTILINE) if out.exists() else None
    if done.returncode != 0 or not found:
        raise process.Failed(f"callgrind: {done.stderr[-400:]}")
    return int(found.group(1))


def instructions_per_sample(build, scene, way, size, folder):
    """Of the scene's package on the host megakernel, so nothing is compiled while callgrind counts.
    Between runs of few and many samples: what a run takes before the first sample is in both."""
    # Without debug information, which valgrind's reader does not understand.
    program, package = folder / "rtsl-run", folder / f"{way}.rtslpkg"
    if not program.exists():
        subprocess.run(["strip", "-g", "-o", program, build / "bin" / "rtsl-run"], check=True)
    process.run(
        [str(build / "bin" / "rtslc"), "pack", "-q", str(scene), "-o", str(package), *WAYS[way]]
    )
    few, many = 1, 9
    width, height = map(int, size.split("x"))
    counts = [
        count_instructions(program, package, samples, size, folder) for samples in (few, many)
    ]
    return (counts[1] - counts[0]) / ((many - few) * width * height)


def measure(build, size, with_instructions):
    results = []
    for scene in SCENES:
        result = {"scene": str(scene.relative_to(ROOT)), **saved_bytes(build, scene)}
        if with_instructions:
            with tempfile.TemporaryDirectory() as folder:
                result["instructions"] = {
                    way: instructions_per_sample(build, scene, way, size, Path(folder))
                    for way in WAYS
                }
        results.append(result)
    # A trace of a class that several examples share counts once, unless it saves something else in
    # one of them.
    traces = {
        (trace["function"], trace["location"], trace["live"], trace["saved"])
        for result in results
        for trace in result["traces"]
    }
    ratios = [saved / live for _, _, live, saved in traces if live]
    return {
        "scenes": results,
        "medianShareSaved": median(ratios),
        "tracesCounted": len(ratios),
        "size": size,
    }


def show(report):
    print(f"{'bytes at each trace':64}{'alive':>7}{'saved':>7}")
    for scene in report["scenes"]:
        print(scene["scene"])
        for trace in scene["traces"]:
            print(
                f"  {trace['function'] + ', ' + trace['location']:62}"
                f"{trace['live']:7}{trace['saved']:7}"
            )
    print(
        f"median share of {report['tracesCounted']} different traces: "
        f"{report['medianShareSaved']:.2f} (limit 0.50)"
    )
    measured = [scene for scene in report["scenes"] if "instructions" in scene]
    if measured:
        print(
            f"\n{'instructions a sample, host megakernel':40}"
            f"{'all live saved':>15}{'as it is':>10}{'more':>9}"
        )
    for scene in measured:
        counts = scene["instructions"]
        print(
            f"{scene['scene']:40}{counts['live']:15.0f}{counts['needed']:10.0f}"
            f"{100 * (counts['needed'] / counts['live'] - 1):+7.1f} %"
        )
    if measured:
        more = median(
            scene["instructions"]["needed"] / scene["instructions"]["live"] - 1
            for scene in measured
        )
        print(f"median over the examples: {100 * more:+.1f} % (limit +5 %)")


def add(subcommands, common):
    summary = "bytes saved at traces, and instructions that this costs (with valgrind)"
    parser = add_benchmark(subcommands, common, "continuations", summary, part)
    add_size(parser, "32x18", "of the pictures whose instructions are counted")


def part(options):
    """Name, measured report, and how to show it."""
    return (
        "continuations",
        measure(options.build, options.size, shutil.which("valgrind") is not None),
        show,
    )
