"""Scenes with nodes, for tests of the scene graph."""

import json
import shutil

from harness import EXAMPLES, Case

SHADERS = EXAMPLES.parent / "tests" / "cpp" / "scenes" / "Graph.rtsl"
CLUSTER = [[0, 0, 0, 1], [1.2, 0, 0, 0.5], [-1.2, 0, 0, 0.5], [0, 1.2, 0, 0.5], [0, -1.2, 0, 0.4]]
SQUASHED = {"scale": [0.5, 1.5, 1], "rotate": [20, 30, 0], "translate": [4, 0, 0]}


def balls(*all, **more):
    return {
        "primitive": {"class": "Balls", "balls": [list(ball) for ball in all]},
        "count": len(all),
        "material": "paint",
        **more,
    }


def scene(nodes=None, **more):
    """A scene of all features, or of these nodes."""
    result = {
        "rtsl": 1,
        "import": ["Graph.rtsl"],
        "camera": {"class": "Look"},
        "background": [0.1, 0.1, 0.2],
        "materials": {"paint": {"class": "Paint"}},
        "nodes": nodes
        or {
            "cluster": balls(*CLUSTER),
            "one": balls([0, 0, 0, 1.5]),
            "lod": {"selector": {"class": "Near", "limit": 14.6}, "children": ["cluster", "one"]},
            "dice": {
                "selector": {"class": "Chance"},
                "children": ["cluster", "one", {"child": "one", "transform": {"scale": 0.5}}],
            },
            "world": {
                "children": [
                    {"child": "cluster", "id": 7},
                    {
                        "child": "cluster",
                        "transform": SQUASHED,
                        "variables": {"tint": [0.2, 0.9, 0.3]},
                        "id": -2,
                    },
                    {"child": "lod", "transform": {"translate": [-4, 0, 0]}},
                    {
                        "child": "lod",
                        "transform": {"translate": [-4, 0, -6]},
                        "variables": {"tint": [0.9, 0.5, 0.1]},
                    },
                    {
                        "selector": {"class": "Some", "mask": 6},
                        "children": [{"child": "one", "transform": {"scale": 100}}, "far", "dice"],
                        "transform": {"translate": [3, 2, -4]},
                    },
                ]
            },
            "far": {"child": "lod", "transform": {"translate": [0, 2, 0]}},
        },
        "root": "world",
        "variables": {"shine": 0.5},
        "render": {"size": [48, 32], "spp": 4, "depth": 3},
    }
    result.update(more)
    return result


class GraphCase(Case):
    level = "-O0"

    def setUp(self):
        super().setUp()
        shutil.copy(SHADERS, self.folder)

    def mean_of(self, picture):
        said, _ = self.run_rtslc("compare", picture, picture, "--json")
        return sum(json.loads(said)["means"][0]) / 3

    def assert_same_picture(self, first, second):
        self.assert_same_bits(self.render_scene(first)[0], self.render_scene(second)[0])

    def mistakes(self, scene, *options):
        path = self.write("scene.json", json.dumps(scene, indent=1))
        return self.diagnose("check", path, *options)
