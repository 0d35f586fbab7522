"""What continuations cost: bytes saved at each trace beside plain liveness, and instructions beside recursion."""

import json
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from statistics import median

from . import process

ROOT = Path(__file__).resolve().parent.parent.parent
SCENES = sorted((ROOT / "examples").glob("*/scene.json"))

# Both traverse with runtime/device; they differ in how shaders trace.
WAYS = {"recurse": ["--trace=recurse", "--traversal=device"], "split": ["--target=host-megakernel"]}


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
            "recomputed": trace["rematerialisedCost"],
        }
        for function in report["functions"]
        for trace in function["traces"]
    ]
    return {"traces": traces, "frame": report["frameSize"], "stack": report["stack"]}


def count_instructions(program, scene, way, samples, size, folder):
    """What callgrind counts in a whole run with one thread."""
    out = folder / "callgrind.out"
    command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={out}", str(program), "render", str(scene),
               "--threads", "1", "--size", size, "--spp", str(samples), "-q", "-o", str(folder / "x.exr")]
    done = subprocess.run(command + WAYS[way], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    found = re.search(r"^summary: (\d+)", out.read_text(), re.MULTILINE) if out.exists() else None
    if done.returncode != 0 or not found:
        raise process.Failed(f"callgrind: {done.stderr[-400:]}")
    return int(found.group(1))


def instructions_per_sample(build, scene, way, size, folder):
    """Between runs of few and many samples: what a run takes before the first sample is in both."""
    # Without debug information, which valgrind's reader does not understand.
    program = folder / "rtslc-render"
    if not program.exists():
        subprocess.run(["strip", "-g", "-o", program, build / "bin" / "rtslc-render"], check=True)
    few, many = 1, 9
    width, height = map(int, size.split("x"))
    counts = [count_instructions(program, scene, way, samples, size, folder) for samples in (few, many)]
    return (counts[1] - counts[0]) / ((many - few) * width * height)


def measure(build, size, with_instructions):
    results = []
    for scene in SCENES:
        result = {"scene": str(scene.relative_to(ROOT)), **saved_bytes(build, scene)}
        if with_instructions:
            with tempfile.TemporaryDirectory() as folder:
                result["instructions"] = {
                    way: instructions_per_sample(build, scene, way, size, Path(folder)) for way in WAYS
                }
        results.append(result)
    ratios = [trace["saved"] / trace["live"] for result in results for trace in result["traces"] if trace["live"]]
    return {"scenes": results, "medianShareSaved": median(ratios), "tracesCounted": len(ratios), "size": size}


def show(report):
    print(f"{'bytes at each trace':64}{'alive':>7}{'saved':>7}")
    for scene in report["scenes"]:
        print(scene["scene"])
        for trace in scene["traces"]:
            print(f"  {trace['function'] + ', ' + trace['location']:62}{trace['live']:7}{trace['saved']:7}")
    print(f"median share of {report['tracesCounted']} traces: {report['medianShareSaved']:.2f} (limit 0.50)")
    for scene in report["scenes"]:
        if "instructions" in scene:
            recurse, split = scene["instructions"]["recurse"], scene["instructions"]["split"]
            print(f"{scene['scene']}: {split:.0f} instructions a sample on the host megakernel, {recurse:.0f} by recursion: "
                  f"{100 * (split / recurse - 1):+.1f} % (limit +5 %)")


def add(subcommands, common):
    parser = subcommands.add_parser("continuations", parents=[common],
                                    help="bytes saved at traces, and instructions beside recursion (with valgrind)")
    parser.add_argument("--size", default="32x18", help="of the pictures whose instructions are counted (default: 32x18)")
    parser.set_defaults(parts=[part])


def part(options):
    """Name, measured report, and how to show it."""
    size = getattr(options, "size", "32x18")
    return "continuations", measure(options.build, size, shutil.which("valgrind") is not None), show
