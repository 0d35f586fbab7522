"""Paths: rtslc's engine `path` beside the path tracer that was written by hand, which has the same
estimator, in turns, by processor time. In the Cornell box, or in a hall of copies of a mesh."""

import functools
import json
from pathlib import Path

from . import meshes
from .gpu import ROOM_HEIGHT, SPACING, hall, read_mesh, write_hall
from .options import add_benchmark, add_count, add_size
from .render import ROOT

CORNELL = ROOT / "examples" / "cornell" / "scene.json"
LARGEST_MEAN_DIFFERENCE = 0.01  # relative; the paths are not the same, so chance plays a part
STONE = [0.7, 0.68, 0.63]  # the reflectance of the hall


def numbers(value):
    """A color, which may be given by one number."""
    return value if isinstance(value, list) else [value] * 3


def line_of(kind, values, *more):
    return " ".join([kind, *(f"{x:.9g}" for x in values), *map(str, more)])


def line_of_camera(camera):
    constructor = camera["constructor"]
    return line_of("camera", [*constructor["eye"], *constructor["target"], camera["fieldOfView"]])


def line_of_parallelogram(one, materials):
    material = materials[one["material"]]
    corners = [x for point in one["primitive"]["constructor"] for x in point]
    colors = [*numbers(material.get("reflectance", 0)), *numbers(material.get("radiance", 0))]
    return line_of("parallelogram", [*corners, *colors])


def write_twin(folder, scene, meshes_of):
    """The same scene for the program by hand. Gives its arguments."""
    lines = [line_of_camera(scene["camera"]), *meshes_of]
    lines += [
        line_of_parallelogram(one, scene["materials"])
        for one in scene["objects"]
        if "primitive" in one
    ]
    twin = folder / "twin.txt"
    twin.write_text("\n".join(lines) + "\n")
    return [twin, "--depth", scene["render"]["depth"]]


def write_cornell(folder):
    """Gives the scene's file, and the arguments of the program by hand."""
    return CORNELL, write_twin(folder, json.loads(CORNELL.read_text()), [])


def write_paths_in_hall(mesh, grid, folder):
    """The same for a hall of grid x grid copies of a mesh, below a lamp."""
    write_hall(mesh, grid, folder / "hall.ply")
    half, top = SPACING * grid / 2, ROOM_HEIGHT - 0.01
    lamp = [[-half / 2, top, -half / 2], [half, 0, 0], [0, 0, half]]
    scene = {
        "rtsl": 1,
        "import": ["std.cameras", "std.primitives", "std.materials"],
        "camera": {
            "class": "PerspectiveCamera",
            "constructor": {
                "eye": [0.9 * half, 2, 0.8 * half],
                "target": [0, 0.5, 0],
                "up": [0, 1, 0],
            },
            "fieldOfView": 60,
        },
        "materials": {
            "stone": {"class": "Lambert", "reflectance": STONE},
            "lamp": {"class": "Emitter", "radiance": 6, "isTwoSided": True},
        },
        "objects": [
            {"mesh": "hall.ply", "material": "stone"},
            {
                "primitive": {"class": "Parallelogram", "constructor": lamp},
                "material": "lamp",
            },
        ],
        "render": {"engine": "path", "depth": 8},
    }
    path = folder / "scene.json"
    path.write_text(json.dumps(scene))
    return path, write_twin(folder, scene, [line_of("mesh", STONE, folder / "hall.ply")])


def add(subcommands, common):
    summary = "paths in the Cornell box, or a hall, beside the hand-written path tracer"
    parser = add_benchmark(subcommands, common, "paths", summary, part)
    parser.add_argument(
        "hall",
        nargs="?",
        type=hall,
        metavar="MESH:N",
        help="a hall of N x N copies of an OBJ file, in place of the Cornell box; nefertiti.obj:6 "
        "has 3.6 million triangles",
    )
    add_count(parser, "--pairs", 8, "rounds in which every program runs")
    add_count(parser, "--spp", 33, "samples a pixel, of which the first is not counted", least=2)
    add_size(parser, "256x256")


def part(options):
    """Name, measured report, and how to show it."""
    what, write = "the Cornell box", write_cornell
    if options.hall:
        file, grid = options.hall
        what = f"a hall of {grid * grid} copies of {Path(file).name}"
        write = functools.partial(write_paths_in_hall, read_mesh(Path(file)), grid)
    report = meshes.measure(
        options.build, options.pairs, options.spp, options.size, write, "bench-paths"
    )
    for ratio in report["ratios"]:
        pictures = ratio["pictures"]
        pictures["agree"] = pictures["largestMeanDifference"] <= LARGEST_MEAN_DIFFERENCE
    return ("paths", report, lambda report: meshes.show(report, f"{what}, paths of many bounces"))
