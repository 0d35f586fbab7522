"""Samplers: the same bits everywhere, the same picture with less noise, and no trace of it
without."""

import json
import unittest

from harness import EXAMPLES, USAGE, Case, deep

SIZE = ("--size", "40x30")
CONSTANT = 0x65766E73  # of the hash of evenly spread numbers


class Samplers(Case):
    scene = EXAMPLES / "cornell" / "room.json"

    def render(self, name, *options, scene=scene):
        self.run_rtslc("render", scene, "-o", name, "-q", "-Wno-depth-limit", *SIZE, *options)

    @deep
    def test_the_bits_are_the_same_everywhere(self):
        for sampler in ("r2", "sobol"):
            pictures = []
            for way in (
                [],
                ["--traversal=device", "--threads=1"],
                ["--trace=split", "-O", "0"],
                ["--target=host-megakernel"],
                ["--time=5m"],
                ["--keep=all"],
            ):
                self.render("a.exr", "--spp=5", f"--sampler={sampler}", *way)
                pictures.append((self.folder / "a.exr").read_bytes())
            self.assertEqual(len(set(pictures)), 1, sampler)

    def test_independent_is_what_there_was(self):
        self.render("default.exr", "--spp=3")
        self.render("independent.exr", "--spp=3", "--sampler=independent")
        self.assert_same_bits("default.exr", "independent.exr")
        for sampler, is_there in (("independent", False), ("r2", True), ("sobol", True)):
            ptx, _ = self.run_rtslc(
                "compile", self.scene, "--emit=ptx", "-O1", f"--sampler={sampler}"
            )
            words = (str(CONSTANT), str((CONSTANT * 1664525 + 1013904223) % 2**32))
            signed = [str(int(word) - 2**32) for word in words]
            self.assertEqual(any(word in ptx for word in (*words, *signed)), is_there, sampler)

    def test_the_picture_is_the_same_with_less_noise(self):
        metal = (
            EXAMPLES / "metal" / "scene.json"
        )  # without lamps, at whose edges the position in the pixel matters most
        self.render("reference.exr", "--spp=1500", "--seed=77", scene=metal)
        errors = {}
        for sampler in ("independent", "r2", "sobol"):
            self.render("a.exr", "--spp=64", f"--sampler={sampler}", scene=metal)
            out, _ = self.run_rtslc(
                "compare", "reference.exr", "a.exr", "--json", "--threshold", "10"
            )
            comparison = json.loads(out)
            errors[sampler] = comparison["rmse"]
            for mean, other in zip(*comparison["means"]):
                self.assertAlmostEqual(mean / other, 1, delta=0.01)
        self.assertLess(errors["sobol"], 0.75 * errors["independent"])
        self.assertLess(errors["r2"], 0.75 * errors["independent"])

    def test_a_checkpoint_is_of_one_sampler(self):
        self.render("a.exr", "--spp=1", "--checkpoint=a.ckpt", "--sampler=sobol")
        messages = self.diagnose(
            "render", self.scene, "-o", "b.exr", *SIZE, "--spp=2", "--checkpoint=a.ckpt"
        )
        self.assert_message(messages, "E0907", "the sampler is sobol there and independent here")

    def test_a_scene_says_its_sampler(self):
        """An option says another one; the scene's is part of a checkpoint."""
        for sampler in ("independent", "r2", "sobol"):
            self.render("a.exr", "--spp=3", f"--sampler={sampler}")
            self.render("b.exr", "--spp=3", f"--set=render.sampler={sampler}")
            self.assert_same_bits("a.exr", "b.exr", sampler)
            self.render("b.exr", "--spp=3", f"--sampler={sampler}", "--set=render.sampler=r2")
            self.assert_same_bits("a.exr", "b.exr", sampler)
        self.render("a.exr", "--spp=1", "--checkpoint=a.ckpt", "--set=render.sampler=r2")
        messages = self.diagnose(
            "render", self.scene, "-o", "b.exr", *SIZE, "--spp=2", "--checkpoint=a.ckpt"
        )
        self.assert_message(messages, "E0907", "the sampler is r2 there and independent here")
        messages = self.diagnose("check", self.scene, "--set=render.sampler=halton")
        self.assert_message(
            messages, "E0805", "`sampler` is `independent`, `r2`, `sobol`, not `halton`"
        )

    def test_bad_values(self):
        _, error = self.run_rtslc(
            "render", self.scene, "-o", "a.exr", "--sampler=halton", status=USAGE
        )
        self.assertIn("independent|r2|sobol", error.replace(", ", "|"))


if __name__ == "__main__":
    unittest.main()
