"""Paths: rtslc's engine `path` beside path tracers that were written by hand, which have the same
estimator, in turns, by processor time. In the Cornell box, in a hall of copies of a mesh, or in a
product shot."""

import functools
import json
import math
from pathlib import Path

from . import meshes
from .gpu import ROOM_HEIGHT, SPACING, hall, read_mesh, write_hall
from .options import add_benchmark, add_count, add_size
from .render import ROOT

CORNELL = ROOT / "examples" / "cornell" / "scene.json"
PRODUCT = ROOT / "examples" / "product-shot"
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


def turned(line, angle):
    """A line of an OBJ file; vectors are turned about the y axis, by an angle in radians."""
    kind, *numbers_of = line.split()
    if kind not in ("v", "vn"):
        return line
    x, y, z = map(float, numbers_of)
    cosine, sine = math.cos(angle), math.sin(angle)
    return line_of(kind, [cosine * x + sine * z, y, cosine * z - sine * x])


def write_parts(path, angle, folder):
    """A file for each material of an OBJ file, turned. Gives their names by material."""
    vectors, faces, material = [], {}, None
    for line in path.read_text().splitlines():
        if line.startswith("usemtl"):
            material = line.split()[1]
        elif line.startswith("f "):
            faces.setdefault(material, []).append(line)
        elif line.startswith("v"):
            vectors.append(turned(line, angle))
    files = {name: folder / f"{name}.obj" for name in faces}
    for name, file in files.items():
        file.write_text("\n".join([*vectors, *faces[name]]) + "\n")
    return files


def glossy_materials(path):
    """Base color, metallic, roughness, coat and its roughness, as a scene reads them from an MTL
    file (scenefile/obj/Material.cpp) of which no reflectance is that of another index than 1.5."""
    given, made = {}, {}
    for words in map(str.split, path.read_text().splitlines()):
        if words and words[0] == "newmtl":
            given[words[1]] = known = {}
        elif words and not words[0].startswith("#"):
            known[words[0]] = [float(word) for word in words[1:]]
    for name, known in given.items():
        is_mirror = known.get("illum") == [3]
        exponent = known.get("Ns", [0])[0]
        made[name] = [
            *known["Ks" if is_mirror else "Kd"],
            1 if is_mirror else known.get("Pm", [0])[0],
            known["Pr"][0] if "Pr" in known else (2 / (exponent + 2)) ** 0.25,
            *known.get("Pc", [0]),
            *known.get("Pcr", [0.03]),
        ]
    return made


def write_product(folder):
    """The same for examples/product-shot."""
    scene = json.loads((PRODUCT / "scene.json").read_text())
    camera, sky, kettle = scene["camera"], scene["background"], scene["objects"][0]
    angle = math.radians(kettle["transform"]["rotate"][1])
    files = write_parts(PRODUCT / kettle["model"], angle, folder)
    materials = glossy_materials((PRODUCT / kettle["model"]).with_suffix(".mtl"))
    lines = [
        line_of("lens", [camera[name] for name in ("focusDistance", "lensRadius", "blades")]),
        line_of("sky", [*sky["zenith"], *sky["horizon"], *sky["ground"], sky["blur"]]),
        *(line_of("glossy", materials[name], file) for name, file in files.items()),
    ]
    return PRODUCT / "scene.json", write_twin(folder, scene, lines)


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


def subject(text):
    """What is rendered: `product-shot`, or a file and the width of a grid."""
    return text if text == "product-shot" else hall(text)


def add(subcommands, common):
    summary = "paths in the Cornell box, a product shot or a hall, beside path tracers by hand"
    parser = add_benchmark(subcommands, common, "paths", summary, part)
    parser.add_argument(
        "subject",
        nargs="?",
        type=subject,
        metavar="product-shot|MESH:N",
        help="in place of the Cornell box: examples/product-shot, or a hall of N x N copies of an "
        "OBJ file; nefertiti.obj:6 has 3.6 million triangles",
    )
    add_count(parser, "--pairs", 8, "rounds in which every program runs")
    add_count(parser, "--spp", 33, "samples a pixel")
    add_size(parser, "256x256")


def part(options):
    """Name, measured report, and how to show it."""
    what, write, program = "the Cornell box", write_cornell, "bench-paths"
    if options.subject == "product-shot":
        what, write, program = "the product shot", write_product, "bench-product"
    elif options.subject:
        file, grid = options.subject
        what = f"a hall of {grid * grid} copies of {Path(file).name}"
        write = functools.partial(write_paths_in_hall, read_mesh(Path(file)), grid)
    report = meshes.measure(options.build, options.pairs, options.spp, options.size, write, program)
    for ratio in report["ratios"]:
        pictures = ratio["pictures"]
        pictures["agree"] = pictures["largestMeanDifference"] <= LARGEST_MEAN_DIFFERENCE
    return ("paths", report, lambda report: meshes.show(report, f"{what}, paths of many bounces"))
