"""Bilinear lookups in an image: of a shader, of a plain loop by hand, and of OpenImageIO's texture
system. And lookups that are filtered over the footprints of rays, on a plane that is seen at an
angle, beside those in the finest level."""

import json
import random
import shutil
import struct
import subprocess
import tempfile
import zlib
from pathlib import Path

from . import process
from .options import add_benchmark, add_count
from .statistics import summarise

ROOT = Path(__file__).resolve().parent.parent.parent
SIZE, WIDTH, HEIGHT, SAMPLES, LOOKUPS = 512, 1024, 1024, 4, 16  # as in bench/images/Lookups.h
SHADER = """
class Lookups : rt_RayGeneration {
  public sampler2D image;
  void generate() {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 16; ++i)
      sum += image.sample(rt_ScreenCoord * 7.3 + 0.37 * float(i));
    rt_SampleColor = color(sum.r, sum.g, sum.b) / 16.0;
  }
};
"""
FILTERED = """
class Filtered : rt_Material {
  public sampler2D image;
  void shade() {
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 16; ++i)
      sum += image.sample(rt_TextureUV * 40.0 + 0.37 * float(i));
    rt_SampleColor = color(sum.r, sum.g, sum.b) / 16.0;
  }
};
"""
FILTERS = ("bilinear", "trilinear", "anisotropic")


def write_filtered(folder):
    """A scene for each filter. A pixel in the middle of the picture covers 3 x 14 texels."""
    (folder / "filtered.rtsl").write_text(FILTERED)
    for kind in FILTERS:
        scene = {
            "rtsl": 1,
            "import": ["filtered.rtsl", "std.cameras", "std.primitives"],
            "camera": {
                "class": "PerspectiveCamera",
                "constructor": [[0, -4, 1], [0, 0, 0], [0, 0, 1]],
            },
            "objects": [
                {
                    "primitive": {
                        "class": "Parallelogram",
                        "constructor": [[-20, -3, 0], [40, 0, 0], [0, 40, 0]],
                    },
                    "material": {
                        "class": "Filtered",
                        "image": {"file": "image.png", "filter": kind},
                    },
                }
            ],
            "render": {"size": [WIDTH // 2, HEIGHT // 2], "spp": SAMPLES},
        }
        (folder / f"{kind}.json").write_text(json.dumps(scene))


def write_image(folder):
    """Random texels, as PNG and as they lie in memory."""
    chance = random.Random(1)
    texels = chance.randbytes(4 * SIZE * SIZE)
    rows = [texels[4 * SIZE * y : 4 * SIZE * (y + 1)] for y in range(SIZE)]

    def chunk(name, data):
        return (
            struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        )

    (folder / "image.png").write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", SIZE, SIZE, 8, 6, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(b"".join(b"\0" + row for row in rows)))
        + chunk(b"IEND", b"")
    )
    (folder / "image.raw").write_bytes(b"".join(reversed(rows)))
    (folder / "lookups.rtsl").write_text(SHADER)
    scene = {
        "rtsl": 1,
        "import": ["lookups.rtsl"],
        "rayGeneration": {"class": "Lookups", "image": {"file": "image.png", "filter": "bilinear"}},
        "render": {"engine": "programs", "size": [WIDTH, HEIGHT], "spp": SAMPLES},
    }
    (folder / "scene.json").write_text(json.dumps(scene))


def programs(folder):
    """Name and command of each program by hand that can be built here."""
    flags = ["-std=c++17", "-O3", "-march=x86-64-v3", "-I", str(ROOT)]
    wanted = [
        (f"plain loop, {compiler}", compiler, "Plain", [], "image.raw")
        for compiler in ("g++", "clang++-22")
    ]
    wanted.append(
        (
            "OpenImageIO's texture system",
            "g++",
            "OpenImageIO",
            ["-isystem", "/usr/include/Imath", "-lOpenImageIO", "-lOpenImageIO_Util"],
            "image.png",
        )
    )
    for name, compiler, source, more, image in wanted:
        program = folder / name.replace(" ", "-").replace(",", "").replace("'", "")
        if shutil.which(compiler):
            command = [
                compiler,
                *flags,
                str(ROOT / "bench" / "images" / f"{source}.cpp"),
                "-o",
                str(program),
                *more,
            ]
            if subprocess.run(command, capture_output=True).returncode == 0:
                yield name, [str(program), str(folder / image)]


def time_of(build, folder, scene, arithmetic):
    """Seconds to render a scene on one core."""
    command = [str(build / "bin" / "rtslc"), "render", str(folder / scene), "--json"]
    command += ["--threads", "1", f"--fp={arithmetic}", "-o", str(folder / "picture.exr")]
    return json.loads(process.run(command).output)["seconds"]["render"]


def measure(build, rounds):
    results, filtered = {}, {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        write_image(folder)
        write_filtered(folder)
        by_hand = list(programs(folder))
        for _ in range(rounds):
            for arithmetic in ("strict", "fast"):
                results.setdefault(f"rtslc, {arithmetic}", []).append(
                    time_of(build, folder, "scene.json", arithmetic)
                    * 1e9
                    / (WIDTH * HEIGHT * SAMPLES * LOOKUPS)
                )
                for kind in FILTERS:
                    filtered.setdefault(f"{kind}, {arithmetic}", []).append(
                        time_of(build, folder, f"{kind}.json", arithmetic)
                        * 4e9
                        / (WIDTH * HEIGHT * SAMPLES * LOOKUPS)
                    )
            for program, command in by_hand:
                results.setdefault(program, []).append(
                    json.loads(process.run(command).output)["nanoseconds"]
                )
    return {
        "rounds": rounds,
        "results": {program: summarise(times).as_json() for program, times in results.items()},
        "filtered": {kind: summarise(times).as_json() for kind, times in filtered.items()},
    }


def show(report):
    print(
        f"a bilinear lookup in an image of {SIZE} x {SIZE} texels, 8 bits in sRGB; nanoseconds on "
        "one core, medians of "
        f"{report['rounds']} rounds"
    )
    ours = report["results"]["rtslc, strict"]["median"]
    for program, times in report["results"].items():
        low, high = times["interval"]
        print(
            f"  {program:32}{times['median']:8.1f}  "
            f"{f'{low:.1f} to {high:.1f}':16}{times['median'] / ours:6.2f} of the time of strict"
        )
    print("filtered over the footprints of rays (bilinear: in the finest level)")
    finest = report["filtered"]["bilinear, strict"]["median"]
    for kind, times in report["filtered"].items():
        low, high = times["interval"]
        print(
            f"  {kind:32}{times['median']:8.1f}  "
            f"{f'{low:.1f} to {high:.1f}':16}{times['median'] / finest:6.2f} of the finest, strict"
        )


def add(subcommands, common):
    summary = "lookups in images beside others"
    parser = add_benchmark(subcommands, common, "images", summary, part)
    add_count(parser, "--rounds", 7, "rounds of each program")


def part(options):
    """Name, measured report, and how to show it."""
    return "images", measure(options.build, options.rounds), show
