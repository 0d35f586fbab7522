"""Code that is kept for the next run (codegen/driver/machine/CodeFiles.h): it changes no picture,
and whatever happens to its files is no error."""

import json
import os
import pathlib
import unittest

from harness import EXAMPLES, Case

SCENE = EXAMPLES / "quadrics/scene.json"


class CodeFiles(Case):
    def setUp(self):
        super().setUp()
        self.cache = pathlib.Path(self.folder, "cache")
        before = dict(os.environ)
        self.addCleanup(lambda: (os.environ.clear(), os.environ.update(before)))
        os.environ["RTSL_CACHE"] = str(self.cache)

    def picture(self, *options):
        """The picture's bits, and whether code of an earlier run was used."""
        arguments = ("--size", "16x9", "--spp", "1", *options)
        out, _ = self.run_rtslc("render", SCENE, "-o", "x.exr", "--json", *arguments)
        is_known = "modulesOfEarlierRuns" in json.loads(out)
        return pathlib.Path(self.folder, "x.exr").read_bytes(), is_known

    def code(self):
        return sorted(self.cache.glob("llvmcache-*")) if self.cache.exists() else []

    def test_the_next_run_uses_it(self):
        first = self.picture()
        self.assertFalse(first[1])
        self.assertEqual(self.cache.stat().st_mode & 0o777, 0o700)
        self.assertTrue(self.code())
        self.assertEqual(self.picture(), (first[0], True))

    def test_commands_without_pictures_use_it(self):
        def made(name, *arguments):
            """What the command prints and writes."""
            out, _ = self.run_rtslc(*arguments, "-o", name)
            return out, pathlib.Path(self.folder, name).read_bytes()

        for command in (
            ("compile", SCENE, "--emit=ptx"),
            ("pack", SCENE, "-q", "--organisation=wavefront"),
            ("pack", SCENE, "-q", "--organisation=megakernel"),
            ("explain", SCENE, "--no-savings"),
        ):
            with self.subTest(command=command):
                os.environ["RTSL_CACHE"] = "off"
                expected = made("x", *command)
                os.environ["RTSL_CACHE"] = str(self.cache)
                self.assertEqual(made("x", *command), expected)
                files = {file: file.stat().st_ino for file in self.code()}
                self.assertEqual(made("x", *command), expected)
                self.assertEqual({file: file.stat().st_ino for file in self.code()}, files)

    def test_other_options_have_other_code(self):
        host, _ = self.picture()
        known = self.code()
        megakernel, _ = self.picture("--target=host-megakernel")  # constructors are the same
        self.assertGreater(len(self.code()), len(known))
        self.assertEqual(megakernel, host)

    def test_damaged_code_is_made_again(self):
        good, _ = self.picture()
        for damage in (
            lambda text: b"",
            lambda text: text[: len(text) // 2],
            lambda text: text[:-9] + bytes([text[-9] ^ 1]) + text[-8:],
            lambda text: b"0" * len(text),
        ):
            for file in self.code():
                file.write_bytes(damage(file.read_bytes()))
            self.assertEqual(self.picture(), (good, False))
        self.assertEqual(self.picture(), (good, True))  # it was written again

    def test_a_folder_that_others_may_write_to_is_not_used(self):
        self.cache.mkdir()
        self.cache.chmod(0o777)
        self.picture()
        self.assertEqual(self.code(), [])

    def test_a_folder_that_cannot_be_made_is_no_error(self):
        self.cache.write_text("a file")
        self.assertFalse(self.picture()[1])
        self.assertEqual(self.cache.read_text(), "a file")

    def test_where_it_is(self):
        home = pathlib.Path(self.folder, "home")
        for variables, folder in (
            ({"RTSL_CACHE": "off", "HOME": str(home)}, None),
            ({"RTSL_CACHE": "", "HOME": str(home)}, None),
            ({"HOME": str(home)}, home / ".cache/rtslc"),
            ({"HOME": str(home), "XDG_CACHE_HOME": str(home / "x")}, home / "x/rtslc"),
        ):
            with self.subTest(variables=variables):
                for name in ("RTSL_CACHE", "HOME", "XDG_CACHE_HOME"):
                    os.environ.pop(name, None)
                os.environ.update(variables)
                self.picture()
                made = sorted({file.parent for file in home.rglob("llvmcache-*")})
                self.assertEqual(made[-1:], [folder] if folder else [])


if __name__ == "__main__":
    unittest.main()
