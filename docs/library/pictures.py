#!/usr/bin/env python3
"""pictures.py RTSLC FOLDER [--quick] [CLASS...]: renders a picture of each class of the standard
library into FOLDER.

docs/library.md shows them; --quick, for tests, renders few samples of few pixels and compares them
with the pictures of the document. Each scene is written beside its picture while it is rendered,
and removed after."""
import json
import math
import pathlib
import struct
import subprocess
import sys
import zlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
UP = [0, 1, 0]
VIEW = {
    "class": "PerspectiveCamera",
    "constructor": [[2, 1.7, 4.2], [0, -0.05, 0], UP],
    "fieldOfView": 30,
}
BALL = {"class": "Sphere", "center": [0, 0, 0], "radius": 1}
TORUS = {"class": "Torus", "constructor": [[0, 0, 0], UP, 0.8, 0.25]}
FLOOR = {
    "primitive": {"class": "Parallelogram", "constructor": [[-8, -1, 8], [16, 0, 0], [0, 0, -16]]},
    "material": {
        "class": "Lambert",
        "albedo": {
            "class": "Checker",
            "scale": 8,
            "even": [0.55, 0.55, 0.5],
            "odd": [0.3, 0.3, 0.33],
        },
    },
}
LIGHTS = [{"class": "SphereLight", "center": [4, 6, 4], "radius": 0.8, "radiance": [20, 19, 17]}]
SKY = {"class": "GradientSky"}
CLAY = {
    "class": "Lambert",
    "albedo": {"class": "Checker", "even": [0.8, 0.4, 0.25], "odd": [0.75, 0.65, 0.5]},
}
PLAIN = {"class": "Lambert", "reflectance": [0.8, 0.45, 0.3]}
UNPATTERNED = ("DistanceField", "Julia", "Mandelbulb", "HeightField")  # it would hide their form
MARBLE = {"class": "Marble", "scale": 1.2}

CAMERAS = {
    name: {"constructor": [[0, 0.8, 5], [0, -0.2, 0], UP], **more}
    for name, more in {
        "PerspectiveCamera": {"fieldOfView": 40},
        "ThinLensCamera": {"fieldOfView": 40, "focusDistance": 4, "lensRadius": 0.15},
        "TiltShiftCamera": {
            "fieldOfView": 40,
            "focusDistance": 5,
            "lensRadius": 0.1,
            "shift": [0, -0.2],
            "tilt": [0, 60],
        },
        "OrthographicCamera": {"height": 3.5},
        "FisheyeCamera": {},
        "PanoramaCamera": {},
    }.items()
}
CAMERAS["PinholeCamera"] = {
    "constructor": {
        "eye": [0, 0.8, 5],
        "up": UP,
        "gaze": [0, -0.2, -1],
        "uv0": [-0.5, -0.375],
        "uv1": [0.5, 0.375],
        "d": 1,
    }
}
PRIMITIVES = {
    "Sphere": {"center": [0, 0, 0]},
    "Box": {"low": [-0.8, -0.8, -0.8], "high": [0.8, 0.8, 0.8]},
    "Disk": {"constructor": [[0, 0, 0], [0.3, 0.6, 0.8], 1, 0.3]},
    "Parallelogram": {"constructor": [[-0.8, -0.6, 0.2], [1.5, 0.2, -0.3], [0.1, 1.2, -0.4]]},
    "Cone": {"constructor": [[0, -1, 0], [0, 0.9, 0], 0.8, 0.2]},
    "Cylinder": {"constructor": [[0, -1, 0], [0, 0.8, 0], 0.7]},
    "Capsule": {"constructor": [[-0.5, -0.4, 0], [0.5, 0.3, 0.2], 0.45]},
    "Torus": {"constructor": [[0, -0.1, 0], [0.1, 1, 0.6], 0.75, 0.25]},
    "Quadric": {"coefficients": [1, -0.6, 1], "level": 0.15},
    "DistanceField": {},
    "Julia": {"extent": 1.5},
    "Mandelbulb": {"extent": 1.25, "scale": 0.85},
    "HeightField": {
        "heights": [
            [
                math.exp(-((i / 8 - 1.2) ** 2) - (j / 8 - 0.9) ** 2)
                + 0.12 * math.cos(i) * math.cos(j)
                for i in range(25)
            ]
            for j in range(25)
        ],
        "range": [-0.15, 1],
        "low": [-1.1, -1, -1.1],
        "high": [1.1, 0.6, 1.1],
    },
    "Curve": {
        "points": [
            [
                0.9 * math.cos(i) * (1 - i / 24),
                i / 9 - 1.2,
                0.9 * math.sin(i) * (1 - i / 24),
                0.16 - i / 180,
            ]
            for i in range(23)
        ],
        "basis": 1,
    },
}
COUNTS = {"Curve": 20}  # primitives in an object
MATERIALS = {
    "Lambert": {"reflectance": [0.8, 0.4, 0.25]},
    "OrenNayar": {"reflectance": [0.8, 0.4, 0.25], "sigma": 1},
    "Conductor": {},
    "Gold": {},
    "Silver": {"alpha": 0.02},
    "Copper": {"alpha": 0.2},
    "Aluminium": {"alpha": 0.3},
    "Iron": {"alpha": 0.15},
    "Dielectric": {"transmission": [0.8, 0.95, 0.85]},
    "ThinGlass": {"transmission": [0.5, 0.7, 0.95]},
    "Plastic": {"reflectance": [0.1, 0.2, 0.7], "alpha": 0.03},
    "Ward": {"reflectance": [0.1, 0.1, 0.1], "specular": [0.5, 0.5, 0.5]},
    "Velvet": {"reflectance": [0.25, 0.02, 0.08], "sheen": [0.7, 0.4, 0.5]},
    "Principled": {"baseColor": [0.7, 0.05, 0.05], "roughness": 0.6, "clearcoat": 1},
    "Emitter": {"radiance": [1.0, 0.8, 0.5]},
    "MixMaterial": {
        "first": {"class": "Conductor"},
        "second": {"class": "Lambert", "reflectance": [0.1, 0.1, 0.3]},
        "amountMap": {"class": "Checker", "scale": 4},
    },
    "TwoSided": {"front": {"class": "Conductor"}, "back": {"class": "Lambert"}},
    "Cutout": {
        "material": {"class": "Lambert", "reflectance": [0.3, 0.6, 0.2]},
        "opacityMap": {"class": "Checker", "scale": 5},
    },
    "NormalMap": {
        "material": {"class": "Lambert"},
        "slopeU": {"class": "Checker", "scale": 5},
        "strength": 0.8,
    },
    "BumpMap": {
        "material": {"class": "Conductor", "alpha": 0.3},
        "height": {"class": "Noise", "kind": 2, "scale": 5},
        "scale": 0.1,
    },
}
LIGHT_SCENES = {
    "PointLight": {"position": [1.5, 2.5, 2], "intensity": [8, 8, 8]},
    "SpotLight": {
        "position": [2, 3, 2],
        "direction": [-2, -3, -2],
        "angle": 18,
        "intensity": [14, 14, 14],
    },
    "DistantLight": {"direction": [1, 2, 1], "angle": 4},
    "RectangleLight": {
        "corner": [-1, 2.5, -1],
        "side1": [2, 0, 0],
        "side2": [0, 0, 2],
        "radiance": [5, 5, 5],
    },
    "DiskLight": {"center": [2, 2.5, 1], "normal": [-2, -2.5, -1], "radiance": [6, 6, 6]},
    "SphereLight": {"center": [2, 3, 2], "radiance": [18, 18, 18]},
    "MeshLight": {
        "vertices": [[-1, 2, -1], [1, 2, -1], [1, 2, 1], [-1, 2, 1], [0, 3, 0]],
        "triangles": [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4]],
        "radiance": [8, 8, 8],
        "isTwoSided": True,
    },
    "SunLight": {"toSun": [3, 1, 2], "scale": 0.06},
    "SkyLight": {"toSun": [3, 1, 2]},
    "EnvironmentLight": {
        "zenith": [0.5, 0.7, 1],
        "horizon": [0.9, 0.8, 0.7],
        "nadir": [0.2, 0.2, 0.2],
    },
}
TEXTURES = {
    "Solid": {},
    "Checker": {"scale": 4},
    "Brick": {},
    "Noise": {"kind": 3, "scale": 2},
    "Marble": MARBLE,
    "Wood": {},
    "Gradient": {},
    "TransformedPattern": {"pattern": {"class": "Checker", "scale": 4}, "rotation": 30},
    "Triplanar": {"pattern": {"class": "Checker", "scale": 2}},
}
TEXTURES["ImageTexture"] = {
    "image": {"file": str(ROOT / "examples/cornell/picture.png"), "wrap": "mirror"},
    "repeats": [4, 2],
}
TEXTURES["ImageChannel"] = {
    "image": {**TEXTURES["ImageTexture"]["image"], "colorSpace": "linear"},
    "channel": 1,
}
TEXTURES["Product"] = {
    "first": {"class": "Checker", "scale": 2},
    "second": {"class": "Noise", "scale": 4},
}
TEXTURES["Scaled"] = {"pattern": {"class": "Noise", "scale": 4}, "scale": -1, "offset": 1}
TEXTURES["Threshold"] = {"pattern": {"class": "Noise", "scale": 4}}
TEXTURES["ExponentRoughness"] = {"pattern": {"class": "Noise", "scale": 4}, "exponent": 30}
NORMALS = {
    "file": str(ROOT / "examples/gltf/still-life.gltf"),
    "part": "images.1",
    "colorSpace": "linear",
}
BACKGROUNDS = {
    "EnvironmentMap": {
        "image": {
            "file": str(ROOT / "docs/library/PanoramaCamera.png"),
            "wrap": ["repeat", "clamp"],
        }
    },
    "GradientSky": {},
    "DaylightSky": {},
    "UniformSky": {"radiance": [0.6, 0.7, 0.9]},
}


def scene(objects, camera=VIEW, lights=LIGHTS, background=SKY, ambient=0.3):
    return {
        "rtsl": 1,
        "import": ["std"],
        "camera": camera,
        "objects": objects,
        "lights": lights,
        "background": background,
        "ambient": [ambient] * 3,
        "render": {"size": [128, 96], "spp": 64, "depth": 32},
    }


def scenes():
    """A scene for each class that the library has objects of, by name."""
    for name, members in CAMERAS.items():
        row = [
            {
                "primitive": {
                    "class": "Sphere",
                    "center": [1.1 * x, -0.5, -1.4 * x],
                    "radius": 0.5,
                },
                "material": CLAY,
            }
            for x in (-1, 0, 1)
        ]
        yield name, scene([FLOOR, *row], camera={"class": name, **members})
    for name, members in PRIMITIVES.items():
        yield name, scene(
            [
                FLOOR,
                {
                    "primitive": {"class": name, **members},
                    "material": PLAIN if name in UNPATTERNED else CLAY,
                    "count": COUNTS.get(name, 1),
                },
            ]
        )
    for name, members in MATERIALS.items():
        form = {
            "Ward": {"class": "Cylinder", "constructor": [[0, -1, 0], [0, 0.8, 0], 0.8]},
            "NormalMap": TORUS,
            "Velvet": TORUS,
        }.get(name, BALL)
        yield name, scene([FLOOR, {"primitive": form, "material": {"class": name, **members}}])
    for name, members in LIGHT_SCENES.items():
        yield name, scene(
            [FLOOR, {"primitive": BALL, "material": {"class": "Lambert"}}],
            lights=[{"class": name, **members}],
            background=[0, 0, 0],
            ambient=0.02,
        )
    for name, members in TEXTURES.items():
        form = {"class": "Box", "low": [-0.8, -1, -0.8], "high": [0.8, 0.6, 0.8]}
        yield name, scene(
            [
                FLOOR,
                {
                    "primitive": form,
                    "material": {"class": "Lambert", "albedo": {"class": name, **members}},
                },
            ]
        )
    bumps = {
        f"slope{side}": {
            "class": "TransformedPattern",
            "pattern": {"class": "ImageSlope", "image": NORMALS, "axis": axis},
            "scale": [3, 1],
        }
        for axis, side in enumerate("UV")
    }
    yield "ImageSlope", scene(
        [
            FLOOR,
            {
                "primitive": TORUS,
                "material": {"class": "NormalMap", "material": {"class": "Lambert"}, **bumps},
            },
        ]
    )
    walls = [
        {
            "primitive": {"class": "Parallelogram", "constructor": [corner, side1, side2]},
            "material": {"class": "Lambert", "reflectance": reflectance},
        }
        for corner, side1, side2, reflectance in (
            ([-1.6, -1, -1.5], [3.2, 0, 0], [0, 2.4, 0], [0.7] * 3),
            ([-1.6, -1, 2], [0, 0, -3.5], [0, 2.4, 0], [0.6, 0.1, 0.08]),
            ([1.6, -1, -1.5], [0, 0, 3.5], [0, 2.4, 0], [0.1, 0.4, 0.12]),
            ([-1.6, -1, 2], [3.2, 0, 0], [0, 0, -3.5], [0.7] * 3),
            ([-1.6, 1.4, -1.5], [3.2, 0, 0], [0, 0, 3.5], [0.7] * 3),
        )
    ]
    balls = [
        {
            "primitive": {"class": "Sphere", "center": center, "radius": 0.5},
            "material": {"class": material},
        }
        for center, material in (([-0.7, -0.5, -0.3], "Gold"), ([0.6, -0.5, 0.4], "Dielectric"))
    ]
    room = scene(
        walls + balls,
        camera={
            "class": "PerspectiveCamera",
            "constructor": [[0, 0.2, 5.5], [0, 0.15, 0], UP],
            "fieldOfView": 33,
        },
        lights=[
            {
                "class": "RectangleLight",
                "corner": [-0.5, 1.39, -0.5],
                "side1": [1, 0, 0],
                "side2": [0, 0, 1],
                "radiance": [9, 8, 6],
            }
        ],
        background=[0, 0, 0],
    )
    room["render"].update(engine="path", spp=1024)
    yield "PathTracer", room
    fog = {
        **room,
        "helpers": {"fog": {"class": "HomogeneousMedium", "scattering": 0.12, "anisotropy": 0.3}},
        "objects": [
            *walls,
            balls[0],
            {
                "primitive": {"class": "Sphere", "center": [0.6, -0.5, 0.4], "radius": 0.5},
                "material": {
                    "class": "MediumBoundary",
                    "interior": {
                        "class": "HomogeneousMedium",
                        "scattering": [8, 3, 1],
                        "absorption": [0.1, 0.3, 0.5],
                    },
                },
            },
        ],
        "rayGeneration": {"class": "VolumeTracer", "medium": "fog"},
        "render": {**room["render"], "engine": "volume", "spp": 512},
    }
    yield "VolumeTracer", fog
    balls = [
        {
            "primitive": {
                "class": "Sphere",
                "center": [3 * i - 6, 1.9, -420 - 40 * i],
                "radius": 1.2,
            },
            "material": CLAY,
        }
        for i in range(5)
    ]
    road = {
        "primitive": {
            "class": "Parallelogram",
            "constructor": [[-4000, 0, 20], [8000, 0, 0], [0, 0, -6000]],
        },
        "material": {"class": "Lambert"},
    }
    air = scene(
        [road, *balls],
        camera={
            "class": "PerspectiveCamera",
            "constructor": [[0, 1.5, 0], [0, 1.5, -500], UP],
            "fieldOfView": 1.4,
        },
        lights=[{"class": "DistantLight", "direction": [1, 2, 1]}],
    )
    for name, thickness in (("LayeredAir", 0.15), ("CurvedTracer", 0.5)):
        yield name, {
            **air,
            "helpers": {"air": {"class": "LayeredAir", "thickness": thickness}},
            "rayGeneration": {"class": "CurvedTracer", "field": "air", "reach": 2000},
            "render": {**air["render"], "engine": "programs", "spp": 16},
        }
    yellow = {"class": "HomogeneousMedium", "scattering": [6, 5, 1], "absorption": [0, 0.2, 1]}
    ring = scene(
        [
            FLOOR,
            {
                "primitive": TORUS,
                "material": {"class": "MediumBoundary", "interior": yellow},
            },
        ]
    )
    ring["render"].update(engine="volume", spp=1024)
    yield "MediumBoundary", ring
    for name, members in (
        ("HomogeneousMedium", {"scattering": [2.2, 2.5, 2.8]}),
        (
            "GridMedium",
            {
                "density": {
                    "raw": str(ROOT / "examples/smoke/smoke.raw"),
                    "size": [40, 64, 40],
                    "format": "unorm8",
                    "filter": "bilinear",
                    "wrap": "clamp",
                },
                "low": [-0.8, -1, -0.8],
                "high": [0.8, 1.2, 0.8],
                "scattering": 12,
                "absorption": 1,
            },
        ),
    ):
        box = (
            {"class": "Box", "low": [-0.8, -1, -0.8], "high": [0.8, 1.2, 0.8]}
            if name == "GridMedium"
            else BALL
        )
        one = scene(
            [
                FLOOR,
                {
                    "primitive": box,
                    "material": {"class": "MediumBoundary", "interior": {"class": name, **members}},
                },
            ]
        )
        one["render"].update(engine="volume", spp=1024)
        yield name, one
    for name, engine, members in (
        ("NormalsView", "normals", {}),
        ("DepthView", "depth", {"unit": 8}),
        ("IdView", "id", {}),
        ("AlbedoView", "albedo", {}),
        ("OcclusionView", "occlusion", {"reach": 2}),
    ):
        view = {**room, "rayGeneration": {"class": name, **members}}
        yield name, {**view, "render": {**room["render"], "engine": engine, "spp": 256}}
    for name, members in BACKGROUNDS.items():
        yield name, scene(
            [FLOOR, {"primitive": BALL, "material": {"class": "Silver", "alpha": 0}}],
            camera={
                "class": "PerspectiveCamera",
                "constructor": [[0, 0.3, 5], [0, 0.4, 0], UP],
                "fieldOfView": 50,
            },
            background={"class": name, **members},
        )


def cells(png):
    """The mean colors, 0 to 255, of 4 x 3 equal parts of a picture as rtslc writes it: RGB of 8
    bits."""
    data, at, packed = png.read_bytes(), 8, b""
    width, height = struct.unpack(">II", data[16:24])
    while at < len(data):
        (size,) = struct.unpack(">I", data[at : at + 4])
        packed += data[at + 8 : at + 8 + size] if data[at + 4 : at + 8] == b"IDAT" else b""
        at += 12 + size
    raw = zlib.decompress(packed)
    sums, row = [0] * 36, bytes(3 * width)
    for y in range(height):
        line = raw[y * (3 * width + 1) : (y + 1) * (3 * width + 1)]
        above, row = row, bytearray(line[1:])
        for x in range(3 * width):
            a, b, c = (row[x - 3], above[x], above[x - 3]) if x >= 3 else (0, above[x], 0)
            p = a + b - c
            paeth = (
                a
                if abs(p - a) <= min(abs(p - b), abs(p - c))
                else b
                if abs(p - b) <= abs(p - c)
                else c
            )
            row[x] = (row[x] + (0, a, b, (a + b) // 2, paeth)[line[0]]) % 256
            sums[(y * 3 // height * 4 + x // 3 * 4 // width) * 3 + x % 3] += row[x]
    return [s * 12 / (width * height) for s in sums]


def main():
    rtslc, folder = sys.argv[1], pathlib.Path(sys.argv[2])
    options = ["--size", "24x18", "--spp", "16"] if "--quick" in sys.argv else []
    wanted = [argument for argument in sys.argv[3:] if argument != "--quick"]
    failed = []
    for name, description in scenes():
        if wanted and name not in wanted:
            continue
        level = ["-O0"] if options else []  # no picture depends on it
        if name in ("EnvironmentLight", "SkyLight"):  # all of its light is chosen at random
            description["render"]["spp"] = 1024
            level = []
        file = folder / f"{name}.json"
        file.write_text(json.dumps(description))
        done = subprocess.run(
            [rtslc, "render", file, "-o", folder / f"{name}.png", "--quiet", *options, *level],
            capture_output=True,
            text=True,
        )
        file.unlink()
        if done.returncode or done.stderr:
            failed.append(name)
            print(name, done.stderr)
        elif options:
            difference = max(
                abs(a - b)
                for a, b in zip(
                    cells(folder / f"{name}.png"), cells(ROOT / f"docs/library/{name}.png")
                )
            )
            if difference > 25:
                failed.append(name)
                print(
                    f"{name}: part of the picture differs by {difference:.0f} of 255 from "
                    f"docs/library/{name}.png"
                )
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
