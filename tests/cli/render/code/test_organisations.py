"""The organisations of a GPU's program: one kernel, a kernel for each step, or blocks of lanes with
samples of their own. What a lane computes is the same, so the picture has the same bits; the CPU
runs all of them, with many samples in flight."""

import json
import re
import shutil
import subprocess
import unittest

from harness import DIAGNOSED, EXAMPLES, RTSLC, USAGE, Case

PTXAS = shutil.which("ptxas") or shutil.which("/usr/local/cuda/bin/ptxas")
HOST = "--target=host-megakernel"
WAVE = "--organisation=wavefront"
BLOCKS = "--organisation=persistent"
SMALL = ("--size=24x18", "--spp=3", "-q")

# Recursion with a stack and payloads; motion; random paths, and variables of the graph.
SCENES = ("whitted-programs/scene.json", "whirligig/whirligig.json", "inherit/inherit.json")


class Organisations(Case):
    def compare(self, scene, *options):
        self.run_rtslc("render", scene, "-o", "one.exr", HOST, *options)
        for organisation in (WAVE, BLOCKS):
            self.run_rtslc("render", scene, "-o", "other.exr", HOST, organisation, *options)
            self.assert_same_bits("one.exr", "other.exr")

    def test_pictures_have_the_same_bits(self):
        for name in SCENES:
            with self.subTest(scene=name):
                self.compare(EXAMPLES / name, *SMALL, "-O1" if name == SCENES[0] else "-O0")

    def test_with_every_kind_of_code(self):
        scene = EXAMPLES / "metal" / "scene.json"
        for options in (
            ["-O0"],
            ["--fp=double"],
            ["--exceptions", "--undefined=nan"],
            ["--color=spectral:5", "--save=live"],
        ):
            with self.subTest(options=options):
                self.compare(scene, *SMALL, *options)

    def test_passes_and_threads(self):
        scene = EXAMPLES / "metal" / "scene.json"
        self.compare(scene, *SMALL, "--threads=1")
        self.run_rtslc("render", scene, "-o", "one.exr", HOST, *SMALL[:1], "--spp=7", "-q")
        for organisation in (WAVE, BLOCKS):
            for spp in (2, 7):
                self.run_rtslc(
                    *("render", scene, "-o", "other.exr", HOST, organisation, "-q", *SMALL[:1]),
                    *(f"--spp={spp}", f"--checkpoint={organisation}.ckpt"),
                )
            self.assert_same_bits("one.exr", "other.exr")

    def test_the_steps_are_the_same(self):
        """Each sample runs the same states, whatever the organisation."""
        scene = EXAMPLES / "metal" / "scene.json"
        counts = []
        for options in ((), (WAVE,), (BLOCKS,)):
            out, _ = self.run_rtslc(
                *("render", scene, "-o", "a.exr", HOST, "--lane-use", "--json", *SMALL, *options)
            )
            steps = json.loads(out)["steps"]
            counts.append({step["step"]: step["lanes"] for step in steps})
        self.assertGreater(len(counts[0]), 3)
        for one in counts:
            del one["begin samples"]  # lanes and slots that get none
        self.assertEqual(counts[0], counts[1])
        self.assertEqual(counts[0], counts[2])

    def test_a_kernel_for_each_state(self):
        ptx, _ = self.run_rtslc(
            "compile", EXAMPLES / "glass" / "scene.json", "--emit=ptx", WAVE, "-O0", "-o", "-"
        )
        kernels = re.findall(r"\.entry (\w+)\(", ptx)
        states = [name for name in kernels if name.startswith("rtsl_wave_state_")]
        self.assertGreater(len(states), 5)
        self.assertEqual(
            sorted(set(kernels) - set(states)),
            ["rtsl_sum", "rtsl_wave_begin", "rtsl_wave_sample", "rtsl_wave_trace"],
        )
        self.assertFalse("rtsl_record_load" in ptx or "rtsl_record_store" in ptx)

    def test_records_have_only_what_steps_need(self):
        """The engine keeps no address of the ray's state: its words are values, and those that no
        step changes or reads are gone. One loop over components that is not unrolled is enough to
        keep all 300 of them."""
        ptx, _ = self.run_rtslc(
            *("compile", EXAMPLES / "cornell" / "room.json", "--emit=ptx", WAVE),
            "-Wno-depth-limit",
        )
        groups = re.search(
            r"rtsl_record_groups\(\).*?st\.param\.b32 +\t?\[\w+\], (\d+);", ptx, re.S
        )
        self.assertLess(int(groups[1]), 32)

    def test_one_kernel_for_persistent_blocks(self):
        """The records are in shared memory, whose size the launch gives."""
        ptx, _ = self.run_rtslc(
            "compile", EXAMPLES / "glass" / "scene.json", "--emit=ptx", BLOCKS, "-o", "-"
        )
        self.assertEqual(
            sorted(re.findall(r"\.entry (\w+)\(", ptx)), ["rtsl_persistent", "rtsl_sum"]
        )
        self.assertRegex(ptx, r"\.extern \.shared \.align 16 \.b8 rtsl_block_memory\[\]")
        self.assertRegex(ptx, r"ld\.shared[.\w]*v4")
        self.assertFalse("rtsl_record_load" in ptx or "rtsl_record_store" in ptx)

    @unittest.skipUnless(PTXAS, "ptxas is not installed")
    def test_the_assembler_accepts_it(self):
        scene = EXAMPLES / "glass" / "scene.json"
        for organisation in (WAVE, BLOCKS):
            self.run_rtslc("compile", scene, "--emit=ptx", organisation, "-o", "a.ptx")
            done = subprocess.run(
                [PTXAS, "-arch=sm_75", "-O1", "a.ptx", "-o", "a.cubin"],
                cwd=self.folder,
                stderr=subprocess.PIPE,
                text=True,
            )
            self.assertEqual(done.returncode, 0, done.stderr[:2000])

    def test_paths_through_trees_panes_or_long_shaders_are_a_wavefront(self):
        cornell = json.loads((EXAMPLES / "cornell" / "scene.json").read_text())
        cornell["materials"]["white"] = {"class": "ThinGlass"}
        panes = self.write("panes.json", json.dumps(cornell))
        for scene, kernel in (
            (EXAMPLES / "cornell" / "room.json", "rtsl_wave_begin"),
            (EXAMPLES / "cornell" / "scene.json", "rtsl_render"),
            (EXAMPLES / "cook" / "scene.json", "rtsl_wave_begin"),
            (panes, "rtsl_wave_begin"),
        ):
            ptx, _ = self.run_rtslc("compile", scene, "--emit=ptx", "-O0", "-Wno-depth-limit")
            self.assertIn(f".entry {kernel}(", ptx)

    def test_the_name_is_one_of_those_listed(self):
        _, error = self.run_rtslc(
            *("render", EXAMPLES / "metal" / "scene.json", "-o", "a.exr", HOST),
            "--organisation=waves",
            status=USAGE,
        )
        self.assertIn("`waves` is none of auto, megakernel, wavefront, persistent", error)


class OnTheStandIn(Case):
    """On the stand-in for a CUDA driver, which checks how kernels are launched."""

    def render(self, *arguments, scene=EXAMPLES / "glass" / "scene.json", **how):
        command = (RTSLC, "render", scene, "-o", "a.exr", "--target=gpu", "-O0")
        return self.run_with_fake_driver([*command, "-Wno-depth-limit", *arguments], **how)

    def test_turns_end_when_no_sample_is_left(self):
        arguments = ("--size=32x18", "--spp=5", "-q")
        self.render(*arguments)
        (self.folder / "a.exr").rename(self.folder / "one.exr")
        for organisation in (WAVE, BLOCKS):
            out, _ = self.render(*arguments, organisation, "--json")
            self.assert_same_bits("a.exr", "one.exr")
            self.assertEqual(json.loads(out)["samples"], 32 * 18 * 5)

    def test_a_limit_of_registers_is_that_of_all_kernels(self):
        """Those that look for lights state a limit of their own; the stand-in compares both."""
        scene = EXAMPLES / "cornell" / "room.json"
        options = (WAVE, "--light-kernels=always")
        self.assertIn(".maxnreg 64", self.run_rtslc("compile", scene, "--emit=ptx", *options)[0])
        for limit in ((), ("--max-registers=200",), ("--max-registers=40",)):
            self.render("--size=32x18", "-q", *options, *limit, scene=scene)

    def test_little_shared_memory(self):
        _, error = self.render("-q", BLOCKS, fake="little-shared-memory", status=DIAGNOSED)
        self.assertRegex(
            error,
            r"error\[E1001\]: not enough shared memory for rays in flight: \d+ bytes for each of "
            r"32, and a block has 4096 at most; `--organisation=megakernel` needs none",
        )


if __name__ == "__main__":
    unittest.main()
