"""Objects that hold several primitives."""

import copy
import json
import math
import random
import struct
import unittest

from graph_case import CLUSTER, SHADERS, SQUASHED, GraphCase, balls, scene


class Counts(GraphCase):
    def test_several_primitives_are_found_like_several_objects(self):
        """Nothing but the numbers of primitives and instances may differ."""
        together = {
            "all": balls(*CLUSTER),
            "again": {"child": "all", "transform": SQUASHED},
            "root": {"children": ["all", "again"]},
        }
        each = {f"b{i}": balls(ball) for i, ball in enumerate(CLUSTER)}
        apart = {
            **each,
            "all": {"children": list(each)},
            "again": {"child": "all", "transform": SQUASHED},
            "root": {"children": ["all", "again"]},
        }
        text = SHADERS.read_text().replace("(facing + mark)", "facing")
        self.write("Graph.rtsl", text)
        for traversal in ("embree", "device"):
            first, _ = self.render_scene(scene(together, root="root"), f"--traversal={traversal}")
            second, _ = self.render_scene(scene(apart, root="root"), f"--traversal={traversal}")
            self.assert_same_bits(first, second)

    def test_a_ray_that_leaves_a_primitive_meets_its_neighbours(self):
        """Their t is known to 0.1 only: within that, a ray must not meet the ball that it leaves,
        but must meet others, however they are grouped. Two rays leave each hit, so that the second
        one starts after another ray was traced."""
        self.write(
            "Rough.rtsl",
            """
            class RoughBalls : Balls {
              void intersect() {
                vec4 ball = balls[rt_PrimitiveIndex];
                vec3 o = rt_RayOrigin - ball.xyz;
                float a = dot(rt_RayDirection, rt_RayDirection), b = dot(o, rt_RayDirection) / a;
                float d = ball.w * ball.w - dot(o - b * rt_RayDirection, o - b * rt_RayDirection);
                if (d < 0.0) return;
                if (!hit(-b - sqrt(d / a), 0.1)) hit(-b + sqrt(d / a), 0.1);
              }
            };
            class HowNear : rt_Material {
              vec3 away() { return rt_GeometricNormal + 0.9 * vec3(rand() - 0.5, rand() - 0.5, rand() - 0.5); }
              void shade() {
                rt_SampleColor = rt_Depth > 0 ? color(rt_HitDistance)
                                              : trace(rt_HitPoint, away()) + trace(rt_HitPoint, 2.0 * away());
              }
            };
            """,
        )
        balls = [[0, 0, 0, 1], [1.9, 0, 0, 1], [0, 1.9, 0, 1], [0.95, -1.8, 0, 1]]

        def picture(groups, *options):
            objects = [
                {
                    "primitive": {"class": "RoughBalls", "balls": group},
                    "count": len(group),
                    "material": "near",
                }
                for group in groups
            ]
            return self.render_scene(
                {
                    "rtsl": 1,
                    "import": ["Graph.rtsl", "Rough.rtsl"],
                    "camera": {"class": "Look"},
                    "objects": objects,
                    "materials": {"near": {"class": "HowNear"}},
                    "render": {"size": [48, 36], "spp": 4, "depth": 1},
                },
                *options,
            )[0]

        apart = picture([[ball] for ball in balls])
        for options in (
            (),
            ("--trace=split",),
            ("--traversal=device",),
            ("--target=host-megakernel",),
        ):
            self.assert_same_bits(picture([balls], *options), apart, options)

    def test_the_count_may_be_that_of_a_buffer(self):
        numbers = {"all": balls(*CLUSTER)}
        named = copy.deepcopy(numbers)
        named["all"]["count"] = "balls"
        self.assert_same_picture(scene(numbers, root="all"), scene(named, root="all"))

    def test_fewer_than_the_buffer_holds(self):
        fewer, all = {"all": balls(*CLUSTER)}, {"all": balls(*CLUSTER[:3])}
        fewer["all"]["count"] = 3
        self.assert_same_picture(scene(fewer, root="all"), scene(all, root="all"))

    def test_a_hundred_thousand_primitives_in_a_file(self):
        shuffle = random.Random(1)
        with open(self.folder / "balls.raw", "wb") as file:
            for _ in range(100000):
                file.write(
                    struct.pack(
                        "<4f",
                        *(shuffle.uniform(-6, 6) for _ in range(3)),
                        shuffle.uniform(0.005, 0.03),
                    )
                )
        many = scene(
            {
                "all": {
                    "primitive": {
                        "class": "Balls",
                        "balls": {"buffer": "balls.raw", "shape": [100000]},
                    },
                    "count": "balls",
                    "material": "paint",
                },
                "two": {
                    "children": [
                        "all",
                        {
                            "child": "all",
                            "transform": {"rotate": [0, 40, 0], "translate": [0, 0, -9]},
                        },
                    ]
                },
            },
            root="two",
        )
        first, _ = self.render_scene(many)
        second, _ = self.render_scene(many, "--traversal=device")
        self.assert_same_bits(first, second)

    def test_primitives_of_one_object_shine_like_several_objects(self):
        """Chosen by what each sends out; the mean of the picture is known, and must not depend on
        how they are grouped. (Their emission reads no state, above all no normal, which the density
        of a point on them depends on.)"""
        self.write(
            "Floor.rtsl",
            """
class Floor : rt_Primitive {
  void intersect() {
    float t = -rt_RayOrigin.y / rt_RayDirection.y;
    vec3 p = rt_RayOrigin + t * rt_RayDirection;
    if (abs(p.x) < 50.0 && abs(p.z) < 50.0) hit(t);
  }
  void computeBounds() { rt_BoundMin = vec3(-50.0, 0.0, -50.0); rt_BoundMax = vec3(50.0, 0.0, 50.0); }
  void computeNormal() { rt_GeometricNormal = vec3(0.0, 1.0, 0.0); }
};
class Under : rt_Camera {
  void generateRay() { rt_RayOrigin = vec3(0.0, 0.2, 0.0); rt_RayDirection = vec3(0.01 * rt_ScreenCoord.x, -1.0, 0.01 * rt_ScreenCoord.y); }
};
""",
        )
        lamps = [[-2, 3, 0, 0.2], [2, 2, 1, 0.4], [0, 4, -2, 0.1], [1, 1.5, -1, 0.05]]
        floor = {
            "primitive": {"class": "Floor"},
            "material": {"class": "Lambert", "reflectance": 1},
        }

        def lit(nodes, children):
            nodes = {**nodes, "root": {"children": [*children, floor]}}
            return scene(
                nodes,
                root="root",
                camera={"class": "Under"},
                background=0,
                variables={},
                materials={"paint": {"class": "Paint", "tint": [8, 8, 8]}},
                render={"engine": "path", "size": [16, 16], "spp": 256, "depth": 1},
                **{"import": ["Graph.rtsl", "Floor.rtsl", "std.materials"]},
            )

        together = lit({"lamps": balls(*lamps, transform={"scale": 1.25})}, ["lamps"])
        apart = lit(
            {f"l{i}": balls(lamp, transform={"scale": 1.25}) for i, lamp in enumerate(lamps)},
            [f"l{i}" for i in range(4)],
        )
        # A sphere of radiance L under the angle asin(r / d) lights a white floor by L (r / d)^2
        # cos(theta).
        distances = [math.hypot(*lamp[:3]) for lamp in lamps]
        exact = sum(8 * (lamp[3] / d) ** 2 * lamp[1] / d for lamp, d in zip(lamps, distances))
        for one in (together, apart):
            self.assertAlmostEqual(self.mean_of(self.render_scene(one)[0]) / exact, 1, delta=0.02)

    def test_mistakes(self):
        def one(**more):
            return scene({"all": {**balls(*CLUSTER), **more}}, root="all")

        self.assert_message(self.mistakes(one(count=0)), "E0805", "`count`")
        self.assert_message(
            self.mistakes(one(count=2**31 - 1)), "E1001", "not enough memory for the 2147483647"
        )
        self.assert_message(self.mistakes(one(count="ball")), "E0806", "no buffer `ball`")
        self.assertEqual(self.mistakes(one(count="ball"))[0]["fixes"][0]["replacement"], "balls")
        empty = one(count="balls")
        empty["nodes"]["all"]["primitive"]["balls"] = []
        self.assert_message(self.mistakes(empty), "E0805", "is empty")
        mesh = scene({"all": {"mesh": "a.obj", "material": "paint", "count": 3}}, root="all")
        attribute, count = self.mistakes(mesh)  # the material is for balls
        self.assert_message([attribute], "E0704", "`spot`")
        self.assert_message([count], "E0802", "a mesh has its triangles")
        broken = one()
        broken["nodes"]["all"]["primitive"]["balls"][3][3] = -1
        path = self.write("scene.json", json.dumps(broken, indent=1))
        self.assert_message(
            self.diagnose("check", path), "E0816", "primitive 3 of `all` are inverted"
        )


if __name__ == "__main__":
    unittest.main()
