"""Many meshes: rtslc beside the program that was written by hand, in turns, by processor time."""

import json
import math
import random
import tempfile
from pathlib import Path

from . import process
from .options import add_benchmark, add_count, add_size
from .render import ROOT, compare
from .statistics import summarise

SHADERS = ROOT / "examples" / "glass"
MESHES = 382
AROUND, ACROSS = 49, 7  # quads of a torus: 686 triangles


def write_torus(path, center, axes, large, small):
    """A torus with normals, as an OBJ file."""
    lines = []
    for i in range(AROUND):
        for j in range(ACROSS):
            a, b = 2 * math.pi * i / AROUND, 2 * math.pi * j / ACROSS
            out = [math.cos(a) * axes[0][k] + math.sin(a) * axes[1][k] for k in range(3)]
            normal = [math.cos(b) * out[k] + math.sin(b) * axes[2][k] for k in range(3)]
            point = [center[k] + large * out[k] + small * normal[k] for k in range(3)]
            lines.append("v {:.6f} {:.6f} {:.6f}".format(*point))
            lines.append("vn {:.6f} {:.6f} {:.6f}".format(*normal))
    for i in range(AROUND):
        for j in range(ACROSS):
            corners = [
                (i + di) % AROUND * ACROSS + (j + dj) % ACROSS + 1
                for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1))
            ]
            for triangle in (corners[:3], [corners[0], corners[2], corners[3]]):
                lines.append("f " + " ".join(f"{corner}//{corner}" for corner in triangle))
    path.write_text("\n".join(lines) + "\n")


def write_scene(folder):
    """382 tori, 262,052 triangles, in a box that the camera looks into. Gives the scene's file and
    the meshes'."""
    dice = random.Random(7)
    files = []
    for number in range(MESHES):
        center = [dice.uniform(-4, 4), dice.uniform(0, 4), dice.uniform(-6, 2)]
        z = [dice.gauss(0, 1) for _ in range(3)]
        z = [c / math.hypot(*z) for c in z]
        x = [z[1], -z[0], 0] if abs(z[2]) < 0.9 else [0, z[2], -z[1]]
        x = [c / math.hypot(*x) for c in x]
        y = [z[1] * x[2] - z[2] * x[1], z[2] * x[0] - z[0] * x[2], z[0] * x[1] - z[1] * x[0]]
        large = dice.uniform(0.25, 0.6)
        files.append(folder / f"torus{number}.obj")
        write_torus(files[-1], center, (x, y, z), large, large * dice.uniform(0.2, 0.5))
    scene = scene_of([{"mesh": file.name, "material": "clay"} for file in files])
    path = folder / "scene.json"
    path.write_text(json.dumps(scene))
    return path, files


def scene_of(objects):
    """Under two lights, seen by the camera of the program by hand."""
    return {
        "rtsl": 1,
        "import": [
            str(SHADERS / name)
            for name in ("PinholeCamera.rtsl", "Lambert.rtsl", "Solid.rtsl", "BallLight.rtsl")
        ],
        "camera": {
            "class": "PinholeCamera",
            "constructor": {
                "eye": [0, 2.2, 7.5],
                "up": [0, 1, 0],
                "gaze": [0, -0.19, -1],
                "uv0": [-1.6, -0.9],
                "uv1": [1.6, 0.9],
                "d": 2.7,
            },
        },
        "textures": {"terracotta": {"class": "Solid", "value": [0.8, 0.35, 0.2]}},
        "materials": {"clay": {"class": "Lambert", "albedo": "terracotta"}},
        "objects": objects,
        "lights": [
            {"class": "BallLight", "position": [4, 6, 4], "radius": 0.4, "intensity": [38, 36, 33]},
            {"class": "BallLight", "position": [-5, 4, 2], "radius": 0.4, "intensity": [6, 7, 9]},
        ],
        "ambient": [0.12, 0.13, 0.16],
        "background": [0.25, 0.45, 0.8],
        "render": {"engine": "classic", "size": [640, 360], "spp": 16, "depth": 8, "seed": 1},
    }


class Program:
    """One of the programs, by the processor time of the whole command, and of that what it took to
    render the samples, without reading, building trees, compiling and writing."""

    def __init__(self, name, arguments, picture):
        self.name, self.picture = name, picture
        self.arguments = arguments + ["-o", str(picture)]
        self.seconds, self.command, self.scene, self.samples = [], [], [], 0

    def run(self, spp):
        run = process.run(self.arguments + ["--spp", str(spp)])
        figures = json.loads(run.output)
        self.samples = figures["samples"]
        self.seconds.append(figures["processorSeconds"])
        self.command.append(run.user + run.system)
        self.scene.append(figures["seconds"]["scene"])

    def forget(self):
        self.seconds.clear()
        self.command.clear()
        self.scene.clear()

    def figures(self):
        return {
            "program": self.name,
            "samples": self.samples,
            "seconds": summarise(self.seconds).as_json(),
            "command": summarise(self.command).as_json(),
            "scene": summarise(self.scene).as_json(),
        }

    def speed_over(self, other):
        """Round by round: of rendering, and of the whole command."""
        return {
            name: summarise([b / a for a, b in zip(ours, theirs)]).as_json()
            for name, ours, theirs in (
                ("speed", self.seconds, other.seconds),
                ("speedOfCommand", self.command, other.command),
            )
        }


def measure(build, pairs, spp, size, write_scene=write_scene, byhand="bench-meshes"):
    """`write_scene(folder)` gives the scene's file and those for the program by hand."""
    binaries = build / "bin"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        scene, files = write_scene(folder)
        options = ["--size", size, "--threads", "1"]

        def rtslc(name, *more):
            arguments = [str(binaries / "rtslc"), "render", str(scene), "--json", "-q", *more]
            return Program(name, arguments + options, folder / f"{name}.exr")

        theirs = Program(
            byhand,
            [str(binaries / byhand), *map(str, files)] + options,
            folder / "byhand.exr",
        )
        ours = [rtslc("strict"), rtslc("fast", "--fp=fast")]
        programs = [theirs, *ours]
        for program in programs:  # once, to warm the caches
            program.run(2)
            program.forget()
        for round_ in range(pairs):
            first = round_ % len(programs)
            for program in programs[first:] + programs[:first]:
                program.run(spp)
        return {
            "size": size,
            "spp": spp,
            "samples": [program.figures() for program in programs],
            "ratios": [
                {
                    "program": program.name,
                    **program.speed_over(theirs),
                    "pictures": compare(build, program, theirs),
                }
                for program in ours
            ],
        }


def show(report, what="382 meshes, 262,052 triangles"):
    print(
        f"{what}, {report['size']}, {report['spp']} samples a pixel on one thread, processor time"
    )
    for program in report["samples"]:
        seconds = program["seconds"]["median"]
        print(
            f"  {program['program']:14} rendering {seconds:7.3f} s, "
            f"{program['samples'] / seconds * 1e-6:6.3f} million samples/s; whole command "
            f"{program['command']['median']:7.3f} s, of which reading "
            f"{program['scene']['median']:.3f} s"
        )
    print("rtslc's speed over that of the program by hand, round by round")
    for ratio in report["ratios"]:
        pictures = ratio["pictures"]
        for name, of in (("speed", "rendering"), ("speedOfCommand", "whole command")):
            speed = ratio[name]
            low, high = speed["interval"]
            print(
                f"  {ratio['program']:8} {of:13} {speed['median']:.3f}   {low:.3f} to {high:.3f} "
                f"({speed['confidence']:.1%})"
            )
        print(
            f"  {ratio['program']:8} the pictures "
            f"{'agree' if pictures['agree'] else 'DIFFER: the ratio means nothing'}"
            f" (means within {pictures['largestMeanDifference']:.1e}, root mean square "
            f"{pictures['rmse']:.1e})"
        )


def add(subcommands, common):
    summary = "many meshes beside the hand-written program"
    parser = add_benchmark(subcommands, common, "meshes", summary, part)
    add_count(parser, "--pairs", 8, "rounds in which every program runs")
    add_count(parser, "--spp", 9, "samples a pixel")
    add_size(parser, "640x360")


def part(options):
    """Name, measured report, and how to show it."""
    return (
        "meshes",
        measure(options.build, options.pairs, options.spp, options.size),
        show,
    )
