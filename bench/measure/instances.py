"""Many instances: rtslc beside the program that was written by hand, which uses Embree's instances
of one level, in turns, by processor time."""

import json
import math
import random

from . import meshes
from .options import add_benchmark, add_count, add_size

INSTANCES = 20000
AXES = ([1, 0, 0], [0, 1, 0], [0, 0, 1])
SIZES = ((0.5, 0.2), (0.4, 0.12))  # of the two tori


def write_scene(folder):
    """Tori on a field and above it, each turned and scaled. Gives the scene's file, and the meshes
    and their places."""
    dice = random.Random(11)
    files = [folder / f"torus{i}.obj" for i in range(len(SIZES))]
    for file, (large, small) in zip(files, SIZES):
        meshes.write_torus(file, [0, 0, 0], AXES, large, small)
    places, children = [], []
    for _ in range(INSTANCES):
        mesh, degrees = dice.randrange(len(SIZES)), dice.uniform(0, 360)
        size = dice.uniform(0.2, 0.6)
        at = [dice.uniform(-12, 12), dice.uniform(0, 4), dice.uniform(-30, 3)]
        c, s = (size * f(math.radians(degrees)) for f in (math.cos, math.sin))
        columns = [c, 0, -s, 0, size, 0, s, 0, c, *at]
        places.append(" ".join([str(mesh), *(f"{x:.9g}" for x in columns)]))
        rows = [[*columns[3 * i : 3 * i + 3], int(i == 3)] for i in range(4)]
        children.append(
            {"child": f"torus{mesh}", "transform": {"matrix": [x for row in rows for x in row]}}
        )
    placed = folder / "all.places"
    placed.write_text("\n".join(places) + "\n")
    scene = meshes.scene_of([])
    scene["nodes"] = {
        **{file.stem: {"mesh": file.name, "material": "clay"} for file in files},
        "field": {"children": children},
    }
    scene["root"] = "field"
    path = folder / "scene.json"
    path.write_text(json.dumps(scene))
    return path, [*files, placed]


def add(subcommands, common):
    summary = "many instances beside the hand-written program"
    parser = add_benchmark(subcommands, common, "instances", summary, part)
    add_count(parser, "--pairs", 8, "rounds in which every program runs")
    add_count(parser, "--spp", 9, "samples a pixel")
    add_size(parser, "640x360")


def show(report):
    meshes.show(report, "20,000 instances of two meshes of 686 triangles")


def part(options):
    """Name, measured report, and how to show it."""
    report = meshes.measure(options.build, options.pairs, options.spp, options.size, write_scene)
    return ("instances", report, show)
