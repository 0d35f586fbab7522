"""What does not depend on where an object is: a scene that is moved as a whole, camera and lights
included, has the same picture, and so has a mesh in place of a primitive of the same shape."""

import json
import math
import unittest

from harness import Case

# 67 degrees about a slanted axis, and a way off.
AXIS, ANGLE, WAY = (1.0, 2.0, 0.5), 67.0, (3.0, -2.0, 1.5)


def turned(v):
    """Rodrigues' formula."""
    length = math.sqrt(sum(a * a for a in AXIS))
    k = [a / length for a in AXIS]
    c, s = math.cos(math.radians(ANGLE)), math.sin(math.radians(ANGLE))
    across = [k[1] * v[2] - k[2] * v[1], k[2] * v[0] - k[0] * v[2], k[0] * v[1] - k[1] * v[0]]
    along = sum(a * b for a, b in zip(k, v))
    return [c * v[i] + s * across[i] + (1 - c) * along * k[i] for i in range(3)]


def moved(v):
    return [a + b for a, b in zip(turned(v), WAY)]


SMOOTH = {"class": "Noise", "kind": 1, "scale": 1.5}
TILES = {"class": "Triplanar", "pattern": {"class": "Gradient"}, "scale": 0.5}
MATERIALS = {
    "plain": {"class": "Lambert"},
    "marble": {"class": "Lambert", "albedo": {"class": "Marble"}},
    "tiled": {"class": "Lambert", "albedo": TILES},
    "bumpy": {"class": "BumpMap", "material": "plain", "height": SMOOTH, "scale": 0.3},
    "stretched": {
        "class": "BumpMap",
        "material": "plain",
        "scale": 0.2,
        "height": {"class": "TransformedPattern", "pattern": SMOOTH, "spaceScale": [1, 3, 0.5]},
    },
    "leaning": {"class": "NormalMap", "material": "plain", "slopeU": SMOOTH, "slopeV": TILES},
    "brushed": {"class": "Ward", "alphaU": 0.1, "alphaV": 0.4},
}
EGG = """
import std.primitives.DistanceField;
class Egg : DistanceField { float distance(vec3 p) { return 0.5 * (length(p * vec3(1.0, 0.8, 1.2)) - 0.35); } };
"""
SHAPES = [
    {"class": "Sphere", "center": [0, 0, 0], "radius": 0.45},
    {"class": "Box", "low": [-0.4, -0.3, -0.4], "high": [0.4, 0.3, 0.4]},
    {"class": "Torus", "constructor": [[0, 0, 0], [0, 1, 0.6], 0.32, 0.12]},
    {"class": "Cone", "constructor": [[0, -0.4, 0], [0.1, 0.4, 0], 0.4, 0.1]},
    {"class": "Capsule", "constructor": [[-0.2, 0, 0], [0.2, 0.1, 0], 0.25]},
    {"class": "Quadric", "center": [0, 0, 0], "coefficients": [8, 4, 6], "extent": [0.5, 0.5, 0.5]},
    {"class": "Egg", "extent": 0.5},
    {
        "class": "HeightField",
        "heights": [[0, 0.5, 0.2], [0.3, 1, 0.1], [0.2, 0.4, 0]],
        "low": [-0.45, -0.3, -0.45],
        "high": [0.45, 0.3, 0.45],
    },
    {
        "class": "Curve",
        "points": [
            [-0.3, -0.3, 0, 0.1],
            [0, 0.6, 0.2, 0.2],
            [0.2, -0.6, 0, 0.05],
            [0.4, 0.3, 0, 0.1],
        ],
    },
]


class TransformCase(Case):
    def setUp(self):
        super().setUp()
        self.write("Egg.rtsl", EGG)

    def render(self, name, objects, point=list, vector=list, imports=(), **more):
        self.write(
            name + ".json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": [
                        "std.cameras",
                        "std.primitives",
                        "std.materials",
                        "std.textures",
                        "std.lights",
                        "Egg.rtsl",
                        *imports,
                    ],
                    "camera": {
                        "class": "PerspectiveCamera",
                        "constructor": [point([1, 3, 9]), point([0, 0, 0]), vector([0, 1, 0])],
                    },
                    "materials": MATERIALS,
                    "lights": [
                        {
                            "class": "PointLight",
                            "position": point([3, 5, 6]),
                            "intensity": [40, 40, 40],
                        },
                        {
                            "class": "PointLight",
                            "position": point([-6, 1, 4]),
                            "intensity": [20, 8, 8],
                        },
                    ],
                    "render": {"size": [64, 64], "spp": 2},
                    **objects,
                    **more,
                }
            ),
        )
        self.run_rtslc("render", name + ".json", "-o", name + ".exr")

    def difference(self, first, second):
        """RMSE, relative to the mean."""
        said, _ = self.run_rtslc("compare", first + ".exr", second + ".exr", "--json", status=None)
        numbers = json.loads(said)
        mean = sum(numbers["means"][0]) / 3
        self.assertGreater(mean, 0.01)
        return numbers["rmse"] / mean


class Motions(TransformCase):
    def test_a_scene_that_is_moved_as_a_whole_looks_the_same(self):
        """Every shape with every material, in rows. Wrong spaces differ by 0.03 and more."""
        children = []
        for row, shape in enumerate(SHAPES):
            for column, material in enumerate(MATERIALS):
                children.append(
                    {
                        "child": {"primitive": shape, "material": material},
                        "transform": {"translate": [column - 3, 3 - row, 0]},
                    }
                )
        still = {"nodes": {"all": {"children": children}}, "root": "all"}
        motion = {"rotate": {"axis": AXIS, "angle": ANGLE}, "translate": WAY}
        moving = {"nodes": {"all": {"children": children, "transform": motion}}, "root": "all"}
        self.render("still", still)
        self.render("moved", moving, moved, turned)
        self.assertLess(self.difference("still", "moved"), 0.002)


class Meshes(TransformCase):
    def test_a_mesh_has_the_patterns_of_a_primitive(self):
        """Two triangles and the parallelogram that they cover, squeezed and turned. What is
        computed from points in space and from texture coordinates must agree; a mesh without such
        points would differ by 0.1."""
        anchor, e1, e2 = [-3, -2, 0], [6, 0, 0.5], [0.5, 4, -1]
        corners = [
            [a + u * b + v * c for a, b, c in zip(anchor, e1, e2)]
            for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))
        ]
        self.write(
            "mesh.obj",
            "".join("v {} {} {}\n".format(*corner) for corner in corners)
            + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n",
        )
        squeeze = {"scale": [1, 0.5, 1.2], "rotate": [0, 20, 10]}
        primitive = {"primitive": {"class": "Parallelogram", "constructor": [anchor, e1, e2]}}
        for material in ("marble", "tiled", "bumpy", "leaning"):
            for name, shape in (("primitive", primitive), ("mesh", {"mesh": "mesh.obj"})):
                node = {**shape, "material": material, "transform": squeeze}
                self.render(name, {"nodes": {"all": node}, "root": "all"})
            self.assertLess(self.difference("primitive", "mesh"), 0.002, material)


PLATE = """v -2 -2 0.3
v 2 -2 -0.2
v 2 2 0.1
v -2 2 0
vn -0.3 -0.2 1
vn 0.3 -0.2 1
vn 0.3 0.2 1
vn -0.3 0.2 1
vt 0 0
vt 1 0
vt 1 1
vt 0 1
f 1/1/1 2/2/2 3/3/3
f 1/1/1 3/3/3 4/4/4
"""
SPACES = """class Spaces : rt_Material {
  void shade() {
    vec3 own = (rt_WorldToObject * vec4(rt_HitPoint, 1.0)).xyz;
    vec3 there = (rt_ObjectToWorld * vec4(own, 1.0)).xyz - rt_HitPoint;
    vec3 seen = 0.5 + 0.4 * sin(own * 3.0) + rt_dUVWdx * 9.0 + there * 100.0;
    rt_SampleColor = color(seen.x, seen.y, seen.z);
  }
};
"""


class PlacedMeshes(TransformCase):
    """A mesh of a node that is in the scene once, and does not move, is in world space."""

    def setUp(self):
        super().setUp()
        self.write("plate.obj", PLATE)
        self.write("Spaces.rtsl", SPACES)

    def scene(self, transform, isShared=False, **node):
        plate = {"mesh": "plate.obj", "material": "plain", **node}
        there = [{"child": "plate", "transform": transform}]
        if isShared:  # behind the camera
            there.append({"child": "plate", "transform": {"translate": [0, 0, 90]}})
        return {"nodes": {"plate": plate, "all": {"children": there}}, "root": "all"}

    def test_it_looks_as_in_its_own_space(self):
        turn = {"scale": [1, 0.6, 1.3], "rotate": [20, 30, 40], "translate": [0.3, 0.2, -0.5]}
        for material in [*MATERIALS, "spaces"]:
            more = {"materials": {**MATERIALS, "spaces": {"class": "Spaces"}}}
            for name, is_shared in (("once", False), ("twice", True)):
                scene = self.scene(turn, is_shared, material=material)
                self.render(name, scene, **more, imports=["Spaces.rtsl"])
            # That of Ward's material grows without bound towards grazing directions.
            bound = 0.003 if material == "brushed" else 2e-4
            self.assertLess(self.difference("once", "twice"), bound, material)

    def has_transforms(self, transform, is_shared=False, **node):
        self.render("one", self.scene(transform, is_shared, **node))
        said, _ = self.run_rtslc("explain", "one.json", "--json")
        entries = [entry for item in json.loads(said)["items"] for entry in item["entries"]]
        return next(one["needed"] for one in entries if one["subject"] == "transforms")

    def test_only_where_nothing_depends_on_its_space(self):
        turned = {"rotate": [10, 20, 30], "translate": [5, 0, 0]}
        self.assertFalse(self.has_transforms(turned))
        self.assertTrue(self.has_transforms(turned, is_shared=True))
        self.assertTrue(self.has_transforms({"scale": [-1, 1, 1]}))
        keys = [{"translate": [0, 0, 0]}, {"translate": [1, 0, 0]}]
        self.assertTrue(self.has_transforms({"keys": keys}))

    def test_not_far_away_where_floats_are_coarse(self):
        self.assertFalse(self.has_transforms({"rotate": [0, 20, 0], "translate": [10, 0, 0]}))
        self.assertTrue(self.has_transforms({"rotate": [0, 20, 0], "translate": [1000, 0, 0]}))
        # Whole numbers have no error there.
        self.write("plate.obj", "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\n")
        self.assertFalse(self.has_transforms({"translate": [1000, 0, -7]}))


if __name__ == "__main__":
    unittest.main()
