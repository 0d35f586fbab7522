"""The scene graph beyond instances: selectors, ids, roots, and variables along the graph."""

import json
import shutil
import unittest

from harness import EXAMPLES, GRAPH_ITEMS, deep
from graph_case import CLUSTER, SHADERS, SQUASHED, GraphCase, balls, scene


class EveryPath(GraphCase):
    level = None

    def test_gives_the_same_bits(self):
        expected, _ = self.render_scene(scene())
        for options in (
            ["--trace=recurse"],
            ["--traversal=device"],
            ["--traversal=device", "--trace=recurse"],
            ["-O0"],
            ["--target=host-megakernel"],
            ["--keep=all"],
            ["--target=host-megakernel", "--keep=transforms,counts,selectors,roots,motion,masks"],
        ):
            picture, _ = self.render_scene(scene(), *options)
            self.assert_same_bits(picture, expected, options)

    @deep
    def test_gives_the_same_forest(self):
        shutil.copytree(EXAMPLES / "forest", self.folder, dirs_exist_ok=True)
        first = None
        for number, options in enumerate(
            ([], ["--trace=recurse"], ["--traversal=device"], ["--target=host-megakernel"])
        ):
            self.run_rtslc(
                "render",
                "forest.json",
                "-o",
                f"{number}.exr",
                "--set",
                "render.size=[64, 36]",
                "--spp",
                "1",
                *options,
            )
            first = first or "0.exr"
            self.assert_same_bits(f"{number}.exr", first, options)

    def test_what_a_scene_does_not_have_is_left_out(self):
        parts = {
            "transforms",
            "linear parts of transforms",
            "rotations and shears of transforms",
            "scales of transforms",
            "uneven scales and shears of transforms",
            "counts",
            "selectors",
        }
        plain = scene({"one": balls([0, 0, 0, 1])}, root="one")
        for one, needed in ((scene(), parts), (plain, set())):
            path = self.write("scene.json", json.dumps(one))
            self.assertEqual(self.graph_parts(path), needed)

    def assert_cheaper_form(self, needed, *transforms):
        """A ball with each of these transforms has the bits of the general form, and of the graph
        no other parts than these are needed."""
        placed = scene(
            {
                "ball": balls([0, 0, 0, 1], [0, 1, 0, 0.5]),
                "all": {"children": [{"child": "ball", "transform": one} for one in transforms]},
            },
            root="all",
        )
        path = self.write("scene.json", json.dumps(placed))
        self.assertEqual(self.graph_parts(path), {"transforms", "counts", *needed})
        expected, _ = self.render_scene(placed, "--keep=transforms")
        for options in (
            [],
            ["--traversal=device", "--trace=recurse"],
            ["--target=host-megakernel"],
        ):
            picture, _ = self.render_scene(placed, *options)
            self.assert_same_bits(picture, expected, options)

    def test_scales_have_the_bits_of_all_matrices(self):
        self.assert_cheaper_form(
            {"linear parts of transforms", "scales of transforms"},
            {"scale": 0.7, "translate": [-1, 0, 0]},
            {"scale": [0.3, -1.1, 0.6], "translate": [1, 0, 1]},
        )

    def test_rigid_transforms_have_the_bits_of_all_matrices(self):
        turned = {"rotate": [20, 130, 45], "translate": [-1, 0, 0]}
        turning = {"keys": [{"rotate": [0, 0, 0]}, {"rotate": [0, 170, 0], "translate": [1, 0, 0]}]}
        linear = {"linear parts of transforms", "rotations and shears of transforms"}
        self.assert_cheaper_form(linear, turned, {"translate": [2, 1, 0]})
        self.assert_cheaper_form(
            {*linear, "motion", "shutter"}, [turned, turning, {"translate": [1, 0, 1]}]
        )
        # One scale for all directions, constant in time.
        larger = [{"scale": 1.3}, turned]
        scaled = {*linear, "scales of transforms"}
        self.assert_cheaper_form(scaled, larger, turned, {"scale": 0.2, "translate": [2, 1, 0]})
        self.assert_cheaper_form(
            {*scaled, "motion", "shutter"}, [*larger, turning, {"scale": 0.7}], {"scale": 2}
        )
        uneven = {*scaled, "uneven scales and shears of transforms"}
        # Six digits are no rotation, and neither is what is mirrored.
        rounded = {"matrix": [0.866025, 0, -0.5, 0, 0, 1, 0, 0, 0.5, 0, 0.866025, 0, 0, 0, 0, 1]}
        for other in (rounded, [turned, {"scale": [-1, 1, 1]}]):
            self.assert_cheaper_form(uneven, turned, other)

    def test_each_thing_that_a_scene_does_not_have_can_be_kept(self):
        plain = scene({"one": {**balls([0, 0, 0, 1]), "count": 1}}, root="one", variables={})
        expected, _ = self.render_scene(plain)
        items = (*GRAPH_ITEMS, "buffers", "images", "bindless", "meshes", "mesh-attributes")
        for number, item in enumerate(items):
            options = ["--target=host-megakernel"] if number % 2 else []
            picture, _ = self.render_scene(plain, f"--keep={item}", *options)
            self.assert_same_bits(picture, expected, item)

    def test_what_has_no_mask_is_seen_and_what_has_none_set_is_not(self):
        both = {"a": balls([0, 0, 0, 1]), "b": balls([3, 0, 0, 1])}
        one, _ = self.render_scene(scene({"w": {"children": [both["a"]]}}, root="w"))
        two, _ = self.render_scene(scene({"w": {"children": list(both.values())}}, root="w"))
        self.assertGreater(self.mean_of(two), self.mean_of(one) + 0.005)
        hidden = scene({"w": {"children": [both["a"], {**both["b"], "mask": 0}]}}, root="w")
        path = self.write("scene.json", json.dumps(hidden))
        self.assertIn("masks", self.graph_parts(path))
        for options in (
            [],
            ["--trace=recurse"],
            ["--traversal=device"],
            ["--target=host-megakernel"],
            ["--target=host-megakernel", "--keep=all"],
        ):
            self.assert_same_bits(self.render_scene(hidden, *options)[0], one, options)

    def test_in_double_precision_it_is_nearly_the_same(self):
        expected, _ = self.render_scene(scene())
        picture, _ = self.render_scene(scene(), "--fp=double")
        said, _ = self.run_rtslc("compare", picture, expected, "--json", status=None)
        self.assertLess(json.loads(said)["rmse"], 0.02, said)


class Depth(GraphCase):
    """Graphs of ten thousand nodes below each other."""

    DEPTH = 10000

    def chain(self, **more):
        """Each node has the next one as its child."""
        nodes = {
            f"n{i}": {"child": f"n{i + 1}", **{key: of(i) for key, of in more.items()}}
            for i in range(self.DEPTH)
        }
        nodes[f"n{self.DEPTH}"] = balls([0, 0, 0, 1])
        return nodes

    def test_transforms_add_up(self):
        step = 2**-12  # no sum is rounded
        deep = scene(self.chain(transform=lambda _: {"translate": [step, 0, 0]}), root="n0")
        flat = scene(
            {
                "one": balls([0, 0, 0, 1]),
                "n0": {"child": "one", "transform": {"translate": [self.DEPTH * step, 0, 0]}},
            },
            root="n0",
        )
        self.assert_same_picture(deep, flat)

    def test_the_nearest_variable_of_all_counts(self):
        tints = self.chain(variables=lambda i: {"tint": [i / self.DEPTH, 0.5, 0]})
        last = {"tint": [(self.DEPTH - 1) / self.DEPTH, 0.5, 0]}
        one = {"n0": {"child": "one", "variables": last}, "one": balls([0, 0, 0, 1])}
        self.assert_same_picture(scene(tints, root="n0"), scene(one, root="n0"))

    def test_selectors_below_each_other(self):
        nodes = {
            name: node
            if "primitive" in node
            else {"selector": {"class": "Some", "mask": 1}, "children": [node["child"]]}
            for name, node in self.chain().items()
        }
        self.assert_same_picture(
            scene(nodes, root="n0"), scene({"n0": balls([0, 0, 0, 1])}, root="n0")
        )

    def test_cycles_and_too_many_instances_and_nesting(self):
        nodes = self.chain()
        nodes[f"n{self.DEPTH}"] = {"child": "n0"}
        found = self.mistakes(scene(nodes, root="n0"))
        self.assert_message(found, "E0807", "the node `n0` is below itself: n0 > n1")
        twice = {f"n{i}": {"children": [f"n{i + 1}"] * 2} for i in range(40)}
        twice["n40"] = balls([0, 0, 0, 1])
        self.assert_message(
            self.mistakes(scene(twice, root="n0")), "E0805", "more than 67108864 instances"
        )
        with open("/proc/meminfo") as lines:
            kibibytes = next(int(line.split()[1]) for line in lines if "MemAvailable" in line)
        if kibibytes < 40 << 20:  # these would take 44 GiB
            self.assert_message(
                self.mistakes(scene(twice, root="n14")),
                "E1001",
                "not enough memory for 67108864 instances",
            )
        moving = {"keys": [{"rotate": [0, 0, 0]}, {"rotate": [0, 0, 0.01]}]}
        nodes = self.chain()
        for i in range(1001):
            nodes[f"n{i}"]["transform"] = moving
        self.assert_message(
            self.mistakes(scene(nodes, root="n0")),
            "E0805",
            "1001 transforms that move are above one another; the limit is 1000",
        )
        path = self.write(
            "nested.json", '{"rtsl": 1, "nodes": ' + '{"child": ' * 300 + '"a"' + "}" * 301
        )
        self.assert_message(self.diagnose("check", path), "E0800", "nested deeper than 256 levels")


class Ids(GraphCase):
    def test_the_nearest_one_counts(self):
        by_child = {
            "one": balls(*CLUSTER),
            "root": {"children": [{"child": {"child": "one", "id": 3}, "id": 4}]},
        }
        of_geometry = {
            "one": balls(*CLUSTER, id=3),
            "root": {"children": [{"child": "one", "id": 9}]},
        }
        other = {"one": balls(*CLUSTER, id=4), "root": {"children": ["one"]}}
        self.assert_same_picture(scene(by_child, root="root"), scene(of_geometry, root="root"))
        first, second = (
            self.render_scene(scene(nodes, root="root"))[0] for nodes in (by_child, other)
        )
        self.assertNotEqual(first.read_bytes(), second.read_bytes())

    def test_of_an_object(self):
        plain = scene({"one": balls(*CLUSTER, id=5)}, root="one")
        listed = scene()
        del listed["nodes"], listed["root"]
        listed["objects"] = [balls(*CLUSTER, id=5)]
        self.assert_same_picture(plain, listed)

    def test_a_32_bit_number(self):
        for id in (2**31, -(2**31) - 1, 2**32, 0.5):
            self.assert_message(
                self.mistakes(scene({"one": balls(*CLUSTER, id=id)}, root="one")),
                "E0805",
                "`id` is a whole number",
            )
        for id in (2**31 - 1, -(2**31)):
            self.render_scene(scene({"one": balls(*CLUSTER, id=id)}, root="one"))


class Selectors(GraphCase):
    def test_what_is_visited_is_seen_and_nothing_else(self):
        three = {f"b{i}": balls([2.5 * i - 2.5, 0, 0, 1], id=i) for i in range(3)}
        for mask in (0, 2, 5, 7):
            some = {
                **three,
                "root": {"selector": {"class": "Some", "mask": mask}, "children": list(three)},
            }
            seen = [name for i, name in enumerate(three) if mask >> i & 1]
            plain = {
                **three,
                "root": {
                    "children": seen or [{"child": "b0", "transform": {"translate": [0, 1e4, 0]}}]
                },
            }
            self.assert_same_picture(scene(some, root="root"), scene(plain, root="root"))

    def test_the_origin_is_in_the_space_of_the_node(self):
        """Scaled by 4, the same distance is a quarter."""
        lod = {
            "near": balls([0, 0, 0, 0.25]),
            "away": balls([0, 0, 0, 0.5]),
            "lod": {"selector": {"class": "Near", "limit": 3.6}, "children": ["near", "away"]},
            "root": {"child": "lod", "transform": {"scale": 4}},
        }
        plain = {
            "near": balls([0, 0, 0, 0.25]),
            "root": {"child": "near", "transform": {"scale": 4}},
        }
        # 3.58 units from the node: sqrt(3^2 + 14^2) / 4
        self.assert_same_picture(
            scene(lod, root="root", variables={}), scene(plain, root="root", variables={})
        )

    def test_chance_is_fair_and_the_same_for_every_traversal(self):
        """One child in six, one in six, and two in three: by the mean of many samples."""
        dice = {
            "wall": balls([0, 0, -100, 95]),
            "gone": balls([0, 1e5, 0, 1]),
            "root": {"selector": {"class": "Chance"}, "children": ["gone", "gone2", "wall"]},
            "gone2": balls([0, -1e5, 0, 1]),
        }
        plain = {"root": balls([0, 0, -100, 95])}
        self.write("Graph.rtsl", SHADERS.read_text().replace("(facing + mark)", "1.0"))
        extra = {
            "variables": {"shine": 0},
            "background": 0,
            "render": {"size": [16, 16], "spp": 64, "depth": 0},
        }
        means = []
        for nodes in (dice, plain):
            picture, _ = self.render_scene(scene(nodes, root="root", **extra))
            means.append(self.mean_of(picture))
        self.assertAlmostEqual(means[0] / means[1], 2 / 3, delta=0.02)

    def test_chance_depends_on_no_other_object(self):
        """Neither on records in front of the selector's, nor on their size or what is kept."""
        shaders = SHADERS.read_text()
        larger = shaders.replace("public float shine", "public vec4 more; public float shine")
        self.assertNotEqual(larger, shaders)
        nodes = {
            "one": balls([0, 0, 0, 1.5]),
            "two": balls([0, 1, 0, 0.5]),
            "dice": {"selector": {"class": "Chance"}, "children": ["one", "two", "one"]},
            "world": {"children": ["dice", {"child": "dice", "transform": SQUASHED}]},
        }
        paint = {"paint": {"class": "Paint", "shine": 0.5}}
        before = {"another": {"class": "Paint", "tint": 0.5}}
        alone, more = (
            scene(nodes, root="world", materials=materials, variables={})
            for materials in (paint, {**before, **paint})
        )
        expected, _ = self.render_scene(alone)
        cases = (
            (more, shaders, []),
            (alone, larger, []),
            (alone, larger, ["--keep=all"]),
            (more, larger, ["--target=host-megakernel"]),
            (alone, shaders, ["--keep=all"]),
            (more, shaders, ["--traversal=device", "--trace=recurse"]),
        )
        for number, (one, text, options) in enumerate(cases):
            self.write("Graph.rtsl", text)
            picture, _ = self.render_scene(one, *options)
            self.assert_same_bits(picture, expected, (number, options))

    def test_below_others(self):
        """An instance is seen if all selectors above it say so."""
        one = {"b": balls([0, 0, 0, 1])}
        nothing = scene({"b": balls([0, 1e5, 0, 1])}, root="b")
        for outer, inner in ((1, 1), (1, 2), (2, 1)):
            nested = {
                **one,
                "inner": {"selector": {"class": "Some", "mask": inner}, "children": ["b"]},
                "outer": {"selector": {"class": "Some", "mask": outer}, "children": ["inner"]},
            }
            plain = scene(one, root="b") if outer == inner == 1 else nothing
            self.assert_same_picture(scene(nested, root="outer"), plain)

    def test_mistakes(self):
        def world(**node):
            return scene({"b": balls(*CLUSTER), "root": node}, root="root")

        self.assert_message(
            self.mistakes(world(selector={"class": "Some", "mask": 1}, child="b")),
            "E0802",
            "chooses among `children`",
        )
        self.assert_message(
            self.mistakes(world(selector={"class": "Balls", "balls": []}, children=["b"])),
            "E0811",
            "where a selector is needed",
        )
        self.assert_message(
            self.mistakes(world(selector="paint", children=["b"])),
            "E0811",
            "where a selector is needed",
        )
        self.assert_message(
            self.mistakes(world(selector="pant", children=["b"])), "E0806", "`pant`"
        )
        # What has the name although it is of another kind is shown.
        for node, label in (
            ({"selector": "b", "children": ["b"]}, "a node, not an object"),
            ({"children": ["paint"]}, "one of the `materials`, not a node"),
        ):
            (mistake,) = self.mistakes(world(**node))
            self.assertEqual([one["message"] for one in mistake["labels"]], [label])
        self.assert_message(self.mistakes(world(selector=3, children=["b"])), "E0804", "`selector`")


class Roots(GraphCase):
    @staticmethod
    def with_roots(nodes, roots):
        made = scene(nodes, roots=roots)
        del made["root"]
        return made

    def notes(self, nodes, **roots):
        path = self.write("scene.json", json.dumps(self.with_roots(nodes, roots), indent=1))
        _, told = self.run_rtslc("check", path, "--diagnostics=json")  # status 0
        found = json.loads(told)["diagnostics"]
        lines = path.read_text().splitlines()

        def word_at(range):
            line = lines[range["begin"]["line"] - 1]
            return line[range["begin"]["column"] - 1 :].split('"')[0]

        for note in found:
            self.assertEqual((note["code"], note["severity"]), ("N2802", "note"), found)
        return [
            (
                note["message"],
                word_at(note["range"]),
                [word_at(one["range"]) for one in note["labels"]],
            )
            for note in found
        ]

    def test_what_they_share_is_said(self):
        nodes = {
            "ball": balls(*CLUSTER),
            "both": {"child": "ball"},
            "left": {"children": ["both", "other"]},
            "right": {"children": ["both", "ball", "other"]},
            "other": balls([3, 0, 0, 1]),
        }
        shared = "shared by several roots: `seen`, `shadowing`"
        self.assertEqual(
            self.notes(nodes, seen="left", shadowing="right"),
            [
                (
                    f"`ball` and 2 other nodes are {shared}",
                    "ball",
                    ["seen", "shadowing", "both", "other"],
                )
            ],
        )
        # `ball` is below `both` alone, and a root may be below another.
        nodes["right"] = {"child": "left"}
        self.assertEqual(
            self.notes(nodes, seen="left", shadowing="right"),
            [(f"`left` is {shared}", "left", ["seen", "shadowing"])],
        )
        nodes["right"] = {"child": "other"}
        nodes["left"] = {"child": "both"}
        self.assertEqual(self.notes(nodes, seen="left", shadowing="right"), [])

    def test_it_is_no_warning(self):
        nodes = {"ball": balls(*CLUSTER)}
        path = self.write(
            "scene.json", json.dumps(self.with_roots(nodes, {"a": "ball", "b": "ball"}))
        )
        _, told = self.run_rtslc("check", path, "-Werror")
        self.assertIn("note[N2802]: `ball` is shared by several roots", told)
        _, told = self.run_rtslc("render", path, "-o", "picture.png", "-O0", "-q")
        self.assertEqual(told, "")


if __name__ == "__main__":
    unittest.main()
