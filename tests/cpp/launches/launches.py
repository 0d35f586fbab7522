#!/usr/bin/env python3
"""launches.py RTSLC SOURCE LAUNCHES TURNTABLE MODELS: runs the test of launches in C, checks the
messages of its mistakes, and compares pictures of the turntable, whose trees follow what moves,
and of a model with materials of the library with those that `rtslc render` makes."""
import base64
import json
import os
import pathlib
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent))
from programs import run

rtslc, source, launches, turntable, models = sys.argv[1:]

WORDS = (
    "no node was entered",
    "no buffer number 9",
    "no buffer number 0",
    "not enough memory for a buffer of",
    "1 to 3 dimensions, not 4",
    "`steps` of `Measure`",
    "no node number 7",
    "no instance number 99",
    "not finite",
    "flattens it",
    "no mesh number 5",
    "no mesh number 0",
    "the vertices of mesh 0 are mapped",
    "not finite: x of vertex 1",
    "wait",
    "inverted",
    "inverted",
    "reference 4711",
    "member `weight` of `Marked` is -1, which is not in its range [0, inf)",
    "member `weight` of `Marked` is nan, which is not in its range [0, inf)",
    "the width",
    "slices",
    "there is no file `nowhere.png`",
    "a `sampler2D` has one file",
    "of 1, 2 or 4 channels",
    "`roots` is 0: no ray would see the instances",
    "there are no shaders",
    "there are no shaders",
    "nowhere.json",
    "there is no pass 0: the scene file has 0 launches",
    "nowhere",
    "the scene cannot be reloaded",
    "no object of the scene is named `nothing`",
    "no output buffer `nothing`",
    "a mesh that moves needs at least two keys",
    "meshes.0",
    "`weights` of `meshes.0.primitives.0` takes 2 numbers, not 1",
    "no light sampler has the number 3",
    "no sampler has the number 3",
    "no space of attributes has the number 5",
    "no wrap has the number 4",
    "`scene` is null",
    "`className` is null",
    "`numbers` is null",
    "`sizes` is null",
    "`positions` is null",
    "`times` is null",
    "`scene` is null",
    "`pixels` is null",
    "`scene` is null",
    "`query` is null",
    "cannot read `nowhere.npy`",
    "nothing",
    "`columns` is for .csv and .ply files",
    "`linear` of `Sources`",
    "numbers.raw",
    "no class is named `Source`",
    "class `Sources` has no member `arrays`",
    "texels.raw",
    "2 x 2 texels of 3 channels",
    "no format of texels has the number 7",
    "images.1",
    "frames of keys must ascend: 2 follows 2",
    "at least one is needed",
    "no interpolation has the number 2",
)


WORDS_OF_MODELS = (
    "nowhere.gltf",
    "broken.gltf",
    "Jump",
    "`fps`",
    "compile them with `std.materials.Dielectric`",
    "is 1e+38",
    "Back",
    "an `Emitter` cannot be in a node",
    "`position` takes 3 numbers, not 2",
    "a light in a node cannot move",
    "a camera cannot move",
)


def triangle_model(*targets):
    """A glTF file of a triangle, with morph targets that move its first two vertices."""
    corners = [-1, -1, 0, 1, -1, 0.3, 0, 1.5, 0]
    lists = [corners, *([*first, *second, 0, 0, 0] for first, second in targets)]
    numbers = b"".join(struct.pack("<9f", *one) for one in lists)
    uvs = struct.pack("<6f", 0.1, 0.2, 0.9, 0.3, 0.5, 0.8)
    accessor = {"componentType": 5126, "count": 3, "type": "VEC3", "min": [-9] * 3, "max": [9] * 3}
    return {
        "asset": {"version": "2.0"},
        "buffers": [
            {
                "byteLength": len(numbers + uvs),
                "uri": "data:application/octet-stream;base64,"
                + base64.b64encode(numbers + uvs).decode(),
            }
        ],
        "bufferViews": [
            {"buffer": 0, "byteLength": len(numbers)},
            {"buffer": 0, "byteOffset": len(numbers), "byteLength": len(uvs)},
        ],
        "accessors": [
            *({**accessor, "bufferView": 0, "byteOffset": 36 * i} for i in range(len(lists))),
            {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"},
        ],
        "meshes": [
            {
                "primitives": [
                    {
                        "attributes": {"POSITION": 0, "TEXCOORD_0": len(lists)},
                        **(
                            {"targets": [{"POSITION": i} for i in range(1, len(lists))]}
                            if targets
                            else {}
                        ),
                    }
                ]
            }
        ],
    }


def write_scenes(folder):
    """The scenes that the test loads: one of cameras, frames, an included file and a part of a
    model, one that writes a buffer, and one of passes."""
    shaders = f"{source}/tests/cpp/launches/Launches.rtsl"
    start = {"rtsl": 1, "import": [shaders], "render": {"size": [48, 32], "spp": 2}}
    model = triangle_model()
    morph = triangle_model(([0.5, 0, 1], [0, 0.5, 0]), ([0, -1, 0], [0.25, 0.25, 2]))
    ball = {"primitive": {"class": "Ball"}, "material": "clay"}
    moving = {"translate": {"frames": {"0": [0, 0, 0], "4": [2, 1, 0]}}}
    part = {"mesh": "model.gltf", "part": "meshes.0.primitives.0", "material": "clay"}
    morphed = {
        "mesh": "morph.gltf",
        "part": "meshes.0.primitives.0",
        "material": "coordinates",
    }
    measure = {"class": "Measure", "steps": [0.5], "from": [0, 0, 20], "hits": [0]}
    scenes = {
        "model.gltf": model,
        "morph.gltf": morph,
        "parts.json": {
            **start,
            "camera": {"class": "Eye"},
            "materials": {"coordinates": {"class": "Coordinates"}},
            "objects": [
                {**morphed, "weights": {"keys": [[0, 0], [1, 0.5]], "times": [0, 1]}},
                {
                    **morphed,
                    "weights": [0.25, -0.5],
                    "textureCoordinates": "barycentric",
                    "transform": {"translate": [2, 0, 0]},
                },
            ],
            "render": {"size": [48, 32], "spp": 4},
        },
        "materials.json": {"rtsl": 1, "materials": {"clay": {"class": "Lit"}}},
        "scene.json": {
            **start,
            "include": ["materials.json"],
            "cameras": {"front": {"class": "Eye"}, "side": {"class": "Eye", "eye": [1, 0, 8]}},
            "nodes": {
                "ball": ball,
                "part": part,
                "all": {
                    "children": [
                        {"child": "ball", "transform": moving},
                        {"child": "part", "transform": moving},
                        {"child": "part", "transform": {"translate": [-2, 0, 0]}},
                    ]
                },
            },
            "root": "all",
        },
        "moving.json": {
            **start,
            "camera": {"class": "Eye"},
            "objects": [
                {
                    "mesh": {"keys": ["flat.obj", "bent.obj"], "times": [0.25, 1]},
                    "material": {"class": "Lit"},
                }
            ],
            "render": {"size": [48, 32], "spp": 4},
        },
        "rays.json": {
            **start,
            "materials": {"clay": {"class": "Marked"}},
            "objects": [ball],
            "rayGeneration": {**measure, "found": [[[[0, 0]] * 3] * 2]},
            "render": {"engine": "programs", "size": [3, 2, 1], "spp": 1},
        },
        "passes.json": {
            **start,
            "materials": {"clay": {"class": "Marked"}},
            "objects": [ball],
            "buffers": {"found": {"size": [1, 2, 3]}},
            "passes": [
                {"rayGeneration": {**measure, "found": "found"}, "size": [3, 2, 1], "spp": 1},
                {"rayGeneration": {"class": "Total", "found": "found"}, "size": [1, 1]},
            ],
            "render": {},  # and with it no samples
        },
    }
    for name, corner in (("flat", "0 2 0"), ("bent", "1.5 2.5 3")):
        (folder / f"{name}.obj").write_text(f"v -2 -1 0\nv 2 -1 0\nv {corner}\nf 1 2 3\n")
    for name, document in scenes.items():
        (folder / name).write_text(json.dumps(document))


def write_sources(folder):
    """What Sources.c reads, and the scenes that say the same."""
    (folder / "table.csv").write_text("a,b\n1,0.25\n2,-7.5\n")
    header = "{'descr': '<f4', 'fortran_order': False, 'shape': (2,), }"
    header = header.ljust(117) + "\n"
    (folder / "array.npy").write_bytes(
        b"\x93NUMPY\x01\x00"
        + struct.pack("<H", len(header))
        + header.encode()
        + struct.pack("<2f", 0.1, 1e-9)
    )
    (folder / "points.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
        "end_header\n0.3 1\n-0.7 2\n"
    )
    (folder / "numbers.raw").write_bytes(struct.pack("<4f", 1.5, 2.5, 3.5, 4.5))
    (folder / "texels.raw").write_bytes(bytes(range(1, 256, 16)))
    shutil.copy(f"{source}/examples/bindless/tiles/00.png", folder / "tile.png")
    model = {"asset": {"version": "2.0"}, "images": [{"uri": "tile.png"}]}
    (folder / "picture.gltf").write_text(json.dumps(model))
    start = {
        "rtsl": 1,
        "import": [f"{source}/tests/cpp/launches/Launches.rtsl"],
    }

    def frames(*values, **more):
        return {"frames": dict(zip(("-2", "1", "4.5"), values, strict=True)), **more}

    (folder / "sources.json").write_text(
        json.dumps(
            {
                **start,
                "rayGeneration": {
                    "class": "Sources",
                    "table": {"buffer": "table.csv", "columns": ["b"]},
                    "array": {"buffer": "array.npy"},
                    "points": {"buffer": "points.ply", "element": "vertex", "columns": ["x"]},
                    "raw": {"buffer": "numbers.raw", "shape": [2, 2]},
                    "linear": frames([9, 9, 9], [0.1, -5, 1e9], [0.7, 5, -1e-3]),
                    "stepped": frames(3, 4, 5, interpolate="step"),
                    "seen": {"size": [12]},
                },
                "render": {"engine": "programs", "size": [1, 1], "spp": 1},
            }
        )
    )
    raw = {"raw": "texels.raw", "size": [2, 2], "format": "unorm8", "channels": 4}
    for name, picture in (
        ("raw", {**raw, "filter": "bilinear", "wrap": ["mirror", "repeat"]}),
        ("part", {"file": "picture.gltf", "part": "images.0"}),
    ):
        (folder / f"{name}.json").write_text(
            json.dumps(
                {
                    **start,
                    "rayGeneration": {"class": "Look", "picture": picture},
                    "render": {"engine": "programs", "size": [5, 1], "spp": 1},
                }
            )
        )


def write_given(folder):
    """The scene that Given.c makes."""
    (folder / "square.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
        "property float z\nelement face 2\nproperty int stripe\n"
        "property list uchar int vertex_indices\nend_header\n"
        "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n3 3 0 1 2\n-2 3 0 2 3\n"
    )

    def square(x, material, **more):
        return {
            "mesh": "square.ply",
            "material": material,
            "transform": {"translate": [x, 0, 0]},
            **more,
        }

    chosen = {"class": "Chosen", "constructor": [{"class": "Lit", "level": 0.75}]}
    striped = {"class": "Striped"}
    scene = {
        "rtsl": 1,
        "import": [f"{source}/tests/cpp/launches/Launches.rtsl"],
        "camera": {"class": "Eye"},
        "variables": {"tone": {"class": "Lit", "level": 0.5}},
        "objects": [
            square(-2.5, striped),
            square(0, striped, variables={"tone": {"class": "Lit", "level": 2}}),
            square(2.5, chosen),
        ],
        "background": [0.25, 0.5, 0.75],
        "ambient": [0.5, 0.25, 0.125],
        "render": {"size": [48, 32], "spp": 4, "sampler": "sobol"},
    }
    (folder / "given.json").write_text(json.dumps(scene))


def write_model(folder):
    """An OBJ file with two materials of an MTL file, which are the library's, and a scene with it
    and two lamps."""
    (folder / "model.mtl").write_text(
        "newmtl red\nKd 0.7 0.2 0.1\nPr 0.5\nnewmtl metal\nKd 0.8 0.8 0.7\nPm 1\nPr 0.3\n"
    )
    (folder / "model.obj").write_text(
        "mtllib model.mtl\nv -1 0 0\nv 1 0 0\nv 0 1.5 0\nv -2 -0.5 -2\nv 2 -0.5 -2\n"
        "v 2 -0.5 2\nv -2 -0.5 2\nusemtl red\nf 1 2 3\nusemtl metal\nf 4 7 6 5\n"
    )
    scene = {
        "rtsl": 1,
        "import": ["std.cameras", "std.materials"],
        "camera": {
            "class": "PerspectiveCamera",
            "constructor": [[0.9, 1.3, 6], [0, 0.5, 0], [0, 1, 0]],
        },
        "objects": [
            {"model": "model.obj"},
            *(
                {
                    "mesh": "lamp.obj",
                    "material": {"class": "Emitter", "radiance": radiance},
                    "transform": {"translate": [x, 2, 0]},
                }
                for x, radiance in ((-2, 3), (1, 5))
            ),
        ],
        "background": [0.5, 0.6, 0.8],
        "render": {"engine": "path", "size": [48, 32], "spp": 4},
    }
    (folder / "lamp.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")
    (folder / "model.json").write_text(json.dumps(scene))


def write_built(folder):
    """The scene that Models.c builds: a model with an animation, a light and a camera, beside the
    OBJ model, and lights in a node."""
    numbers = struct.pack("<2f", 0, 1) + struct.pack("<6f", 0, 0, 0, 0, 1, -0.5)
    model = triangle_model()
    (geometry,) = model["buffers"]
    data = base64.b64decode(geometry["uri"].split(",")[1]) + numbers
    start = geometry["byteLength"]
    geometry["uri"] = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
    geometry["byteLength"] = len(data)
    model["bufferViews"] += [
        {"buffer": 0, "byteOffset": start, "byteLength": 8},
        {"buffer": 0, "byteOffset": start + 8, "byteLength": 24},
    ]
    model["accessors"] += [
        {"bufferView": 2, "componentType": 5126, "count": 2, "type": "SCALAR"},
        {"bufferView": 3, "componentType": 5126, "count": 2, "type": "VEC3"},
    ]
    for accessor, limits in ((2, ([0], [1])), (3, ([0, 0, -1], [0, 1, 0]))):
        model["accessors"][accessor] |= dict(zip(("min", "max"), limits, strict=True))
    model |= {
        "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.7, 0.3, 1]}}],
        "cameras": [
            {
                "name": "Front",
                "type": "perspective",
                "perspective": {"yfov": 0.8, "aspectRatio": 1.5, "znear": 0.1},
            }
        ],
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "intensity": 5}]}},
        "nodes": [
            {"mesh": 0, "scale": [0.7, 0.9, 1], "translation": [-1, 0, 0]},
            {"children": [0], "rotation": [0, 0.1, 0, 1]},
            {"camera": 0, "translation": [0, 0.5, 6]},
            {"translation": [0, 2, 2], "extensions": {"KHR_lights_punctual": {"light": 0}}},
        ],
        "scenes": [{"nodes": [1, 2, 3]}],
        "scene": 0,
        "animations": [
            {
                "name": "Turn",
                "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}],
                "samplers": [{"input": 2, "output": 3}],
            }
        ],
    }
    model["meshes"][0]["primitives"][0]["material"] = 0
    (folder / "room.gltf").write_text(json.dumps(model))
    (folder / "broken.gltf").write_text('{"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}]}')
    (folder / "glass.mtl").write_text("newmtl red\nillum 7\nNi 1.5\n")
    (folder / "glass.obj").write_text(
        "mtllib glass.mtl\nv -1 0 0\nv 1 0 0\nv 0 1.5 0\nusemtl red\nf 1 2 3\n"
    )
    # A triangle that would be seen, and one that is too far away.
    late = {key: model[key] for key in model if key not in ("animations", "cameras", "scenes")}
    late["nodes"] = [{"mesh": 0}, {"mesh": 0, "translation": [1e38, 0, 0]}]
    (folder / "late.gltf").write_text(json.dumps(late | {"scenes": [{"nodes": [0, 1]}]}))
    moved = {"model": "room.gltf", "animation": "Turn", "fps": 12}
    intensity = {"intensity": [9, 8, 6]}
    scene = {
        "rtsl": 1,
        "frame": 5,
        "import": ["std.lights"],
        "camera": {**moved, "name": "Front", "transform": {"translate": [0, 0.25, 1]}},
        "nodes": {
            "table": {
                "children": [
                    {**moved, "transform": {"translate": [0.5, 0, 0.1]}},
                    {"model": "model.obj"},
                    {"light": {"class": "PointLight", "position": [1, 2, 0.5], **intensity}},
                    {
                        "light": {"class": "SpotLight", **intensity},
                        "transform": {"translate": [0, 1, 0]},
                    },
                ],
                "transform": {"scale": [1.25, 1, 0.5], "translate": [-0.3, 0.1, 0.2]},
            }
        },
        "root": "table",
        "background": [0.5, 0.6, 0.8],
        "render": {"engine": "path", "size": [48, 32], "spp": 4, "shutter": [0, 1]},
    }
    (folder / "built.json").write_text(json.dumps(scene))


def compare(picture, *options, scene="scene.json"):
    """The picture has the bits of what `rtslc render` makes of the scene."""
    run(rtslc, "render", scene, "-o", "expected.exr", "-q", *options)
    said = json.loads(run(rtslc, "compare", picture, "expected.exr", "--json"))
    assert said["rmse"] == 0, (picture, said)


with tempfile.TemporaryDirectory(prefix="rtsl-launches-") as name:
    write_scenes(pathlib.Path(name))
    write_sources(pathlib.Path(name))
    write_given(pathlib.Path(name))
    os.chdir(name)
    said = run(launches, f"{source}/examples/bindless/tiles/00.png", 64).splitlines()
    run(rtslc, "run", "passes.json", "--out", "total=total.npy", "-q")
    (total,) = struct.unpack("<f", pathlib.Path("total.npy").read_bytes()[-4:])
    assert said[:2] == [f"total {total:g}"] * 2, (said, total)
    for line, word in zip(said[2:], WORDS, strict=True):
        assert word in line, (word, said)
    compare("first.exr", "--camera=side", "--frame=1")
    compare("level.exr", "--camera=side", "--frame=1", "--set=materials.clay.level=0.25")
    compare("second.exr", "--camera=front", "--frame=2", "--sampler=r2")
    compare("same.exr", "--camera=front", "--frame=2", "--sampler=r2")
    compare("moving.exr", scene="moving.json")
    compare("parts.exr", scene="parts.json")
    compare("given.exr", scene="given.json")
    write_model(pathlib.Path(name))
    run(models, "model.json", "model.exr")
    compare("model.exr", scene="model.json")
    run(models, "model.json", "tree.exr", "tree")
    compare("tree.exr", "--set=render.lightSampler=tree", scene="model.json")
    assert pathlib.Path("tree.exr").read_bytes() != pathlib.Path("model.exr").read_bytes()
    write_built(pathlib.Path(name))
    said = run(models, "--build", "built.exr").splitlines()
    for line, word in zip(said, WORDS_OF_MODELS, strict=True):
        assert word in line, (word, said)
    compare("built.exr", scene="built.json")
    # A model of glass, whose class these shaders do not have.
    pathlib.Path(name, "model.mtl").write_text("newmtl red\nillum 7\nNi 1.5\nnewmtl metal\n")
    failed = subprocess.run([models, "model.json", "none.exr"], capture_output=True, text=True)
    assert failed.returncode == 1, failed
    assert "compile them with `std.materials.Dielectric`, `std.materials.Lambert`" in failed.stderr
    assert not os.path.exists("none.exr")
    os.chdir(source)

scene = {
    "rtsl": 1,
    "import": [
        f"{source}/examples/glass/{name}.rtsl"
        for name in ("PinholeCamera", "Parallelogram", "Lambert", "Solid", "BallLight", "Sky")
    ],
    "camera": {
        "class": "PinholeCamera",
        "constructor": [[0, 2.2, 7.5], [0, 1, 0], [0, -0.19, -1], [-1.6, -0.9], [1.6, 0.9], 4],
    },
    "materials": {
        "floor": {"class": "Lambert", "albedo": {"class": "Solid", "value": [0.7, 0.7, 0.65]}},
        "clay": {"class": "Lambert", "albedo": {"class": "Solid", "value": [0.8, 0.35, 0.2]}},
    },
    "objects": [
        {
            "primitive": {
                "class": "Parallelogram",
                "constructor": [[-8, 0, 8], [16, 0, 0], [0, 0, -16]],
            },
            "material": "floor",
        }
    ],
    "lights": [{"class": "BallLight", "position": [4, 6, 4], "intensity": [38, 36, 33]}],
    "ambient": [0.12, 0.13, 0.16],
    "background": {"class": "Sky"},
    "render": {"size": [64, 36]},
}
FRAMES = 4
with tempfile.TemporaryDirectory(prefix="rtsl-launches-") as name:
    folder = pathlib.Path(name)
    run(turntable, f"{source}/examples/glass/knot.obj", folder, FRAMES, 64)
    for i in range(FRAMES):
        scene["nodes"] = {
            "knot": {"mesh": f"{source}/examples/glass/knot.obj", "material": "clay"},
            "table": {
                "child": "knot",
                "transform": {"rotate": [0, 360 * i / FRAMES, 0], "translate": [0, 1.15, 0]},
            },
        }
        scene["root"] = "table"
        (folder / "scene.json").write_text(json.dumps(scene))
        run(rtslc, "render", folder / "scene.json", "-o", folder / "expected.png", "-q")
        said = json.loads(
            run(rtslc, "compare", folder / f"turn{i}.png", folder / "expected.png", "--json")
        )
        assert said["rmse"] < 2e-3, said  # of 8 bits: the sines of the two programs may differ
