"""Messages of the command line for invalid arguments, and their hints."""

import os
import re
import subprocess
import unittest

from harness import DIAGNOSED, RTSLC, SECONDS, USAGE, Case

RTSL_RUN = os.environ["RTSL_RUN"]
COMMANDS = (
    "new",
    "check",
    "compile",
    "explain",
    "render",
    "run",
    "trace",
    "report",
    "pack",
    "compare",
)
# What must be given beside the option that is tried.
REQUIRED = {
    "new": ["material", "X"],
    "render": ["x.json", "-o", "x.png"],
    "run": ["x.json"],
    "trace": ["x.obj", "--rays", "x.npy"],
    "report": ["x.json", "--out", "x"],
    "pack": ["x.json", "-o", "x"],
    "compare": ["x.png", "x.png"],
}


class Arguments(Case):
    def usage(self, program, *arguments):
        """Standard error of a run that ends with the status of wrong arguments."""
        done = subprocess.run(
            [program, *arguments],
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            timeout=SECONDS,
        )
        error = done.stderr.decode("utf-8")  # and nothing but text
        self.assertEqual(done.returncode, USAGE, (arguments, error))
        self.assertTrue(all(c.isprintable() or c == "\n" for c in error), error)
        return error

    def options(self):
        """Every option with what --help says that it takes: (program, command, option, values,
        description)."""
        for command in (*COMMANDS, None):
            program, first = (RTSLC, [command]) if command else (RTSL_RUN, [])
            text = subprocess.run(
                [program, *first, "--help"], stdout=subprocess.PIPE, text=True, check=True
            ).stdout
            text = re.sub(r"\n {20,}", " ", text)
            for names, values, description in re.findall(
                r"^  (-\S+) (\S+)(?: \.\.\.)?(?: +(.*))?$", text, re.M
            ):
                yield program, first, names.split(",")[-1], values, description

    def test_every_option_of_few_words_lists_them(self):
        tried = set()
        for program, first, option, values, _ in self.options():
            words = values.split("|")
            if len(words) < 2 or option == "--color":
                continue
            with self.subTest(command=first, option=option):
                extra = REQUIRED.get(
                    first[0] if first else None,
                    ["x.rtslpkg", "-o", "x.png"] if not first else ["x.rtsl"],
                )
                error = self.usage(program, *first, *extra, f"{option}=nonsense")
                self.assertIn("`nonsense`", error)
                for word in words:
                    self.assertRegex(error, rf"\b{re.escape(word)}\b")
                tried.add(option)
        self.assertLessEqual(
            {
                "--emit",
                "--metric",
                "--fp",
                "--trace",
                "--save",
                "--gpu-arch",
                "--diagnostics",
                "--ansi",
                "--format",
                "--traversal",
                "--target",
                "--keep",
            },
            tried,
        )

    def test_every_number_with_a_range_says_it(self):
        """Of each two of the values in turn; most options are of several commands."""
        tried = set()
        for program, first, option, values, description in self.options():
            found = re.search(r"\((\d+) to (\d+)\)", description or "")
            if not found:
                continue
            extra = REQUIRED.get(
                first[0] if first else None,
                ["x.rtslpkg", "-o", "x.png"] if not first else ["x.rtsl"],
            )
            low, high = map(int, found.groups())
            wrong_ones = (str(low - 1), "1e400", "", "0x3", str(high + 1), "nan", "3x", "+1")
            self.turn = getattr(self, "turn", -1) + 1
            for wrong in wrong_ones[self.turn % 4 :: 4]:
                with self.subTest(command=first, option=option, value=wrong):
                    error = self.usage(program, *first, *extra, option, wrong)
                    self.assertIn(f"`{wrong}` is not a whole number from {low} to {high}", error)
            tried.add(option)
        self.assertLessEqual(
            {
                "--spp",
                "--depth",
                "--seed",
                "--threads",
                "--runs",
                "--pairs",
                "-O",
                "--error-limit",
                "--max-registers",
            },
            tried,
        )

    def test_thresholds(self):
        for wrong in ("-1", "nan", "-inf", "many", "", "1x"):
            error = self.usage(RTSLC, "compare", "a.exr", "b.exr", "--threshold", wrong)
            self.assertIn(f"`{wrong}` is not a number of at least 0", error)

    def test_numbers_that_are_too_large_for_a_scene(self):
        scene = self.glass_scene()
        for value, place in (("1e400", "1e400"), ("[1, 1e999]", "1e999"), ("-1e400", "-1e400")):
            (message,) = self.diagnose(
                "render", "scene.json", "-o", "a.png", "--set", f"render.spp={value}"
            )
            self.assertEqual(message["code"], "E0809")
            self.assertEqual(
                message["message"], f"`{place}` is too large: the largest number is 1.8e+308"
            )
        scene.write_text(scene.read_text().replace('"depth": 8', '"depth": 8e999'))
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "a.png"), "E0805", "`8e999` is too large"
        )

    def test_help_is_a_command(self):
        for words, same in (
            (["help"], ["--help"]),
            *((["help", command], [command, "--help"]) for command in COMMANDS),
        ):
            self.assertEqual(self.run_rtslc(*words), self.run_rtslc(*same))
        self.assertIn(
            "unknown command `rendr`; did you mean `render`?", self.usage(RTSLC, "help", "rendr")
        )
        out, _ = self.run_rtslc("--help")
        for command in (*COMMANDS, "help"):
            self.assertRegex(out, rf"\n  {command} +\S")

    def test_short_version(self):
        self.assertEqual(self.run_rtslc("-V"), self.run_rtslc("--version"))
        done = subprocess.run([RTSL_RUN, "-V"], stdout=subprocess.PIPE, text=True, check=True)
        self.assertRegex(done.stdout, r"^rtsl-run \d+\.\d+\.\d+\n$")

    def test_files_in_place_of_commands(self):
        self.glass_scene()
        self.write("grey.rtsl", "float f() { return 1.0; }")
        self.assertIn(
            "did you mean `rtslc render scene.json -o picture.png`?",
            self.usage(RTSLC, "scene.json"),
        )
        self.assertIn("did you mean `rtslc check grey.rtsl`?", self.usage(RTSLC, "grey.rtsl"))

    def test_shaders_in_place_of_a_scene(self):
        self.write("grey.rtsl", "float f() { return 1.0; }")
        (message,) = self.diagnose("pack", "grey.rtsl", "-o", "a.png")
        self.assertEqual(message["code"], "E0865")
        self.assertEqual(
            message["message"],
            "`grey.rtsl` contains shaders, but `rtslc pack` takes a scene, which imports them",
        )
        self.assertIn('"import": ["grey.rtsl"]', message["notes"][0])
        _, error = self.run_rtslc("report", "grey.rtsl", "--out", "out", status=DIAGNOSED)
        self.assertIn("E0865", error)

    def test_scenes_are_checked(self):
        scene = self.glass_scene()
        self.assertEqual(self.run_rtslc("check", "scene.json"), ("", ""))
        self.assertEqual(
            self.run_rtslc("check", "scene.json", *sorted(self.folder.glob("*.rtsl"))), ("", "")
        )
        good = scene.read_text()
        for old, new, code in (
            ('"rtsl": 1', '"rtsl": "one"', "E0804"),
            ('"radius"', '"radios"', None),
            ('"Glass"', '"Glas"', "E0810"),
            (".obj", ".objekt", "E0900"),
        ):
            scene.write_text(good.replace(old, new, 1))
            messages = self.diagnose("check", "scene.json")
            self.assertTrue(messages, new)
            if code:
                self.assertEqual(messages[0]["code"], code)
        scene.write_text(good)
        self.assert_message(self.diagnose("check", "scene.json", "--set", "render.spp=0"), "E0805")
        _, error = self.run_rtslc("check", "scene.json", "--set", "objects.1.primitive.radius=0")
        self.assertIn("[-Wscene]", error)
        self.write("broken.rtsl", "float f() { return; }")
        scene.write_text(good.replace('"rtsl": 1', '"rtsl": 2'))
        codes = [message["code"] for message in self.diagnose("check", "broken.rtsl", "scene.json")]
        self.assertEqual(len(codes), 2, "one of the scene, one of the other file")
        self.usage(RTSLC, "check", "broken.rtsl", "--set", "render.spp=1")


if __name__ == "__main__":
    unittest.main()
