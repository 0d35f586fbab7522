"""PTX: the same on every run, and accepted by NVIDIA's assembler where that is installed."""

import re
import shutil
import struct
import subprocess
import unittest

from harness import EXAMPLES, USAGE, Case, example_scenes

PTXAS = shutil.which("ptxas") or shutil.which("/usr/local/cuda/bin/ptxas")
SCENES = example_scenes(part=0, parts=8)


class Ptx(Case):
    def test_it_is_the_same_on_every_run(self):
        sources = sorted((EXAMPLES / "glass").glob("*.rtsl"))
        for inputs, level in ((sources, "-O2"), ([EXAMPLES / "glass" / "scene.json"], "-O1")):
            first, _ = self.run_rtslc("compile", *inputs, "--emit=ptx", level)
            second, _ = self.run_rtslc("compile", *inputs, "--emit=ptx", level)
            self.assertEqual(first, second)

    @unittest.skipUnless(PTXAS, "ptxas is not installed")
    def test_the_assembler_accepts_it(self):
        """Programs for the oldest GPU, which has the fewest instructions, and some of each kind for
        each later one, in turn: the assembler takes seconds for each."""
        self.assertGreaterEqual(len(SCENES), 3)
        for number, scene in enumerate(SCENES):
            oldest, later = "sm_75", ("sm_80", "sm_90")[number // 2 % 2]
            for arch in (oldest, later)[: 2 if number % 2 == 0 else 1]:
                with self.subTest(arch=arch, scene=scene.parent.name):
                    self.assemble(arch, scene)
            shaders = sorted(scene.parent.glob("*.rtsl"))
            arch = (oldest, later)[number % 2]
            if shaders:
                with self.subTest(arch=arch, shaders=scene.parent.name):
                    self.assemble(arch, *shaders, relocatable=True)

    def assemble(self, arch, *inputs, relocatable=False):
        self.run_rtslc(
            *("compile", *inputs, "--emit=ptx", "-O1", f"--gpu-arch={arch}", "-o", "out.ptx")
        )
        done = subprocess.run(
            [
                PTXAS,
                f"-arch={arch}",
                "-O1",
                *(["-c"] if relocatable else []),
                "out.ptx",
                "-o",
                "out.cubin",
            ],
            cwd=self.folder,
            stderr=subprocess.PIPE,
            text=True,
        )
        self.assertEqual(done.returncode, 0, done.stderr[:2000])

    def test_lanes_wait_for_all_of_the_warp_or_for_none(self):
        """A barrier or vote of some lanes can hang a GPU (runtime/device/ray/Warp.h)."""
        scenes = ("environment/scene", "product-shot/scene", "glass/scene", "smoke/smoke")
        for number, scene in enumerate(scenes):
            organisation = ("megakernel", "wavefront", "persistent")[number % 3]
            with self.subTest(scene=scene, organisation=organisation):
                file = EXAMPLES / f"{scene}.json"
                options = ("--exceptions", "-O1", f"--organisation={organisation}")
                text = self.ptx(file, *options, "-Wno-depth-limit")
                waiting = re.findall(r"(?:bar\.warp|vote|shfl|match|redux|elect)\.sync.*;", text)
                self.assertTrue(waiting)
                self.assertEqual([one for one in waiting if not one.endswith(", -1;")], [])

    def test_the_last_line_is_the_limit_of_a_package(self):
        for name in ("glass", "metal"):
            scene = EXAMPLES / name / "scene.json"
            self.run_rtslc("pack", scene, "-o", "a.rtslpkg")
            package = (self.folder / "a.rtslpkg").read_bytes()
            info = struct.unpack_from("<Q", package, 64 + 8)[0]  # docs/packages.md
            registers = struct.unpack_from("<I", package, info + 4 * 18)[0]
            self.assertEqual(
                self.ptx(scene, "-O0").splitlines()[-1],
                f"// rtslc: a thread may have {registers} registers "
                f"(ptxas -maxrregcount={registers})",
            )

    def test_the_architecture_is_one_of_those_listed(self):
        _, error = self.run_rtslc(
            "compile",
            EXAMPLES / "glass" / "Glass.rtsl",
            "--emit=ptx",
            "--gpu-arch=sm_42",
            status=USAGE,
        )
        self.assertIn("sm_75", error)

    def ptx(self, scene, *arguments):
        return self.run_rtslc("compile", scene, "--emit=ptx", *arguments)[0]

    def schedule(self, name, *options):
        """The number of the schedule, and whether states run on: constants of the program, as
        functions that return them before anything is optimised."""
        ptx = self.ptx(EXAMPLES / name, "-O0", *options)
        return [
            re.search(rf"\) {function}\([^}}]*st\.param\.b32\s+\[func_retval0\], (\d+);", ptx)[1]
            for function in ("rtsl_schedule", "rtsl_states_run_on")
        ]

    def test_schedules(self):
        """Scenes that choose rays at random let their lanes gather or vote, others keep them
        together. Where lanes do not gather for states, these run without a choice, but not with a
        schedule that is asked for."""
        schedules = ("majority", "prioritized", "least-waste")
        for name, chosen, runs_on in (
            ("whitted-programs/scene.json", "prioritized", "1"),
            ("metal/scene.json", "majority", "0"),
            ("../bench/gpu/paths/scene.json", "least-waste", "1"),
        ):
            with self.subTest(scene=name):
                schedule, *automatic = self.schedule(name)
                self.assertEqual(automatic, [runs_on])
                asked_for = {one: self.schedule(name, f"--schedule={one}") for one in schedules}
                self.assertEqual({one[1] for one in asked_for.values()}, {"0"})
                self.assertEqual(
                    [name for name, (number, _) in asked_for.items() if number == schedule],
                    [chosen],
                )
        _, error = self.run_rtslc(
            "compile",
            EXAMPLES / "glass" / "scene.json",
            "--emit=ptx",
            "--schedule=fair",
            status=USAGE,
        )
        self.assertIn(
            "`fair` is none of auto, majority, prioritized, least-waste, round-robin, naive", error
        )

    @unittest.skipUnless(PTXAS, "ptxas is not installed")
    def test_the_assembler_accepts_every_schedule(self):
        for one in ("round-robin", "naive"):  # examples have the others
            self.assemble("sm_75", EXAMPLES / "glazes" / "scene.json", f"--schedule={one}")

    def test_a_scene_stands_alone(self):
        glass = EXAMPLES / "glass"
        _, error = self.run_rtslc(
            "compile", glass / "scene.json", glass / "Glass.rtsl", "--emit=ptx", status=USAGE
        )
        self.assertIn("one scene", error)
        self.run_rtslc("compile", glass / "scene.json", "--emit=ast", status=USAGE)
        self.run_rtslc(
            "compile", glass / "Glass.rtsl", "--emit=ptx", "--set", "camera.fov=30", status=USAGE
        )


if __name__ == "__main__":
    unittest.main()
