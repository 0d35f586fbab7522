"""Light of many lamps: error and seconds with lamps chosen by their power and by a light tree."""

import json
import random
import tempfile
from pathlib import Path

from . import process


def write_scene(path, lamps):
    """Balls on a floor, under small lamps of different power, which together are as strong in every
    scene. The camera is below the lamps and looks down, so that all light is that of surfaces."""
    numbers = random.Random(lamps)
    objects = [
        {
            "primitive": {
                "class": "Parallelogram",
                "constructor": [[-100, 0, -100], [0, 0, 200], [200, 0, 0]],
            },
            "material": "clay",
        }
    ]
    for x in range(-4, 5):
        for z in range(-4, 5):
            objects.append(
                {
                    "primitive": {
                        "class": "Sphere",
                        "center": [4 * x + numbers.uniform(-1, 1), 0.8, 4 * z],
                        "radius": 0.8,
                    },
                    "material": "clay",
                }
            )
    for _ in range(lamps):
        objects.append(
            {
                "primitive": {
                    "class": "Sphere",
                    "center": [numbers.uniform(-20, 20), 2.5, numbers.uniform(-20, 20)],
                    "radius": 0.1,
                },
                "material": {
                    "class": "Emitter",
                    "radiance": 20000 / lamps * 10 ** numbers.uniform(-1, 0),
                },
            }
        )
    path.write_text(
        json.dumps(
            {
                "rtsl": 1,
                "import": ["std.cameras", "std.primitives", "std.materials"],
                "camera": {
                    "class": "PerspectiveCamera",
                    "constructor": {"eye": [0, 2.2, 0], "target": [0, 0, 0], "up": [0, 0, -1]},
                    "fieldOfView": 120,
                },
                "materials": {"clay": {"class": "Lambert", "reflectance": 0.6}},
                "objects": objects,
                "render": {"engine": "path", "depth": 1},
            }
        )
    )


def measure(build, counts, spp, size):
    rtslc = str(build / "bin" / "rtslc")
    seeds = (1, 2, 3, 4)
    results = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)

        def render(sampler, seed):
            run = process.run(
                [
                    *(rtslc, "render", str(folder / "scene.json"), "--json", "-q"),
                    *("-o", str(folder / f"{seed}.exr"), "--size", size, "--spp", str(spp)),
                    *("--seed", str(seed), "--set", f"render.lightSampler={sampler}"),
                ]
            )
            return json.loads(run.output)["seconds"]["render"]

        for count in counts:
            write_scene(folder / "scene.json", count)
            results[count] = {}
            for sampler in ("power", "tree"):
                seconds = min(render(sampler, seed) for seed in seeds)
                squares = mean = 0
                for first, second in zip(seeds[::2], seeds[1::2]):
                    compared = json.loads(
                        process.run(
                            [
                                *(rtslc, "compare", str(folder / f"{first}.exr")),
                                *(str(folder / f"{second}.exr"), "--json", "--threshold", "1e30"),
                            ]
                        ).output
                    )
                    squares += compared["rmse"] ** 2 / len(seeds)
                    mean += sum(compared["means"][0]) / 3 / (len(seeds) / 2)
                results[count][sampler] = {"seconds": seconds, "error": squares**0.5 / mean}
    return {"size": size, "spp": spp, "results": results}


def show(report):
    print(
        f"pictures of {report['size']} pixels with {report['spp']} samples each; errors relative "
        "to the mean, from pictures of two seeds. The gain is in seconds times error squared: the "
        "time to the same error"
    )
    for count, of in report["results"].items():
        power, tree = of["power"], of["tree"]
        cost = {name: one["seconds"] * one["error"] ** 2 for name, one in of.items()}
        print(
            f"  {count:6} lamps   by power {power['seconds']:7.3f} s, error {power['error']:.4f}   "
            f"by tree {tree['seconds']:7.3f} s, error {tree['error']:.4f}   in the same time "
            f"{tree['error'] * (tree['seconds'] / power['seconds']) ** 0.5:.4f}   "
            f"gain {cost['power'] / cost['tree']:.2f}"
        )


def add(subcommands, common):
    parser = subcommands.add_parser(
        "lamps", parents=[common], help="error and seconds of light from many lamps"
    )
    parser.add_argument(
        "--lamps",
        type=int,
        nargs="+",
        default=[2, 4, 8, 16, 32, 100, 1000],
        help="their numbers (default: 2 4 8 16 32 100 1000)",
    )
    parser.add_argument("--spp", type=int, default=64, help="samples per pixel (default: 64)")
    parser.add_argument(
        "--size", metavar="WxH", default="160x120", help="of the pictures (default: 160x120)"
    )
    parser.set_defaults(parts=[part])


def part(options):
    """Name, measured report, and how to show it."""
    report = measure(options.build, options.lamps, options.spp, options.size)
    return "lamps", report, show
