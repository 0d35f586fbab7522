"""Adaptive sampling: pixels whose color is known well enough get no more samples."""

import json
import math
import random
import signal
import statistics
import subprocess
import time
import unittest

from harness import RTSLC, USAGE, Case, deep

SMALL = ("--size", "50x37")  # not whole tiles


class Adaptive(Case):
    def setUp(self):
        super().setUp()
        self.glass_scene()

    def arguments(self, name, *options):
        return ["render", "scene.json", "-o", name, "-Wno-depth-limit", *SMALL, *options]

    def render(self, name, *options):
        out, _ = self.run_rtslc(*self.arguments(name, "--json", "--adaptive", *options))
        return json.loads(out)

    def test_all_ways_have_the_same_bits(self):
        first = self.render("first.exr", "--noise=0.03", "--traversal=device")
        self.assertLessEqual(first["noise"], 0.03)
        self.assertEqual(first["adaptive"]["openPixels"], 0)
        self.assertLess(first["adaptive"]["mean"], first["spp"])
        self.assertAlmostEqual(first["adaptive"]["mean"] * 50 * 37, first["samples"], delta=1)
        for way in (["--threads=1"], ["--trace=split", "-O", "0"], ["--target=host-megakernel"]):
            with self.subTest(way=way):
                other = self.render("other.exr", "--noise=0.03", "--traversal=device", *way)
                self.assert_same_bits("first.exr", "other.exr")
                for key in ("spp", "samples", "noise", "adaptive", "pixels"):
                    self.assertEqual(other[key], first[key], key)

    def test_evenly_spread_samples_have_the_same_bits_too(self):
        for sampler in ("r2", "sobol"):
            with self.subTest(sampler=sampler):
                self.render("first.exr", "--noise=0.05", f"--sampler={sampler}", "--threads=1")
                self.render(
                    "other.exr", "--noise=0.05", f"--sampler={sampler}", "--target=host-megakernel"
                )
                self.assert_same_bits("first.exr", "other.exr")

    def test_the_mean_is_right(self):
        """The means of pictures with a large error are those of a picture with a small one, within
        their confidence interval of 99.9 %."""

        def mean(name):
            out, _ = self.run_rtslc(
                "compare", name, "converged.exr", "--json", "--threshold", "1000"
            )
            return [sum(means) / len(means) for means in json.loads(out)["means"]]

        options = ("--engine=path", "-O", "0")
        self.run_rtslc(*self.arguments("converged.exr", "--spp=2000", "--seed=1000", *options))
        means = []
        for seed in range(12):
            document = self.render("a.exr", "--noise=0.05", f"--seed={seed}", *options)
            self.assertLess(document["adaptive"]["mean"], document["spp"])
            own, converged = mean("a.exr")
            means.append(own)
        error = statistics.stdev(means) / math.sqrt(len(means))
        self.assertLess(
            abs(statistics.mean(means) - converged), 4.44 * error
        )  # Student's t with 11 degrees of freedom

    def test_spp_and_time_end_it_too(self):
        document = self.render("a.exr", "--noise=0.00001", "--spp=18")
        self.assertEqual(document["spp"], 18)
        self.assertGreater(document["adaptive"]["openPixels"], 0)
        document = self.render("a.exr", "--noise=0.00001", "--time=200ms")
        self.assertGreater(document["adaptive"]["openPixels"], 0)

    def test_the_summary_says_how_many_samples_there_are(self):
        _, text = self.run_rtslc(*self.arguments("a.exr", "--adaptive", "--noise=0.03"))
        self.assertRegex(text, r"a\.exr: 50x37, \d+ spp at most, \d+\.\d on average; ")

    @deep
    def test_an_interrupted_rendering_goes_on(self):
        """Killed while checkpoints are written, or anywhere, and with a limit of samples first."""
        options = ["--adaptive", "--noise=0.004", "--checkpoint=a.ckpt"]
        self.run_rtslc(*self.arguments("a.exr", *options, "--spp=18"))
        for way in (["--threads=1"], ["--target=host-megakernel"], ["--trace=split"]):
            running = subprocess.Popen(
                [RTSLC, *self.arguments("a.exr", *options, "--checkpoint-every=10ms", *way)],
                cwd=self.folder,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
            )
            time.sleep(random.uniform(0.3, 1))
            running.send_signal(signal.SIGKILL)
            running.communicate()
        resumed = self.render("resumed.exr", *options[1:])
        whole = self.render("whole.exr", "--noise=0.004")
        self.assertGreaterEqual(resumed["resumedAt"], 18)
        self.assert_same_bits("resumed.exr", "whole.exr")
        for key in ("spp", "samples", "noise", "adaptive"):
            self.assertEqual(resumed[key], whole[key], key)

    def test_a_checkpoint_is_of_one_error(self):
        self.render("a.exr", "--noise=0.05", "--checkpoint=a.ckpt")
        messages = self.diagnose(
            *self.arguments("b.exr", "--adaptive", "--noise=0.04", "--checkpoint=a.ckpt")
        )
        self.assert_message(messages, "E0907", "`--noise` is 0.05 there and 0.04 here")
        messages = self.diagnose(*self.arguments("b.exr", "--noise=0.05", "--checkpoint=a.ckpt"))
        self.assert_message(messages, "E0907", "`--adaptive` is on there and off here")

    def test_there_must_be_an_error(self):
        _, text = self.run_rtslc(*self.arguments("a.exr", "--adaptive", "--time=1s"), status=USAGE)
        self.assertIn("give the wanted one to `--noise`", text)


if __name__ == "__main__":
    unittest.main()
