"""Paths in the Cornell box: rtslc's engine `path` beside the path tracer that was written by hand,
which has the same estimator, in turns, by processor time."""

import json

from . import meshes
from .options import add_benchmark, add_count, add_size
from .render import ROOT

SCENE = ROOT / "examples" / "cornell" / "scene.json"
LARGEST_MEAN_DIFFERENCE = 0.01  # relative; the paths are not the same, so chance plays a part


def numbers(value):
    """A color, which may be given by one number."""
    return value if isinstance(value, list) else [value] * 3


def write_scene(folder):
    """Gives the scene of the example, and the arguments of the program by hand: a file with the
    parallelograms, and the depth."""
    scene = json.loads(SCENE.read_text())
    lines = []
    for one in scene["objects"]:
        material = scene["materials"][one["material"]]
        corners = [x for point in one["primitive"]["constructor"] for x in point]
        reflectance = numbers(material.get("reflectance", 0))
        radiance = numbers(material.get("radiance", 0))
        lines.append(" ".join(f"{x:.9g}" for x in [*corners, *reflectance, *radiance]))
    surfaces = folder / "surfaces.txt"
    surfaces.write_text("\n".join(lines) + "\n")
    return SCENE, [surfaces, "--depth", scene["render"]["depth"]]


def add(subcommands, common):
    summary = "paths in the Cornell box beside the hand-written path tracer"
    parser = add_benchmark(subcommands, common, "paths", summary, part)
    add_count(parser, "--pairs", 8, "rounds in which every program runs")
    add_count(parser, "--spp", 33, "samples a pixel, of which the first is not counted", least=2)
    add_size(parser, "256x256")


def show(report):
    meshes.show(report, "the Cornell box, paths of up to 9 bounces")


def part(options):
    """Name, measured report, and how to show it."""
    report = meshes.measure(
        options.build, options.pairs, options.spp, options.size, write_scene, "bench-paths"
    )
    for ratio in report["ratios"]:
        pictures = ratio["pictures"]
        pictures["agree"] = pictures["largestMeanDifference"] <= LARGEST_MEAN_DIFFERENCE
    return ("paths", report, show)
