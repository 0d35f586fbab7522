"""Ctrl-C and SIGTERM: the picture so far is written and said to be that, with a status of its
own."""

import json
import os
import pathlib
import re
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
LONG = (*SIZE, "--spp", "20000")  # pixels that are finished one after the other


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

    def interrupt(self, program, *arguments, by=signal.SIGINT, after=0.2, again=False):
        """Standard output and error of a rendering that is stopped some time after it began."""
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
        if again:
            self.wait_for_handler(running, by, isCaught=False)
            running.send_signal(by)
        out, error = running.communicate(timeout=SECONDS)
        self.assertEqual(running.returncode, -by if again else 128 + by, error)
        return out, error

    def assert_partly_black(self, name):
        """Some pixels are black, and the picture is whole as a file."""
        out, _ = self.run_rtslc("compare", name, name)
        self.assertIn("the same", out)

    def test_the_picture_so_far_is_written(self):
        for way in ([], ["--trace=split"], ["--target=host-megakernel"]):
            for by in (signal.SIGINT, signal.SIGTERM):
                with self.subTest(way=way, by=by):
                    _, error = self.interrupt(
                        RTSLC, "render", "scene.json", "-o", "a.exr", *ENDLESS, *way, by=by
                    )
                    self.assertRegex(
                        error,
                        rf"W2867\]: stopped by {by.name} after 0\.0 % of the samples: 0 of 4096 "
                        r"pixels are done",
                    )
                    self.assert_partly_black("a.exr")
                    (self.folder / "a.exr").unlink()

    def test_json_says_it(self):
        for way in ([], ["--target=host-megakernel"]):
            with self.subTest(way=way):
                out, _ = self.interrupt(
                    RTSLC, "render", "scene.json", "-o", "a.exr", "--json", *LONG, *way, after=2
                )
                figures = json.loads(out)
                self.assertEqual(figures["stoppedBy"], "SIGINT")
                self.assertLess(figures["pixels"], 64 * 64)
                self.assertGreaterEqual(figures["samples"], figures["pixels"] * 20000)
                self.assertGreater(figures["samples"], 0)

    def test_finished_pixels_have_their_bits(self):
        """What was done before is what the whole picture has there; a pixel that was begun has its
        samples so far."""
        few = (*SIZE, "--spp", "2000")
        self.interrupt(RTSLC, "render", "scene.json", "-o", "part.exr", "-q", *few, after=1)
        self.run_rtslc("render", "scene.json", "-o", "whole.exr", "-q", *few)
        out, _ = self.run_rtslc("compare", "whole.exr", "part.exr", "--json", status=None)
        self.assertLess(json.loads(out)["pixelsThatDiffer"], 64 * 64)

    def test_a_second_signal_ends_it_at_once(self):
        large = ("--size", "3000x3000")  # it takes a while to write
        self.interrupt(RTSLC, "render", "scene.json", "-o", "a.exr", *FOREVER, *large, again=True)
        self.assertNotIn("a.exr", self.files())
        self.assertEqual([name for name in self.files() if name.endswith(".tmp")], [])

    def test_packages(self):
        self.run_rtslc("pack", "scene.json", "-o", "glass.rtslpkg", "-q")
        for by in (signal.SIGINT, signal.SIGTERM):
            _, error = self.interrupt(
                RTSL_RUN, "glass.rtslpkg", "--target=host", "-o", "a.exr", *ENDLESS, by=by
            )
            self.assertIn(f"stopped by {by.name} after 0.0 % of the samples", error)
            self.assert_partly_black("a.exr")
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
                        self.assertIn("2048 of 4096 pixels are done", error)
                        self.assert_partly_black("a.exr")
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
