"""What adaptive samples gain: samples and seconds for the same error, measured against a converged
picture."""

import json
import tempfile
from pathlib import Path

from . import process

ROOT = Path(__file__).resolve().parent.parent.parent
# The file of each scene, the wanted error, and the samples per pixel of the converged picture.
SCENES = {
    "cornell": ("examples/cornell/room.json", 0.1, 2000),
    "gltf": ("examples/gltf/scene.json", 0.3, 1000),
    "glass": ("examples/glass/scene.json", 0.03, 1000),
}


def render(build, folder, scene, name, options):
    return json.loads(
        process.run(
            [
                str(build / "bin" / "rtslc"),
                "render",
                str(ROOT / scene),
                "--json",
                "-q",
                "-Wno-depth-limit",
                "-o",
                str(folder / name),
                *options,
            ]
        ).output
    )


def difference(build, folder, name):
    """The root mean square error."""
    return json.loads(
        process.run(
            [
                str(build / "bin" / "rtslc"),
                "compare",
                str(folder / name),
                str(folder / "converged.exr"),
                "--json",
                "--threshold",
                "1e30",
            ]
        ).output
    )["rmse"]


def measure(build, seeds, size):
    results = {}
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for scene, (file, noise, converged) in SCENES.items():
            render(
                build,
                folder,
                file,
                "converged.exr",
                ["--size", size, "--spp", str(converged), "--seed", "1000"],
            )
            results[scene] = {"noise": noise}
            for way, options in (("even", []), ("adaptive", ["--adaptive"])):
                samples = seconds = squares = 0
                for seed in range(seeds):
                    run = render(
                        build,
                        folder,
                        file,
                        "picture.exr",
                        ["--size", size, "--noise", str(noise), "--seed", str(seed), *options],
                    )
                    samples += run["samples"] / seeds
                    seconds += run["seconds"]["render"] / seeds
                    squares += difference(build, folder, "picture.exr") ** 2 / seeds
                results[scene][way] = {
                    "samples": samples,
                    "seconds": seconds,
                    "rmse": squares**0.5,
                }
    return {"seeds": seeds, "size": size, "results": results}


def show(report):
    width, height = map(int, report["size"].split("x"))
    print(
        f"pictures of {report['size']} pixels; means of {report['seeds']} seeds. "
        "The gain is at equal error: of samples times error "
        "squared, and of seconds times error squared"
    )
    for scene, of in report["results"].items():
        even, adaptive = of["even"], of["adaptive"]
        gain = {
            of_what: even[of_what] * even["rmse"] ** 2 / (adaptive[of_what] * adaptive["rmse"] ** 2)
            for of_what in ("samples", "seconds")
        }
        for way in ("even", "adaptive"):
            print(
                f"  {scene:10}{way:10}{of[way]['samples'] / (width * height):9.1f} spp "
                f"{of[way]['seconds']:8.2f} s   error {of[way]['rmse']:.5f}"
            )
        print(f"  {'':10}gain      {gain['samples']:9.2f}     {gain['seconds']:8.2f}")


def add(subcommands, common):
    parser = subcommands.add_parser(
        "adaptive", parents=[common], help="samples and seconds for the same error"
    )
    parser.add_argument("--seeds", type=int, default=3, help="pictures of each scene (default: 3)")
    parser.add_argument(
        "--size", metavar="WxH", default="64x48", help="of the pictures (default: 64x48)"
    )
    parser.set_defaults(parts=[part])


def part(options):
    """Name, measured report, and how to show it."""
    return "adaptive", measure(options.build, max(1, options.seeds), options.size), show
