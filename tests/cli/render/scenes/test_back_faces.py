"""Meshes whose back faces are left out."""

import json
import unittest

from harness import Case

SHADERS = """
import std.primitives.Sphere;

class Look : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.3, 0.2, 8.0);
    rt_RayDirection = vec3(4.0 * (rt_ScreenCoord - 0.5), -2.5);
  }
};

struct Seen { color light; int bounces; };

class Below : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0, -0.5, 6.0);
    rt_RayDirection = vec3(rt_ScreenCoord.x - 0.5, -0.3 * rt_ScreenCoord.y - 0.05, -1.0);
  }
};

class Rays : rt_RayGeneration {
  void generate() {
    Seen seen = Seen(color(0.0), 0);
    trace(rt_RayOrigin, rt_RayDirection, 0.0, 1e30, seen);
    rt_SampleColor = seen.light;
  }
};

class Sky : rt_Miss {
  void miss(inout Seen seen) { seen.light += color(0.2, 0.3, 0.4); }
};

class Paint : rt_Material {
  public bool rejectsBacks = false;
  void anyHit(inout Seen seen) {
    if (rejectsBacks && dot(rt_RayDirection, rt_GeometricNormal) > 0.0)
      ignoreIntersection();
  }
  void closestHit(inout Seen seen) {
    bool isBack = dot(rt_RayDirection, rt_GeometricNormal) > 0.0;
    seen.light += color(isBack ? 100.0 : 0.1 + abs(rt_GeometricNormal.x), 0.5 * abs(rt_GeometricNormal.y), 0.25);
    if (seen.bounces < 3) {
      seen.bounces += 1;
      trace(rt_HitPoint, reflect(rt_RayDirection, rt_GeometricNormal), 0.0, 1e30, seen);
    }
  }
};

class Matte : rt_Material {
  void shade() {
    rt_SampleColor = color(0.05);
    illuminance (rt_HitPoint)
      rt_SampleColor += rt_LightColor * abs(dot(normalize(rt_LightDirection), rt_ShadingNormal));
  }
};
"""
# A box around the origin, seen from outside; its last face is missing.
CORNERS = "".join(f"v {x} {y} {z}\n" for x in (-1, 1) for y in (-1, 1) for z in (-1, 1))
FACES = ("1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5")
BOX = CORNERS + "".join(f"f {face}\n" for face in FACES)
INSIDE_OUT = CORNERS + "".join("f " + " ".join(reversed(face.split())) + "\n" for face in FACES)
WAVE = BOX.replace("v 1 1 1", "v 1.5 1.2 1")


def scene(back_faces=False, rejects=False):
    """Meshes in world space, in their own space, mirrored, moving, and with keys."""

    def mesh(file, **more):
        return {"mesh": file, "material": "paint", "backFaces": back_faces, **more}

    return {
        "rtsl": 1,
        "import": ["Faces.rtsl"],
        "camera": {"class": "Look"},
        "rayGeneration": {"class": "Rays"},
        "background": {"class": "Sky"},
        "materials": {"paint": {"class": "Paint", "rejectsBacks": rejects}},
        "objects": [
            mesh("box.obj", transform=[{"rotate": [20, 30, 0]}, {"translate": [-2.5, 2, 0]}]),
            mesh(
                "inside-out.obj", transform=[{"rotate": [-40, 10, 0]}, {"translate": [2.5, 2, 0]}]
            ),
            {
                "primitive": {"class": "Sphere", "center": [0, 0, -4], "radius": 2},
                "material": "paint",
            },
        ],
        "nodes": {
            "box": mesh("box.obj"),
            "room": mesh("inside-out.obj"),
            "wave": mesh({"keys": ["box.obj", "wave.obj"]}),
            "mirrored": {
                "child": "box",
                "transform": [
                    {"scale": [-1, 0.7, 1]},
                    {"rotate": [50, -40, 0]},
                    {"translate": [-3, -1.5, 0]},
                ],
            },
            "moving": {
                "child": "room",
                "transform": [
                    {"scale": 0.6},
                    {
                        "keys": [
                            {"rotate": [0, 0, 0], "translate": [0, -2, 1]},
                            {"rotate": [90, 140, 0], "translate": [1, -2, 1]},
                        ]
                    },
                ],
            },
            "waving": {
                "child": "wave",
                "transform": [{"rotate": [30, 210, 0]}, {"translate": [3, -1.5, -1]}],
            },
            "top": {"children": ["mirrored", "moving", "waving"]},
        },
        "root": "top",
        "render": {"engine": "programs", "size": [64, 48], "spp": 4, "depth": 6},
    }


class BackFaces(Case):
    def setUp(self):
        super().setUp()
        self.write("Faces.rtsl", SHADERS)
        for name, text in (("box", BOX), ("inside-out", INSIDE_OUT), ("wave", WAVE)):
            self.write(name + ".obj", text)

    def render(self, scene, *options):
        return self.render_scene(scene, *options)[0]

    def means(self, picture):
        said, _ = self.run_rtslc("compare", picture, picture, "--json")
        return json.loads(said)["means"][0]

    def test_every_path_leaves_out_what_any_hit_would_reject(self):
        expected = self.render(scene(back_faces=True, rejects=True))
        self.assertLess(self.means(expected)[0], 1)
        self.assertGreater(
            self.means(self.render(scene(back_faces=True)))[0], 5
        )  # where they are seen
        for options in (
            [],
            ["--trace=recurse"],
            ["--traversal=device"],
            ["--traversal=device", "--trace=recurse", "-O0"],
            ["--target=host-megakernel"],
            ["--keep=all"],
        ):
            self.assert_same_bits(self.render(scene(), *options), expected, options)

    def lit(self, mesh, back_faces, material="floor", engine="classic"):
        """A floor below a face of two triangles, and a light above."""
        self.write("floor.obj", "v -9 -1 -9\nv -9 -1 9\nv 9 -1 9\nv 9 -1 -9\nf 1 2 3 4\n")
        self.write("up.obj", "v -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nf 1 2 3 4\n")
        self.write("down.obj", "v -2 0 -2\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nf 4 3 2 1\n")
        return {
            "rtsl": 1,
            "import": [
                "Faces.rtsl",
                "std.lights",
                "std.materials.Lambert",
                "std.materials.Emitter",
            ],
            "camera": {"class": "Below"},
            "materials": {
                "floor": {"class": "Matte" if engine == "classic" else "Lambert"},
                "glow": {"class": "Emitter", "radiance": [4, 4, 4], "isTwoSided": True},
            },
            "objects": [
                {"mesh": "floor.obj", "material": "floor"},
                {"mesh": mesh, "material": material, "backFaces": back_faces},
            ],
            "lights": [{"class": "PointLight", "position": [0, 4, 0], "intensity": [30, 30, 30]}]
            if engine == "classic"
            else [],
            "render": {"size": [48, 32], "spp": 16, "engine": engine},
        }

    def test_shadow_rays_pass_from_behind_and_not_from_the_front(self):
        """Those of the floor meet the lower side of the face."""
        shadowed = self.render(self.lit("down.obj", True))
        self.assert_same_bits(self.render(self.lit("down.obj", False)), shadowed)
        self.assertGreater(
            self.means(self.render(self.lit("up.obj", False)))[0], 1.2 * self.means(shadowed)[0]
        )

    def test_surfaces_shine_to_the_front_alone(self):
        """The floor below a lamp that faces down is as bright as without the option, and below one
        that faces up it is black."""
        for name, shines in (("down.obj", True), ("up.obj", False)):
            means = [
                self.means(self.render(self.lit(name, back_faces, "glow", "path")))[0]
                for back_faces in (False, True)
            ]
            self.assertGreater(means[1], 0.05)
            if shines:
                self.assertAlmostEqual(*means, delta=0.1 * means[1])
            else:
                self.assertEqual(means[0], 0)

    def test_other_scenes_have_no_code_for_it(self):
        for back_faces in (False, True):
            path = self.write("scene.json", json.dumps(scene(back_faces)))
            self.assertEqual("back faces" in self.graph_parts(path), not back_faces)

    def test_mistakes(self):
        for change, code, part in (
            ({"backFaces": 0}, "E0804", "`backFaces`"),
            ({"backFaces": "cull"}, "E0804", "`backFaces`"),
        ):
            wrong = scene()
            wrong["objects"][0].update(change)
            self.assert_message(
                self.diagnose("check", self.write("scene.json", json.dumps(wrong))), code, part
            )
        wrong = scene()
        wrong["objects"][2]["backFaces"] = False
        self.assert_message(
            self.diagnose("check", self.write("scene.json", json.dumps(wrong))),
            "E0802",
            "`backFaces` is for a `mesh`",
        )


if __name__ == "__main__":
    unittest.main()
