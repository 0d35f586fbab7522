"""What moves: transforms and meshes with keys, the shutter, and the times of rays."""

import json
import math
import unittest

from harness import Case

SHADERS = """
import std.primitives.Sphere;

class Look : rt_Camera {
  void generateRay() {
    rt_RayOrigin = vec3(0.0, 0.0, 12.0);
    rt_RayDirection = vec3(3.0 * (rt_ScreenCoord - 0.5), -2.5);
  }
};

class Paint : rt_Material {
  public color tint = color(0.8);
  void shade() {
    rt_SampleColor = tint * (0.3 + 0.7 * abs(rt_ShadingNormal.z)) * (0.5 + 0.5 * rt_Time);
    if (rt_Depth < 1) {
      vec3 n = rt_GeometricNormal;
      rt_SampleColor += 0.3 * trace(rt_HitPoint, reflect(rt_RayDirection, n)) + color(0.01 * rt_ObjectToWorld[3].y);
    }
  }
};

class Near : rt_Selector {
  void visit() { visitChild(rt_ObjectToWorld[3].x > 0.0 ? 1 : 0); }
};
"""
# A strip of two triangles, flat and bent.
FLAT = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3\nf 1 3 4\n"
BENT = "v -1 -1 1\nv 1 -1 -0.5\nv 1.5 1 1\nv -1 1.5 0\nf 1 2 3\nf 1 3 4\n"
BALL = {"primitive": {"class": "Sphere", "center": [0.5, 0, 0], "radius": 0.8}, "material": "paint"}
TURNING = {
    "keys": [
        {"rotate": [0, 0, 0]},
        {"rotate": [0, 0, 80], "scale": [1, 2, 1]},
        {"rotate": [0, 0, 300]},
    ],
    "times": [0.1, 0.3, 1],
}


def scene(nodes=None, **more):
    """A scene of everything that moves, or of these nodes."""
    result = {
        "rtsl": 1,
        "import": ["Motion.rtsl"],
        "camera": {"class": "Look"},
        "background": [0.1, 0.1, 0.2],
        "materials": {"paint": {"class": "Paint"}},
        "nodes": nodes
        or {
            "ball": BALL,
            "strip": {
                "mesh": {"keys": ["flat.obj", "bent.obj", "flat.obj"], "times": [0, 0.6, 0.9]},
                "material": "paint",
            },
            "still": {"mesh": "bent.obj", "material": "paint"},
            "turning": {
                "children": ["ball", {"child": "strip", "transform": {"translate": [2, 0, 0]}}],
                "transform": TURNING,
            },
            "orbit": {
                "child": "turning",
                "transform": [
                    {"translate": [2, 1, 0]},
                    {
                        "keys": [
                            {"rotate": {"axis": [0, 1, 0], "angle": -30}},
                            {"rotate": {"quaternion": [0.3, 0.1, 0.2, 0.9]}},
                        ]
                    },
                ],
            },
            "sheared": {
                "child": "still",
                "transform": {
                    "keys": [
                        {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -3, 2, 0, 1]},
                        {"matrix": [1, 0.5, 0, 0, -0.5, 2, 0, 0, 0, 0, 1, 0, -2, 3, -1, 1]},
                    ]
                },
            },
            "chosen": {
                "selector": {"class": "Near"},
                "children": ["ball", "still"],
                "transform": {"keys": [{"translate": [-0.5, -3, 0]}, {"translate": [0.7, -3, 0]}]},
            },
            "world": {
                "children": [
                    "strip",
                    {"child": "turning", "transform": {"translate": [-2, -2, -1]}},
                    "orbit",
                    "sheared",
                    "chosen",
                ]
            },
        },
        "root": "world",
        "render": {"size": [48, 32], "spp": 8, "depth": 3},
    }
    result.update(more)
    return result


class MotionCase(Case):
    def setUp(self):
        super().setUp()
        self.write("Motion.rtsl", SHADERS)
        self.write("flat.obj", FLAT)
        self.write("bent.obj", BENT)

    def render(self, scene, *options):
        return self.render_scene(scene, *options)[0]

    def difference(self, first, second):
        said, _ = self.run_rtslc("compare", first, second, "--json", status=None)
        return json.loads(said)["rmse"]

    def mistakes(self, scene):
        return self.diagnose("check", self.write("scene.json", json.dumps(scene, indent=1)))


class EveryPath(MotionCase):
    def test_gives_the_same_bits(self):
        expected = self.render(scene())
        for options in (
            ["--trace=recurse"],
            ["--traversal=device"],
            ["--traversal=device", "--trace=recurse", "-O0"],
            ["--target=host-megakernel"],
            ["--keep=all"],
            ["--undefined=nan"],
        ):
            self.assert_same_bits(self.render(scene(), *options), expected, options)

    def test_gives_the_same_bits_along_paths(self):
        lit = scene()
        lit["import"] = ["Motion.rtsl", "std.materials.Emitter", "std.materials.Lambert"]
        lit["materials"] = {
            "paint": {"class": "Lambert"},
            "glow": {"class": "Emitter", "radiance": [4, 3, 2]},
        }
        lit["nodes"]["lamp"] = {**BALL, "material": "glow", "transform": TURNING}
        lit["nodes"]["flag"] = {"mesh": {"keys": ["flat.obj", "bent.obj"]}, "material": "glow"}
        lit["nodes"]["world"]["children"] += [
            "lamp",
            {
                "child": "flag",
                "transform": {
                    "keys": [
                        {"scale": 0.5, "translate": [3, -2, 2]},
                        {"scale": 1, "translate": [3, -3, 2]},
                    ]
                },
            },
        ]
        lit["render"]["engine"] = "path"
        expected = self.render(lit)
        for options in (
            ["--trace=recurse"],
            ["--traversal=device"],
            ["--target=host-megakernel"],
            ["--keep=all"],
        ):
            self.assert_same_bits(self.render(lit, *options), expected, options)

    def test_points_vectors_and_normals_find_back_to_object_space(self):
        """The ball is a ball there, and its normals are, below every transform and at every
        time."""
        self.write(
            "Spaces.rtsl",
            """
            class Spaces : rt_Material {
              bool near(vec3 a, vec3 b) { return distance(a, b) < 1e-4; }
              void shade() {
                vec3 p = pointToObject(rt_HitPoint), n = (p - vec3(0.5, 0.0, 0.0)) / 0.8;
                vec3 along = cross(n, vec3(0.6, 0.0, 0.8));
                bool points = near(p - n * 0.8 / length(n), vec3(0.5, 0.0, 0.0)) && near(pointToWorld(p), rt_HitPoint);
                bool vectors = near(vectorToWorld(along), pointToWorld(p + along) - rt_HitPoint)
                    && near(vectorToObject(vectorToWorld(along)), along);
                bool normals = near(normalize(normalToObject(rt_GeometricNormal)), n)
                    && near(normalize(normalToWorld(n)), rt_GeometricNormal)
                    && abs(dot(normalToWorld(n), vectorToWorld(along))) < 1e-4;
                rt_SampleColor = color(1.0, points && vectors && normals ? 1.0 : 0.0, 0.5 + 0.5 * sin(8.0 * p.y));
              }
            };""",
        )
        moving = scene(materials={"paint": {"class": "Spaces"}}, background=0)
        moving["import"].append("Spaces.rtsl")
        nodes = moving["nodes"]
        nodes["turning"]["children"] = [
            "ball",
            {"child": "ball", "transform": {"scale": [-2, 1, 0.5], "translate": [2, 0, 0]}},
        ]
        nodes["sheared"]["child"] = "ball"
        nodes["chosen"]["children"] = ["ball", "ball"]
        nodes["world"]["children"].remove("strip")
        picture = self.render(moving)
        said, _ = self.run_rtslc("compare", picture, picture, "--json")
        hit, right, _ = json.loads(said)["means"][0]
        self.assertGreater(hit, 0.05)
        self.assertEqual(right, hit)
        for options in (
            ["--trace=recurse"],
            ["--traversal=device"],
            ["--target=host-megakernel"],
            ["--keep=all"],
        ):
            self.assert_same_bits(self.render(moving, *options), picture, options)

    def test_what_a_scene_does_not_have_is_left_out(self):
        parts = {
            "transforms",
            "linear parts of transforms",
            "rotations and shears of transforms",
            "scales of transforms",
            "uneven scales and shears of transforms",
            "motion",
            "mesh keys",
            "shutter",
        }
        plain = scene({"one": {"mesh": "flat.obj", "material": "paint"}}, root="one")
        timed = scene(
            {"one": {"mesh": "flat.obj", "material": "paint"}},
            root="one",
            render={"shutter": [0, 0.5]},
        )
        for one, needed in ((scene(), parts | {"selectors"}), (plain, set()), (timed, {"shutter"})):
            path = self.write("scene.json", json.dumps(one))
            self.assertEqual(self.graph_parts(path), needed)


class Times(MotionCase):
    def frozen(self, time, nodes, **more):
        return scene(
            nodes, root="one", **more, render={"size": [48, 32], "spp": 4, "shutter": [time, time]}
        )

    def test_rays_see_the_scene_at_their_time(self):
        """A picture with the shutter at a time is that of a scene at rest, as far as roundings
        go."""

        def at(time):
            """The ball of `moving`, at rest."""
            degrees = 720 * time
            return {
                "one": {
                    **BALL,
                    "transform": {"rotate": [0, 0, degrees], "translate": [2 * time, -time, 0]},
                }
            }

        moving = {
            "one": {
                **BALL,
                "transform": {
                    "keys": [
                        {"rotate": [0, 0, 0]},
                        {"rotate": [0, 0, 720], "translate": [2, -1, 0]},
                    ]
                },
            }
        }
        for time in (0, 0.25, 0.7, 1):
            still, frozen = self.frozen(time, at(time)), self.frozen(time, moving)
            self.assertLess(self.difference(self.render(frozen), self.render(still)), 1e-3, time)
        self.assertGreater(
            self.difference(
                self.render(self.frozen(0.2, moving)), self.render(self.frozen(0.6, moving))
            ),
            0.03,
        )

    def test_a_mesh_is_between_its_keys(self):
        halfway = (
            "\n".join(
                " ".join(
                    ["v"]
                    + [str((float(x) + float(y)) / 2) for x, y in zip(a.split()[1:], b.split()[1:])]
                )
                for a, b in zip(FLAT.splitlines()[:4], BENT.splitlines()[:4])
            )
            + "\nf 1 2 3\nf 1 3 4\n"
        )
        self.write("half.obj", halfway)
        moving = {"one": {"mesh": {"keys": ["flat.obj", "bent.obj"]}, "material": "paint"}}
        still = {"one": {"mesh": "half.obj", "material": "paint"}}
        self.assert_same_bits(
            self.render(self.frozen(0.5, moving)), self.render(self.frozen(0.5, still))
        )

    def test_blur_is_the_mean_over_time(self):
        """A bright square that crosses a quarter of the picture is seen there for a share of the
        time."""
        self.write(
            "Glow.rtsl", "class Glow : rt_Material; void shade() { rt_SampleColor = color(1.0); }"
        )
        moving = scene(
            {
                "one": {
                    "mesh": "flat.obj",
                    "material": "glow",
                    "transform": {"keys": [{"translate": [-4, 0, 0]}, {"translate": [4, 0, 0]}]},
                }
            },
            root="one",
            background=0,
            materials={"glow": {"class": "Glow"}},
            render={"size": [32, 32], "spp": 64},
        )
        moving["import"].append("Glow.rtsl")
        picture = self.render(moving)
        said, _ = self.run_rtslc("compare", picture, picture, "--json")
        mean = sum(json.loads(said)["means"][0]) / 3
        # The plane z = 0 is seen from -7.2 to 7.2: the square always covers 2 x 2 of 14.4 x 14.4.
        self.assertAlmostEqual(mean, 4 / 14.4**2, delta=0.03 * 4 / 14.4**2)

    def test_without_motion_the_time_is_zero_unless_there_is_a_shutter(self):
        self.write(
            "Clock.rtsl", "class Clock : rt_Miss; void miss() { rt_SampleColor = color(rt_Time); }"
        )
        base = scene(
            {
                "one": {
                    "mesh": "flat.obj",
                    "material": "paint",
                    "transform": {"translate": [99, 0, 0]},
                }
            },
            root="one",
            background={"class": "Clock"},
        )
        base["import"].append("Clock.rtsl")
        for shutter, expected in ((None, 0), ([0, 1], 0.5), ([0.25, 0.5], 0.375), ([1, 1], 1)):
            render = {"size": [32, 32], "spp": 16, **({"shutter": shutter} if shutter else {})}
            picture = self.render({**base, "render": render})
            said, _ = self.run_rtslc("compare", picture, picture, "--json")
            self.assertAlmostEqual(
                json.loads(said)["means"][0][0], expected, delta=0.002, msg=str(shutter)
            )


class Mistakes(MotionCase):
    def of_transform(self, transform):
        return self.mistakes(
            scene(
                {"one": {"mesh": "flat.obj", "material": "paint", "transform": transform}},
                root="one",
            )
        )

    def test_of_keys(self):
        a, b = {"translate": [0, 0, 0]}, {"translate": [1, 0, 0]}
        matrix = {"matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
        half_turn = {"matrix": [-1, 0, 0, 0, 0, -1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]}
        for transform, part in (
            ({"keys": [a]}, "needs at least two keys"),
            ({"keys": []}, "needs at least two keys"),
            ({"keys": 3}, "is a list"),
            ({"keys": [a, b], "times": [0]}, "the number of times is 1, and that of keys is 2"),
            ({"keys": [a, b], "times": [0.5, 0.5]}, "0.5 is not after 0.5"),
            ({"keys": [a, b], "times": [0.5, 0.25]}, "0.25 is not after 0.5"),
            (
                {"keys": [a, b], "times": [0, 1.5]},
                "from 0 to 1, not 1.5",
            ),
            ({"keys": [a, b], "times": [-1, 0]}, "not -1"),
            ({"keys": [a, b], "time": [0, 1]}, "has no key `time`"),
            ({"keys": [a, [b]]}, "a key must be one transform"),
            ({"keys": [a, {"keys": [a, b]}]}, "a key must be one transform"),
            ({"keys": [a, matrix]}, "the keys of a transform must all be matrices or none"),
            ({"keys": [a, {"rotate": {"quaternion": [0, 0, 0, 0]}}]}, "a quaternion of length 0"),
            ({"keys": [a, {"scale": [1, 0, 1]}]}, "flattens"),
            ({"keys": [matrix, half_turn]}, "this transform flattens `one`"),
        ):
            messages = self.of_transform(transform)
            self.assertEqual(len(messages), 1, (transform, messages))
            self.assertIn(part, messages[0]["message"], transform)

    def test_of_meshes(self):
        self.write("more.obj", FLAT + "v 2 2 2\nf 2 3 5\n")
        self.write("turned.obj", FLAT.replace("f 1 2 3", "f 1 3 2"))

        def of_mesh(keys, **more):
            return self.mistakes(
                scene({"one": {"mesh": {"keys": keys, **more}, "material": "paint"}}, root="one")
            )

        for keys, part in (
            (["flat.obj", "more.obj"], "has 5 vertices, but the first key of its object"),
            (["flat.obj", "turned.obj"], "does not have the triangles of the first key"),
            (["flat.obj", "none.obj"], "cannot read mesh"),
            (["flat.obj"], "needs at least two keys"),
            (["flat.obj", 2], "a key of a mesh"),
        ):
            messages = of_mesh(keys)
            self.assertEqual(len(messages), 1, (keys, messages))
            self.assertIn(part, messages[0]["message"])
        second = self.mistakes(
            scene(
                {"one": {"mesh": {"keys": ["flat.obj", "more.obj"]}, "material": "paint"}},
                root="one",
            )
        )
        text = (self.folder / "scene.json").read_text().splitlines()
        self.assertIn("more.obj", text[second[0]["range"]["begin"]["line"] - 1])

    def test_a_mesh_that_is_written_in_another_way(self):
        keys = [{"time": 0, "file": "flat.obj"}, {"time": 0.25, "file": "bent.obj"}]
        flag = '"keys": ["flat.obj", "bent.obj"]'
        for mesh, what, note in (
            (keys, "not a list", f'write `"mesh": {{{flag}, "times": [0, 0.25]}}`'),
            (["flat.obj", {"file": "bent.obj"}], "not a list", f'write `"mesh": {{{flag}}}`'),
            ({"file": "flat.obj"}, "not an object", 'write `"mesh": "flat.obj"`'),
            (["flat.obj", 2], "not a list", None),
        ):
            node = {"mesh": mesh, "material": "paint"}
            for place in (
                scene({"one": node}, root="one"),
                scene({"one": {"children": [node]}}, root="one"),
                scene({"one": BALL}, root="one", objects=[node]),
            ):
                messages = self.mistakes(place)
                self.assertEqual(len(messages), 1, (mesh, messages))
                self.assertIn("`mesh` is the path of a file, or ", messages[0]["message"])
                self.assertIn(what, messages[0]["message"])
                self.assertEqual(messages[0].get("notes", []), [note] if note else [], mesh)

    def test_of_the_shutter(self):
        for shutter, part in (
            ([0.5], "`shutter`"),
            ([0.5, 0.25], "when it opens, and when it closes"),
            ([0, 2], "from 0 to 1"),
            ("open", "`shutter`"),
        ):
            messages = self.mistakes(scene(render={"shutter": shutter}))
            self.assertEqual(len(messages), 1, messages)
            self.assertIn(part, messages[0]["message"])


if __name__ == "__main__":
    unittest.main()
