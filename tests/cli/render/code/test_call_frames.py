"""Methods that trace and are called through references: recursion of objects, with frames of its
own on the machine."""

import json
import unittest

from harness import EXAMPLES, Case

SHADERS = EXAMPLES.parent / "tests/cpp/scenes/Chains.rtsl"

WAYS = (
    ["--trace=recurse", "--traversal=device"],
    ["--trace=split", "--traversal=device"],
    ["--target=host-megakernel"],
)


class CallFrames(Case):
    def setUp(self):
        super().setUp()
        self.write("shaders.rtsl", SHADERS.read_text())

    def scene(self, chain, depth=3, rounds=2, branches=True):
        """Tints in a chain of this length, the last with a filter that only traces inside."""
        textures = {"t0": {"class": "Filter"}}
        for i in range(1, chain + 1):
            textures[f"t{i}"] = {
                "class": "Tint",
                "inner": f"t{i - 1}",
                "others": [f"t{max(i - 2, 0)}" if branches else "t0", "t0"],
                "rounds": rounds,
            }
        scene = {
            "rtsl": 1,
            "import": ["shaders.rtsl", str(EXAMPLES / "glass" / "Sphere.rtsl")],
            "camera": {"class": "Eye"},
            "textures": textures,
            "materials": {"mirror": {"class": "Mirror", "filter": f"t{chain}"}},
            "objects": [
                {
                    "primitive": {"class": "Sphere", "center": [0, 0, 4], "radius": 2},
                    "material": "mirror",
                },
                {
                    "primitive": {"class": "Sphere", "center": [3, 2, 0], "radius": 1},
                    "material": "mirror",
                },
            ],
            "background": {"class": "Sky", "filter": "t0"},
            "render": {"engine": "classic", "size": [8, 8], "spp": 1, "depth": depth},
        }
        self.write("scene.json", json.dumps(scene))

    def test_engines_agree(self):
        for chain, depth in ((0, 2), (3, 2), (4, 1)):
            self.scene(chain, depth)
            for i, way in enumerate(WAYS):
                self.run_rtslc("render", "scene.json", "-o", f"{i}.exr", *way)
                self.assert_same_bits("0.exr", f"{i}.exr")

    def test_a_long_chain(self):
        self.scene(40, 0, rounds=1, branches=False)
        for i, way in enumerate(WAYS):
            self.run_rtslc("render", "scene.json", "-o", f"{i}.exr", *way)
            self.assert_same_bits("0.exr", f"{i}.exr")

    def test_no_object_does_nothing_whatever_is_left_out(self):
        self.write("nothing.rtsl", (SHADERS.parent / "Nothing.rtsl").read_text())
        self.write(
            "scene.json",
            json.dumps(
                {
                    "rtsl": 1,
                    "import": [
                        "nothing.rtsl",
                        str(EXAMPLES / "glass" / "Sphere.rtsl"),
                        str(EXAMPLES / "glass" / "PinholeCamera.rtsl"),
                    ],
                    "camera": {
                        "class": "PinholeCamera",
                        "constructor": [
                            [0, 0, 6],
                            [0, 1, 0],
                            [0, 0, -1],
                            [-0.5, -0.5],
                            [0.5, 0.5],
                            1,
                        ],
                    },
                    "textures": {"filter": {"class": "Filter"}, "half": {"class": "Scale"}},
                    "materials": {
                        "mirror": {
                            "class": "Mirror",
                            "filter": "filter",
                            "scales": ["half", "half"],
                        }
                    },
                    "objects": [
                        {
                            "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 1.5},
                            "material": "mirror",
                        }
                    ],
                    "background": {"class": "Sky"},
                    "render": {"engine": "classic", "size": [16, 16], "spp": 1, "depth": 2},
                }
            ),
        )
        for i, way in enumerate([*WAYS, ["--keep=all"], ["--keep=all", *WAYS[1]]]):
            self.run_rtslc("render", "scene.json", "-o", f"{i}.exr", *way)
            self.assert_same_bits("0.exr", f"{i}.exr")
        said = self.run_rtslc("explain", "scene.json", "--no-savings")[0]
        self.assertIn("`Filter`, or no object", said)

    def test_a_package_holds_them(self):
        self.scene(3, 2)
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg")
        self.run_rtslc("render", "scene.json", "-o", "0.exr", "--target=host-megakernel")
        self.run_package("x.rtslpkg", "-o", "1.exr", "--target=host")
        self.assert_same_bits("0.exr", "1.exr")

    def test_the_bound_of_the_stack_counts_them(self):
        self.scene(3, 2)
        text, _ = self.run_rtslc("explain", "--states", "scene.json")
        self.assertIn("call of dispatch.Filter.follow at shaders.rtsl:", text)
        self.assertRegex(
            text,
            r"stack: \d+ more bytes for each level and each object in the scene's longest chain of "
            r"references",
        )
        report = json.loads(self.run_rtslc("explain", "--states", "--json", "scene.json")[0])
        [filter_] = [
            function
            for function in report["functions"]
            if function["name"] == "dispatch.Filter.follow"
        ]
        self.assertEqual(
            report["stack"]["levelBytesAReference"], (filter_["frameSize"] + 7) // 8 * 8
        )
        self.assertEqual(
            {trace.get("callee") for trace in filter_["traces"]}, {None, "dispatch.Filter.follow"}
        )

    def test_cpp_is_printed_with_frames(self):
        text, _ = self.run_rtslc("compile", "shaders.rtsl", "--emit=cpp", "--trace=split")
        self.assertIn("struct FollowFrame : FilterRef::Follow {", text)
        self.assertRegex(
            text,
            r"return rtsl::callThen\(rt, frame, Step::Tint_followAfterCall1, "
            r"inner,\s+FilterRef::Follow\{frame.o,",
        )
        self.assertNotIn("rtsl::trace(", text)
        self.assertEqual(text, self.run_rtslc("compile", "shaders.rtsl", "--emit=cpp")[0])
        text, _ = self.run_rtslc("compile", "shaders.rtsl", "--emit=cpp", "--trace=recurse")
        self.assertRegex(text, r"Color follow\(State &rt, .*\) const override")
        self.assertNotIn("enum class Step", text)


if __name__ == "__main__":
    unittest.main()
