"""Rendering examples/glass: rtslc beside the program that was written by hand, in turns."""

import json
import tempfile
from pathlib import Path

from . import process
from .options import add_benchmark, add_count
from .statistics import summarise

ROOT = Path(__file__).resolve().parent.parent.parent
SCENE = ROOT / "examples" / "glass" / "scene.json"
MESH = ROOT / "examples" / "glass" / "knot.obj"
VARIANTS = {
    "v3": "bench-handwritten",
    "native": "bench-handwritten-native",
    "fast": "bench-handwritten-fast",
}

# Both pictures come from the same random numbers, but not from the same roundings: where a ray
# passes an edge, a sample may fall on its other side. Pictures that are further apart than this do
# not show the same thing.
LARGEST_MEAN_DIFFERENCE = 1e-3  # of a channel's mean, relative
LARGEST_ROOT_MEAN_SQUARE = 1e-2


class Program:
    """One of the programs that are compared, with what its runs took."""

    def __init__(self, name, arguments, picture):
        self.name = name
        self.arguments = arguments + ["-o", str(picture)]
        self.picture = picture
        self.rates = []  # samples a second of the render phase alone
        self.runs = []
        self.flags = None

    def run(self):
        run = process.run(self.arguments)
        try:
            report = json.loads(run.output)
            self.rates.append(report["samples"] / report["seconds"]["render"])
        except (ValueError, KeyError, ZeroDivisionError) as error:
            raise process.Failed(f"{self.name} does not print its times: {error!r}") from error
        self.flags = report.get("flags")
        self.runs.append(run)

    def forget(self):
        self.rates.clear()
        self.runs.clear()

    def as_json(self):
        return {
            "program": self.name,
            "flags": self.flags,
            "samplesPerSecond": summarise(self.rates).as_json(),
            "wall": summarise([run.wall for run in self.runs]).as_json(),
            "processor": summarise([run.user + run.system for run in self.runs]).as_json(),
            "memory": max(run.memory for run in self.runs),
        }


def compare(build, ours, theirs):
    """How far the last pictures of both are apart, and whether they show the same."""
    largest_of_all = ["--threshold", "1e30"]  # the verdict is ours
    difference = json.loads(
        process.run(
            [
                str(build / "bin" / "rtslc"),
                "compare",
                str(ours.picture),
                str(theirs.picture),
                "--json",
            ]
            + largest_of_all
        ).output
    )
    means = [abs(a - b) / max(abs(b), 1e-6) for a, b in zip(*difference["means"])]
    difference["largestMeanDifference"] = max(means)
    difference["agree"] = (
        max(means) <= LARGEST_MEAN_DIFFERENCE and difference["rmse"] <= LARGEST_ROOT_MEAN_SQUARE
    )
    return difference


def measure(build, pairs, variants, render_options, rtslc_options):
    binaries = build / "bin"
    with tempfile.TemporaryDirectory() as folder:
        ours = Program(
            "rtslc",
            [str(binaries / "rtslc"), "render", str(SCENE), "--json", "-q"]
            + render_options
            + rtslc_options,
            Path(folder) / "rtslc.exr",
        )
        others = [
            Program(
                VARIANTS[name],
                [str(binaries / VARIANTS[name]), str(MESH)] + render_options,
                Path(folder) / f"{name}.exr",
            )
            for name in variants
        ]
        programs = [ours] + others
        for program in programs:  # once, to warm the caches
            program.run()
            program.forget()
        for round_ in range(pairs):
            # Each round begins with another program, so that none always profits from what ran
            # before it.
            first = round_ % len(programs)
            for program in programs[first:] + programs[:first]:
                program.run()
        return {
            "scene": str(SCENE.relative_to(ROOT)),
            "options": render_options,
            "rtslcOptions": rtslc_options,
            "programs": [program.as_json() for program in programs],
            "ratios": [
                {
                    "against": other.name,
                    "samplesPerSecond": summarise(
                        [a / b for a, b in zip(ours.rates, other.rates)]
                    ).as_json(),
                    "wholeProcess": summarise(
                        [b.wall / a.wall for a, b in zip(ours.runs, other.runs)]
                    ).as_json(),
                    "pictures": compare(build, ours, other),
                }
                for other in others
            ],
        }


def show(report):
    options = " ".join(report["options"] + report["rtslcOptions"])
    print(f"{report['scene']}{' ' + options if options else ''}")
    print(f"{'':28}{'million samples/s':>24}{'whole process, s':>24}{'memory':>10}")
    print(f"{'':28}{'median':>8}{'min':>8}{'max':>8}{'median':>8}{'min':>8}{'max':>8}")
    for program in report["programs"]:
        rate, wall = program["samplesPerSecond"], program["wall"]
        print(
            f"{program['program']:28}"
            + "".join(f"{rate[key] * 1e-6:8.3f}" for key in ("median", "min", "max"))
            + "".join(f"{wall[key]:8.3f}" for key in ("median", "min", "max"))
            + f"{program['memory'] / 2**20:7.1f} MB"
        )
    for program in report["programs"]:
        if program["flags"]:
            print(f"  {program['program']}: {program['flags']}")
    print("rtslc's speed over that of the other, round by round")
    print(f"{'':42}{'median':>8}{'min':>8}{'max':>8}   interval of the median")
    for ratio in report["ratios"]:
        for name, key in (("", "samplesPerSecond"), (", whole process", "wholeProcess")):
            value = ratio[key]
            low, high = value["interval"]
            print(
                f"{ratio['against'] + name:42}"
                + "".join(f"{value[key]:8.3f}" for key in ("median", "min", "max"))
                + f"   {low:.3f} to {high:.3f} ({value['confidence']:.1%})"
            )
    for ratio in report["ratios"]:
        pictures = ratio["pictures"]
        print(
            f"{ratio['against']}: the pictures "
            f"{'agree' if pictures['agree'] else 'DIFFER: the ratio means nothing'}"
            f" (means within {pictures['largestMeanDifference']:.1e}, root mean square "
            f"{pictures['rmse']:.1e},"
            f" largest {pictures['largest']:.2g})"
        )


def add(subcommands, common):
    summary = "rtslc render beside the hand-written program"
    parser = add_benchmark(subcommands, common, "render", summary, part)
    add_count(parser, "--pairs", 10, "rounds in which every program runs once")
    parser.add_argument(
        "--against",
        nargs="+",
        choices=VARIANTS,
        default=list(VARIANTS),
        help="builds of the hand-written program (default: all)",
    )
    parser.add_argument(
        "--spp", help="samples a pixel, for all programs (default: 16, as in the scene)"
    )
    parser.add_argument("--size", metavar="WxH", help="for all programs (default: 960x540)")
    parser.add_argument("--threads", help="for all programs (default: all cores)")
    parser.add_argument(
        "--rtslc-option",
        action="append",
        default=[],
        metavar="OPTION",
        help="for rtslc alone, such as --rtslc-option=--traversal=device; may be repeated",
    )


def part(options):
    """Name, measured report, and how to show it."""
    render_options = []
    for name in ("spp", "size", "threads"):
        if getattr(options, name, None):
            render_options += [f"--{name}", getattr(options, name)]
    return (
        "render",
        measure(
            options.build,
            getattr(options, "pairs", 10),
            getattr(options, "against", list(VARIANTS)),
            render_options,
            getattr(options, "rtslc_option", []),
        ),
        show,
    )
