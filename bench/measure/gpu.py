"""The GPU: rays through halls of scanned meshes, and pictures of scenes of ours.

A hall is a grid of copies of a mesh in a closed room, as one list of triangles. Its rays:
`primary`, those of a camera; `ao`, seven from each point that these meet, of length 1, for which
any hit will do; `diffuse`, one of any length; `shuffled`, the same in random order. They are traced
by `rtslc trace --repeat`, that is by a ray generation that reads 32 bytes and writes 16 for each,
and the time is that of the launch by the device's clock: the median of 12 after a first one. A
picture of the hall has samples of a camera ray and a diffuse one, in one kernel. Each hall is
traced with both kinds of trees.
"""

import array
import json
import math
import random
import struct
import sys
import tempfile
from pathlib import Path

from . import process

ROOT = Path(__file__).resolve().parent.parent.parent
WIDTH, HEIGHT, REPEATS = 1920, 1080, 12
SPACING, ROOM_HEIGHT = 1.5, 3.0
SETS = ("primary", "ao", "diffuse", "shuffled")
TREES = ("fast", "good")
PICTURES = {
    "path tracer": (ROOT / "bench/gpu/paths/scene.json", 64),
    "glass": (ROOT / "examples/glass/scene.json", 64),
    "programs": (ROOT / "examples/whitted-programs/scene.json", 64),
}


def read_mesh(path):
    """Vertices and triangles of an OBJ file; polygons are fans."""
    vertices, triangles = [], []
    for line in path.read_text().splitlines():
        word, *rest = line.split() or [""]
        if word == "v":
            vertices.append(tuple(map(float, rest[:3])))
        elif word == "f":
            corners = [int(corner.split("/")[0]) for corner in rest]
            corners = [c - 1 if c > 0 else len(vertices) + c for c in corners]
            triangles += [
                (corners[0], corners[i], corners[i + 1]) for i in range(1, len(corners) - 1)
            ]
    return vertices, triangles


def write_hall(mesh, grid, path):
    """Writes a hall as a PLY file; gives its number of triangles."""
    vertices, triangles = mesh
    low, high = ([bound(v[axis] for v in vertices) for axis in range(3)] for bound in (min, max))
    scale = 1 / max(b - a for a, b in zip(low, high))
    x, z = ([(v[axis] - (low[axis] + high[axis]) / 2) * scale for v in vertices] for axis in (0, 2))
    y = [(v[1] - low[1]) * scale for v in vertices]
    side, positions = SPACING * grid, array.array("f")
    for i in range(grid):
        for j in range(grid):
            dx, dz = (i + 0.5) * SPACING - side / 2, (j + 0.5) * SPACING - side / 2
            for n in range(len(vertices)):
                positions.extend((x[n] + dx, y[n], z[n] + dz))
    faces = bytearray()
    for copy in range(grid * grid):
        base = copy * len(vertices)
        faces += b"".join(
            struct.pack("<B3i", 3, base + a, base + b, base + c) for a, b, c in triangles
        )
    h, top = side / 2, ROOM_HEIGHT
    for quad in (
        [(-h, 0, -h), (h, 0, -h), (h, 0, h), (-h, 0, h)],
        [(-h, top, -h), (h, top, -h), (h, top, h), (-h, top, h)],
        [(-h, 0, -h), (-h, top, -h), (-h, top, h), (-h, 0, h)],
        [(h, 0, -h), (h, top, -h), (h, top, h), (h, 0, h)],
        [(-h, 0, -h), (h, 0, -h), (h, top, -h), (-h, top, -h)],
        [(-h, 0, h), (h, 0, h), (h, top, h), (-h, top, h)],
    ):
        base = len(positions) // 3
        for corner in quad:
            positions.extend(corner)
        faces += struct.pack("<B3iB3i", 3, base, base + 1, base + 2, 3, base, base + 2, base + 3)
    count = grid * grid * len(triangles) + 12
    with open(path, "wb") as file:
        file.write(
            (
                "ply\nformat binary_little_endian 1.0\nelement vertex %d\nproperty float x\n"
                "property float y\nproperty float z\n"
                "element face %d\nproperty list uchar int vertex_indices\nend_header\n"
                % (len(positions) // 3, count)
            ).encode()
        )
        positions.tofile(file)
        file.write(faces)
    return count


def write_rays(options, grid, folder):
    """Writes the ray sets as .npy files."""
    pixels = WIDTH * HEIGHT
    scene = {
        "rtsl": 1,
        "import": [str(ROOT / "bench/gpu/halls/Rays.rtsl")],
        "rayGeneration": {
            "class": "HallRays",
            "size": SPACING * grid,
            "primary": {"size": [pixels]},
            "ao": {"size": [7 * pixels]},
            "diffuse": {"size": [pixels]},
        },
        "materials": {"meeting": {"class": "Meeting"}},
        "objects": [{"mesh": "hall.ply", "material": "meeting"}],
        "render": {"engine": "programs", "size": [WIDTH, HEIGHT], "depth": 0},
    }
    (folder / "rays.json").write_text(json.dumps(scene))
    outputs = [
        argument for name in SETS[:3] for argument in ("--out", f"{name}={folder / name}.npy")
    ]
    rtslc(options, "run", str(folder / "rays.json"), *outputs, "-q")
    data = (folder / "diffuse.npy").read_bytes()
    start = 10 + struct.unpack("<H", data[8:10])[0]
    rays = [data[i : i + 32] for i in range(start, len(data), 32)]
    random.Random(1).shuffle(rays)
    (folder / "shuffled.npy").write_bytes(data[:start] + b"".join(rays))


def write_bounce(grid, folder):
    """Writes a scene whose samples are a camera ray and one from what it meets."""
    scene = {
        "rtsl": 1,
        "import": [str(ROOT / "bench/gpu/halls/Rays.rtsl")],
        "rayGeneration": {"class": "HallBounce", "size": SPACING * grid},
        "materials": {"meeting": {"class": "Meeting"}},
        "objects": [{"mesh": "hall.ply", "material": "meeting"}],
        "render": {"engine": "programs", "size": [WIDTH, HEIGHT], "depth": 0},
    }
    (folder / "bounce.json").write_text(json.dumps(scene))


def command_of_rtslc(options, command, *arguments):
    return [str(options.build / "bin" / "rtslc"), command, *arguments, f"--target={options.target}"]


def rtslc(options, command, *arguments):
    return process.run(command_of_rtslc(options, command, *arguments)).output


def measure_hall(options, name, mesh, grid):
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        triangles = write_hall(mesh, grid, folder / "hall.ply")
        write_rays(options, grid, folder)
        write_bounce(grid, folder)
        figures = {"mesh": name, "grid": grid, "triangles": triangles, "trees": {}}
        for tree in TREES:
            figures["trees"][tree] = measure_tree(options, folder, tree, triangles)
        return figures


def measure_tree(options, folder, tree, triangles):
    """Traces the rays of a hall through a tree of one kind."""
    figures = {"raysPerSecond": {}}
    for rays in SETS:
        kind = ["--any"] if rays == "ao" else []
        launch = json.loads(
            rtslc(
                options,
                "trace",
                str(folder / "hall.ply"),
                "--rays",
                str(folder / f"{rays}.npy"),
                *kind,
                "--out",
                str(folder / "hits.npy"),
                f"--tree={tree}",
                f"--repeat={REPEATS}",
                "--json",
                "-q",
            )
        )["launches"][0]
        times = launch["repeats"]
        figures["raysPerSecond"][rays] = launch["size"][0] / times[len(times) // 2]
        if rays == "ao":
            hits = (folder / "hits.npy").read_bytes()
            figures["aoHits"] = hits.count(b"\1", 128) / launch["size"][0]
        if "gpu" in launch:
            figures["device"] = launch["gpu"]["device"]
        built = launch["tree"]
        # The first of them finds the files and the code of the driver in no cache.
        figures["treeSeconds"] = min(built["seconds"], figures.get("treeSeconds", math.inf))
        figures["cost"] = built.get("cost")
        figures["bytesPerTriangle"] = (80 * built["nodes"] + 48 * triangles) / triangles
    bounce = measure_picture(
        options, folder / "bounce.json", 16, f"{WIDTH}x{HEIGHT}", f"--tree={tree}"
    )
    figures["bounceSamplesPerSecond"] = bounce["samplesPerSecond"]
    return figures


def command_of_picture(options, scene, picture, samples, size="1024x1024", *arguments):
    size, samples = f"--size={size}", f"--spp={samples}"
    options_of_picture = ["-q", "-Wno-depth-limit", size, samples, *arguments]
    return command_of_rtslc(options, "render", str(scene), "-o", picture, *options_of_picture)


def measure_picture(options, scene, *arguments):
    """The arguments are those of command_of_picture from `samples` on."""
    with tempfile.TemporaryDirectory() as folder:
        command = command_of_picture(options, scene, f"{folder}/picture.exr", *arguments)
        figures = json.loads(process.run([*command, "--json"]).output)
    gpu = figures.get("gpu", {})
    seconds = gpu.get("kernelSeconds") or figures["seconds"]["render"]
    return {
        "samplesPerSecond": figures["samples"] / seconds,
        "registers": gpu.get("registers"),
        "localBytes": gpu.get("localBytes"),
    }


def measure(options):
    halls = []
    for mesh, grid in options.hall:
        halls.append(measure_hall(options, Path(mesh).stem, read_mesh(Path(mesh)), grid))
    pictures = {
        name: measure_picture(options, scene, samples)
        for name, (scene, samples) in PICTURES.items()
    }
    return "gpu", {"target": options.target, "halls": halls, "pictures": pictures}, show


def markdown(report):
    lines = [
        "| hall | triangles | tree | "
        + " | ".join(SETS)
        + " | primary and diffuse, million samples/s | bytes a triangle | cost | built, ms |",
        "|---|" + "---|" * 10,
    ]
    for hall in report["halls"]:
        for tree, figures in hall["trees"].items():
            rates = " | ".join(f"{figures['raysPerSecond'][rays] * 1e-6:.0f}" for rays in SETS)
            lines.append(
                f"| {hall['mesh']} {hall['grid']} | {hall['triangles']:,} | {tree} | {rates} | "
                f"{figures['bounceSamplesPerSecond'] * 1e-6:.0f} | "
                f"{figures['bytesPerTriangle']:.1f} | {figures['cost'] or 0:.2f} | "
                f"{figures['treeSeconds'] * 1e3:.1f} |"
            )
    lines += [
        "",
        "| 1024x1024 | million samples/s | registers | local bytes |",
        "|---|---|---|---|",
    ]
    for name, picture in report["pictures"].items():
        lines.append(
            f"| {name} | {picture['samplesPerSecond'] * 1e-6:.1f} | {picture['registers']} | "
            f"{picture['localBytes']} |"
        )
    devices = {
        figures["device"]
        for hall in report["halls"]
        for figures in hall["trees"].values()
        if "device" in figures
    }
    return (
        f"Target {report['target']}{', ' + ', '.join(devices) if devices else ''}; halls in "
        "million rays/s.\n\n" + "\n".join(lines) + "\n"
    )


def show(report):
    sys.stdout.write(markdown(report))


def part(options):
    name, report, printer = measure(options)
    if options.out:
        options.out.mkdir(parents=True, exist_ok=True)
        (options.out / "gpu.json").write_text(json.dumps(report, indent=2) + "\n")
        (options.out / "gpu.md").write_text(markdown(report))
    return name, report, printer


def hall(text):
    """MESH:N of the command line."""
    mesh, _, grid = text.rpartition(":")
    if not mesh or not grid.isdigit() or int(grid) == 0:
        raise ValueError
    return mesh, int(grid)


def add(subcommands, common):
    parser = subcommands.add_parser(
        "gpu", parents=[common], help="rays through halls, and pictures, on a GPU"
    )
    parser.add_argument(
        "hall",
        nargs="*",
        type=hall,
        metavar="MESH:N",
        help="a hall of N x N copies of an OBJ file; nefertiti.obj:6 has 3.6 million triangles",
    )
    parser.add_argument(
        "--target",
        default="gpu",
        choices=["gpu", "host-megakernel"],
        help="what runs the programs (default: gpu)",
    )
    parser.add_argument(
        "--out", type=Path, metavar="FOLDER", help="write gpu.json and gpu.md there, too"
    )
    parser.set_defaults(parts=[part])
