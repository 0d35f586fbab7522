"""Random scenes of the standard library: any of its cameras, primitives, materials, textures,
media, lights, backgrounds and engines, with random members in their ranges, as the reflection of
the library gives them. A class that is added to the library takes part."""

import json
import math
import random

# Not made: bases without a shape or look of their own, and classes that need more than members: an
# instance's mesh, colors of vertices, or an engine of their own.
LEFT_OUT = {
    "AreaLight", "DistanceField", "Pattern", "Scatterer", "ViewCamera", "Wrapper",
    "ClassicScatterer", "MeshLight", "PinholeCamera", "VertexColorCutout", "VertexColorEmitter",
    "VertexColorLambert", "VertexColorPrincipled",
}  # fmt: skip
ENGINES = ("classic", "path", "path", "volume", "albedo", "normals", "depth", "id", "occlusion")
SIMPLE = {"Pattern": "Solid", "rt_Texture": "Checker", "Scatterer": "Lambert"}
MOST_OCTAVES, MOST_STEPS = 4, 64
IMAGES = [("picture.raw", [8, 4]), ("heights.raw", [5, 5])]
DENSITY = ("density.raw", [6, 5, 4])


def ball(stacks, sectors):
    """The text of an OBJ file."""
    lines = []
    for i in range(stacks + 1):
        for k in range(sectors):
            polar, azimuth = math.pi * i / stacks, 2 * math.pi * k / sectors
            normal = (
                math.sin(polar) * math.cos(azimuth),
                math.cos(polar),
                math.sin(polar) * math.sin(azimuth),
            )
            lines += ["v {:g} {:g} {:g}".format(*(0.6 * x for x in normal))]
            lines += ["vn {:g} {:g} {:g}".format(*normal), f"vt {k / sectors:g} {i / stacks:g}"]
    for i in range(stacks):
        for k in range(sectors):
            a, b = i * sectors + k + 1, i * sectors + (k + 1) % sectors + 1
            quad = (a, b, b + sectors, a + sectors)
            lines.append("f " + " ".join(f"{corner}/{corner}/{corner}" for corner in quad))
    return "\n".join(lines) + "\n"


MESHES = {
    "tetrahedron.obj": "v -1 -1 -1\nv 1 1 -1\nv 1 -1 1\nv -1 1 1\n"
    "f 1 2 3\nf 1 4 2\nf 1 3 4\nf 2 4 3\n",
    "ball.obj": ball(6, 8),
}


def files():
    """What the scenes read, by name."""
    rng = random.Random(7)
    texels = {
        name: bytes(rng.randrange(256) for _ in range(math.prod(size)))
        for name, size in (*IMAGES, DENSITY)
    }
    return {**MESHES, **texels}


class Library:
    """The classes of the library, by name, as `rtslc compile --emit=reflection` describes them.
    Scenes have those of `names`."""

    def __init__(self, reflection, names):
        self.classes = {one["name"]: one for one in json.loads(reflection)["classes"]}
        self.names = [name for name in names if name in self.classes and name not in LEFT_OUT]

    def members(self, name):
        return [one for one in self.classes[name]["members"] if one["access"] == "public"]

    def parameters(self, name):
        return self.classes[name].get("constructor", {}).get("parameters", [])

    def derived_from(self, base):
        """Those that a scene can have, of this class or with it as a base."""

        def is_derived(name):
            while name in self.classes and name != base:
                name = self.classes[name].get("base")
            return name == base

        return [name for name in self.names if is_derived(name)]


def bounds(text, largest):
    """Numbers that a range allows, no larger than `largest` if it has no end."""
    low, high = (float(end) for end in text.strip("[]()").split(", "))
    inside = 0.02 * (high - low) if math.isfinite(high) else 0.02
    if text[0] == "(":
        low += inside
    if not math.isfinite(high):
        return low, low + largest
    return low, high - inside if text[-1] == ")" else high


class RandomScene:
    def __init__(self, library, seed):
        self.library = library
        self.rng = random.Random(seed)
        self.nesting = 0

    def chance(self, probability):
        return self.rng.random() < probability

    def number(self, low, high):
        if self.chance(0.05):
            return self.rng.choice([low, high])
        return round(self.rng.uniform(low, high), 4)

    def point(self, size=1.5):
        return [round(self.rng.uniform(-size, size), 3) for _ in range(3)]

    def value(self, kind, limits, size=1.5):
        """A value of this type in RTSL, in these limits if there are any."""
        if kind == "bool":
            return self.chance(0.5)
        if kind == "int":
            low, high = bounds(limits or "[0, 3]", 6)
            return self.rng.randint(int(low), int(min(high, low + 12)))
        if kind in ("float", "color", "vec2", "vec3", "vec4"):
            if not limits:
                limits = "[0, 1]" if kind == "color" else f"[{-size}, {size}]"
            count = {"float": 1, "color": 3}.get(kind) or int(kind[3])
            numbers = [self.number(*bounds(limits, size)) for _ in range(count)]
            return numbers[0] if count == 1 else numbers
        if kind in ("sampler2D", "sampler3D"):
            name, texels = DENSITY if kind == "sampler3D" else self.rng.choice(IMAGES)
            wraps = ["repeat", "mirror", "clamp", "black"]
            filters = ["nearest", "bilinear", "trilinear"]
            return {
                "raw": name,
                "size": texels,
                "format": "unorm8",
                "filter": self.rng.choice(filters[:2] if kind == "sampler3D" else filters),
                "wrap": self.rng.choice(wraps),
            }
        return self.object(kind)

    def object(self, base):
        """An object of any class with this base."""
        self.nesting += 1
        deep = self.nesting > 3 and base in SIMPLE
        name = SIMPLE[base] if deep else self.rng.choice(self.library.derived_from(base))
        made = self.object_of(name)
        self.nesting -= 1
        return made

    def object_of(self, name):
        made = {"class": name}
        for member in self.library.members(name):
            if member.get("hasDefault"):
                wanted = self.chance(0.5)
            elif member.get("isOptional"):
                wanted = self.chance(0.3)
            else:
                wanted = not member["type"].endswith("[]")
            if wanted and "[" not in member["type"]:
                made[member["name"]] = self.value(member["type"], member.get("range"))
        arguments = [
            self.value(one["type"], one.get("range"), 0.9) for one in self.library.parameters(name)
        ]
        if arguments:
            made["constructor"] = arguments
        for member, most in (("octaves", MOST_OCTAVES), ("maxSteps", MOST_STEPS)):
            if member in made:
                made[member] = min(made[member], most)
        return made

    def camera(self):
        camera = self.object("rt_Camera")
        eye = [self.number(-1, 1), self.number(0, 2), 5]
        camera["constructor"] = {"eye": eye, "target": [0, 0, 0], "up": [0, 1, 0]}
        return camera

    def primitive(self):
        made = self.object("rt_Primitive")
        if made["class"] == "Box":
            made["low"], high = self.point(), self.point()
            made["high"] = [low + abs(size) + 0.1 for low, size in zip(made["low"], high)]
        elif made["class"] == "Curve":
            points = [[*self.point(), self.number(0.02, 0.2)] for _ in range(4)]
            made = {"class": "Curve", "points": points}
        elif made["class"] == "HeightField":
            made = {"class": "HeightField", "image": self.value("sampler2D", None)}
        return made

    def transform(self):
        turn = {"rotate": [round(self.rng.uniform(-180, 180)) for _ in range(3)]}
        scale = self.rng.choice([1, 0.7, [1, -1.3, 0.4]])
        return {**(turn if self.chance(0.7) else {}), "scale": scale, "translate": self.point(0.8)}

    def geometry(self, materials):
        if self.chance(0.3):
            made = {"mesh": self.rng.choice(list(MESHES))}
            if self.chance(0.2):
                made["backFaces"] = False
        else:
            made = {"primitive": self.primitive()}
        made["material"] = self.rng.choice(materials)
        if self.chance(0.1):
            made["mask"] = self.rng.choice([0, 1, 254])
        return made

    def graph(self, materials):
        """Nodes whose root is `all`."""
        nodes = {}
        for i in range(self.rng.randint(1, 3)):
            nodes[f"g{i}"] = self.geometry(materials)
        children = []
        for _ in range(self.rng.randint(1, 4)):
            transform = self.transform()
            if self.chance(0.3):
                transform = {"keys": [transform, {**transform, "translate": self.point(0.8)}]}
            children.append({"child": self.rng.choice(list(nodes)), "transform": transform})
        return {**nodes, "all": {"children": children}}

    def scene(self):
        materials = {f"m{i}": self.object("Scatterer") for i in range(self.rng.randint(1, 4))}
        if self.chance(0.6):
            materials["lamp"] = {"class": "Emitter", "radiance": self.number(0, 9)}
        names = list(materials)
        scene = {
            "rtsl": 1,
            "import": ["std"],
            "camera": self.camera(),
            "materials": materials,
            "objects": [self.geometry(names) for _ in range(self.rng.randint(1, 6))],
            "lights": [self.object("rt_Light") for _ in range(self.rng.choice([0, 1, 2, 5]))],
            "render": {
                "engine": self.rng.choice(ENGINES),
                "depth": self.rng.choice([1, 4, 12]),
                "size": [24, 16],
                "spp": 3,
                "seed": self.rng.randint(1, 1000),
                "lightSampler": self.rng.choice(["auto", "power", "tree"]),
            },
        }
        if self.chance(0.5):
            scene.update(nodes=self.graph(names), root="all")
        if self.chance(0.7):
            scene["background"] = self.object("rt_Miss")
        if self.chance(0.2):
            scene["ambient"] = 0.1
        if self.chance(0.4):
            scene["render"]["sampler"] = self.rng.choice(["r2", "sobol"])
        return scene


def classes_of(value):
    """The names of classes in a scene."""
    if isinstance(value, dict):
        found = {value["class"]} if isinstance(value.get("class"), str) else set()
        return found.union(*map(classes_of, value.values()))
    return set().union(*map(classes_of, value)) if isinstance(value, list) else set()
