"""Running out of memory, wherever it happens: a command succeeds, or fails with status 1 and a
message that names the cause."""

import os
import resource
import subprocess
import unittest

from harness import DIAGNOSED, FINE, RTSLC, SECONDS, Case

RTSL_RUN = os.environ["RTSL_RUN"]
os.environ["RTSL_CACHE"] = "off"  # generating code takes memory, too
MIB = 1 << 20
NOT_LOADED = 127  # not even the program's libraries fit


class Memory(Case):
    def run_limited(self, program, *arguments, mebibytes):
        def limit():
            resource.setrlimit(resource.RLIMIT_AS, (mebibytes * MIB, mebibytes * MIB))
            resource.setrlimit(resource.RLIMIT_CORE, (0, 0))

        return subprocess.run(
            [program, *arguments],
            cwd=self.folder,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            timeout=SECONDS,
            preexec_fn=limit,
        )

    def sweep(self, program, *arguments, limits):
        seen = set()
        for mebibytes in limits:
            with self.subTest(arguments=arguments, mebibytes=mebibytes):
                done = self.run_limited(program, *arguments, mebibytes=mebibytes)
                error = done.stderr.decode("utf-8", "replace")
                self.assertIn(done.returncode, (FINE, DIAGNOSED, NOT_LOADED), error)
                self.assertNotIn("fault of", error)
                if done.returncode == DIAGNOSED:
                    self.assertRegex(error, "memory|MiB")
                seen.add(done.returncode)
        return seen

    def test_every_amount(self):
        self.glass_scene()
        small = ("--size", "16x16", "--spp", "1", "--threads", "1")
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", *small)
        # With less, the loader or the start of a library may crash.
        limits = [*range(88, 400, 48), 450, 600, 1200]
        rows = [
            (RTSLC, "check", "Glass.rtsl"),
            (RTSLC, "compile", "Glass.rtsl", "--emit=llvm"),
            (RTSLC, "check", "scene.json"),
            (RTSLC, "render", "scene.json", "-o", "b.exr", "-q", *small),
            (RTSLC, "compare", "a.exr", "a.exr"),
            (RTSL_RUN, "x.rtslpkg", "-o", "b.exr", "-q", "--target=host", *small),
        ]
        for program, *arguments in rows:
            self.assertIn(FINE, self.sweep(program, *arguments, limits=limits))

    def test_a_large_picture_names_itself(self):
        self.glass_scene()
        for way in ([], ["--target=host-megakernel"]):
            done = self.run_limited(
                RTSLC,
                "render",
                "scene.json",
                "-o",
                "a.exr",
                "-q",
                "--size",
                "65536x65536",
                *way,
                mebibytes=2048,
            )
            self.assertEqual(done.returncode, DIAGNOSED)
            self.assertRegex(
                done.stderr.decode(),
                r"E1001\]: not enough memory for the picture: 51539607552 bytes",
            )


if __name__ == "__main__":
    unittest.main()
