"""Random scenes of the standard library: every way to render one gives the same bits."""

import json
import random
import re
import unittest
from pathlib import Path

from harness import EXAMPLES, Case, deep
from random_scenes import Library, RandomScene, classes_of, files

LIBRARY = EXAMPLES.parent / "library" / "std"
WAYS = (
    ["-O2"],
    ["-O3", "--trace=split"],
    ["-O2", "--target=host-megakernel"],
    ["-O1", "--target=host-megakernel", "--organisation=wavefront", "--light-kernels=always"],
    ["-O2", "--target=host-megakernel", "--organisation=persistent"],
    ["-O0", "--undefined=nan"],
    ["-O1", "--traversal=device", "--trace=split", "--undefined=bytes"],
    ["-O0", "--keep=all"],
)
# With the values of all classes in records instead of the code.
WAYS_OF_RECORDS = (["-O2"], ["-O2", "--target=host-megakernel"], ["-O3", "--trace=split"])


class RandomScenes(Case):
    def setUp(self):
        super().setUp()
        for name, content in files().items():
            self.write(name, content)
        # Of the library the files are read whose classes are mentioned, in a comment, too.
        names = sorted(file.stem for file in LIBRARY.glob("*/*.rtsl"))
        self.write("all.rtsl", f"import std;\n// {' '.join(names)}\n")
        self.library = Library(self.run_rtslc("compile", "all.rtsl", "--emit=reflection")[0], names)

    def ways(self, scene):
        editable = "--set=render.editable=" + json.dumps(sorted(classes_of(scene)))
        return [*WAYS, *([*way, editable] for way in WAYS_OF_RECORDS)]

    def render(self, scene, *way):
        # Random values are not always sensible; what is said of them is not compared.
        return self.render_scene(scene, "-q", "-Wno-scene", *way)[0]

    def assert_same(self, seed, count=None):
        """Compares all ways, or so many, chosen at random."""
        scene = RandomScene(self.library, seed).scene()
        expected = self.render(scene, "-O0")
        ways = self.ways(scene)
        for way in random.Random(seed).sample(ways, count or len(ways)):
            self.assert_same_bits(self.render(scene, *way), expected, (seed, way))

    def test_every_way_gives_the_same_bits(self):
        for seed in range(1, 3):
            with self.subTest(seed=seed):
                self.assert_same(seed, 2)

    def assert_finite(self, seed):
        """No class makes a number infinite or NaN of values that its ranges allow, but to report
        what only the sample shows, such as a negative color."""
        scene = RandomScene(self.library, seed).scene()
        _, said = self.render_scene(scene, "-q", "-Wno-scene", "-O0", "--size=24x24", "--spp=8")
        for file, line in re.findall(r"\bsince (.+):(\d+):\d+$", said, re.M):
            self.assertIn("sqrt(-1.0)", Path(file).read_text().split("\n")[int(line) - 1], seed)

    def test_numbers_are_finite(self):
        for seed in range(5000, 5009):
            with self.subTest(seed=seed):
                self.assert_finite(seed)

    def test_every_class_of_the_library_takes_part(self):
        scenes = [RandomScene(self.library, seed).scene() for seed in range(300)]
        taken = set().union(*map(classes_of, scenes))
        for base in ("rt_Camera", "rt_Primitive", "Scatterer", "rt_Light", "rt_Miss", "Pattern"):
            self.assertEqual(set(self.library.derived_from(base)) - taken, set())

    @deep
    def test_many_on_all_ways(self):
        for seed in range(1000, 1100):
            with self.subTest(seed=seed):
                self.assert_same(seed)

    @deep
    def test_many_numbers_are_finite(self):
        for seed in range(40000, 40500):
            with self.subTest(seed=seed):
                self.assert_finite(seed)


if __name__ == "__main__":
    unittest.main()
