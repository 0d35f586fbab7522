"""rtslc explain --gpu: what a scene's program costs a GPU, by the driver, by ptxas, or neither."""

import json
import re
import shutil
import unittest

from harness import EXAMPLES, RTSLC, USAGE, Case

PTXAS = shutil.which("ptxas") or shutil.which("/usr/local/cuda/bin/ptxas")
SCENE = EXAMPLES / "metal" / "scene.json"


class ExplainGpu(Case):
    level = None  # the figures are those of optimised code

    def test_by_the_driver(self):
        """Each state has a row, with the names of --lane-use."""
        text, _ = self.run_with_fake_driver([RTSLC, "explain", "--gpu", SCENE])
        self.assertIn("assembled by the driver of Fake 1000", text)
        self.assertRegex(text, r"(?m)^  megakernel +\d+ +40 +8 +40 +38 %$")
        used = json.loads(
            self.run_rtslc(
                *("render", SCENE, "-o", "a.exr", "--target=host-megakernel", "--lane-use"),
                *("--json", "--size=4x4", "--spp=1", "-q"),
            )[0]
        )["steps"]
        self.assertGreater(len(used), 3)
        for step in used:
            self.assertRegex(text, rf"(?m)^  {re.escape(step['step'])}  +\d+")
        self.assertRegex(text, r"Rays that wait for others take \d+ bytes a lane, for a depth of 8")

    @unittest.skipUnless(PTXAS, "ptxas is not installed")
    def test_by_the_assembler(self):
        options = ("--gpu-arch=sm_90", "--max-registers=64", "--json")
        figures = json.loads(self.run_rtslc("explain", "--gpu", SCENE, *options)[0])
        self.assertEqual(figures["architecture"], "sm_90")
        whole, steps = figures["megakernel"], figures["steps"]
        if figures["assembler"] == "ptxas":
            self.assertEqual((whole["registers"], whole["occupancy"]), (64, 0.5))
        for step in (whole, *steps):
            self.assertGreater(step["ptxInstructions"], 20)
            self.assertGreater(step["registers"], 10)
            self.assertTrue(0 < step["occupancy"] <= 1)
        self.assertGreater(figures["laneBytes"], figures["frameBytes"])
        self.assertGreater(figures["recordBytes"], 0)

    def test_bad_combinations(self):
        for arguments, message in (
            ((SCENE, "--gpu", "--states"), "--gpu: cannot be combined with --states"),
            ((SCENE, "--gpu", "--measure"), "--gpu: cannot be combined with"),
            (
                (EXAMPLES / "glass" / "Glass.rtsl", "--gpu"),
                "--gpu: explains the program of a scene",
            ),
            ((SCENE, "--max-registers=80"), "--max-registers: is for --gpu"),
            ((SCENE, "--gpu", "--fp=double"), "--fp: shaders on a GPU compute in single"),
        ):
            with self.subTest(message=message):
                _, error = self.run_rtslc("explain", *arguments, status=USAGE)
                self.assertIn(message, error)


if __name__ == "__main__":
    unittest.main()
