"""What motion costs: rays per second through instances at rest, and through the same in motion."""

import json
import random
import tempfile
from pathlib import Path

from . import process
from .options import add_benchmark, add_count, add_size
from .meshes import write_torus
from .statistics import summarise

INSTANCES = 400
AXES = ([1, 0, 0], [0, 1, 0], [0, 0, 1])
SHADERS = """
class Look : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0, 0.0, 14.0);
    rt_RayDirection = vec3(12.0 * (rt_ScreenCoord - 0.5), -14.0);
  }
};
class Paint : rt_Material {
  void shade() { rt_SampleColor = color(abs(rt_GeometricNormal.z)); }
};
"""
TURN = ({"rotate": [0, 0, 0]}, {"rotate": [0, 20, 0], "translate": [0.1, 0.05, 0]})
# By name: the first key and the last one, beside the place and, unless it is rigid, the size of an
# instance.
TRANSFORMS = {
    "transforms at rest": None,
    "translations": ({}, {"translate": [0.1, 0.05, 0]}),
    "translations and rotations": TURN,
    "matrices": (
        {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]},
        {"matrix": [1, 0.1, 0, 0, -0.1, 1, 0, 0, 0, 0, 1, 0, 0.1, 0.05, 0, 1]},
    ),
    "rigid, at rest": None,
    "rigid, translations and rotations": TURN,
}
MESHES = {
    "a mesh in world space": "torus.obj",
    "a mesh with two keys": {"keys": ["torus.obj", "moved.obj"]},
}


def scene_of(nodes, root, objects=()):
    return {
        "rtsl": 1,
        "import": ["motion.rtsl"],
        "camera": {"class": "Look"},
        "materials": {"paint": {"class": "Paint"}},
        "background": 0.5,
        "objects": list(objects),
        **({"nodes": nodes, "root": root} if nodes else {}),
        "render": {"engine": "classic", "depth": 1, "seed": 1},
    }


def write_scenes(folder):
    """The file of each scene, by name."""
    (folder / "motion.rtsl").write_text(SHADERS)
    write_torus(folder / "small.obj", [0, 0, 0], AXES, 0.5, 0.2)
    write_torus(folder / "torus.obj", [0, 0, 0], AXES, 4, 1.5)
    write_torus(folder / "moved.obj", [0.1, 0.05, 0], AXES, 4, 1.5)
    scenes = {}
    for name, keys in TRANSFORMS.items():
        dice = random.Random(7)
        children = []
        for _ in range(INSTANCES):
            place = [
                {"scale": dice.uniform(0.5, 1.2)},
                {"rotate": [dice.uniform(0, 360) for _ in range(3)]},
                {"translate": [dice.uniform(-6, 6), dice.uniform(-6, 6), dice.uniform(-6, 2)]},
            ]
            if name.startswith("rigid"):
                del place[0]
            children.append(
                {"child": "torus", "transform": [{"keys": list(keys)}, *place] if keys else place}
            )
        scenes[name] = scene_of(
            {"torus": {"mesh": "small.obj", "material": "paint"}, "all": {"children": children}},
            "all",
        )
    for name, mesh in MESHES.items():
        scenes[name] = scene_of(None, None, [{"mesh": mesh, "material": "paint"}])
    files = {}
    for number, (name, scene) in enumerate(scenes.items()):
        files[name] = folder / f"scene{number}.json"
        files[name].write_text(json.dumps(scene))
    return files


def measure(build, rounds, spp, size):
    results = {}
    width, height = map(int, size.split("x"))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = write_scenes(folder)
        for _ in range(rounds):
            for scene, file in files.items():
                run = json.loads(
                    process.run(
                        [
                            str(build / "bin" / "rtslc"),
                            "render",
                            str(file),
                            "--json",
                            "-q",
                            "--threads",
                            "1",
                            "--size",
                            size,
                            "--spp",
                            str(spp),
                            "-o",
                            str(folder / "picture.exr"),
                        ]
                    ).output
                )
                results.setdefault(scene, []).append(
                    width * height * spp / run["seconds"]["render"] * 1e-6
                )
    return {
        "rounds": rounds,
        "size": size,
        "spp": spp,
        "instances": INSTANCES,
        "results": {scene: summarise(rates).as_json() for scene, rates in results.items()},
    }


def show(report):
    print(
        f"millions of camera rays per second on one core: {report['instances']} instances of a "
        "mesh of 686 triangles, and one such "
        f"mesh; medians of {report['rounds']} rounds"
    )
    rigid = [name for name in TRANSFORMS if name.startswith("rigid")]
    for names in ([name for name in TRANSFORMS if name not in rigid], rigid, list(MESHES)):
        rest = report["results"][names[0]]["median"]
        for scene in names:
            rates = report["results"][scene]
            low, high = rates["interval"]
            print(
                f"  {scene:34}{rates['median']:8.2f}  "
                f"{f'{low:.2f} to {high:.2f}':16}{rates['median'] / rest:6.2f} of that at rest"
            )


def add(subcommands, common):
    summary = "rays per second through what moves and what rests"
    parser = add_benchmark(subcommands, common, "motion", summary, part)
    add_count(parser, "--rounds", 7, "rounds of each scene")
    add_count(parser, "--spp", 16, "samples a pixel")
    add_size(parser, "320x320")


def part(options):
    """Name, measured report, and how to show it."""
    return (
        "motion",
        measure(options.build, options.rounds, options.spp, options.size),
        show,
    )
