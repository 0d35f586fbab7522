"""`rtslc render --time` and `--noise`: passes of samples, until the picture is good enough."""

import json
import os
import pty
import signal
import subprocess
import time
import unittest

from harness import RTSLC, SECONDS, USAGE, Case

SMALL = ("--size", "50x37")  # not whole tiles


class Progressive(Case):
    def setUp(self):
        super().setUp()
        self.glass_scene()

    def render(self, name, *options):
        out, _ = self.run_rtslc(
            "render", "scene.json", "-o", name, "--json", "-Wno-depth-limit", *SMALL, *options
        )
        return json.loads(out)

    def assert_same_pixels(self, first, second):
        self.assertEqual((self.folder / first).read_bytes(), (self.folder / second).read_bytes())

    def test_passes_have_the_bits_of_one_rendering(self):
        for way in (
            [],
            ["--traversal=device"],
            ["--trace=split"],
            ["--threads=1"],
            ["--color=spectral:4"],
            ["--engine=path"],
            ["--target=host-megakernel"],
        ):
            with self.subTest(way=way):
                passes = self.render("passes.exr", "--time=300ms", "--spp=40", *way)
                whole = self.render("whole.exr", f"--spp={passes['spp']}", *way)
                self.assert_same_pixels("passes.exr", "whole.exr")
                for count in (
                    "samples",
                    "pixels",
                    "raysTooDeep",
                    "samplesNotFinite",
                    "pixelsWithoutSample",
                ):
                    self.assertEqual(passes[count], whole[count], count)

    def on_terminal(self, *options):
        """What a rendering writes to a terminal."""
        leader, follower = pty.openpty()
        running = subprocess.Popen(
            [RTSLC, "render", "scene.json", "-o", "a.exr", "-O0", "--spp=1", *SMALL, *options],
            cwd=self.folder,
            stderr=follower,
        )
        os.close(follower)
        written = b""
        try:
            while part := os.read(leader, 4096):
                written += part
        except OSError:  # the rendering is over
            pass
        os.close(leader)
        self.assertEqual(running.wait(timeout=SECONDS), 0)
        return written.decode()

    def test_reading_and_building_are_shown_on_a_terminal(self):
        written = self.on_terminal("-Wno-depth-limit")
        self.assertRegex(written, r"reading: \d+\.\d s")
        self.assertRegex(written, r"building trees: \d+\.\d s")
        self.assertEqual(self.on_terminal("-Wno-depth-limit", "-q"), "")

    def test_the_time_is_kept(self):
        start = time.monotonic()
        document = self.render("a.exr", "--time=1.5s")
        self.assertGreaterEqual(document["seconds"]["render"], 1.5)
        self.assertLess(document["seconds"]["render"], 8)  # a busy machine
        self.assertGreater(document["spp"], 1)
        self.assertLess(time.monotonic() - start, SECONDS)

    def test_there_is_at_least_one_sample(self):
        self.assertEqual(self.render("a.exr", "--time=0.001ms")["spp"], 1)

    def test_spp_is_the_most(self):
        document = self.render("a.exr", "--time=5m", "--spp=7")
        self.assertEqual((document["spp"], document["samples"]), (7, 7 * 50 * 37))

    def test_noise_ends_at_the_same_sample_each_time(self):
        coarse = self.render("a.exr", "--noise=0.01")
        self.assertLessEqual(coarse["noise"], 0.01)
        again = self.render("b.exr", "--noise=0.01", "--threads=1")
        self.assertEqual((coarse["spp"], coarse["noise"]), (again["spp"], again["noise"]))
        self.assert_same_pixels("a.exr", "b.exr")
        fine = self.render("c.exr", "--noise=0.005")
        self.assertAlmostEqual(
            fine["spp"] / coarse["spp"], 4, delta=1.5
        )  # halved by four times as many samples

    def test_noise_is_not_below_the_error(self):
        """Pictures with different seeds differ by the root of 2 times their error. Samples that are
        spread evenly make it smaller than that of independent ones, which is estimated."""
        for noise in ("0.05", "0.02"):
            with self.subTest(noise=noise):
                estimate = self.render("a.exr", f"--noise={noise}")["noise"]
                self.render("b.exr", f"--noise={noise}", "--seed=4")
                out, _ = self.run_rtslc("compare", "a.exr", "b.exr", "--json", "--threshold", "10")
                difference = json.loads(out)
                mean = sum(difference["means"][0]) / len(difference["means"][0])
                error = difference["rmse"] / 2**0.5 / mean
                self.assertLess(error, estimate * 1.1)
                self.assertGreater(error, estimate / 6)

    def test_the_picture_so_far_is_written_at_intervals_and_after_ctrl_c(self):
        """Also without a limit of time or error."""
        running = subprocess.Popen(
            [
                RTSLC,
                "render",
                "scene.json",
                "-o",
                "a.exr",
                "--spp=100000000",
                "--threads=1",
                "--json",
                "-Wno-depth-limit",
                *SMALL,
            ],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )
        for _ in range(SECONDS * 10):
            if (self.folder / "a.exr").exists():
                break
            self.assertIsNone(running.poll(), "it was still to run")
            time.sleep(0.1)
        self.run_rtslc("compare", "a.exr", "a.exr")
        running.send_signal(signal.SIGINT)
        out, error = running.communicate(timeout=SECONDS)
        self.assertEqual(running.returncode, 128 + signal.SIGINT, error)
        document = json.loads(out)
        self.assertEqual(document["stoppedBy"], "SIGINT")
        self.render("whole.exr", f"--spp={document['spp']}")
        self.assert_same_pixels("a.exr", "whole.exr")

    def test_bad_values(self):
        for option, part in (
            ("--time=30", "`30` is not a time; write a number and a unit: `30s`, `2m`, `500ms`"),
            ("--time=0s", "`0s` is not a time"),
            ("--time=-1s", "`-1s` is not a time"),
            ("--time=infs", "`infs` is not a time"),
            ("--time=s", "`s` is not a time"),
            ("--noise=0", "no picture is without error; give a number like 0.01"),
            ("--noise=inf", "no picture is without error"),
            ("--noise=-1", "`-1` is not a number of at least 0"),
        ):
            with self.subTest(option=option):
                _, error = self.run_rtslc(
                    "render", "scene.json", "-o", "a.exr", option, status=USAGE
                )
                self.assertIn(part, error)
        for option in ("--time=1s", "--noise=0.1"):
            _, error = self.run_rtslc(
                "render", "scene.json", "-o", "a.exr", option, "--watch", status=USAGE
            )
            self.assertIn("`--watch` renders each picture with the same number of samples", error)
        self.assertFalse((self.folder / "a.exr").exists())


if __name__ == "__main__":
    unittest.main()
