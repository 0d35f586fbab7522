"""rtslc new: files to start from. Each is correct and renders; nothing is overwritten or half
written."""

import os
import pathlib
import re
import resource
import shlex
import unittest

from harness import DIAGNOSED, RTSLC, USAGE, Case

TEMPLATES = pathlib.Path(RTSLC).parent.parent / "share/rtslc/library/templates"


class New(Case):
    def kinds(self):
        text, _ = self.run_rtslc("new", "--help")
        return re.search(r"\n  KIND ([\w|]+)", text).group(1).split("|")

    def refused(self, kind, name, *words, options=()):
        before = self.files()
        _, error = self.run_rtslc("new", kind, name, *options, status=USAGE)
        for word in words:
            self.assertIn(word, error)
        self.assertEqual(self.files(), before)

    def test_every_kind_has_a_template(self):
        self.assertEqual(sorted(self.kinds()), sorted(path.stem for path in TEMPLATES.iterdir()))

    def test_each_is_correct_and_says_what_to_type_next(self):
        for kind in self.kinds():
            with self.subTest(kind=kind):
                out, error = self.run_rtslc("new", kind, f"My_{kind}2")
                file = f"My_{kind}2" + (".json" if kind == "scene" else ".rtsl")
                self.assertIn(file, self.files())
                self.assertEqual(error, "")
                self.assertNotRegex((self.folder / file).read_text(), r"\bNAME\b")
                self.assertEqual(self.run_rtslc("check", file, "-Wall", "-Wperf"), ("", ""))
                wrote, next_line = out.splitlines()
                self.assertEqual(wrote, f"wrote {file}")
                command = shlex.split(next_line.removeprefix("next: "))
                self.assertEqual(command[0], "rtslc")
                self.assertEqual(self.run_rtslc(*command[1:])[0], "")

    def test_the_scene_renders(self):
        self.run_rtslc("new", "scene", "room")
        _, error = self.run_rtslc(
            "render",
            "room.json",
            "-o",
            "room.exr",
            "-q",
            "--size",
            "48x32",
            "--spp",
            "4",
            "-Werror",
        )
        self.assertEqual(error, "")
        self.write_exr("black.exr", 48, 32, 0.0)
        self.run_rtslc("compare", "black.exr", "room.exr", "--threshold", "0.3", status=DIAGNOSED)

    def test_nothing_is_overwritten(self):
        path = self.write("Clay.rtsl", "mine")
        os.symlink("nowhere", self.folder / "Link.rtsl")
        for name in ("Clay", "Link"):
            (message,) = self.diagnose("new", "material", name)
            self.assertEqual(
                (message["code"], message["message"]),
                ("E0902", f"cannot write `{name}.rtsl`: File exists"),
            )
            self.assertIn("another folder by `-o`", message["notes"][0])
        self.assertEqual(path.read_text(), "mine")
        self.assertEqual(self.files(), ["Clay.rtsl", "Link.rtsl"])

    def test_folders(self):
        (self.folder / "a b").mkdir()
        out, _ = self.run_rtslc("new", "scene", "room", "-o", "a b")
        self.assertEqual(
            out, "wrote a b/room.json\nnext: rtslc render 'a b/room.json' -o room.png\n"
        )
        (message,) = self.diagnose("new", "scene", "room", "-o", "no such")
        self.assertIn("`mkdir -p 'no such'` makes it", message["notes"][0])
        (message,) = self.diagnose("new", "scene", "room", "-o", "/dev/full")
        self.assertEqual(message["message"], "cannot write `/dev/full/room.json`: Not a directory")
        (self.folder / "sealed").mkdir(mode=0o555)
        (message,) = self.diagnose("new", "scene", "room", "-o", "sealed", unprivileged=True)
        self.assertEqual(message["message"], "cannot write `sealed/room.json`: Permission denied")

    def test_nothing_is_left_half_written(self):
        """A limit on the size of files stands in for a full disk."""

        def small_files():
            resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))

        (message,) = self.diagnose("new", "material", "Clay", prepare=small_files)
        self.assertEqual(
            (message["code"], message["message"]),
            ("E0902", "cannot write `Clay.rtsl`: File too large"),
        )
        self.assertEqual(self.files(), [])

    def test_full_standard_output_is_said(self):
        with open("/dev/full", "w") as full:
            _, error = self.run_rtslc("new", "material", "Clay", stdout=full, status=DIAGNOSED)
        self.assertIn("No space left on device", error)

    def test_names(self):
        self.refused("material", "my clay", "`my clay` is not a name", "did you mean `MyClay`?")
        self.refused("material", "3d", "did you mean `My3d`?")
        self.refused("material", "Clay.rtsl", "did you mean `Clay`?")
        self.refused("material", "shaders/Clay", "did you mean `Clay -o shaders`?")
        self.refused("material", "../Clay.rtsl", "did you mean `Clay -o ..`?")
        self.refused("scene", "room.json", "did you mean `room`?")
        self.refused("material", "", "`` is not a name")
        self.refused("material", "Ü", "`Ü` is not a name")
        self.refused("camera", "rt_Lens", "`rt_Lens` is reserved")
        self.refused("material", "Lambert", "`std.materials.Lambert`", "did you mean `MyLambert`?")
        self.refused("texture", "ViewCamera", "`std.cameras.ViewCamera`")
        for word in ("class", "float", "color", "normalize", "__LINE__"):
            self.refused("material", word, f"`{word}` means something else in RTSL", "did you mean")

    def test_the_name_of_a_scene_is_only_that_of_a_file(self):
        self.run_rtslc("new", "scene", "Lambert")
        self.assertEqual(self.files(), ["Lambert.json"])

    def test_kinds(self):
        self.refused(
            "materal",
            "Clay",
            "`materal` is none of material, camera, primitive, texture, light, scene",
        )

    def test_templates_are_no_modules(self):
        self.write("a.rtsl", "import templates.material;\n")
        self.assert_message(self.diagnose("check", "a.rtsl"), "E0126", "templates.material")
        self.write("a.rtsl", "import templates;\n")
        self.assert_message(self.diagnose("check", "a.rtsl"), "E0126", "templates")


if __name__ == "__main__":
    unittest.main()
