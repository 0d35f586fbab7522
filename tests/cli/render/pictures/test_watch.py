"""rtslc render --watch: a new picture after each save, the old one after a mistake."""

import os
import queue
import shutil
import signal
import subprocess
import threading
import time
import unittest

from harness import DIAGNOSED, RTSLC, SECONDS, USAGE, Case, deep

SMALL = ("--size", "16x12", "--spp", "1", "-O", "0")
NEW_PICTURE = " spp; compiled in "
GREY = "class Grey : rt_Material {\n  void shade() { rt_SampleColor = color(0.5) * share(); }\n};\n"
SHARE = "float share() { return 1.0; }\n"
TRIANGLE = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n"


class Watch(Case):
    def setUp(self):
        super().setUp()
        self.write("a.rtsl", 'import "b.rtsl";\n' + GREY)
        self.write("b.rtsl", '#include "c.inc"\n')
        self.write("c.inc", SHARE)

    def start(self, *arguments, small=SMALL):
        """Starts it, and waits for the first picture."""
        # Python's own handling of SIGINT is not inherited; that of a shell's background jobs would
        # be.
        self.running = subprocess.Popen(
            [RTSLC, "render", *arguments, "--watch", *small],
            cwd=self.folder,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )
        self.addCleanup(self.running.stderr.close)
        self.addCleanup(self.running.wait)
        self.addCleanup(self.running.kill)
        self.lines = queue.Queue()
        self.reader = threading.Thread(
            target=lambda: [self.lines.put(line) for line in self.running.stderr], daemon=True
        )
        self.reader.start()
        self.addCleanup(self.reader.join)
        self.addCleanup(self.running.kill)

    def expect(self, text, without=NEW_PICTURE):
        """The lines up to one with this text; those before have no other text."""
        seen = []
        while True:
            seen.append(self.lines.get(timeout=SECONDS))
            if text in seen[-1]:
                return "".join(seen)
            self.assertNotIn(without, seen[-1])

    def end(self, by=signal.SIGINT):
        self.running.send_signal(by)
        self.assertEqual(self.running.wait(timeout=SECONDS), 128 + by)
        self.assertEqual([name for name in self.files() if name.endswith(".tmp")], [])

    def lines_left(self):
        """Those after the last expected one; it has ended."""
        self.reader.join()
        return "".join(self.lines.queue)

    def picture(self):
        return (self.folder / "a.exr").read_bytes()

    def save_by_renaming(self, name, text):
        self.write(".new", text)
        os.rename(self.folder / ".new", self.folder / name)

    def save_as_vim_does(self, name, text):
        os.rename(self.folder / name, self.folder / (name + "~"))
        self.write(name, text)

    def test_each_file_and_each_way_to_save_it(self):
        self.start("a.rtsl", "-o", "a.exr")
        self.expect(NEW_PICTURE)
        self.assertRegex(self.expect("watching"), r"^watching \d+ files; Ctrl-C ends\n$")
        number = 1
        for save in (self.write, self.save_by_renaming, self.save_as_vim_does):
            for name, text in (
                ("c.inc", SHARE),
                ("a.rtsl", 'import "b.rtsl";\n' + GREY),
                ("b.rtsl", '#include "c.inc"\n'),
            ):
                with self.subTest(save=save.__name__, name=name):
                    before = self.picture()
                    number += 1
                    text = (
                        text.replace("1.0", f"0.{number}")
                        .replace("0.5", f"0.5{number}")
                        .replace("#inc", f"// {number}\n#inc")
                    )
                    save(name, text)
                    self.expect(NEW_PICTURE, without="error")
                    if name != "b.rtsl":
                        self.assertNotEqual(self.picture(), before)
        self.end()
        last = self.picture()
        self.run_rtslc("render", "a.rtsl", "-o", "a.exr", "-q", *SMALL[:-2])
        self.assertEqual(self.picture(), last, "-O does not change the picture")

    def test_a_scene_and_its_mesh(self):
        shutil.copy(
            os.path.join(os.path.dirname(RTSLC), "../share/rtslc/library/preview/material.json"),
            self.folder / "scene.json",
        )
        self.write("part.obj", TRIANGLE)
        os.mkdir(self.folder / "elsewhere")
        os.symlink("../part.obj", self.folder / "elsewhere/link.obj")
        self.start(
            "scene.json",
            "-o",
            "a.exr",
            "--set",
            "objects.1.primitive.radius=0.5",
            "--set",
            'objects.2={"mesh": "elsewhere/link.obj", "material": {"class": "Lambert"}}',
        )
        self.expect("watching", without="error")
        for name, old, new in (("part.obj", "-1 -1 0", "-1 -1 1"), ("scene.json", "0.42", "0.1")):
            before = self.picture()
            self.write(name, (self.folder / name).read_text().replace(old, new))
            self.expect(NEW_PICTURE, without="error")
            self.assertNotEqual(self.picture(), before)
        self.end(by=signal.SIGTERM)

    def test_after_a_mistake_the_picture_is_kept(self):
        self.start("a.rtsl", "-o", "a.exr")
        self.expect("watching", without="error")
        before = self.picture()
        for name, wrong, text in (
            ("c.inc", "float share() { return 1.0 }\n", SHARE),
            ("b.rtsl", "", '#include "c.inc"\n'),
            ("a.rtsl", "class", 'import "b.rtsl";\n' + GREY),
        ):
            self.write(name, wrong)
            self.assertIn("error", self.expect("`a.exr` is left as it was"))
            self.assertEqual(self.picture(), before)
            self.write(name, text)
            self.expect(NEW_PICTURE, without="error")
            self.assertEqual(self.picture(), before)
        self.end()

    def test_mistakes_from_the_start_and_missing_files(self):
        (self.folder / "c.inc").unlink()
        self.start("a.rtsl", "-o", "a.exr")
        self.assertIn("c.inc", self.expect("watching"))
        self.assertNotIn("a.exr", self.files())
        self.write(".hidden", "")
        self.write("c.inc", SHARE)
        self.expect(NEW_PICTURE, without="error")
        os.rename(self.folder / "c.inc", self.folder / "d.inc")  # that is no save
        self.write("b.rtsl", '#include "c.inc"\n\n')
        self.expect("left as it was")
        os.rename(self.folder / "d.inc", self.folder / "c.inc")
        self.expect(NEW_PICTURE, without="error")
        self.end()

    def test_warnings_do_not_stop_it(self):
        self.write("c.inc", SHARE.replace("return", "float x = 2.0; return"))
        self.start("a.rtsl", "-o", "a.exr")
        self.assertIn("W2200", self.expect("watching", without="error"))
        self.end()

    def test_other_files_do_not_matter(self):
        self.start("a.rtsl", "-o", "a.exr")
        self.expect("watching", without="error")
        self.write("other.rtsl", "class")
        (self.folder / "a.exr").touch()
        time.sleep(0.5)
        self.assertTrue(self.lines.empty())
        self.end()

    def test_a_save_overtakes_a_rendering(self):
        self.start("a.rtsl", "-o", "a.exr")
        self.expect("watching", without="error")
        before = self.picture()
        self.write(
            "c.inc",
            SHARE.replace(
                "return",
                "float x = 0.0; for (int i = 0; i < 1000000000; ++i) x += rand(); return x +",
            ),
        )
        time.sleep(2)
        self.write("c.inc", SHARE.replace("1.0", "0.25"))
        self.expect(NEW_PICTURE, without="error")
        self.assertNotEqual(self.picture(), before)
        self.end()
        self.assertNotIn(NEW_PICTURE, self.lines_left())

    @deep
    def test_a_sample_that_never_ends(self):
        """No thread can be stopped in it: the process starts again, or ends."""
        self.start("a.rtsl", "-o", "a.exr", "--threads", "1")
        self.expect("watching", without="error")
        before = self.picture()
        for value in ("0.25", "0.75"):
            self.write("c.inc", "float share() { while (true) ; return 1.0; }\n")
            time.sleep(1)
            self.assertEqual(self.picture(), before)
            self.write("c.inc", SHARE.replace("1.0", value))
            self.expect("starting again")
            self.expect(NEW_PICTURE, without="error")
            self.assertNotEqual(self.picture(), before)
            before = self.picture()
        self.write("c.inc", "float share() { while (true) ; return 0.5; }\n")
        time.sleep(1)
        self.end()
        self.assertEqual(self.picture(), before)

    def test_ending_writes_no_unfinished_picture(self):
        self.start("a.rtsl", "-o", "a.exr", small=("--size", "600x600", "--spp", "100000"))
        time.sleep(1.5)
        self.end()
        self.assertNotIn("a.exr", self.files())

    def test_what_no_save_can_mend_ends_it(self):
        for arguments, words in (
            (("no.rtsl", "-o", "a.exr"), "cannot read `no.rtsl`"),
            (("a.rtsl", "-o", "no/a.exr"), "cannot write `no/a.exr`"),
            (("a.rtsl", "-o", "a.rtsl", "--format=exr"), "would be overwritten"),
        ):
            _, error = self.run_rtslc("render", *arguments, "--watch", *SMALL, status=DIAGNOSED)
            self.assertIn(words, error)
        for arguments, words in (
            (("-", "-o", "a.exr"), "standard input is no file that changes"),
            (("a.rtsl", "-o", "-"), "takes one picture"),
            (("a.rtsl", "-o", "a.exr", "--json"), "describes one picture"),
            (("a.rtsl", "-o", "a.exr", "--diagnostics=json"), "describes one picture"),
        ):
            _, error = self.run_rtslc("render", *arguments, "--watch", status=USAGE)
            self.assertIn(words, error)


if __name__ == "__main__":
    unittest.main()
