"""Random scenes with nodes: all paths give the same bits, and so does a scene without sharing."""

import unittest

from harness import Case, deep
from random_graphs import Flattening, Graph, files

PATHS = (
    ["--trace=split"],
    ["--traversal=device"],
    ["--traversal=device", "--trace=split"],
    ["--target=host-megakernel"],
    ["--target=host-megakernel", "--organisation=wavefront"],
    ["--keep=all"],
    ["--target=host-megakernel", "--keep=all"],
)


class RandomGraphs(Case):
    def setUp(self):
        super().setUp()
        for name, content in files().items():
            self.write(name, content)

    def assert_twins(self, seed, paths):
        """The twin is rendered on another path, so that both are compared by one rendering."""
        scene = Graph(seed).scene()
        picture, _ = self.render_scene(scene)
        twin = Flattening(scene).twin()
        for options in paths:
            self.assert_same_bits(self.render_scene(twin, *options)[0], picture, (seed, options))

    def test_a_scene_without_sharing_is_the_same(self):
        for seed, options in zip((1, 2, 4, 7, 10), PATHS):
            self.assert_twins(seed, [options])

    @deep
    def test_many_are_the_same_on_all_paths(self):
        for seed in range(100, 160):
            self.assert_twins(seed, PATHS)

    @deep
    def test_what_turns_is_the_same_on_all_paths(self):
        for seed in range(200, 240):
            scene = Graph(seed, turns=True).scene()
            picture, _ = self.render_scene(scene)
            for options in PATHS:
                self.assert_same_bits(
                    self.render_scene(scene, *options)[0], picture, (seed, options)
                )


if __name__ == "__main__":
    unittest.main()
