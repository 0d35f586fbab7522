"""Where commands write: every command with every output option, onto what it reads, to a full disk,
and to a folder."""

import json
import os
import shutil
import subprocess
import unittest

from harness import DIAGNOSED, EXAMPLES, FINE, RTSLC, SECONDS, Case

RTSL_RUN = os.environ["RTSL_RUN"]
SMALL = ("--size", "8x8", "--spp", "1")
QUIET = ("-q", "-Wno-depth-limit", "-O0")  # where files go does not depend on how code is optimised
MATERIAL = (
    '#include "part.inc"\nimport "other.rtsl";\nclass Grey : rt_Material {\n'
    "  void shade() { rt_SampleColor = shared() * other() * trace(rt_HitPoint, vec3(0.0, 1.0, "
    "0.0)); }\n};\n"
)


class Outputs(Case):
    def setUp(self):
        super().setUp()
        self.write("grey.rtsl", MATERIAL)
        self.write("part.inc", "float shared() { return 0.5; }\n")
        self.write("other.rtsl", "float other() { return 0.5; }\n")
        self.glass_scene()

    def run_any(self, program, *arguments, stdout=subprocess.PIPE, stdin=None):
        return subprocess.run(
            [program, *map(str, arguments)],
            cwd=self.folder,
            stdin=stdin or subprocess.DEVNULL,
            stdout=stdout,
            stderr=subprocess.PIPE,
            timeout=SECONDS,
            text=True,
        )

    def package(self):
        if not (self.folder / "glass.rtslpkg").exists():
            self.run_rtslc("pack", "scene.json", "-o", "glass.rtslpkg", *QUIET)

    def mesh(self):
        return next(path.name for path in self.folder.iterdir() if path.suffix == ".obj")

    # Each row: the program, its arguments with OUT where the output stands, and the files that it
    # reads.
    def writers(self):
        shaders = sorted(
            path.name
            for path in self.folder.glob("*.rtsl")
            if path.name not in ("grey.rtsl", "other.rtsl")
        )
        read_by_scene = ["scene.json", self.mesh(), shaders[0]]
        read_by_grey = ["grey.rtsl", "part.inc", "other.rtsl"]
        rows = [
            (RTSLC, ["compile", "grey.rtsl", "--emit=ir", "-o", "OUT"], read_by_grey),
            (
                RTSLC,
                ["compile", "grey.rtsl", "--emit=preprocessed", "-o", "OUT"],
                ["grey.rtsl", "part.inc"],
            ),
            (RTSLC, ["compile", "grey.rtsl", "--emit=cpp", "-o", "OUT"], read_by_grey),
            (RTSLC, ["compile", "grey.rtsl", "--emit=reflection", "-o", "OUT"], read_by_grey),
            (
                RTSLC,
                ["compile", "grey.rtsl", "--emit=ir", "-o", "ir", "-MD", "-MF", "OUT"],
                read_by_grey,
            ),
            (RTSLC, ["check", "grey.rtsl", "-MD", "-MF", "OUT"], read_by_grey),
            (RTSLC, ["check", "scene.json", "-MD", "-MF", "OUT"], read_by_scene),
            (RTSLC, ["explain", "--states", "grey.rtsl", "-o", "OUT"], read_by_grey),
            (RTSLC, ["explain", "--states", "grey.rtsl", "-MD", "-MF", "OUT"], read_by_grey),
            (RTSLC, ["compile", "scene.json", "--emit=ir", "-o", "OUT"], read_by_scene),
            (RTSLC, ["explain", "--states", "scene.json", "-o", "OUT"], read_by_scene),
            (RTSLC, ["pack", "scene.json", "-o", "OUT", *QUIET], read_by_scene),
            (
                RTSLC,
                ["pack", "scene.json", "-o", "package", *QUIET, "-MD", "-MF", "OUT"],
                read_by_scene,
            ),
            (
                RTSLC,
                ["render", "scene.json", *QUIET, "--format=exr", "-o", "OUT", *SMALL],
                read_by_scene,
            ),
            (
                RTSLC,
                ["render", "scene.json", *QUIET, "-o", "a.exr", "-MD", "-MF", "OUT", *SMALL],
                read_by_scene,
            ),
            (
                RTSL_RUN,
                ["glass.rtslpkg", "-q", "--target=host", "--format=exr", "-o", "OUT", *SMALL],
                ["glass.rtslpkg"],
            ),
            (
                RTSL_RUN,
                [
                    "glass.rtslpkg",
                    "-q",
                    "--target=host",
                    "--format=exr",
                    "-o",
                    "OUT",
                    "--compare",
                    "glass.exr",
                    *SMALL,
                ],
                ["glass.exr"],
            ),
        ]
        self.package()
        self.run_rtslc(
            "render", "scene.json", *QUIET, "-o", "glass.exr", "--target=host-megakernel", *SMALL
        )
        return rows

    def test_nothing_that_is_read_is_overwritten(self):
        """Not by its name, by another name, through a symbolic link, or through a hard link: of
        each input by its name, and by one of the others in turn."""
        turn = 0
        for program, arguments, inputs in self.writers():
            for name in inputs:
                before = (self.folder / name).read_bytes()
                os.symlink(self.folder / name, self.folder / "symbolic")
                os.link(self.folder / name, self.folder / "hard")
                others = (f"./{name}", self.folder / name, "symbolic", "hard")
                turn += 1
                for output in (name, others[turn % 4]):
                    with self.subTest(arguments=arguments, output=str(output)):
                        done = self.run_any(
                            program, *[output if a == "OUT" else a for a in arguments]
                        )
                        self.assertEqual(done.returncode, DIAGNOSED, done.stderr)
                        self.assertRegex(done.stderr, "input .*overwritten")
                        self.assertEqual((self.folder / name).read_bytes(), before)
                        self.assertEqual((self.folder / "hard").read_bytes(), before)
                for link in ("symbolic", "hard"):
                    (self.folder / link).unlink()

    def test_it_is_a_message_with_a_code(self):
        self.assert_message(
            self.diagnose("compile", "grey.rtsl", "--emit=ir", "-o", "other.rtsl"),
            "E0965",
            "overwritten",
        )

    def test_reports_keep_what_they_read(self):
        self.run_rtslc("render", "scene.json", *QUIET, "-o", "a.exr", *SMALL)
        for part in ("reference.exr", "pictures/a.exr", "partial/a.exr"):
            path = self.folder / "out" / part
            path.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(self.folder / "a.exr", path)
            for reference in (f"out/{part}", "link.exr"):
                if reference == "link.exr":
                    os.symlink(path, self.folder / reference)
                _, error = self.run_rtslc(
                    "report",
                    "scene.json",
                    "--out",
                    "out",
                    "--fresh",
                    "--budget",
                    "10ms",
                    "--runs",
                    "2",
                    "--reference",
                    reference,
                    status=DIAGNOSED,
                )
                self.assertIn("overwritten", error)
                self.assertTrue(path.exists())
            (self.folder / "link.exr").unlink()
            path.unlink()

    def test_folders_and_missing_folders_are_no_outputs(self):
        (self.folder / "folder").mkdir()
        for program, arguments, _ in self.writers():
            for output in ("folder", "missing/out"):
                with self.subTest(arguments=arguments, output=output):
                    done = self.run_any(program, *[output if a == "OUT" else a for a in arguments])
                    self.assertEqual(done.returncode, DIAGNOSED, done.stderr)
                    self.assertIn(f"cannot write `{output}`", done.stderr)
        self.assertEqual(list((self.folder / "folder").iterdir()), [])

    def test_a_full_disk_is_said(self):
        for program, arguments, _ in self.writers():
            with self.subTest(arguments=arguments):
                done = self.run_any(program, *["/dev/full" if a == "OUT" else a for a in arguments])
                self.assertEqual(done.returncode, DIAGNOSED, done.stderr)
                self.assertIn("No space left on device", done.stderr)

    def test_full_standard_output_is_said(self):
        self.package()
        self.run_rtslc("render", "scene.json", *QUIET, "-o", "a.exr", *SMALL)
        self.run_rtslc("render", "scene.json", *QUIET, "-o", "b.exr", "--seed", "7", *SMALL)
        self.write(
            "print.rtsl",
            'class Grey : rt_Material { void shade() { print("here"); rt_SampleColor = color(0.5); '
            "} };",
        )
        prints = ["--set", "import.9=print.rtsl", "--set", 'materials.clay={"class":"Grey"}']
        render = ["render", "scene.json", *QUIET, *SMALL]
        rows = [
            (RTSLC, ["--help"]),
            (RTSLC, ["--version"]),
            (RTSLC, ["-V"]),
            (RTSLC, ["help"]),
            (RTSLC, ["help", "render"]),
            (RTSLC, ["check", "--help"]),
            (RTSLC, ["check", "-Whelp"]),
            *[(RTSLC, ["compile", "grey.rtsl", f"--emit={stage}"]) for stage in self.stages()],
            (RTSLC, ["compile", "grey.rtsl", "--emit=ir", "-o", "ir", "-MD", "-MF", "-"]),
            (RTSLC, ["explain", "--states", "Glass.rtsl"]),
            (RTSLC, ["explain", "scene.json", "--json", "--no-savings"]),
            (RTSLC, [*render, "-o", "c.exr", "--json"]),
            (RTSLC, [*render, "-o", "c.exr", "--print", *prints]),
            (RTSLC, [*render, "-o", "-"]),
            (RTSLC, ["pack", "scene.json", "-o", "-", *QUIET]),
            (RTSLC, ["compare", "a.exr", "a.exr"]),
            (RTSLC, ["compare", "a.exr", "b.exr"]),
            (RTSLC, ["compare", "a.exr", "b.exr", "--json"]),
            *[
                (
                    RTSLC,
                    [
                        "report",
                        "scene.json",
                        "--out",
                        "out",
                        "--size",
                        "8x8",
                        "--budget",
                        "10ms",
                        "--runs",
                        "2",
                        "--only",
                        "strict embree recurse",
                        *form,
                    ],
                )
                for form in ([], ["--json"])
            ],
            (RTSL_RUN, ["--help"]),
            (RTSL_RUN, ["-V"]),
            (RTSL_RUN, ["glass.rtslpkg", "-q", "--target=host", "-o", "c.exr", "--json", *SMALL]),
            (RTSL_RUN, ["glass.rtslpkg", "-q", "--target=host", "-o", "-", *SMALL]),
        ]
        for program, arguments in rows:
            with self.subTest(arguments=arguments), open("/dev/full", "w") as full:
                done = self.run_any(program, *arguments, stdout=full)
                self.assertEqual(done.returncode, DIAGNOSED, done.stderr)
                self.assertIn(
                    "cannot write to standard output: No space left on device", done.stderr
                )
                self.assertNotIn("fault of", done.stderr)

    def test_fixes_on_standard_output(self):
        with open("/dev/full", "w") as full:
            done = subprocess.run(
                [RTSLC, "check", "--fix", "-"],
                input=b"float f() { return 1.0 }\n",
                stdout=full,
                stderr=subprocess.PIPE,
                timeout=SECONDS,
            )
        self.assertEqual(done.returncode, DIAGNOSED)
        self.assertIn(b"No space left on device", done.stderr)

    def test_standard_output_is_no_input_either(self):
        with open(self.folder / "grey.rtsl", "a") as output:
            done = self.run_any(RTSLC, "compile", "grey.rtsl", "--emit=ir", stdout=output)
        self.assertEqual(done.returncode, DIAGNOSED)
        self.assertIn("standard output is the same file as the input `grey.rtsl`", done.stderr)
        self.assertEqual((self.folder / "grey.rtsl").read_text(), MATERIAL)

    def test_a_report_of_nothing_leaves_nothing(self):
        for arguments in (
            ["--only", "nothing"],
            ["--set", "materials.clay.class=Nothing"],
            ["--set", "objects.0.material=nothing"],
        ):
            _, error = self.run_rtslc(
                "report",
                "scene.json",
                "--out",
                "out",
                "--budget",
                "10ms",
                *arguments,
                status=DIAGNOSED,
            )
            self.assertNotEqual(error, "")
            self.assertNotIn("out", self.files(), arguments)

    def test_the_picture_to_compare_with_is_looked_at_first(self):
        self.package()
        self.run_rtslc("render", "scene.json", *QUIET, "-o", "a.exr", "--size", "9x8", "--spp", "1")
        for reference, words in (
            ("missing.exr", "No such file"),
            ("a.exr", "has 9x8 pixels of 3 channels, not 8x8 of 3"),
        ):
            done = self.run_any(
                RTSL_RUN,
                "glass.rtslpkg",
                "--target=host",
                "-o",
                "out.exr",
                "--compare",
                reference,
                *SMALL,
            )
            self.assertEqual(done.returncode, DIAGNOSED)
            self.assertIn(words, done.stderr)
            self.assertNotIn("out.exr", self.files())


class Endless(Case):
    """A device is no input, by whatever name: it may never end."""

    def test_devices_are_refused(self):
        self.glass_scene()
        self.run_rtslc("render", "scene.json", *QUIET, "-o", "a.exr", *SMALL)
        for device in ("/dev/zero", "/dev/urandom"):
            for name in (
                "zero.rtsl",
                "zero.json",
                "zero.obj",
                "zero.ply",
                "zero.png",
                "zero.exr",
                "zero.rtslpkg",
            ):
                os.symlink(device, self.folder / name)
            self.write("imports.rtsl", 'import "zero.rtsl";\n')
            self.write("includes.rtsl", '#include "zero.rtsl"\n')
            rows = [
                (RTSLC, ["check", "zero.rtsl"]),
                (RTSLC, ["check", device]),
                (RTSLC, ["check", "imports.rtsl"]),
                (RTSLC, ["check", "includes.rtsl"]),
                (RTSLC, ["check", "zero.json"]),
                (RTSLC, ["compile", "zero.rtsl", "--emit=ir"]),
                (RTSLC, ["render", "zero.json", "-o", "b.exr"]),
                (
                    RTSLC,
                    [
                        "render",
                        "scene.json",
                        "-o",
                        "b.exr",
                        *SMALL,
                        "--set",
                        "objects.3.mesh=zero.obj",
                    ],
                ),
                (
                    RTSLC,
                    [
                        "render",
                        "scene.json",
                        "-o",
                        "b.exr",
                        *SMALL,
                        "--set",
                        "objects.3.mesh=zero.ply",
                    ],
                ),
                (RTSLC, ["compare", "a.exr", "zero.png"]),
                (RTSLC, ["compare", "zero.exr", "a.exr"]),
                (RTSLC, ["report", "scene.json", "--out", "out", "--reference", "zero.exr"]),
                (RTSL_RUN, ["zero.rtslpkg", "-o", "b.exr"]),
            ]
            for program, arguments in rows:
                with self.subTest(arguments=arguments):
                    done = subprocess.run(
                        [program, *arguments],
                        cwd=self.folder,
                        stdin=subprocess.DEVNULL,
                        stdout=subprocess.PIPE,
                        stderr=subprocess.PIPE,
                        timeout=30,
                        text=True,
                    )
                    self.assertEqual(done.returncode, DIAGNOSED, done.stderr)
                    self.assertRegex(done.stderr, "it is a device|cannot find `zero.rtsl`")
            with open(device) as stdin:
                for arguments in (
                    ["check", "-"],
                    ["render", "-", "-o", "b.exr"],
                    ["compare", "-", "a.exr"],
                ):
                    done = subprocess.run(
                        [RTSLC, *arguments],
                        cwd=self.folder,
                        stdin=stdin,
                        stdout=subprocess.PIPE,
                        stderr=subprocess.PIPE,
                        timeout=30,
                        text=True,
                    )
                    self.assertEqual(done.returncode, DIAGNOSED, done.stderr)
                    self.assertIn("it is a device", done.stderr)
            for name in ("rtsl", "json", "obj", "ply", "png", "exr", "rtslpkg"):
                (self.folder / f"zero.{name}").unlink()

    def test_nothing_is_an_input(self):
        out, _ = self.run_rtslc("check", "/dev/null", status=DIAGNOSED)
        self.assertEqual(out, "")


class Streams(Case):
    """`-` is standard input and output."""

    def test_scenes_pictures_and_packages(self):
        scene = self.glass_scene()
        self.run_rtslc("render", "scene.json", *QUIET, "-o", "a.exr", *SMALL)
        arguments = [*QUIET, *SMALL]

        def piped(program, *command, stdin):
            done = subprocess.run(
                [program, *command],
                cwd=self.folder,
                input=stdin,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                timeout=SECONDS,
            )
            self.assertEqual(done.returncode, FINE, done.stderr)
            return done.stdout

        exr = piped(
            RTSLC, "render", "-", "-o", "-", "--format=exr", *arguments, stdin=scene.read_bytes()
        )
        self.assertEqual(exr, (self.folder / "a.exr").read_bytes())
        self.assertEqual(
            piped(RTSLC, "render", "-", "-o", "-", *arguments, stdin=scene.read_bytes())[:4],
            b"\x89PNG",
        )
        self.assertIn(b"the same, bit for bit", piped(RTSLC, "compare", "-", "a.exr", stdin=exr))
        package = piped(RTSLC, "pack", "-", "-o", "-", "-q", stdin=scene.read_bytes())
        picture = piped(
            RTSL_RUN, "-", "-q", "--target=host", "-o", "-", "--format=exr", *SMALL, stdin=package
        )
        self.write("b.exr", picture)
        self.run_rtslc(
            "render", "scene.json", *QUIET, "-o", "c.exr", "--target=host-megakernel", *SMALL
        )
        self.run_rtslc("compare", "b.exr", "c.exr")

    def test_mistakes_in_a_scene_of_standard_input_are_shown(self):
        scene = self.glass_scene(lights=3)
        done = subprocess.run(
            [RTSLC, "render", "-", "-o", "a.png"],
            cwd=self.folder,
            input=scene.read_bytes(),
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            timeout=SECONDS,
        )
        self.assertEqual(done.returncode, DIAGNOSED)
        self.assertRegex(done.stderr.decode(), r"<stdin>:\d+:\d+: error\[E0804\]")
        self.assertIn('"lights": 3', done.stderr.decode())

    def test_two_things_do_not_share_standard_output(self):
        self.glass_scene()
        for option in ("--json", "--print"):
            _, error = self.run_rtslc("render", "scene.json", "-o", "-", option, status=2)
            self.assertIn("standard output is the picture", error)


if __name__ == "__main__":
    unittest.main()
