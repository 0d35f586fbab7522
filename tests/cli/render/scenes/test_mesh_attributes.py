"""Named attributes of meshes, which materials read as scratch members."""

import json
import unittest

from harness import Case
from numpy_files import npy

SHADERS = """
import std.primitives.Sphere;

class Look : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0, 0.0, 4.0);
    rt_RayDirection = vec3(2.0 * (rt_ScreenCoord - 0.5), -2.0);
  }
};

struct Seen { color light; };

class Rays : rt_RayGeneration {
  void generate() {
    Seen seen = Seen(color(0.0));
    trace(rt_RayOrigin, rt_RayDirection, 0.0, 1e30, seen);
    rt_SampleColor = seen.light;
  }
};

class Wear : rt_Material {
  scratch float wear;
  void closestHit(inout Seen seen) { seen.light += color(wear); }
};
class Second : rt_Material {
  scratch vec2 uv1;
  scratch vec3 flow;
  scratch int part;
  void anyHit(inout Seen seen) {
    seen.light += color(0.25 * flow.x, 0.0, 0.0);
    if (fract(4.0 * uv1.x) < 0.25)
      ignoreIntersection();
  }
  void closestHit(inout Seen seen) { seen.light += color(uv1.x, uv1.y, 0.125 * float(part)); }
};
class Colored : rt_Material {
  scratch color color;
  void closestHit(inout Seen seen) { seen.light += color; }
};
class Twisted : rt_Material {
  scratch vec4 tangent;
  scratch vec3 side;
  void closestHit(inout Seen seen) { seen.light += color(tangent.w, abs(dot(tangent.xyz, side)), dot(normalize(side), rt_GeometricNormal)); }
};
class Matrix : rt_Material {
  scratch mat2 turn;
  void closestHit(inout Seen seen) { seen.light += color(turn[0][0]); }
};
class Idle : rt_Material {
  scratch float wear;
  void closestHit(inout Seen seen) { seen.light += color(0.5); }
};
class Banded : rt_Primitive {
  scratch float wear;
  void computeBounds() { rt_BoundMin = vec3(-1.0); rt_BoundMax = vec3(1.0); }
  void intersect() { if (hit((0.5 - rt_RayOrigin.z) / rt_RayDirection.z)) wear = 0.75; }
  void computeNormal() { rt_GeometricNormal = vec3(0.0, 0.0, 1.0); }
};
"""

# Two squares side by side, as one mesh of two faces.
SQUARES = "v -1 -1 0\nv 0 -1 0\nv 1 -1 0\nv 1 1 0\nv 0 1 0\nv -1 1 0\nf 1 2 5 6\nf 2 3 4 5\n"
PLY = """ply
format ascii 1.0
element vertex 6
property float x
property float y
property float z
property float wear
property float uv1_u
property float uv1_v
property uchar red
property uchar green
property uchar blue
property float flow_x
property float flow_y
property float flow_z
element face 2
property int part
property list uchar int vertex_indices
end_header
-1 -1 0 0.1 0 0 255 0 0 1 0 0
0 -1 0 0.2 0.5 0 0 255 0 1 0 0
1 -1 0 0.3 1 0 0 0 255 1 0 0
1 1 0 0.4 1 1 255 255 0 1 0 0
0 1 0 0.5 0.5 1 0 255 255 1 0 0
-1 1 0 0.6 0 1 51 51 51 1 0 0
3 4 0 1 4 5
5 4 1 2 3 4
"""


def scene(**more):
    return {
        "rtsl": 1,
        "import": ["Attributes.rtsl"],
        "camera": {"class": "Look"},
        "rayGeneration": {"class": "Rays"},
        "materials": {
            name.lower(): {"class": name}
            for name in ("Wear", "Second", "Colored", "Twisted", "Idle")
        },
        "background": [0.5, 0.25, 0],
        "render": {"engine": "programs", "size": [32, 32], "spp": 1},
        **more,
    }


class Attributes(Case):
    def setUp(self):
        super().setUp()
        self.write("Attributes.rtsl", SHADERS)
        self.write("squares.obj", SQUARES)
        self.write("squares.ply", PLY)

    def render(self, scene, *options):
        return self.render_scene(scene, *options)[0]

    def everything(self):
        """Meshes in world space, in their own, mirrored, moving, with keys; and a primitive."""
        side = {"values": [[0, 0, 1]] * 6, "space": "vector"}
        tangent = {"values": [[1, 0, 0.5, 1]] * 6, "space": "tangent"}
        return scene(
            objects=[
                {
                    "mesh": "squares.ply",
                    "material": "second",
                    "transform": [{"scale": 0.5}, {"translate": [-0.5, 0.5, 0]}],
                },
                {
                    "mesh": "squares.obj",
                    "material": "wear",
                    "attributes": {"wear": [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]},
                    "transform": [{"scale": 0.5}, {"translate": [0.5, 0.5, 0]}],
                },
                {"primitive": {"class": "Banded"}, "material": "wear"},
            ],
            nodes={
                "turned": {
                    "mesh": "squares.obj",
                    "material": "twisted",
                    "attributes": {"side": side, "tangent": tangent},
                },
                "left": {
                    "child": "turned",
                    "transform": [
                        {"scale": [-0.5, 0.4, 0.3]},
                        {"rotate": [10, 20, 30]},
                        {"translate": [-0.5, -0.5, 0.7]},
                    ],
                },
                "painted": {
                    "mesh": {"keys": ["squares.ply", "squares.ply"]},
                    "material": "colored",
                },
                "right": {
                    "child": "painted",
                    "transform": [
                        {"scale": 0.5},
                        {"keys": [{"rotate": [0, 0, 0]}, {"rotate": [0, 0, 90]}]},
                        {"translate": [0.5, -0.5, 0.9]},
                    ],
                },
                "top": {"children": ["left", "right"]},
            },
            root="top",
        )

    def test_every_path_gives_the_same_bits(self):
        expected = self.render(self.everything(), "--spp", "4")
        for options in (
            [],
            ["--trace=recurse"],
            ["--traversal=device"],
            ["--traversal=device", "--trace=recurse", "-O0"],
            ["--target=host-megakernel"],
            ["--keep=all"],
            ["--keep=meshes,mesh-attributes"],
        ):
            self.assert_same_bits(
                self.render(self.everything(), "--spp", "4", *options), expected, options
            )

    def test_values_are_interpolated_and_those_of_faces_are_not(self):
        """The same square with values in the file and in the scene."""
        of_file = self.render(scene(objects=[{"mesh": "squares.ply", "material": "wear"}]))
        self.write("wear.npy", npy("f", (6,), [0.1, 0.2, 0.3, 0.4, 0.5, 0.6]))
        for wear in (
            [0.1, 0.2, 0.3, 0.4, 0.5, 0.6],
            {"buffer": "wear.npy"},
            {"values": {"buffer": "wear.npy"}, "per": "vertex"},
            {"buffer": "squares.ply", "columns": ["wear"]},
        ):
            given = scene(
                objects=[{"mesh": "squares.obj", "material": "wear", "attributes": {"wear": wear}}]
            )
            self.assert_same_bits(self.render(given), of_file, wear)
        faces = scene(
            objects=[
                {
                    "mesh": "squares.obj",
                    "material": "wear",
                    "attributes": {"wear": {"values": [0.25, 0.75], "per": "face"}},
                }
            ]
        )
        picture, _ = self.render_scene(faces)
        said, _ = self.run_rtslc("compare", picture, picture, "--json")
        self.assertAlmostEqual(
            json.loads(said)["means"][0][0], 0.5 / 4, places=6
        )  # it covers a quarter

    def test_colors_are_converted(self):
        objects = [{"mesh": "squares.ply", "material": "colored"}]
        for components in ("1", "spectral:4", "spectral:16"):
            self.render(scene(objects=objects), f"--color={components}")
        said = self.fails(
            [
                "render",
                self.put(
                    scene(
                        objects=[
                            {
                                "mesh": "squares.ply",
                                "material": "wear",
                                "attributes": {"wear": [[1, 2]]},
                            }
                        ]
                    )
                ),
                "-o",
                "a.exr",
            ]
        )
        self.assertIn("the attribute `wear`", said)

    def test_only_what_is_read_is_kept(self):
        said, _ = self.run_rtslc(
            "explain",
            self.put(scene(objects=[{"mesh": "squares.ply", "material": "second"}])),
            "--no-savings",
            "--json",
        )
        items = {
            (one["subject"], one["needed"])
            for item in json.loads(said)["items"]
            if item["item"] in ("meshes", "mesh-attributes")
            for one in item["entries"]
        }
        self.assertIn(
            f"attribute `flow` of {self.folder}/squares.ply",
            {name for name, needed in items if needed},
        )
        self.assertNotIn(
            f"attribute `wear` of {self.folder}/squares.ply", {name for name, _ in items}
        )
        idle = scene(objects=[{"mesh": "squares.obj", "material": "idle"}])
        self.render(idle)  # nothing reads `wear`
        plain, _ = self.run_rtslc("compile", self.put(idle), "--emit=ptx", "-o", "-")
        self.assertNotIn("mesh_attributes", plain)

    def refused(self, objects, *texts):
        said = self.fails(["render", self.put(scene(objects=objects)), "-o", "bad.exr"])
        for text in texts:
            self.assertIn(text, said)

    def test_mistakes(self):
        self.refused(
            [{"mesh": "squares.obj", "material": "wear"}],
            "squares.obj` has no attribute `wear`, which the material `wear` reads as a `float`",
            "it has no attributes",
        )
        self.refused(
            [{"mesh": "squares.ply", "material": "twisted"}],
            "has no attribute",
            "it has `color`, `flow`, `part`, `uv1`, `wear`",
        )
        self.refused(
            [{"mesh": "squares.obj", "material": "wear", "attributes": {"wear": [1, 2]}}],
            "the attribute `wear` has 2 values, and `squares.obj` has 6 vertices",
        )
        self.refused(
            [
                {
                    "mesh": "squares.obj",
                    "material": "wear",
                    "attributes": {"wear": {"values": [1, 2, 3], "per": "face"}},
                }
            ],
            "has 3 values, and `squares.obj` has 2 faces",
        )
        self.refused(
            [{"mesh": "squares.obj", "material": "wear", "attributes": {"wear": {"per": "face"}}}],
            "needs `values` or a `space`",
        )
        self.refused(
            [
                {
                    "mesh": "squares.obj",
                    "material": "wear",
                    "attributes": {"wear": {"values": [1], "per": "edge"}},
                }
            ],
            "`per` is `vertex` or `face`, not `edge`",
        )
        self.refused(
            [
                {
                    "mesh": "squares.obj",
                    "material": "wear",
                    "attributes": {"wear": {"values": [1], "space": "up"}},
                }
            ],
            "`space` is `numbers`, `point`",
        )
        self.refused(
            [
                {
                    "mesh": "squares.ply",
                    "material": "wear",
                    "attributes": {"wear": {"space": "vector"}},
                }
            ],
            "has 1 numbers, and its `space` is `vector`: 3 are needed",
        )
        self.refused(
            [
                {
                    "mesh": "squares.ply",
                    "material": "wear",
                    "attributes": {"wear": {"space": "vector", "per": "face"}},
                }
            ],
            "`per` is only for `values`",
        )
        self.refused(
            [
                {
                    "mesh": "squares.obj",
                    "material": "wear",
                    "attributes": {"wear": {"values": [1] * 6, "space": "vector"}},
                }
            ],
            "is a `float`, and its `space` is `vector`: a `vec3` is needed",
        )
        self.refused(
            [
                {
                    "mesh": "squares.obj",
                    "material": "second",
                    "attributes": {"uv1": [[0, 0]] * 6, "flow": [[0, 0, 0]] * 6, "part": [1] * 6},
                }
            ],
            "the attribute `part` is read as `int`, and numbers of vertices are interpolated: "
            'its values can be "per": "face"',
        )
        self.refused(
            [{"mesh": "squares.obj", "material": "wear", "attributes": {"wear": ["a"]}}],
            "the attribute `wear`",
        )
        self.refused(
            [{"mesh": "squares.obj", "material": "wear", "attributes": {"wear": 1}}],
            "the attribute `wear` is an object, not a number",
        )
        self.refused(
            [{"mesh": "squares.obj", "material": {"class": "Matrix"}}],
            "reads the attribute `turn` of a mesh as a `mat2`",
        )
        self.refused(
            [{"primitive": {"class": "Banded"}, "material": "wear", "attributes": {"wear": [1]}}],
            "`attributes` are for a `mesh`",
        )
        self.write("bad.ply", PLY.replace("0 -1 0 0.2", "0 -1 0 nan"))
        self.refused(
            [{"mesh": "bad.ply", "material": "wear"}],
            "has an attribute `wear` that is not finite at vertex 1",
        )
        said = self.renders_with_warning(
            scene(
                objects=[
                    {
                        "mesh": "squares.obj",
                        "material": "wear",
                        "attributes": {"wear": [1] * 6, "waer": [1]},
                    }
                ]
            )
        )
        self.assertIn("no material of the scene reads the attribute `waer`", said)

    def put(self, scene):
        return self.write("scene.json", json.dumps(scene))

    def renders_with_warning(self, scene):
        return self.render_scene(scene)[1]

    def fails(self, arguments):
        return self.run_rtslc(*arguments, status=1)[1]


if __name__ == "__main__":
    unittest.main()
