"""examples/line-of-sight and examples/photons: the same bits on every path, and what must hold of
their results."""

import json
import shutil
import unittest

from harness import EXAMPLES, Case
from numpy_files import read_npy
from output_case import PATHS


class QueryExamples(Case):
    def copy(self, name):
        shutil.copytree(EXAMPLES / name, self.folder, dirs_exist_ok=True)

    def test_line_of_sight(self):
        self.copy("line-of-sight")
        first = None
        for way, options in PATHS.items():
            self.run_rtslc(
                "run",
                "city.json",
                "-q",
                "--set",
                "render.size=[97, 89]",
                "-o",
                "map.exr",
                "--out=visible=v.npy",
                "--out=nearest=n.npy",
                "--out=places=p.csv",
                *options,
            )
            files = [
                (self.folder / name).read_bytes() for name in ("map.exr", "v.npy", "n.npy", "p.csv")
            ]
            first = first or files
            self.assertEqual(files, first, way)
        shape, visible = read_npy(self.folder / "v.npy")
        _, nearest = read_npy(self.folder / "n.npy")
        places = [int(line) for line in (self.folder / "p.csv").read_text().split()]
        self.assertEqual(shape, (89, 97))
        self.assertEqual(sum(visible), sum(places))
        self.assertGreater(max(visible), 3)
        self.assertTrue(
            all((count == 0) == (distance == -1) for count, distance in zip(visible, nearest))
        )
        self.assertTrue(
            all(0 < distance <= 400 for count, distance in zip(visible, nearest) if count)
        )

    def test_line_of_sight_of_other_masts(self):
        self.copy("line-of-sight")
        # One far above everything within reach sees all streets, one inside of a house nothing.
        house = json.loads((self.folder / "city.json").read_text())["objects"][0]["primitive"]
        x, height, z = (0.5 * (a + b) for a, b in zip(house["low"], house["high"]))
        self.write("others.csv", f"x,height,z\n217,300,217\n{x},{height},{z}\n")
        self.run_rtslc(
            "run",
            "city.json",
            "-q",
            "--set",
            "render.size=[60, 60]",
            "--set",
            "rayGeneration.reach=1000",
            "--in=masts=others.csv",
            "--out=places=p.csv",
            "--out=visible=v.npy",
        )
        places = [int(line) for line in (self.folder / "p.csv").read_text().split()]
        self.assertGreater(places[0], 800)
        self.assertEqual(places[1:], [0] * 7)

    def test_photons(self):
        """The lists of the grid depend on the threads; the picture does not."""
        self.copy("photons")
        count = 30000
        small = [
            f"--set=buffers.{name}={json.dumps({'size': [3 * count]})}"
            for name in ("places", "channels", "next")
        ]
        small += [
            f"--set=passes.0.size=[{count}]",
            "--set=passes.2.size=[80, 56]",
            "--set=passes.2.spp=1",
            "--set=passes.2.rayGeneration.nearest=8",
            "--set=passes.2.rayGeneration.cells=64",
            "--set=passes.1.rayGeneration.cells=64",
            '--set=buffers.first={"size": [4096]}',
        ]
        _, error = self.run_rtslc("run", "photons.json", "-q", *small, "--set=passes.0.depth=2")
        self.assertRegex(error, "W2866.* give a larger `depth` in the scene file")
        first = None
        for way, options in PATHS.items():
            if "--exceptions" in options:
                continue  # paths deeper than the limit end there with another color
            self.run_rtslc(
                "run",
                "photons.json",
                "-q",
                "-Wno-all",
                *small,
                "-o",
                "p.exr",
                "--out=places=places.npy",
                *options,
            )
            files = [(self.folder / name).read_bytes() for name in ("p.exr", "places.npy")]
            first = first or files
            self.assertEqual(files, first, way)
        _, places = read_npy(self.folder / "places.npy")
        self.assertTrue(all(abs(height) < 1e-5 for height in places[1::3]))


if __name__ == "__main__":
    unittest.main()
