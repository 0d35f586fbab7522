"""Programs of ours on a GPU beside CUDA by hand for the same algorithm.

Each program is rendered in 1024x1024 pixels with 64 samples, by ours with strict and with fast
arithmetic, and by bench/gpu/byhand/*.cu, compiled by nvcc without and with --use_fast_math. The
time is that of the kernels by the device's clock; of ours it contains adding the samples to the
pixels. Where NVIDIA's profiler `ncu` is installed and may read counters, the instructions of a
sample are counted: those of all lanes of all kernels.
"""

import csv
import io
import json
import os
import shutil
import sys
import tempfile
from pathlib import Path

from . import process
from .gpu import ROOT, command_of_picture, measure_picture

PROGRAMS = ("paths", "crystal", "noise", "ggx")
ARITHMETIC = {"strict": [], "fast": ["--use_fast_math"]}
COUNTER = "smsp__thread_inst_executed.sum"
SIZE, SAMPLES, COUNTED_SAMPLES = 1024, 64, 4


def find_tool(name):
    return shutil.which(name) or shutil.which(name, path="/usr/local/cuda/bin")


def lane_instructions(command):
    """Of all kernels that the command runs; None if they cannot be counted."""
    profiler = find_tool("ncu")
    if not profiler:
        return None
    try:
        run = process.run(
            [profiler, "--csv", "--target-processes", "all", "--metrics", COUNTER, *command]
        )
    except process.Failed:
        return None
    lines = [line for line in run.output.splitlines() if line.startswith('"')]
    rows = csv.DictReader(io.StringIO("\n".join(lines)))
    counts = [float(row["Metric Value"].replace(",", "")) for row in rows]
    return sum(counts) if counts else None


def measure_ours(options, name, arithmetic):
    scene = ROOT / "bench" / "gpu" / name / "scene.json"
    how = [f"{SIZE}x{SIZE}", f"--fp={arithmetic}"]
    figures = measure_picture(options, scene, SAMPLES, *how)
    with tempfile.TemporaryDirectory() as folder:
        picture = f"{folder}/picture.exr"
        count = lane_instructions(
            command_of_picture(options, scene, picture, COUNTED_SAMPLES, *how)
        )
    if count is not None:
        figures["instructionsPerSample"] = count / (SIZE * SIZE * COUNTED_SAMPLES)
    return figures


def measure_hand(folder, name, arithmetic):
    compiler = find_tool("nvcc")
    if not compiler:
        raise process.Failed("nvcc, which compiles bench/gpu/byhand, is not installed")
    program = os.path.join(folder, f"{name}-{arithmetic}")
    source = ROOT / "bench" / "gpu" / "byhand" / f"{name}.cu"
    process.run(
        [compiler, "-O3", "-arch=native", *ARITHMETIC[arithmetic], str(source), "-o", program]
    )
    figures = json.loads(process.run([program]).output)
    count = lane_instructions([program])
    if count is not None:  # of the measured launches and the first one
        figures["instructionsPerSample"] = count / (figures["launches"] * figures["samples"])
    return figures


def measure(options):
    results = {}
    with tempfile.TemporaryDirectory() as folder:
        for name in options.programs:
            results[name] = {
                arithmetic: {
                    "ours": measure_ours(options, name, arithmetic),
                    "by hand": measure_hand(folder, name, arithmetic),
                }
                for arithmetic in ARITHMETIC
            }
    return "byhand", results, show


def markdown(results):
    lines = [
        "| 1024x1024, 64 samples | by | million samples/s | ratio | instructions a sample | "
        "registers | local bytes |",
        "|---|" + "---|" * 6,
    ]
    for name, of in results.items():
        for arithmetic, both in of.items():
            ratio = both["ours"]["samplesPerSecond"] / both["by hand"]["samplesPerSecond"]
            for who, figures in both.items():
                instructions = figures.get("instructionsPerSample")
                lines.append(
                    f"| {name}, {arithmetic} | {who} | {figures['samplesPerSecond'] * 1e-6:.0f} | "
                    f"{f'{ratio:.2f}' if who == 'ours' else ''} | "
                    f"{f'{instructions:.0f}' if instructions else ''} | {figures['registers']} | "
                    f"{figures['localBytes']} |"
                )
    return "\n".join(lines) + "\n"


def show(results):
    sys.stdout.write(markdown(results))


def program(name):
    if name not in PROGRAMS:
        raise ValueError
    return name


def add(subcommands, common):
    parser = subcommands.add_parser(
        "byhand", parents=[common], help="programs on a GPU beside CUDA by hand"
    )
    parser.add_argument(
        "programs",
        nargs="*",
        type=program,
        default=list(PROGRAMS),
        metavar="PROGRAM",
        help=f"of {', '.join(PROGRAMS)} (default: all)",
    )
    parser.set_defaults(parts=[measure], target="gpu")
