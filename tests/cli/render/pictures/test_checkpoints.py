"""`rtslc render --checkpoint`: a rendering that goes on where it was interrupted, whatever has
ended it."""

import json
import os
import random
import resource
import shutil
import signal
import struct
import subprocess
import time
import unittest

from harness import DIAGNOSED, RTSLC, SECONDS, USAGE, Case

SMALL = ("--size", "50x37")  # not whole tiles
KILLS = int(os.environ.get("RTSL_KILLS", "5"))
COUNTS = (
    "samples",
    "pixels",
    "badRays",
    "raysTooDeep",
    "samplesNotFinite",
    "pixelsWithoutSample",
    "notFinite",
)


def crc64(data):
    """CRC-64/XZ."""
    remainder = 2**64 - 1
    for byte in data:
        remainder ^= byte
        for _ in range(8):
            remainder = remainder >> 1 ^ (0xC96C5795D7870F42 if remainder & 1 else 0)
    return remainder ^ 2**64 - 1


class Checkpoints(Case):
    def setUp(self):
        super().setUp()
        self.glass_scene()

    def arguments(self, name, *options):
        size = () if any(option.startswith("--size") for option in options) else SMALL
        return ["render", "scene.json", "-o", name, "-Wno-depth-limit", *size, *options]

    def render(self, name, *options):
        out, _ = self.run_rtslc(*self.arguments(name, "--json", *options))
        return json.loads(out)

    def start(self, *options):
        def signals():
            signal.signal(signal.SIGINT, signal.default_int_handler)

        return subprocess.Popen(
            [RTSLC, *self.arguments("a.exr", *options)],
            cwd=self.folder,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=signals,
        )

    def inode(self):
        return os.stat(self.folder / "a.ckpt").st_ino if (self.folder / "a.ckpt").exists() else 0

    def wait_for_checkpoint(self, running, before):
        """Until the process has written one. `before`: the inode when it began."""
        while self.inode() == before:
            self.assertIsNone(running.poll(), "it was still to run")
            time.sleep(0.001)

    def checkpoint(self):
        return (self.folder / "a.ckpt").read_bytes()

    def refuse(self, part, *options, code="E0907"):
        """The rendering is refused, and what was there stays."""
        before = self.checkpoint()
        messages = self.diagnose(*self.arguments("new.exr", "--checkpoint=a.ckpt", *options))
        self.assert_message(messages, code, part)
        self.assertEqual(self.checkpoint(), before)
        self.assertFalse((self.folder / "new.exr").exists())


class Resuming(Checkpoints):
    def test_the_bits_are_those_of_a_rendering_without_interruption(self):
        for way in (
            [],
            ["--traversal=device"],
            ["--trace=split"],
            ["--target=host-megakernel"],
            ["--color=spectral:4"],
            ["--engine=path"],
            ["--fp=fast"],
        ):
            with self.subTest(way=way):
                whole = self.render("whole.exr", "--spp=11", *way)
                self.render("part.exr", "--spp=4", "--checkpoint=a.ckpt", "--threads=1", *way)
                again = self.render("again.exr", "--spp=4", "--checkpoint=a.ckpt", *way)
                self.assertEqual(again["resumedAt"], 4)
                self.assert_same_bits("part.exr", "again.exr")
                resumed = self.render(
                    "resumed.exr", "--spp=11", "--checkpoint=a.ckpt", "--threads=3", *way
                )
                self.assert_same_bits("whole.exr", "resumed.exr")
                for count in COUNTS:
                    self.assertEqual(whole[count], resumed[count], count)
                (self.folder / "a.ckpt").unlink()

    def test_resume_needs_a_checkpoint(self):
        """It goes on as --checkpoint does, and never begins anew."""
        messages = self.diagnose(*self.arguments("a.exr", "--resume=a.ckpt"))
        self.assert_message(messages, "E0907", "cannot resume from `a.ckpt`: there is no such file")
        self.assertEqual(self.inode(), 0)
        self.render("a.exr", "--spp=2", "--checkpoint=a.ckpt")
        self.assertEqual(self.render("a.exr", "--spp=3", "--resume=a.ckpt")["resumedAt"], 2)
        same = self.render("a.exr", "--spp=4", "--resume=a.ckpt", "--checkpoint=a.ckpt")
        self.assertEqual(same["resumedAt"], 3)
        self.render("whole.exr", "--spp=4")
        self.assert_same_bits("a.exr", "whole.exr")
        for options, part in (
            (["--resume=a.ckpt", "--seed=2"], "the seed is 1 there and 2 here"),
            (["--resume=scene.json"], "`scene.json` is an input and would be overwritten"),
        ):
            messages = self.diagnose(*self.arguments("a.exr", *options))
            self.assertIn(part, messages[0]["message"])
        for options, part in (
            (["--resume=a.ckpt", "--checkpoint=b.ckpt"], "leave out `--checkpoint`"),
            (["--resume=%04d.ckpt", "--frames=0..1"], "frames that were not begun"),
        ):
            name = "%04d.exr" if "--frames=0..1" in options else "a.exr"
            _, error = self.run_rtslc(*self.arguments(name, *options), status=USAGE)
            self.assertIn(part, error)

    def test_another_backend_goes_on(self):
        ways = (
            ["--traversal=device"],
            ["--target=host-megakernel"],
            ["--trace=split", "-O", "0"],
            [],
        )
        for i, way in enumerate(ways):
            self.render("parts.exr", f"--spp={3 * (i + 1)}", "--checkpoint=a.ckpt", *way)
        self.render("whole.exr", f"--spp={3 * len(ways)}")
        self.assert_same_bits("parts.exr", "whole.exr")

    def test_noise_ends_at_the_same_sample(self):
        whole = self.render("whole.exr", "--noise=0.02")
        self.render("part.exr", "--noise=0.02", "--spp=18", "--checkpoint=a.ckpt")
        resumed = self.render(
            "resumed.exr", "--noise=0.02", "--checkpoint=a.ckpt", "--target=host-megakernel"
        )
        self.assertEqual((whole["spp"], whole["noise"]), (resumed["spp"], resumed["noise"]))
        self.assert_same_bits("whole.exr", "resumed.exr")
        self.assertEqual(
            self.render("again.exr", "--noise=0.02", "--checkpoint=a.ckpt")["spp"], whole["spp"]
        )

    def test_time_counts_from_the_first_start(self):
        first = self.render("a.exr", "--time=400ms", "--checkpoint=a.ckpt")
        again = self.render("b.exr", "--time=400ms", "--checkpoint=a.ckpt")
        self.assertEqual(first["spp"], again["spp"])
        self.assertGreater(
            self.render("c.exr", "--time=800ms", "--checkpoint=a.ckpt")["spp"], first["spp"]
        )

    def test_signals_end_it_at_once(self):
        """In the middle of a pass, with some pixels further than others."""
        self.render("whole.exr", "--spp=400", "--engine=path")
        for number, status in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            before = self.inode()
            running = self.start(
                "--spp=400",
                "--checkpoint=a.ckpt",
                "--checkpoint-every=10ms",
                "--engine=path",
                "--json",
            )
            self.wait_for_checkpoint(running, before)
            running.send_signal(number)
            out, error = running.communicate(timeout=SECONDS)
            self.assertEqual(running.returncode, status, error)
            self.assertIn("W2867", error)
            self.assertIn("of 400 samples per pixel", error)
            self.assertEqual(json.loads(out)["stoppedBy"], signal.Signals(number).name)
            self.run_rtslc("compare", "a.exr", "a.exr")
        resumed = self.render(
            "resumed.exr", "--spp=400", "--checkpoint=a.ckpt", "--engine=path", "--threads=3"
        )
        self.assertEqual(resumed["samples"], 400 * 50 * 37)
        self.assert_same_bits("whole.exr", "resumed.exr")

    def test_kill_at_any_moment(self):
        """The file is the old or the new one, and no other is left. 100 kills: RTSL_KILLS=100."""
        options = ["--spp=1000000", "--checkpoint=a.ckpt", "--checkpoint-every=10ms"]
        ways = (["--threads=1"], ["--threads=3", "--trace=split"], ["--target=host-megakernel"])
        start = time.monotonic()
        self.render("a.exr", "--spp=1", "--checkpoint=a.ckpt")
        seconds = time.monotonic() - start
        for kill in range(KILLS):
            before = self.inode()
            running = self.start(*options, *ways[kill % len(ways)])
            if kill % 5:  # while checkpoints are being written, or anywhere
                self.wait_for_checkpoint(running, before)
                time.sleep(random.uniform(0, 0.1))
            else:
                time.sleep(random.uniform(0, seconds))
            running.kill()
            running.communicate()
            self.assertEqual(running.returncode, -signal.SIGKILL)
        reached = self.samples_of_checkpoint()
        self.assertGreater(reached[0], 0)
        last = self.render("a.exr", f"--spp={reached[1] + 3}", "--checkpoint=a.ckpt")
        self.assertEqual(last["resumedAt"], reached[0])
        self.render("whole.exr", f"--spp={reached[1] + 3}")
        self.assert_same_bits("a.exr", "whole.exr")
        self.assertEqual([file for file in self.files() if file.startswith(".a.ckpt")], [])

    def samples_of_checkpoint(self):
        """The least and the most of a pixel: the last numbers of a file that is not adaptive."""
        pixels = 50 * 37
        taken = struct.unpack(f"<{pixels}I", self.checkpoint()[-4 * pixels :])
        return min(taken), max(taken)


class Refusing(Checkpoints):
    def setUp(self):
        super().setUp()
        self.render("a.exr", "--spp=2", "--checkpoint=a.ckpt")

    def test_other_options(self):
        for option, part in (
            ("--seed=2", "the seed is 1 there and 2 here"),
            ("--depth=3", "the depth is 8 there and 3 here"),
            ("--size=51x37", "the size is 50x37 there and 51x37 here"),
            ("--color=mono", "the number of components of a color is 3 there and 1 here"),
            ("--fp=fast", "`--fp` is strict there and fast here"),
            ("--exceptions", "`--exceptions` is off there and on here"),
            ("-DGREEN", "what `-D` and `-U` define is nothing there and GREEN=1 here"),
            ("--engine=normals", "the scene has changed since it was written"),
            ("--set=background=[0,0,0]", "the scene has changed"),
            ("--spp=1", "it has 2 samples per pixel, more than 1"),
        ):
            with self.subTest(option=option):
                self.refuse(part, option)

    def test_other_files(self):
        for name in ("scene.json", "Checker.rtsl", "knot.obj"):
            with self.subTest(name=name):
                path = self.folder / name
                text = path.read_text()
                path.write_text(
                    text.replace("0.85", "0.75", 1)
                    if name == "scene.json"
                    else text + ("# more\n" if name.endswith("obj") else "// more\n")
                )
                self.assertNotEqual(path.read_text(), text)
                self.refuse(
                    "the scene has changed"
                    if name == "scene.json"
                    else f"`{name}` has changed since it was written"
                )
                path.write_text(text)
        scene = json.loads((self.folder / "scene.json").read_text())
        self.write("scene.json", json.dumps(scene, indent=4))  # the same in other words
        self.render("b.exr", "--spp=2", "--checkpoint=a.ckpt")

    def test_damaged_files(self):
        whole = self.checkpoint()
        for size in (0, 5, 40, 1000, len(whole) - 1):
            with self.subTest(size=size):
                self.write("a.ckpt", whole[:size])
                self.refuse("it is truncated" if size > 8 else "it is not a checkpoint of rtslc")
        for at in (20, 70, len(whole) // 2, len(whole) - 1):
            with self.subTest(at=at):
                self.write("a.ckpt", whole[:at] + bytes([whole[at] ^ 1]) + whole[at + 1 :])
                self.refuse("it is ")
        shutil.copy(self.folder / "a.exr", self.folder / "a.ckpt")
        self.refuse("it is not a checkpoint of rtslc")

    def test_another_version(self):
        whole = self.checkpoint()
        changed = bytearray(whole)
        changed[24:32] = bytes(8)
        self.assertEqual(struct.unpack("<Q", whole[24:32])[0], crc64(changed))
        changed[32:45] = b"rtslc 99.0.0\0"
        changed[24:32] = struct.pack("<Q", crc64(changed))
        self.write("a.ckpt", bytes(changed))
        self.refuse("it was written by rtslc 99.0.0, and this is rtslc")
        changed[8] = 99
        self.write("a.ckpt", bytes(changed))
        self.refuse("it is a checkpoint of format 99")


class Writing(Checkpoints):
    def small_files(self):
        resource.setrlimit(resource.RLIMIT_FSIZE, (30000, resource.RLIM_INFINITY))

    def test_a_full_disk_at_the_end(self):
        """A limit on the size of files stands in for it. The old checkpoint stays, and the picture
        is written."""
        self.render("a.exr", "--spp=2", "--checkpoint=a.ckpt")
        before = self.checkpoint()
        arguments = self.arguments("a.png", "--spp=5", "--checkpoint=a.ckpt", "--diagnostics=json")
        _, error = self.run_rtslc(*arguments, status=DIAGNOSED, prepare=self.small_files)
        self.assert_message(
            json.loads(error)["diagnostics"], "E0902", "cannot write `a.ckpt`: File too large"
        )
        self.assertEqual(self.checkpoint(), before)
        self.render("whole.png", "--spp=5")
        self.assert_same_bits("a.png", "whole.png")
        self.assertEqual([file for file in self.files() if file.endswith(".tmp")], [])

    def test_a_disk_that_is_full_for_a_while(self):
        running = self.start(
            "--spp=100000", "--checkpoint=a.ckpt", "--checkpoint-every=20ms", "--diagnostics=json"
        )
        try:
            self.wait_for_checkpoint(running, 0)
            resource.prlimit(running.pid, resource.RLIMIT_FSIZE, (0, resource.RLIM_INFINITY))
            time.sleep(0.5)
            resource.prlimit(
                running.pid, resource.RLIMIT_FSIZE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
            )
        finally:
            running.send_signal(signal.SIGINT)
        _, error = running.communicate(timeout=SECONDS)
        self.assertEqual(running.returncode, 130, error)
        messages = json.loads(error)["diagnostics"]
        self.assertEqual(
            sorted(message["code"] for message in messages), ["W2867", "W2868"], messages
        )
        self.assertRegex(
            error,
            r"[0-9]+ checkpoints were not written, but the last one was: cannot write `a.ckpt`",
        )
        self.assertTrue((self.folder / "a.ckpt").exists())

    def test_other_files_are_not_replaced(self):
        for name in ("scene.json", "Checker.rtsl", "knot.obj"):
            with self.subTest(name=name):
                before = (self.folder / name).read_bytes()
                messages = self.diagnose(*self.arguments("a.exr", f"--checkpoint={name}"))
                self.assert_message(
                    messages, "E0965", f"`{name}` is an input and would be overwritten"
                )
                self.assertEqual((self.folder / name).read_bytes(), before)
        os.symlink("a.exr", self.folder / "link")
        for name in ("a.exr", "./a.exr", "link", "a.d"):
            with self.subTest(name=name):
                messages = self.diagnose(*self.arguments("a.exr", f"--checkpoint={name}", "-MD"))
                self.assert_message(
                    messages, "E0965", "cannot be the checkpoint and another output"
                )
        self.assertFalse((self.folder / "a.exr").exists())

    def test_places_that_cannot_be_written(self):
        for name, part in (
            ("no/where.ckpt", "No such file or directory"),
            (".", "Is a directory"),
            ("/dev/null", "is not a regular file"),
            ("/dev/full", "is not a regular file"),
        ):
            with self.subTest(name=name):
                self.assert_message(
                    self.diagnose(*self.arguments("a.exr", f"--checkpoint={name}")), "E0902", part
                )

    def test_bad_values(self):
        for options, part in (
            (["--checkpoint=-"], "standard output cannot be read again; give a file"),
            (["--checkpoint=a", "--watch"], "a checkpoint is of one picture"),
            (["--checkpoint=a", "--print"], "a checkpoint does not keep what shaders have printed"),
            (["--checkpoint-every=1s"], "there is no `--checkpoint`"),
            (["--checkpoint=a", "--checkpoint-every=0s"], "`0s` is not a time"),
            (["--checkpoint=a", "--checkpoint-every=soon"], "`soon` is not a time"),
        ):
            with self.subTest(options=options):
                _, error = self.run_rtslc(*self.arguments("a.exr", *options), status=USAGE)
                self.assertIn(part, error)


if __name__ == "__main__":
    unittest.main()
