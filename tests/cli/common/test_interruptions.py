"""Ctrl-C and SIGTERM: the picture so far is written and said to be that, with a status of its
own."""

import json
import os
import pathlib
import re
import select
import signal
import subprocess
import time
import unittest
import unittest.mock

from harness import RTSLC, SECONDS, Case

RTSL_RUN = os.environ["RTSL_RUN"]
SIZE = ("--size", "64x64", "--threads", "2", "--format=exr")
FOREVER = ("--spp", "100000000")
ENDLESS = (*SIZE, *FOREVER)  # more samples than any test waits for
SLOW = """class Slow : rt_Material;
void shade() {
  float sum = 0.0;
  for (int i = 0; i < 3000000; ++i)
    sum = sin(sum + rt_HitPoint.x);
  rt_SampleColor = color(sum);
}
"""


class Interruptions(Case):
    def setUp(self):
        super().setUp()
        self.glass_scene()

    def wait_for_handler(self, running, by, isCaught=True):
        """Until the program catches the signal, which it does from before the first sample until
        the first signal."""
        status = pathlib.Path(f"/proc/{running.pid}/status")
        for _ in range(SECONDS * 50):
            self.assertIsNone(running.poll(), "it was still to run")
            caught = re.search(r"^SigCgt:\s*(\w+)$", status.read_text(), re.M)
            if bool(int(caught.group(1), 16) >> (by - 1) & 1) == isCaught:
                return
            time.sleep(0.02 if isCaught else 0.001)
        self.fail("no handler")

    def interrupt(self, program, *arguments, by=signal.SIGINT, after=0.2, again=False, says=False):
        """Standard output and error of a rendering that is stopped some time after it began; with
        `again` by a second signal as soon as the first one is handled, or, with `says`, as soon as
        it has said something. (The second one may reach another thread, while the first one is
        still in the handler, which says it.)"""
        # Python's own handling of SIGINT is not inherited; that of a shell's background jobs would
        # be.
        running = subprocess.Popen(
            [program, *arguments],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )
        self.wait_for_handler(running, by)
        time.sleep(after)
        self.assertIsNone(running.poll(), "it was still to run")
        running.send_signal(by)
        said = ""
        if says:
            readable, _, _ = select.select([running.stderr], [], [], SECONDS)
            self.assertTrue(readable, "it says nothing")
            said = os.read(running.stderr.fileno(), 4096).decode()
        if again:
            self.wait_for_handler(running, by, isCaught=False)
            running.send_signal(by)
        out, error = running.communicate(timeout=SECONDS)
        error = said + error
        self.assertEqual(running.returncode, -by if again else 128 + by, error)
        return out, error

    def assert_whole_picture(self, name, samples):
        """All pixels have so many samples: none is black that the whole picture has."""
        self.run_rtslc(
            "render", "scene.json", "-o", "whole.exr", "-q", *SIZE, "--spp", str(samples)
        )
        self.assertEqual(
            (self.folder / name).read_bytes(), (self.folder / "whole.exr").read_bytes()
        )

    def test_the_picture_so_far_is_written(self):
        for way in ([], ["--trace=split"], ["--target=host-megakernel"]):
            for by in (signal.SIGINT, signal.SIGTERM):
                with self.subTest(way=way, by=by):
                    out, error = self.interrupt(
                        *(RTSLC, "render", "scene.json", "-o", "a.exr", "--json", *ENDLESS),
                        *way,
                        by=by,
                    )
                    figures = json.loads(out)
                    self.assertEqual(figures["stoppedBy"], by.name)
                    self.assertEqual(figures["pixels"], 64 * 64)
                    self.assertEqual(figures["samples"], figures["spp"] * 64 * 64)
                    self.assertRegex(
                        error,
                        rf"W2867\]: stopped by {by.name} after {figures['spp']} of {FOREVER[1]} "
                        r"samples per pixel \[",
                    )
                    self.assert_whole_picture("a.exr", figures["spp"])
                    (self.folder / "a.exr").unlink()

    def test_a_long_pass_is_not_awaited(self):
        """A sample of all pixels takes minutes. Those that have none are black."""
        self.write("Slow.rtsl", SLOW)
        _, error = self.interrupt(
            RTSLC, "render", "Slow.rtsl", "-o", "a.exr", *SIZE, "--spp=2", "-Wno-depth-limit"
        )
        self.assertIn("after 0 of 2 samples per pixel; some pixels have more, the others", error)

    def test_the_first_one_says_at_once_what_is_awaited(self):
        """Samples that never end."""
        self.write(
            "Endless.rtsl",
            """class Endless : rt_RayGeneration;
            void generate() {
              float sum = 0.0;
              for (int i = 0; i < 2147483647; ++i)
                sum = sin(sum + float(rt_LaunchIndex.x));
              rt_SampleColor = color(sum);
            }""",
        )
        scene = {
            "rtsl": 1,
            "import": ["Endless.rtsl"],
            "rayGeneration": {"class": "Endless"},
            "render": {"engine": "programs", "spp": 2},
        }
        self.write("endless.json", json.dumps(scene))
        self.run_rtslc("pack", "endless.json", "-o", "endless.rtslpkg", "-q")
        for command in (
            (RTSLC, "render", "endless.json"),
            (RTSL_RUN, "endless.rtslpkg", "--target=host"),
        ):
            with self.subTest(command=command[0]):
                _, error = self.interrupt(*command, "-o", "a.exr", *SIZE, again=True, says=True)
                self.assertEqual(error, "finishing the sample; press Ctrl-C again to leave\n")

    def test_few_samples_are_in_all_pixels(self):
        """They begin as one pass, pixel by pixel."""
        large = ("--size", "800x800", "--threads", "2", "--spp", "64", "-Wno-depth-limit")
        _, error = self.interrupt(RTSLC, "render", "scene.json", "-o", "a.exr", *large)
        self.assertIn("after 1 of 64 samples per pixel; some pixels have more", error)
        self.assertNotIn("black", error)

    def test_a_second_signal_ends_it_at_once(self):
        large = ("--size", "3000x3000")  # it takes a while to write
        self.interrupt(RTSLC, "render", "scene.json", "-o", "a.exr", *FOREVER, *large, again=True)
        self.assertNotIn("a.exr", self.files())
        self.assertEqual([name for name in self.files() if name.endswith(".tmp")], [])

    def test_packages(self):
        self.run_rtslc("pack", "scene.json", "-o", "glass.rtslpkg", "-q")
        for by in (signal.SIGINT, signal.SIGTERM):
            out, error = self.interrupt(
                *(RTSL_RUN, "glass.rtslpkg", "--target=host", "-o", "a.exr", "--json", *ENDLESS),
                by=by,
            )
            figures = json.loads(out)
            samples = figures["samples"] // (64 * 64)
            self.assertIn(f"stopped by {by.name} after {samples} of {FOREVER[1]} samples", error)
            self.assert_whole_picture("a.exr", samples)
            (self.folder / "a.exr").unlink()

    def test_a_gpu_is_stopped_too(self):
        """The stand-in of the driver paints half of the picture, and ends on the signal."""
        self.run_rtslc("pack", "scene.json", "-o", "glass.rtslpkg", "-q")
        fake = {"LD_LIBRARY_PATH": os.environ["FAKE_CUDA_FOLDER"], "FAKE_CUDA": "endless"}
        with unittest.mock.patch.dict(os.environ, fake):
            for command in (
                (RTSLC, "render", "scene.json", "-Wno-depth-limit"),
                (RTSL_RUN, "glass.rtslpkg"),
            ):
                for by in (signal.SIGINT, signal.SIGTERM):
                    with self.subTest(command=command[0], by=by):
                        out, error = self.interrupt(
                            *command,
                            "--target=gpu",
                            "-o",
                            "a.exr",
                            "--json",
                            "--size",
                            "64x64",
                            by=by,
                        )
                        figures = json.loads(out)
                        self.assertEqual((figures["pixels"], figures["stoppedBy"]), (2048, by.name))
                        self.assertRegex(error, "the others are black")
                        self.run_rtslc("compare", "a.exr", "a.exr")
                        (self.folder / "a.exr").unlink()

    def test_no_message_without_interruption(self):
        out, error = self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "a.exr",
            "--size",
            "8x8",
            "--spp",
            "1",
            "--json",
            "-Wno-depth-limit",
        )
        self.assertNotIn("stoppedBy", json.loads(out))
        self.assertEqual((json.loads(out)["pixels"], error), (64, ""))


if __name__ == "__main__":
    unittest.main()
