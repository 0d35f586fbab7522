"""How the time of the compiler grows with the program, in each direction in which programs grow."""

import tempfile
from math import hypot, log, sqrt
from pathlib import Path

from . import growing, process
from .options import add_benchmark, add_count

LIMIT = 1.2  # of exponents
SPREAD = 0.03  # of a time from run to run, relatively
RESOLUTION = 0.005  # of a time, in seconds

# What grows, and to what sizes. The largest takes some seconds at most, the smallest several times
# what a program of size 1 takes where that is possible.
SERIES = {
    "classes": (growing.classes, (100, 300, 1000)),
    "traces in an if": (growing.traces, (30, 100, 300)),
    "cases of a switch": (growing.cases, (500, 1500, 5000)),
    "functions in a chain": (growing.chain, (500, 1500, 5000)),
    "statements": (growing.statements, (500, 1500, 5000)),
    "branches": (growing.branches, (300, 1000, 3000)),
    "loops": (growing.loops, (100, 300, 1000)),
    "nested branches": (growing.nesting, (50, 100, 200)),
    "overloads": (growing.overloads, (100, 300, 1000)),
    "elements of an array": (growing.array, (3000, 10000, 30000)),
    "members": (growing.members, (100, 300, 1000)),
    "imports": (growing.imports, (100, 300, 1000)),
    "texture classes": (growing.textures, (100, 300, 1000)),
    "light classes": (growing.lights, (100, 300, 1000)),
    "derived classes": (growing.derived, (100, 300, 1000)),
    "objects": (growing.objects, (1000, 3000, 10000)),
    "materials of one class": (growing.references, (1000, 3000, 10000)),
    "lights of one class": (growing.bulbs, (1000, 3000, 10000)),
}

# What is done with them: arguments for a file of classes, or for a scene.
JOBS = {
    "check": lambda rtslc, source, scene, out: source and [rtslc, "check", source],
    "cpp": lambda rtslc, source, scene, out: source
    and [rtslc, "compile", source, "--emit=cpp", "-o", out / "x.cpp"],
    "ptx": lambda rtslc, source, scene, out: source
    and [rtslc, "compile", source, "--emit=ptx", "-o", out / "x.ptx"],
    "render": lambda rtslc, source, scene, out: [rtslc, "render", scene, "-q", "-o", out / "x.exr"],
}


def processor_time(arguments, runs):
    """The least of some runs, in seconds of processor time over all threads; and of time by the
    clock."""
    done = [process.run([str(one) for one in arguments], keep_output=False) for _ in range(runs)]
    return min(run.user + run.system for run in done), min(run.wall for run in done)


def fit(points, constant):
    """The exponent of the power of the size with which the time beyond `constant` grows, and its
    standard error: the slope of a line through the logarithms, by least squares. Points count by
    how well the growth is known, which is badly where it is a small part of a time. None where the
    largest program takes hardly more than the smallest possible one."""

    def spread(time):
        return hypot(SPREAD * time, RESOLUTION)

    grown = [
        (
            log(size),
            log(time - constant),
            ((time - constant) / hypot(spread(time), spread(constant))) ** 2,
        )
        for size, time in points
        if time > 1.1 * constant
    ]
    if len(grown) < 2 or points[-1][1] < 1.5 * constant:
        return None
    total = sum(weight for _, _, weight in grown)
    x_mean = sum(weight * x for x, _, weight in grown) / total
    y_mean = sum(weight * y for _, y, weight in grown) / total
    across = sum(weight * (x - x_mean) ** 2 for x, _, weight in grown)
    slope = sum(weight * (x - x_mean) * (y - y_mean) for x, y, weight in grown) / across
    return {"exponent": slope, "error": 1 / sqrt(across)}


def measure_one(rtslc, make, sizes, job, runs):
    times = []
    for size in (1, *sizes):
        with tempfile.TemporaryDirectory() as folder:
            source, scene = make(Path(folder), size)
            arguments = JOBS[job](rtslc, source, scene, Path(folder))
            if not arguments:
                return None
            times.append((size, *processor_time(arguments, runs)))
    constant = times[0][1]
    points = [(size, processor) for size, processor, _ in times[1:]]
    return {
        "constant": constant,
        "sizes": list(sizes),
        "processor": [time for _, time in points],
        "wall": [wall for _, _, wall in times[1:]],
        "growth": fit(points, constant),
    }


def measure(build, names, jobs, runs):
    rtslc = build / "bin" / "rtslc"
    series = {}
    for name in names:
        make, sizes = SERIES[name]
        measured = {job: measure_one(rtslc, make, sizes, job, runs) for job in jobs}
        series[name] = {job: one for job, one in measured.items() if one}
    return {
        "limit": LIMIT,
        "spread": SPREAD,
        "resolution": RESOLUTION,
        "runs": runs,
        "series": series,
    }


def show(report):
    print(
        "processor time in seconds, beside that of a program of size 1, and the exponent of the "
        "size with which it grows"
    )
    print(f"{'':24}{'':8}{'sizes':>20}{'of size 1':>11}{'seconds':>26}{'exponent':>14}")
    for name, jobs in report["series"].items():
        for job, one in jobs.items():
            sizes = " ".join(str(size) for size in one["sizes"])
            times = " ".join(f"{time:.2f}" for time in one["processor"])
            growth = one["growth"]
            exponent = f"{growth['exponent']:.2f} +- {growth['error']:.2f}" if growth else ""
            mark = (
                " above the limit"
                if growth and growth["exponent"] - growth["error"] > report["limit"]
                else ""
            )
            print(
                f"{name:24}{job:8}{sizes:>20}{one['constant']:>11.2f}"
                f"{times:>26}{exponent:>14}{mark}"
            )
    print(
        f"the limit of exponents is {report['limit']}; none is given where time hardly grows; +-: "
        "one standard error, if times "
        f"vary by {report['spread']:.0%} and {report['resolution'] * 1000:.0f} ms"
    )


def add(subcommands, common):
    summary = "how the compiler's time grows with the program"
    parser = add_benchmark(subcommands, common, "scaling", summary, part)
    add_count(parser, "--runs", 2, "runs of each command, of which the fastest counts")
    parser.add_argument(
        "--series", action="append", choices=list(SERIES), help="only this; may be repeated"
    )
    parser.add_argument(
        "--job", action="append", choices=list(JOBS), help="only this; may be repeated"
    )


def part(options):
    """Name, measured report, and how to show it."""
    return (
        "scaling",
        measure(
            options.build,
            options.series or list(SERIES),
            options.job or list(JOBS),
            options.runs,
        ),
        show,
    )
