"""The Cornell box by the engine `path` and by Blender's Cycles: the error that each leaves after
equal processor time, against a converged picture of its own and against that of the other."""

import json
import shutil
import tempfile
from pathlib import Path

from . import process
from .options import add_benchmark, add_count, add_size
from .paths import CORNELL, numbers
from .render import ROOT

SCRIPT = ROOT / "bench" / "cycles" / "render.py"
PROBE = 16  # samples a pixel of the rendering that tells the time of a sample
SEED_OF_REFERENCE = 1000


class Rtslc:
    """The engine `path` with a sampler."""

    def __init__(self, build, sampler):
        self.name = f"rtslc, {sampler}"
        self.command = [str(build / "bin" / "rtslc"), "render", str(CORNELL), "--json", "-q"]
        self.command += ["--sampler", sampler]

    def render(self, picture, options, spp, seed):
        command = [*self.command, "--size", options.size, "--spp", str(spp), "--seed", str(seed)]
        run = process.run([*command, "--threads", str(options.threads), "-o", str(picture)])
        return json.loads(run.output)["processorSeconds"]


class Cycles:
    """Cycles with its own sampler, and the same scene."""

    name = "Cycles"

    def __init__(self, folder):
        self.program = shutil.which("blender")
        if not self.program:
            raise process.Failed("blender is not installed (Debian's package `blender`)")
        self.folder = folder
        scene = json.loads(CORNELL.read_text())
        materials, camera = scene["materials"], scene["camera"]
        self.scene = {
            "camera": {**camera["constructor"], "fieldOfView": camera["fieldOfView"]},
            # As many rays follow the camera's, each from a scattering.
            "scatterings": scene["render"]["depth"],
            "parallelograms": [
                {
                    "corners": one["primitive"]["constructor"],
                    "reflectance": numbers(materials[one["material"]].get("reflectance", 0)),
                    "radiance": numbers(materials[one["material"]].get("radiance", 0)),
                }
                for one in scene["objects"]
            ],
        }

    def render(self, picture, options, spp, seed):
        report = self.folder / "report.json"
        settings = self.folder / "settings.json"
        how = {
            "size": list(map(int, options.size.split("x"))),
            "samples": spp,
            "seed": seed,
            "threads": options.threads,
            "picture": str(picture),
            "report": str(report),
        }
        settings.write_text(json.dumps({**self.scene, **how}))
        report.unlink(missing_ok=True)
        command = [self.program, "-b", "--factory-startup", "-P", str(SCRIPT), "--", str(settings)]
        process.run(command)
        if not report.exists():  # Blender succeeds if its script fails
            raise process.Failed("blender has not rendered")
        return json.loads(report.read_text())["processorSeconds"]


def difference(options, picture, reference):
    rtslc = str(options.build / "bin" / "rtslc")
    command = [rtslc, "compare", str(picture), str(reference), "--json", "--threshold", "1e30"]
    return json.loads(process.run(command).output)


def samples_for(renderer, folder, options, seconds):
    """Samples a pixel that a program renders in a time: two renderings tell what one takes."""
    picture = folder / "probe.exr"
    few = renderer.render(picture, options, PROBE, 1)
    many = renderer.render(picture, options, 5 * PROBE, 1)
    start, each = (5 * few - many) / 4, max((many - few) / (4 * PROBE), 1e-6)
    return [max(1, round((time - max(start, 0)) / each)) for time in seconds]


def measure(options):
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        cycles = Cycles(folder)
        renderers = [Rtslc(options.build, s) for s in ("independent", "sobol")] + [cycles]
        times = [*options.seconds, options.reference]
        counts = {one.name: samples_for(one, folder, options, times) for one in renderers}
        references = {}
        for one in (renderers[1], cycles):
            references[one] = folder / f"{len(references)}.exr"
            one.render(references[one], options, counts[one.name][-1], SEED_OF_REFERENCE)
        ours, theirs = references
        rows = []
        for index, seconds in enumerate(options.seconds):
            for one in renderers:
                spp = counts[one.name][index]
                picture = folder / "picture.exr"
                took = one.render(picture, options, spp, 1)
                own = theirs if one is cycles else ours
                other = ours if one is cycles else theirs
                row = {"seconds": seconds, "program": one.name, "spp": spp, "took": took}
                row["own"] = difference(options, picture, references[own])
                row["other"] = difference(options, picture, references[other])
                rows.append(row)
        return {
            "size": options.size,
            "threads": options.threads,
            "referenceSamples": {one.name: counts[one.name][-1] for one in references},
            "references": difference(options, references[ours], references[theirs]),
            "rows": rows,
        }


def show(report):
    print(
        f"the Cornell box, {report['size']}, processor seconds of rendering on "
        f"{report['threads']} thread(s); relative mean square errors"
    )
    print()
    print("| | samples a pixel | took | against its own reference | against the other's |")
    print("|---|---|---|---|---|")
    for row in report["rows"]:
        print(
            f"| {row['seconds']:g} s, {row['program']} | {row['spp']} | {row['took']:.1f} s | "
            f"{row['own']['relMse']:.2e} | {row['other']['relMse']:.2e} |"
        )
    means = " and ".join(
        ", ".join(f"{x:.4f}" for x in mean) for mean in report["references"]["means"]
    )
    samples = ", ".join(f"{name}: {n}" for name, n in report["referenceSamples"].items())
    print()
    print(
        f"The references ({samples} samples a pixel) differ by "
        f"{report['references']['relMse']:.2e}; their means are {means}."
    )


def add(subcommands, common):
    summary = "the Cornell box beside Blender's Cycles, in equal time"
    parser = add_benchmark(subcommands, common, "cycles", summary, part)
    parser.add_argument(
        "--seconds",
        type=float,
        nargs="+",
        default=[10.0, 30.0],
        metavar="S",
        help="processor seconds of each program (default: 10 30)",
    )
    parser.add_argument(
        "--reference",
        type=float,
        default=300.0,
        metavar="S",
        help="processor seconds of the converged pictures (default: 300)",
    )
    add_count(parser, "--threads", 1, "threads of each program")
    add_size(parser, "160x160")


def part(options):
    """Name, measured report, and how to show it."""
    return ("cycles", measure(options), show)
