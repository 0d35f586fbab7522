#!/usr/bin/env python3
"""scenes.py RTSLC SOURCE LIBRARY-FOLDER CPP-RENDER: scenes whose shaders were printed as C++ give
the pictures, the printed lines and the counted exceptions of the compiler's own machine code, to
the last bit."""
import json
import os
import pathlib
import shutil
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parent.parent))
from objects import objects_scene
from programs import compiled_with, linked_with, precompiled_header, run, same_picture

rtslc, source, library, render = sys.argv[1:]
here = pathlib.Path(__file__).parent
glass = pathlib.Path(source, "examples/glass")
COMPILED = ["-fPIC", *compiled_with(source)]
FLAGS = ["-shared", *COMPILED, *linked_with(library)]


def sphere(center, radius, material):
    return {
        "primitive": {"class": "Sphere", "center": center, "radius": radius},
        "material": material,
    }


def file_of(imported, folder):
    """The file that a scene in the folder imports: by its path, or by the name of a module."""
    if imported.endswith(".rtsl"):
        return (folder / imported).resolve()
    return pathlib.Path(source, "library", *imported.split(".")).with_suffix(".rtsl")


def with_paths(value, folder):
    """The JSON with absolute paths of the folder's files."""
    if isinstance(value, dict):
        return {key: with_paths(member, folder) for key, member in value.items()}
    if isinstance(value, list):
        return [with_paths(element, folder) for element in value]
    is_file = isinstance(value, str) and value and (folder / value).is_file()
    return str(folder / value) if is_file else value


def example(name, file="scene.json", spp=4):
    folder = pathlib.Path(source, "examples", name)
    scene = json.loads((folder / file).read_text())
    imported = [str(file_of(name, folder)) for name in scene["import"]]
    scene["render"].update(size=[64, 36], spp=spp)
    return {**with_paths(scene, folder), "import": imported}


def classes_in(value):
    """The names of classes that the JSON mentions."""
    if isinstance(value, dict):
        here = {value["class"]} if "class" in value else set()
        return here.union(*map(classes_in, value.values()))
    return set().union(*map(classes_in, value)) if isinstance(value, list) else set()


def library_example(name, file, classes=(), **changes):
    """An example whose classes are those of the library: the modules of the classes, of which
    `classes` are those that the scene does not name. `changes` are of its keys."""
    folder = pathlib.Path(source, "examples", name)
    scene = json.loads((folder / file).read_text())
    scene.get("render", {}).update(size=[40, 28], spp=2)
    scene.update(changes)
    own = [str(folder / name) for name in scene["import"] if name.endswith(".rtsl")]
    used = classes_in(scene).union(classes)
    library = sorted(pathlib.Path(source, "library/std").glob("*/*.rtsl"))
    modules = [str(file) for file in library if file.stem in used]
    return {**with_paths(scene, folder), "import": own + modules}


def photons():
    """Three passes, of fewer photons."""
    file = pathlib.Path(source, "examples/photons/photons.json")
    scene = json.loads(file.read_text())
    first, second, third = scene["passes"]
    photons, cells = {"size": [3 * 20000]}, 64
    second["rayGeneration"]["cells"] = cells
    third["rayGeneration"].update(cells=cells, nearest=8)
    return library_example(
        "photons",
        "photons.json",
        buffers={
            "first": {"size": [cells * cells]},
            **dict.fromkeys(("places", "channels", "next"), photons),
        },
        render={**scene["render"], "size": [40, 28]},  # without samples: each photon is sorted once
        passes=[{**first, "size": [20000]}, second, {**third, "size": [40, 28], "spp": 2}],
    )


def answers(engine):
    scene = {
        "rtsl": 1,
        "import": [
            str(here / "Answers.rtsl"),
            str(glass / "Sphere.rtsl"),
            str(glass / "PinholeCamera.rtsl"),
        ],
        "materials": {"sieve": {"class": "Sieve"}, "solid": {"class": "Solid", "scale": 3}},
        "objects": [
            sphere([0, 0, 0], 1, "sieve"),
            sphere([0.9, 0.4, -1], 0.8, "solid"),
            sphere([0.5, -0.7, 0.6], 0.6, "sieve"),
            sphere([-1, 0.5, 0.2], 0.5, "solid"),
        ],
        "background": {"class": "Sky"},
        "render": {"engine": engine, "size": [48, 48], "spp": 4, "depth": 4},
    }
    if engine == "programs":
        scene["rayGeneration"] = {"class": "Eye"}
    else:
        scene["camera"] = {
            "class": "PinholeCamera",
            "constructor": [[0, 0, 4], [0, 1, 0], [0, 0, -1], [-0.5, -0.5], [0.5, 0.5], 1],
        }
    return scene


def events(answered):
    scene = {
        "rtsl": 1,
        "import": [str(here / "Events.rtsl"), str(glass / "Sphere.rtsl")],
        "rayGeneration": {"class": "Eye", "curve": [0.5, 0.25]},
        "objects": [sphere([0, 0, 0], 2, {"class": "Endless"})],
        "render": {"engine": "programs", "size": [4, 4], "spp": 2, "depth": 5},
    }
    if answered:
        scene["exception"] = {"class": "Code"}
    return scene


def late():
    """Indices out of range before, between and after rays that are exceptions themselves."""
    return {
        "rtsl": 1,
        "import": [str(here / "Events.rtsl"), str(glass / "Sphere.rtsl")],
        "rayGeneration": {"class": "Around"},
        "objects": [
            sphere([0, 0, 0], radius, {"class": "Late", "curve": [0.25, 0.75, 0.5, 1]})
            for radius in (1, 2, 3)
        ],
        "exception": {"class": "Code"},
        "render": {"engine": "programs", "size": [24, 24], "spp": 2, "depth": 3},
    }


def beyond():
    """Rays whose results go to elements out of range."""
    return {
        "rtsl": 1,
        "import": [str(here / "Events.rtsl"), str(glass / "Sphere.rtsl")],
        "rayGeneration": {"class": "Beyond", "row": {"size": [30]}, "grid": {"size": [3, 7]}},
        "objects": [sphere([0, 0, 0], 2, {"class": "Late", "curve": [0.25, 0.75, 0.5, 1]})],
        "exception": {"class": "Code"},
        "render": {"engine": "programs", "size": [8, 5], "spp": 2, "depth": 3},
    }


def chains(length, depth, branches=True):
    """Objects that call each other, in a chain of this length (Chains.rtsl)."""
    textures = {"t0": {"class": "Filter"}, "s0": {"class": "Scale"}}
    for i in range(1, length + 1):
        textures[f"t{i}"] = {
            "class": "Tint",
            "inner": f"t{i - 1}",
            "others": [f"t{max(i - 2, 0)}" if branches else "t0", "t0"],
            "rounds": 2 if branches else 1,
        }
        textures[f"s{i}"] = {
            "class": "Twice" if i % 3 == 2 else "Ask",
            "inner": f"s{i - 1}",
            "filter": f"t{min(i, 1)}",
        }
    return {
        "rtsl": 1,
        "import": [str(here / "Chains.rtsl"), str(glass / "Sphere.rtsl")],
        "camera": {"class": "Eye"},
        "textures": textures,
        "materials": {
            "mirror": {"class": "Mirror", "filter": f"t{length}"},
            "marked": {
                "class": "Marked",
                "scale": f"s{length}",
                "others": [f"s{length // 2}", "s0"],
            },
        },
        "objects": [
            sphere([0, 0, 4], 2, "mirror"),
            sphere([3, 2, 0], 1, "mirror"),
            sphere([-2, 1, 3], 1, "marked"),
            sphere([0, -3, 2], 1.5, "marked"),
        ],
        "background": {"class": "Sky", "filter": "t0"},
        "render": {"engine": "classic", "size": [16, 16], "spp": 2, "depth": depth},
    }


def nothing():
    """References to no object (Nothing.rtsl)."""
    return {
        "rtsl": 1,
        "import": [
            str(here / "Nothing.rtsl"),
            str(glass / "Sphere.rtsl"),
            str(glass / "PinholeCamera.rtsl"),
        ],
        "camera": {
            "class": "PinholeCamera",
            "constructor": [[0, 0, 6], [0, 1, 0], [0, 0, -1], [-0.5, -0.5], [0.5, 0.5], 1],
        },
        "textures": {
            "filter": {"class": "Filter"},
            "half": {"class": "Scale"},
            "twice": {"class": "Twice"},
        },
        "materials": {
            "mirror": {"class": "Mirror", "filter": "filter", "scales": ["half", "twice"]}
        },
        "objects": [sphere([0, 0, 0], 1.5, "mirror"), sphere([1, 1.5, -1], 1, "mirror")],
        "background": {"class": "Sky"},
        "render": {"engine": "classic", "size": [32, 32], "spp": 2, "depth": 3},
    }


def names():
    """Whose names C++ cannot have (Names.rtsl)."""
    return {
        "rtsl": 1,
        "import": [str(here / "Names.rtsl"), str(glass / "PinholeCamera.rtsl")],
        "camera": {
            "class": "PinholeCamera",
            "constructor": [[0, 0, 4], [0, 1, 0], [0, 0, -1], [-0.5, -0.5], [0.5, 0.5], 1],
        },
        "textures": {
            "t0": {"class": "glm_", "memory": 0.5},
            "t1": {"class": "FilterRef", "inner": "t0"},
            "s": {"class": "State", "double": 0.5, "NULL": 0.25},
        },
        "materials": {
            "a": {"class": "program", "filter": "t1", "slots": "s"},
            "b": {"class": "lookup", "frame": 0.75},
        },
        "objects": [
            {"primitive": {"class": "intersect", "center": [-0.6, 0, 0]}, "material": "a"},
            {"primitive": {"class": "intersect", "center": [0.6, 0.2, 0.3]}, "material": "b"},
        ],
        "background": {"class": "miss"},
        "render": {"engine": "classic", "size": [32, 32], "spp": 2, "depth": 3},
    }


def objects(layers):
    """Helpers, references that may be empty, definitions of bases, recursion through members
    (Objects.rtsl)."""
    return objects_scene(here / "Objects.rtsl", glass / "Sphere.rtsl", layers)


def paths():
    """The path tracer: materials that call their own methods, default classes, surfaces that shine
    as lights, one of which moves."""
    library = pathlib.Path(source, "library/std")
    return {
        "rtsl": 1,
        "import": [
            str(library / file)
            for file in (
                "engines/PathTracer.rtsl",
                "cameras/PerspectiveCamera.rtsl",
                "primitives/Parallelogram.rtsl",
                "primitives/Sphere.rtsl",
                "materials/Lambert.rtsl",
                "materials/Dielectric.rtsl",
                "materials/Gold.rtsl",
                "materials/Emitter.rtsl",
                "lights/PointLight.rtsl",
                "backgrounds/UniformSky.rtsl",
            )
        ],
        "camera": {
            "class": "PerspectiveCamera",
            "constructor": [[0, 1, 6], [0, 0.5, 0], [0, 1, 0]],
        },
        "rayGeneration": {"class": "PathTracer"},
        "objects": [
            {
                "primitive": {
                    "class": "Parallelogram",
                    "constructor": [[-4, -1, -4], [0, 0, 8], [8, 0, 0]],
                },
                "material": {"class": "Lambert"},
            },
            sphere([-1.2, 0, 0], 1, {"class": "Dielectric"}),
            sphere([1.2, 0, 0], 1, {"class": "Gold"}),
            sphere([0, 3, 1], 0.5, {"class": "Emitter", "radiance": 20}),
        ],
        "nodes": {
            "lamp": {
                "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 0.3},
                "material": {"class": "Emitter", "radiance": 30},
            },
            "both": {
                "children": [
                    {"child": "lamp", "transform": {"scale": [1, 2, 0.5], "translate": [3, 2, 1]}},
                    {
                        "child": "lamp",
                        "transform": {
                            "keys": [
                                {"translate": [-3, 2, 1]},
                                {
                                    "scale": [1, 1.5, 1],
                                    "rotate": [0, 0, 50],
                                    "translate": [-3, 1, 1],
                                },
                            ]
                        },
                    },
                ]
            },
        },
        "root": "both",
        "lights": [{"class": "PointLight", "position": [2, 4, 4], "intensity": 5}],
        "background": {"class": "UniformSky", "radiance": [0.2, 0.3, 0.4]},
        "render": {"engine": "programs", "size": [32, 24], "spp": 4, "depth": 8},
    }


def images():
    """Images with every filter and wrap, in sRGB and not, and a volume."""
    picture = str(pathlib.Path(source, "examples/cornell/picture.png"))
    kinds = [
        ("nearest", "repeat", "srgb"),
        ("bilinear", "mirror", "linear"),
        ("trilinear", "clamp", "srgb"),
        ("anisotropic", ["black", "repeat"], "linear"),
    ]
    return {
        "rtsl": 1,
        "import": [str(here / "Images.rtsl")],
        "images": {"alone": {"file": picture}},
        "rayGeneration": {
            "class": "Lookups",
            "alone": "alone",
            "volume": {"slices": [picture, picture, picture], "wrap": "mirror"},
            "images": [
                {"file": picture, "filter": filter, "wrap": wrap, "colorSpace": space}
                for filter, wrap, space in kinds
            ],
        },
        "render": {"engine": "programs", "size": [40, 30], "spp": 2},
    }


def footprints():
    """Images that are filtered by the footprints of rays, also in a mirror."""
    picture = {"file": str(pathlib.Path(source, "examples/cornell/picture.png"))}
    plane = lambda *vectors: {"class": "Parallelogram", "constructor": vectors}
    return {
        "rtsl": 1,
        "import": [
            str(here / "Footprints.rtsl"),
            str(glass / "Parallelogram.rtsl"),
        ],
        "camera": {"class": "Eye"},
        "textures": {"picture": {"class": "Pictured", "image": picture}},
        "objects": [
            {
                "primitive": plane([-50, 0, 10], [100, 0, 0], [0, 0, -100]),
                "material": {
                    "class": "Floor",
                    "texture": "picture",
                    "images": [picture, {**picture, "filter": "anisotropic"}],
                },
            },
            {
                "primitive": plane([-3, 0, -3], [6, 0, 0], [0, 3, 1]),
                "material": {"class": "Mirror"},
            },
        ],
        "nodes": {
            "painted": {
                "mesh": str(here / "painted.ply"),
                "attributes": {"flow": {"space": "vector"}},
                "material": {"class": "Painted", "image": picture},
            },
            "disk": {
                "primitive": {"class": "Disk", "radius": 1.5},
                "material": {"class": "Painted", "image": picture},
                "transform": {"translate": [2, 2, 0]},
            },
            "both": {"children": ["painted", "disk"]},
        },
        "root": {"child": "both", "transform": [{"scale": [2, 1, 1]}, {"rotate": [5, 20, 0]}]},
        "background": {"class": "Sky", "texture": "picture"},
        "render": {"engine": "classic", "size": [32, 24], "spp": 2, "depth": 3},
    }


def outputs():
    """Output buffers, written and read between rays."""
    return {
        "rtsl": 1,
        "import": [str(here / "Outputs.rtsl")],
        "rayGeneration": {
            "class": "Probe",
            "histogram": {"size": [6]},
            "most": {"size": [7]},
        },
        "materials": {"mirror": {"class": "Mirror"}},
        "objects": [
            {"primitive": {"class": "Ball"}, "material": "mirror"},
            {
                "primitive": {"class": "Ball", "radius": 0.4},
                "material": "mirror",
                "transform": {"translate": [1.2, 0.5, 1]},
            },
        ],
        "render": {"engine": "programs", "size": [8, 6], "spp": 2},
    }


def graph():
    """Objects of several primitives, selectors, ids, variables and attributes of meshes."""
    balls = [[0, 0, 0, 1], [1.2, 0, 0, 0.5], [-1.2, 0, 0, 0.5], [0, 1.2, 0, 0.5]]
    return {
        "rtsl": 1,
        "import": [str(here / "Graph.rtsl")],
        "camera": {"class": "Look"},
        "variables": {"tint": [0.3, 0.6, 0.8]},
        "nodes": {
            "many": {
                "primitive": {"class": "Balls", "balls": balls},
                "count": "balls",
                "material": {"class": "Paint"},
                "id": 5,
            },
            "one": {
                "primitive": {"class": "Balls", "balls": [[0, 0, 0, 1.3]]},
                "material": {"class": "Paint"},
            },
            "tile": {
                "mesh": str(here / "square.obj"),
                "material": {"class": "Worn"},
                "attributes": {
                    "wear": [0.5, 1, 0.25, 0.75],
                    "paint": [[1, 0, 0], [0, 1, 0], [0, 0, 1], 1],
                    "along": {"values": [[1, 0.5, 0.25]] * 4, "space": "vector"},
                    "marks": {"values": [[False, True]], "per": "face"},
                },
            },
            "lod": {"selector": {"class": "Near", "limit": 14.6}, "children": ["many", "one"]},
            "dice": {
                "selector": {"class": "Chance"},
                "children": ["many", "one", {"child": "one", "transform": {"scale": 0.5}}],
            },
            "world": {
                "children": [
                    "many",
                    {
                        "child": "lod",
                        "transform": {"translate": [-4, 0, -6]},
                        "variables": {"tint": [1, 0, 0]},
                    },
                    {
                        "child": "dice",
                        "transform": {
                            "scale": [0.5, 1.5, 1],
                            "rotate": [20, 30, 0],
                            "translate": [3, 0, 0],
                        },
                    },
                    {
                        "child": "tile",
                        "transform": {
                            "scale": [-2, 1, 1],
                            "rotate": [20, 30, 0],
                            "translate": [0, -2, 1],
                        },
                    },
                ]
            },
        },
        "root": "world",
        "render": {"size": [40, 30], "spp": 4, "depth": 3},
    }


def chance():
    """A selector that draws numbers, behind objects whose classes have virtual functions in C++."""
    scene = graph()
    del scene["variables"]  # so named objects come before selectors
    scene["materials"] = {
        "inner": {"class": "Bright", "tint": [0.3, 0.6, 0.8]},
        "outer": {"class": "Paint", "inner": "inner"},
    }
    scene["nodes"]["one"]["material"] = "outer"
    scene["nodes"]["world"]["children"] = [
        "dice",
        {"child": "dice", "transform": {"translate": [3, 1, -2]}},
    ]
    return scene


def spaces(transforms):
    """The functions between spaces, below transforms of all kinds or of one."""
    nodes = {
        "ball": {"primitive": {"class": "Ball"}, "material": {"class": "Spaces"}},
        "small": {"primitive": {"class": "Ball", "radius": 0.5}, "material": {"class": "Spaces"}},
        "either": {"selector": {"class": "Side"}, "children": ["ball", "small"]},
    }
    children = [{"child": "either", "transform": transform} for transform in transforms]
    return {
        "rtsl": 1,
        "import": [str(here / "Spaces.rtsl")],
        "camera": {"class": "Look"},
        "nodes": {**nodes, "world": {"children": ["small", *children]}},
        "root": "world",
        "render": {"size": [40, 30], "spp": 4},
    }


PLACES = [
    {"translate": [-2, 0.5, 0]},
    {"keys": [{"translate": [2, 1, 0]}, {"translate": [2.5, 2, -1]}]},
]
SPACES = [
    spaces(PLACES),
    spaces(  # rigid
        [
            *PLACES,
            {"rotate": [20, 30, 40], "translate": [0, 1.5, -1]},
            {"keys": [{"rotate": [0, 0, 0]}, {"rotate": [0, 90, 200]}]},
        ]
    ),
    spaces(
        [
            *PLACES,
            {"scale": [1.5, -0.5, 1], "rotate": [20, 30, 40], "translate": [0, 1.5, -1]},
            {"keys": [{"rotate": [0, 0, 0]}, {"rotate": [0, 90, 200]}]},
            {"matrix": [1, 0, 0, 0, 0.5, 1, 0, 0, 0, 0, 2, 0, 1, -1, 1, 1]},
        ]
    ),
]


# Scenes by the shaders that they share, and the options of both compilers. The bits are those of
# any level, and g++ takes four times as long as clang++.
CASES = [
    ("g++", ["-O2"], ["--undefined=nan"], [example("quadrics")]),
    ("clang++-22", ["-O2"], ["--undefined=nan"], [example("whitted-programs")]),
    ("clang++-22", ["-O1"], ["--undefined=bytes"], [example("metal")]),
    ("clang++-22", ["-O1"], [], [example("line-of-sight", "city.json", spp=1)]),
    ("clang++-22", ["-O1"], ["--exceptions"], [answers("programs"), answers("classic")]),
    ("clang++-22", ["-O1"], ["--print"], [events(False)]),
    ("g++", ["-O0"], ["--exceptions"], [events(False), events(True), late(), beyond()]),
    ("clang++-22", ["-O0"], ["--trace=recurse", "--exceptions"], [late(), beyond()]),
    ("g++", ["-O0"], ["--unchecked"], [answers("programs")]),
    (
        "clang++-22",
        ["-O1"],
        ["--undefined=nan"],
        [chains(0, 2), chains(3, 2), chains(12, 0, branches=False)],
    ),
    ("clang++-22", ["-O1"], ["--undefined=nan"], [objects(3), objects(9)]),
    ("g++", ["-O0"], [], [nothing()]),
    ("clang++-22", ["-O0"], ["--trace=recurse", "--undefined=bytes"], [paths()]),
    ("g++", ["-O0"], [], [images()]),
    ("clang++-22", ["-O1"], ["--undefined=nan"], [footprints()]),
    ("clang++-22", ["-O0"], ["--trace=recurse"], [footprints()]),
    (
        "clang++-22",
        ["-O0"],
        [],
        [
            library_example("whirligig", "whirligig.json", ["PathTracer"]),
            library_example("motion", "motion.json", ["PathTracer"]),
            library_example("inherit", "inherit.json", ["PathTracer"]),
        ],
    ),
    ("clang++-22", ["-O0"], [], [photons()]),
    ("g++", ["-O0"], ["--undefined=nan"], [outputs()]),
    ("clang++-22", ["-O0"], ["--trace=recurse", "--exceptions"], [outputs()]),
    ("g++", ["-O0"], ["--undefined=nan"], [graph(), chance()]),
    ("clang++-22", ["-O1"], ["--undefined=nan"], SPACES),
    ("clang++-22", ["-O0"], ["--trace=recurse"], SPACES),
    ("g++", ["-O0"], ["--trace=recurse"], [names()]),
    ("clang++-22", ["-O0"], ["--trace=split"], [names()]),
]
# Each takes seconds, and others are like them.
if "RTSL_DEEP" in os.environ:
    CASES += [
        ("clang++-22", ["-O1"], [], [library_example("bindless", "scene.json", ["sampler2D"])]),
        ("g++", ["-O1"], [], [photons()]),
        ("g++", ["-O1"], ["--print"], [events(False)]),
        ("g++", ["-O1"], ["--exceptions"], [events(False), events(True), late(), beyond()]),
        ("g++", ["-O1"], ["--undefined=nan"], [chains(0, 2), chains(12, 0, branches=False)]),
        ("g++", ["-O1"], ["--undefined=nan"], [objects(3), objects(9)]),
        ("g++", ["-O1"], ["--undefined=nan"], [footprints()]),
        ("g++", ["-O1"], ["--undefined=nan"], SPACES),
        ("g++", ["-O1"], ["--undefined=nan"], [paths()]),
        ("g++", ["-O1"], [], [example("forest", "forest.json", spp=1)]),
        ("clang++-22", ["-O0"], ["--trace=recurse", "--undefined=bytes"], [chains(3, 2)]),
        ("clang++-22", ["-O0"], ["--trace=recurse", "--undefined=bytes"], [objects(4)]),
        ("clang++-22", ["-O0"], ["--trace=recurse"], [nothing()]),
        ("clang++-22", ["-O0"], ["--trace=recurse"], [images()]),
        ("clang++-22", ["-O0"], ["--trace=recurse", "--undefined=bytes"], [graph()]),
    ]


with tempfile.TemporaryDirectory(prefix="rtsl-cpp-") as name:
    folder = pathlib.Path(name)
    for compiler, flags, options, scenes in CASES:
        if not shutil.which(compiler):
            sys.exit(f"{compiler} is not installed: make dependencies installs it")
        imports = list(dict.fromkeys(file for scene in scenes for file in scene["import"]))
        run(rtslc, "compile", *imports, "--emit=cpp", *options, "-o", folder / "shaders.cpp")
        header = (
            []
            if "--unchecked" in options
            else precompiled_header(compiler, *flags, COMPILED, folder)
        )
        run(compiler, *header, folder / "shaders.cpp", "-o", folder / "shaders.so", *flags, *FLAGS)
        for scene in scenes:
            (folder / "scene.json").write_text(json.dumps(scene))
            events_of = [option for option in options if option in ("--print", "--exceptions")]
            theirs = json.loads(
                run(
                    rtslc,
                    "run" if "passes" in scene else "render",
                    folder / "scene.json",
                    "-o",
                    folder / "jit.exr",
                    "--json",
                    "-O0",  # the bits are those of any level
                    *events_of,
                )
            )
            ours = json.loads(
                run(render, folder / "shaders.so", folder / "scene.json", folder / "cpp.exr")
            )
            same_picture(rtslc, folder / "cpp.exr", folder / "jit.exr")
            assert ours["printed"] == theirs.get("printed", []), (ours, theirs)
            assert ours.get("exceptions") == theirs.get("exceptions"), (ours, theirs)
            for name, elements in (ours.get("outputs") or {}).items():
                run(
                    rtslc,
                    "run",
                    folder / "scene.json",
                    "-q",
                    f"--out={name}={folder / 'buffer'}",
                    *events_of,
                )
                assert bytes(elements) == (folder / "buffer").read_bytes(), name
            if "--print" in options:
                assert len(ours["printed"]) > 10, ours
            if scene["render"]["size"] == [4, 4] and "--exceptions" in options:
                assert len(ours["exceptions"]) == 3, ours
        assert ("#define RTSL_UNCHECKED" in (folder / "shaders.cpp").read_text()) == (
            "--unchecked" in options
        )
