"""Random scenes with nodes: shared geometry, nested transforms, motion, selectors, variables, ids,
masks, several roots, references and images by index. Each has a flat twin, in which every instance
is a node of its own, and which must give the same picture."""

import copy
import random

SHADERS = """
class Look : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0, 0.0, 9.0);
    rt_RayDirection = vec3(1.3 * (rt_ScreenCoord - 0.5), -1.0);
  }
};

struct Seen { uint hash; int passed; };

class Pattern : rt_Texture {
  public float scale = 1.0;
  public optional sampler2D image;
  void lookup() {
    vec2 at = scale * rt_TextureUV;
    rt_TextureColor = color(image ? image.sample(at).x : fract(at.x + 2.0 * at.y));
    rt_FloatTextureValue = image ? image.sample(at, 0.5).y : dFdx(at.x);
  }
};

// Shows all that tells instances apart, and sends rays to the root `next`.
class Show : rt_Material {
  public color tint = color(0.5);
  public int tag = 1;
  public uint mask = 255u;
  public int next;
  public optional rt_Texture grain;
  public rt_Texture patterns[3];
  public sampler2D images[];
  public vec2 offsets[][];

  color tone() {
    int i = (rt_InstanceId & 65535) + rt_PrimitiveIndex;
    color result = tint * (0.25 + 0.75 * abs(rt_ShadingNormal.z)) + color(0.0625 * float(tag)) + patterns[i % 3].lookup();
    if (grain) result += color(grain.lookupFloat());
    if (images.length() > 0) result += color(images[i % images.length()].sample(rt_TextureUV).x);
    if (offsets.length() > 0) result += color(offsets[i % offsets.length()][i & 1].y);
    return 0.2 * (result + color(0.1 * (rt_ObjectToWorld[3].x + rt_WorldToObject[3].y + rt_Time + length(rt_dPdu))));
  }
  void shade() {
    rt_SampleColor = tone();
    illuminance (rt_HitPoint)
      rt_SampleColor += rt_LightColor * abs(dot(rt_ShadingNormal, rt_LightDirection));
    Seen other = Seen(uint(tag), 0);
    trace(rt_HitPoint, reflect(rt_RayDirection, rt_GeometricNormal), 0.0, 1e30, other, next, mask, fract(rt_Time + 0.25));
    rt_SampleColor += color(float(other.hash & 255u) / 256.0 + 0.125 * float(other.passed));
    if (rt_Depth < 2) rt_SampleColor += 0.25 * trace(rt_HitPoint, reflect(rt_RayDirection, rt_ShadingNormal));
  }
  void anyHit(inout Seen s) {
    if ((rt_PrimitiveIndex + tag & 3) == 1) {
      s.passed += 1;
      ignoreIntersection();
    }
  }
  void closestHit(inout Seen s) {
    s.hash = s.hash * 1664525u + uint(rt_InstanceId * 31 + rt_PrimitiveIndex * 7 + tag) + uint(min(rt_HitDistance, 1e6) * 16.0);
  }
};

class Attributed : Show {
  scratch vec3 grow;
  scratch float plate;
  void shade() {
    Show::shade();
    rt_SampleColor += color(0.1 * grow.x + 0.05 * plate + dFdx(grow.y));
  }
};

class Sky : rt_Miss {
  void miss() { rt_SampleColor = color(0.1, 0.1, 0.2); }
  void miss(inout Seen s) { s.hash = s.hash ^ 12345u; }
};

class Balls : rt_Primitive {
  public vec4 balls[];
  void intersect() {
    vec4 ball = balls[rt_PrimitiveIndex];
    vec3 o = rt_RayOrigin - ball.xyz;
    float a = dot(rt_RayDirection, rt_RayDirection), b = dot(o, rt_RayDirection) / a;
    vec3 nearest = o - b * rt_RayDirection;
    float d = ball.w * ball.w - dot(nearest, nearest);
    if (d < 0.0) return;
    float s = sqrt(d / a);
    if (!hit(-b - s)) hit(-b + s);
  }
  void computeBounds() {
    vec4 ball = balls[rt_PrimitiveIndex];
    rt_BoundMin = ball.xyz - vec3(ball.w);
    rt_BoundMax = ball.xyz + vec3(ball.w);
  }
  void computeNormal() { rt_GeometricNormal = normalize(rt_HitPoint - balls[rt_PrimitiveIndex].xyz); }
  void computeTextureCoordinates() { rt_TextureUV = rt_HitPoint.xy; }
};

// The children whose bits are set, by where the ray begins; the first child of the node has the bit `first`.
class Pick : rt_Selector {
  public int first = 0;
  public float limit = 10.0;
  public int near;
  public int far;
  void visit() {
    int bits = length(rt_RayOrigin) < limit ? near : far;
    if (rt_ObjectToWorld[3].x > 2.0) bits = bits ^ 1;
    for (int i = 0; i < 4; ++i)
      if ((bits >> (i + first) & 1) != 0) visitChild(i);
  }
};
"""

TETRAHEDRON = """\
v -1 -1 -1\nv 1 1 -1\nv 1 -1 1\nv -1 1 1
vt 0 0\nvt 1 0\nvt 0 1\nvt 1 1
f 1/1 2/2 3/3\nf 1/1 4/4 2/2\nf 1/1 3/3 4/4\nf 2/2 4/4 3/3
"""
STRIP = """\
v -1.5 -1 0\nv 1.5 -1 0.25\nv 1 1 0\nv -1 1 0.5\nv 0 0 1
vn 0 0 1\nvn 0.6 0 0.8\nvn 0 0.6 0.8
vt 0 0\nvt 3 0.5\nvt 0.25 2
f 1/1/1 2/2/2 3/3/3\nf 1/1/2 3/2/3 4/3/1\nf 1/1/1 2/2/2 5/3/3
"""
BENT = TETRAHEDRON.replace("v -1 1 1", "v -1.5 1.25 1.5").replace("v 1 1 -1", "v 0.5 2 -1")
VERTICES_AND_FACES = {"tetrahedron.obj": (4, 4), "strip.obj": (5, 3)}
IMAGES = {
    f"i{number}": {
        "raw": f"i{number}.raw",
        "size": size,
        "format": "unorm8",
        "channels": 1,
        "filter": filter,
        "wrap": wrap,
    }
    for number, (size, filter, wrap) in enumerate(
        (
            ([4, 4], "trilinear", "repeat"),
            ([7, 3], "anisotropic", ["mirror", "clamp"]),
            ([1, 16], "bilinear", "black"),
        )
    )
}
# Members of materials and their textures that variables set, and a selector's.
OF_MATERIALS = ("tint", "tag", "mask", "grain", "images", "offsets")


def files():
    """What the scenes read, by name."""
    rng = random.Random(5)
    texels = {
        image["raw"]: bytes(rng.randrange(256) for _ in range(image["size"][0] * image["size"][1]))
        for image in IMAGES.values()
    }
    meshes = {"tetrahedron.obj": TETRAHEDRON, "strip.obj": STRIP, "bent.obj": BENT}
    return {"Random.rtsl": SHADERS, **meshes, **texels}


class Graph:
    """A random scene. All its matrices are exact, in whatever order they are multiplied, but for
    those of a scene that `turns`, which has no twin."""

    def __init__(self, seed, turns=False):
        self.rng = random.Random(seed)
        self.turns = turns
        self.moves = self.chance(0.5)

    def chance(self, probability):
        return self.rng.random() < probability

    def number(self, low, high):
        return round(8 * self.rng.uniform(low, high)) / 8

    def vector(self, size):
        return [self.number(-size, size) for _ in range(3)]

    def linear_transform(self):
        rng = self.rng
        kind = rng.randrange(6)
        if self.turns and kind > 2:
            turn = {"rotate": [rng.uniform(-180, 180) for _ in range(3)]}
            return {**turn, "scale": rng.choice([1, 0.7, [1, -1.3, 0.4]])}
        if kind == 0:
            return {}
        if kind == 1:
            return {"scale": rng.choice([0.5, 2, 1, -1, 0.25])}
        if kind == 2:
            return {"scale": [rng.choice([0.5, 1, -1, 2]) for _ in range(3)]}
        matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        if kind == 3:
            matrix[rng.choice([1, 2, 4, 6, 8, 9])] = rng.choice([0.5, -0.25, 1])
        else:
            for column, row in enumerate(rng.sample(range(3), 3)):
                matrix[4 * column : 4 * column + 3] = [0, 0, 0]
                matrix[4 * column + row] = rng.choice([1, -1, 0.5])
        return {"matrix": matrix}

    def key(self):
        turn = {"rotate": [0, 0, self.rng.uniform(-200, 200)]} if self.turns else {}
        return {"translate": self.vector(2), **turn}

    def transform(self):
        steps = [self.linear_transform(), {"translate": self.vector(3)}]
        if self.moves and self.chance(0.35):
            moving = {"keys": [self.key() for _ in range(self.rng.choice([2, 3]))]}
            if len(moving["keys"]) == 3:
                moving["times"] = self.rng.choice([[0, 0.25, 1], [0.2, 0.5, 0.7]])
            steps.insert(self.rng.randrange(3), moving)
        return steps

    def some_images(self):
        return self.rng.sample(list(IMAGES), self.rng.randrange(1, 4))

    def variables(self):
        rng = self.rng
        makers = {
            "tint": lambda: [self.number(0, 1) for _ in range(3)],
            "tag": lambda: rng.randrange(8),
            "mask": lambda: rng.choice([1, 2, 3, 255]),
            "grain": lambda: rng.choice(["p0", "p1", "p2"]),
            "image": lambda: rng.choice(list(IMAGES)),
            "images": self.some_images,
            "offsets": lambda: [[[0, self.number(0, 1)]] * 2 for _ in range(rng.randrange(1, 3))],
            "limit": lambda: self.number(6, 16),
        }
        return {name: make() for name, make in makers.items() if self.chance(0.2)}

    def with_more(self, node):
        """The node with some of what any node may have."""
        if self.chance(0.3):
            node["variables"] = self.variables()
        if self.chance(0.25):
            node["id"] = self.rng.choice([0, 1, -1, 17, 2**31 - 1, -(2**31)])
        if self.chance(0.5):
            node["transform"] = self.transform()
        return node

    def mesh(self):
        rng = self.rng
        kind = rng.randrange(3)
        node = {
            "mesh": ("strip.obj", "tetrahedron.obj", "bent.obj")[kind],
            "material": rng.choice(["show", "attributed"]) if kind < 2 else "other",
        }
        if node["material"] == "attributed":
            vertices, faces = VERTICES_AND_FACES[node["mesh"]]
            space = rng.choice(["numbers", "vector", "normal", "point"])
            node["attributes"] = {
                "grow": {"values": [self.vector(1) for _ in range(vertices)], "space": space},
                "plate": {"values": [rng.randrange(4) for _ in range(faces)], "per": "face"},
            }
        elif kind == 2 and self.moves:
            times = rng.choice([[0, 1], [0.25, 0.625]])
            node["mesh"] = {"keys": ["tetrahedron.obj", "bent.obj"], "times": times}
        if self.chance(0.4):
            node["backFaces"] = False
        return node

    def balls(self):
        sizes = [self.rng.choice([0.25, 0.5, 1]) for _ in range(self.rng.choice([1, 2, 5]))]
        balls = [[*self.vector(1.5), size] for size in sizes]
        return {
            "primitive": {"class": "Balls", "balls": balls},
            "count": "balls",
            "material": self.rng.choice(["show", "other"]),
        }

    def geometry(self):
        node = self.mesh() if self.chance(0.6) else self.balls()
        if self.chance(0.3):
            node["mask"] = self.rng.choice([1, 2, 3, 0, 254])
        return self.with_more(node)

    def group(self, names):
        rng = self.rng
        children = []
        for _ in range(rng.choice([1, 2, 2, 3])):
            child = rng.choice(names)
            children.append(self.with_more({"child": child}) if self.chance(0.6) else child)
        node = {"children": children}
        if self.chance(0.35):
            node["selector"] = {
                "class": "Pick",
                "near": rng.randrange(1, 16),
                "far": rng.randrange(1, 16),
            }
            if self.chance(0.5):
                node["selector"]["limit"] = self.number(6, 16)
        return self.with_more(node)

    def nodes(self):
        nodes = {f"g{i}": self.geometry() for i in range(self.rng.randrange(2, 5))}
        if not self.moves and self.chance(0.4):
            light = {"class": "PointLight", "position": self.vector(2), "intensity": [3, 2, 4]}
            nodes["lamp"] = {"light": light, "transform": self.transform()}
        for i in range(self.rng.randrange(2, 6)):
            nodes[f"n{i}"] = self.group(list(nodes))
        return nodes

    def material(self, name, roots):
        material = {
            "class": name,
            "next": self.rng.choice(roots),
            "patterns": [f"p{self.rng.randrange(3)}" for _ in range(3)],
        }
        if self.chance(0.3):
            material["images"] = self.some_images()
        if self.chance(0.3):
            material["mask"] = self.rng.choice([1, 2, 3, 255])
        return material

    def scene(self):
        nodes = self.nodes()
        names = list(nodes)
        roots = {"seen": names[-1]}
        for i in range(self.rng.randrange(3)):
            roots[f"r{i}"] = self.rng.choice(names)
        self.rng.shuffle(names)
        patterns = {}
        for i in range(3):
            patterns[f"p{i}"] = {"class": "Pattern", "scale": self.rng.choice([1, 2.5, 100])}
            if self.chance(0.5):
                patterns[f"p{i}"]["image"] = f"i{i}"
        classes = {"show": "Show", "other": "Show", "attributed": "Attributed"}
        scene = {
            "rtsl": 1,
            "import": ["std.lights", "Random.rtsl"],
            "camera": {"class": "Look"},
            "background": {"class": "Sky"},
            "images": IMAGES,
            "textures": patterns,
            "materials": {n: self.material(c, list(roots)) for n, c in classes.items()},
            "nodes": {name: nodes[name] for name in names},
            "roots": roots,
            "variables": self.variables(),
            "render": {"size": [24, 16], "spp": 2, "depth": 3},
        }
        if self.chance(0.3):
            scene["objects"] = [self.geometry()]
        if self.moves and self.chance(0.4):
            scene["render"]["shutter"] = self.rng.choice([[0.25, 0.75], [0.5, 0.5], [0, 0.125]])
        return scene


class Flattening:
    """The twin of a scene: an instance for each path from a root down to a geometry or a light,
    with a material of its own whose members are what its variables are. Selectors remain, with one
    child each."""

    def __init__(self, scene):
        self.old = scene
        self.everywhere = scene["variables"]

    def twin(self):
        nodes = self.old["nodes"]
        self.paths = {name: [] for name in nodes}  # (path, root) for each instance
        for number, top in enumerate(self.old["roots"].values()):
            self.walk([(nodes[top], 0)], top, number)
        made = {}
        below = [[] for _ in self.old["roots"]]
        for paths in self.paths.values():
            for path, root in paths:
                below[root].append(f"x{len(made)}")
                made[f"x{len(made)}"] = self.instance(path)
        roots = {}
        for name, children in zip(self.old["roots"], below):
            made["top of " + name] = {"children": children}
            roots[name] = "top of " + name
        twin = {**self.old, "nodes": made, "roots": roots, "variables": {}}
        if "objects" in self.old:
            twin["objects"] = [
                self.with_own_material(one, [(one, 0)]) for one in self.old["objects"]
            ]
        return twin

    def walk(self, path, name, root):
        """`path`: nodes, each with the number of the child that the path takes."""
        node = path[-1][0]
        children = [node["child"]] if "child" in node else node.get("children")
        if children is None:
            self.paths[name].append((path, root))
            return
        for i, child in enumerate(children):
            longer = [*path[:-1], (node, i)]
            if isinstance(child, dict):
                longer.append((child, 0))
                child = child["child"]
            self.walk([*longer, (self.old["nodes"][child], 0)], child, root)

    def completed(self, thing, path, members):
        """The object with these members from the nearest variables, if it does not set them."""
        result = copy.deepcopy(thing)
        for name in members:
            scopes = [node.get("variables", {}) for node, _ in reversed(path)] + [self.everywhere]
            values = [scope[name] for scope in scopes if name in scope]
            if values and name not in result:
                result[name] = values[0]
        return result

    def with_own_material(self, geometry, path):
        def texture(name):
            return self.completed(self.old["textures"][name], path, ["image"])

        material = self.old["materials"][geometry["material"]]
        material = self.completed(material, path, OF_MATERIALS)
        material["patterns"] = [texture(name) for name in material["patterns"]]
        if "grain" in material:
            material["grain"] = texture(material["grain"])
        result = {**geometry, "material": material}
        result.pop("variables", None)
        return result

    def instance(self, path):
        result = dict(path[-1][0])
        transform = result.pop("transform", [])
        if "light" not in result:
            result = self.with_own_material(result, path)
            ids = [node["id"] for node, _ in path if "id" in node]
            result.update({"id": ids[-1]} if ids else {})
        for depth in reversed(range(len(path) - 1)):
            node, child = path[depth]
            if "selector" in node:
                selector = self.completed(node["selector"], path[: depth + 1], ["limit"])
                selector["first"] = child
                result = {"child": result, "transform": transform} if transform else result
                result = {"selector": selector, "children": [result]}
                transform = []
            transform = transform + node.get("transform", [])
        # No geometry has a name, so that they are numbered in the order of the twin's nodes.
        return {"child": result, "transform": transform}
