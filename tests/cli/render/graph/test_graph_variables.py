"""Variables along the scene graph."""

import copy
import json
import unittest

from graph_case import CLUSTER, SQUASHED, GraphCase, balls, scene


class Variables(GraphCase):
    def test_members_that_nothing_sets(self):
        """An error that lists the nodes whose variables could set it, unless nothing reads it or
        the constructor sets it."""
        self.write(
            "Bare.rtsl",
            "class Bare : rt_Material { public float glow; public rt_Texture grain; public "
            "optional rt_Texture film;\n"
            "  public float dim = 2.0; void shade() { rt_SampleColor = color(glow * dim) * "
            "grain.lookup(); } };\n"
            "class Flat : rt_Texture { public float level; public float unread; void lookup() { "
            "rt_TextureColor = color(level); } };\n"
            "class Made : rt_Texture { public float set; public float kept; public vec2 more; "
            "public vec3 steps[];\n"
            "  void constructor(float x) { set = 2.0 * x; }\n"
            "  void lookup() { rt_TextureColor = color(set + kept + more.x + "
            "float(steps.length())); } };\n",
        )

        def bare(material, **variables):
            nodes = {
                "ball": {**balls([0, 0, 0, 1]), "material": "bare"},
                "row": {"children": ["ball", {"child": "ball", "transform": SQUASHED}]},
                "root": {"child": "row", "variables": variables},
                "unused": {"child": "ball"},
            }
            return scene(
                nodes,
                root="root",
                materials={"bare": {"class": "Bare", **material}},
                textures={"flat": {"class": "Flat"}},
                variables={},
                **{"import": ["Graph.rtsl", "Bare.rtsl"]},
            )

        places = (
            r"a variable of this name in `ball` \(line \d+\), `row` \(line \d+\), "
            r"a node \(line \d+\), `root` \(line \d+\) or the scene"
        )
        for member, given in (
            ("`glow` of `bare`", {"level": 1}),
            ("`level` of `flat`", {"glow": 1}),
        ):
            path = self.write("scene.json", json.dumps(bare({"grain": "flat"}, **given), indent=1))
            error = self.run_rtslc("render", path, "-o", "x.exr", status=1)[1]
            self.assertRegex(
                error,
                r"error\[E0815\]: member "
                + member
                + " is read, but not set and without a default: set it, or "
                + places,
            )
            self.assertEqual(error.count("E0815"), 1, error)
        _, warned = self.render_scene(bare({"grain": "flat"}, glow=0.5, level=0.25))
        self.assertNotIn("is not set", warned)
        made = bare({"glow": 1, "grain": {"class": "Made", "constructor": [1]}})
        del made["textures"]
        messages = self.diagnose("check", self.write("scene.json", json.dumps(made, indent=1)))
        self.assert_message(
            messages,
            "E0815",
            "members `kept`, `more` of `Made` are read, but not set and without a default: set "
            "them",
        )
        path = self.write("scene.json", json.dumps(bare({"glow": 1}), indent=1))
        error = self.run_rtslc("render", path, "-o", "x.exr", status=1)[1]
        self.assertRegex(
            error,
            r"error\[E0815\]: `bare` refers to nothing: set member `grain` of class `Bare`, an "
            r"`rt_Texture`, or " + places,
        )

    def tinted(self, material, **nodes):
        return scene(
            {"b": balls(*CLUSTER), "root": {"children": ["b"]}, **nodes},
            root="root",
            materials={"paint": material},
            variables={},
        )

    def test_the_nearest_definition_counts(self):
        red, green, blue = [1, 0, 0], [0, 1, 0], [0, 0, 1]
        tinted = [
            self.render_scene(self.tinted({"class": "Paint", "tint": c}))[0]
            for c in (red, green, blue)
        ]
        plain = {"class": "Paint"}
        above = {**self.tinted(plain), "variables": {"tint": red}}
        self.assert_same_bits(self.render_scene(above)[0], tinted[0])
        group = {
            **self.tinted(plain, root={"children": ["b"], "variables": {"tint": green}}),
            "variables": {"tint": red},
        }
        self.assert_same_bits(self.render_scene(group)[0], tinted[1])
        geometry = copy.deepcopy(group)
        geometry["nodes"]["b"]["variables"] = {"tint": blue}
        self.assert_same_bits(self.render_scene(geometry)[0], tinted[2])
        own = copy.deepcopy(geometry)
        own["materials"]["paint"]["tint"] = red
        picture, said = self.render_scene(own)
        self.assert_same_bits(picture, tinted[0])
        self.assertIn("no object takes the variable `tint`", said)

    def test_what_an_object_refers_to_takes_them_too(self):
        inner = {"class": "Paint", "inner": {"class": "Paint"}}
        expected = {
            "class": "Paint",
            "tint": [0.2, 0.3, 0.9],
            "inner": {"class": "Paint", "tint": [0.2, 0.3, 0.9]},
        }
        taken = {**self.tinted(inner), "variables": {"tint": [0.2, 0.3, 0.9]}}
        self.assert_same_picture(taken, self.tinted(expected))
        named = {
            **taken,
            "materials": {
                "paint": {"class": "Paint", "inner": "other"},
                "other": {"class": "Paint"},
            },
        }
        self.assert_same_picture(named, self.tinted(expected))

    def test_a_variable_may_be_an_object(self):
        other = {"class": "Paint", "tint": [0, 1, 0]}
        taken = {**self.tinted({"class": "Paint"}), "variables": {"inner": other}}
        self.assert_same_picture(taken, self.tinted({"class": "Paint", "inner": other}))

    def test_primitives_selectors_and_cameras_take_them(self):
        taken = scene(
            {
                "b": {"primitive": {"class": "Balls"}, "count": "balls", "material": "paint"},
                "lod": {
                    "selector": {"class": "Near"},
                    "children": ["b", {"child": "b", "transform": {"scale": 0.3}}],
                },
            },
            root="lod",
            variables={"balls": CLUSTER, "limit": 2, "distance": 9},
        )
        given = scene(
            {
                "b": balls(*CLUSTER),
                "lod": {
                    "selector": {"class": "Near", "limit": 2},
                    "children": ["b", {"child": "b", "transform": {"scale": 0.3}}],
                },
            },
            root="lod",
            variables={},
            camera={"class": "Look", "distance": 9},
        )
        self.assert_same_picture(taken, given)

    def test_where_all_agree_it_is_a_constant(self):
        def explained(nodes):
            path = self.write("scene.json", json.dumps(nodes))
            said, _ = self.run_rtslc("explain", path, "--no-savings", "--json")
            return {f["subject"]: f for item in json.loads(said)["items"] for f in item["entries"]}

        same = {**self.tinted({"class": "Paint"}), "variables": {"tint": [1, 0, 0]}}
        self.assertIn("in the code", explained(same)["Paint.tint"]["reason"])
        two = {
            "children": [
                {"child": "b", "variables": {"tint": [1, 0, 0]}},
                {"child": "b", "variables": {"tint": [0, 1, 0]}},
            ]
        }
        self.assertTrue(
            explained(self.tinted({"class": "Paint"}, root=two))["Paint.tint"]["needed"]
        )

    def test_mistakes(self):
        wrong = {**self.tinted({"class": "Paint"}), "variables": {"tint": "red"}}
        messages = self.mistakes(wrong)
        self.assertIn(
            "the variable `tint`, which member `tint` of `paint` takes,", messages[0]["message"]
        )
        self.assert_message(
            self.mistakes(
                self.tinted({"class": "Paint"}, root={"children": ["b"], "variables": 3})
            ),
            "E0804",
            "`variables`",
        )
        untaken = {**self.tinted({"class": "Paint"}), "variables": {"tinte": 3}}
        self.assertIn("no object takes the variable `tinte`", self.render_scene(untaken)[1])


if __name__ == "__main__":
    unittest.main()
