"""rtslc render --target=gpu: the scene goes to the driver whole, what is wrong with a device is
said, and where the machine has a GPU the picture has the bits of the host megakernel."""

import json
import re
import unittest

from harness import (
    DIAGNOSED,
    EXAMPLES,
    FAULTS_OF_DEVICES,
    FINE,
    INTERNAL,
    LITTLE_MEMORY,
    RTSL_RUN,
    RTSLC,
    UNUSABLE_DEVICES,
    USAGE,
    Case,
    example_scenes,
    has_gpu,
)

SMALL = ("--size", "32x18", "--spp", "2", "-Wno-depth-limit")


class Gpu(Case):
    def setUp(self):
        super().setUp()
        self.glass_scene()

    def render(
        self,
        *arguments,
        status=FINE,
        fake="",
        folder=None,
        program=(RTSLC, "render", "scene.json"),
        devices=1,
    ):
        arguments = (*program[1:], "-o", "a.exr", "--target=gpu", *arguments)
        if program[0] == RTSLC:
            arguments = self.with_level(arguments)
        command = [program[0], *arguments]
        return self.run_with_fake_driver(command, status, fake, folder, devices)

    def test_the_gpu_gets_what_a_package_gives_it(self):
        """The stand-in paints x, y and the seed, if all of the launch has arrived."""
        out, error = self.render(*SMALL, "--seed", "3", "--json")
        figures = json.loads(out)
        self.assertEqual(error, "")
        self.assertEqual((figures["pixels"], figures["samples"], figures["seed"]), (576, 1152, 3))
        gpu = figures["gpu"]
        self.assertEqual(
            (gpu["device"], gpu["blocks"], gpu["threadsPerBlock"], gpu["registers"]),
            ("Fake 1000", 5, 128, 40),
        )
        self.assertEqual((gpu["spillStores"], gpu["spillLoads"], gpu["occupancy"]), (8, 12, 0.375))
        for seconds in (gpu["loadSeconds"], gpu["uploadSeconds"], *figures["seconds"].values()):
            self.assertGreaterEqual(seconds, 0)
        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
        (self.folder / "a.exr").rename(self.folder / "first.exr")
        out, _ = self.render(
            "--size",
            "32x18",
            "--spp",
            "2",
            "--seed",
            "3",
            "--compare",
            "first.exr",
            "--json",
            program=(RTSL_RUN, "x.rtslpkg"),
        )
        self.assertEqual(json.loads(out)["laneBytes"], gpu["laneBytes"])

    def test_a_rendering_goes_on_with_its_sums(self):
        """They go to the device and come back; sample n of the stand-in is n times what it
        paints."""
        whole = json.loads(
            self.render(*SMALL[:2], "--spp=9", "--checkpoint=whole.ckpt", "--json")[0]
        )
        (self.folder / "a.exr").rename(self.folder / "whole.exr")
        for spp in (2, 5, 9):
            part = json.loads(
                self.render(*SMALL[:2], f"--spp={spp}", "--checkpoint=a.ckpt", "--json")[0]
            )
            self.assertEqual(part["samples"], 576 * spp)
        self.assertEqual(part["resumedAt"], 5)
        self.assertEqual((part["samples"], part["pixels"]), (whole["samples"], whole["pixels"]))
        self.assert_same_bits("a.exr", "whole.exr")
        document = json.loads(
            self.render(*SMALL[:2], "--time=300ms", "--json", "--crop=3,4,10,8")[0]
        )
        self.assertEqual(document["samples"], 28 * document["spp"])

    def test_sums_stay_on_the_device(self):
        """Passes of 1, 16 and more samples copy as much as two of 1, but for the state of each."""

        def copied(samples):
            size = ("--size", "64x64", "--time=1000s", "-Wno-depth-limit", "-q")
            _, error = self.render(*size, f"--spp={samples}", fake="copies")
            return max(map(int, re.findall(r"(\d+) bytes were copied", error)))

        sums = 64 * 64 * (3 * 8 + 4 + 4)
        few, many = copied(2), copied(300)
        self.assertGreater(few, sums)  # they come back
        self.assertLess(many - few, sums)

    def test_a_thread_for_each_sample_or_pixel(self):
        """Each launch goes on where the one before ended, as the stand-in checks."""
        size = ("--size", "200x150", "--spp", "40", "--max-registers", "64", "-Wno-depth-limit")
        self.render(*size)
        (self.folder / "a.exr").rename(self.folder / "lanes.exr")
        for engine, kernel in (("albedo", "samples"), ("depth", "pixels")):
            scene = {"include": str(EXAMPLES / "cornell" / "scene.json")}
            scene["render"] = {"engine": engine}
            self.write("view.json", json.dumps({"rtsl": 1, **scene}))
            ptx = self.run_rtslc("compile", "view.json", "--emit=ptx", "-O0")[0]
            self.assertIn(f".entry rtsl_render_{kernel}(", ptx)
            out, _ = self.render(*size, "--json", program=(RTSLC, "render", "view.json"))
            self.assertEqual(json.loads(out)["samples"], 200 * 150 * 40)
            self.assert_same_bits("a.exr", "lanes.exr")

    def test_the_drivers_compiler_uses_all_cores(self):
        """Older drivers refuse the option."""
        self.render(*SMALL)
        (self.folder / "a.exr").rename(self.folder / "old.exr")
        self.render(*SMALL, fake="new-driver")
        self.assert_same_bits("a.exr", "old.exr")

    def test_it_says_what_ran(self):
        _, error = self.render(*SMALL)
        self.assertRegex(
            error,
            r"^a\.exr: 32x18, 2 spp; compiled in \d+ ms, rendered in .* samples/s\)\n"
            r"Fake 1000: 40 registers and 40 local bytes \(8 spilled\) per thread, 5 blocks of 128 "
            r"threads \(38 % of those that fit\), \d+ bytes for the rays of each; "
            r"code loaded in \d+ ms, scene in \d+ ms\n"
            r"good tree: \d+ nodes for \d+ items, cost [\d.]+, built in \d+ ms\n$",
        )

    def test_trees_on_the_device_follow_from_frame_to_frame(self):
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["objects"][0]["transform"] = {
            "translate": {"frames": {"0": [0.1, 0, 0], "4": [1, 0.5, 0]}}
        }
        self.write("scene.json", json.dumps(scene))
        frames = (RTSLC, "render", "scene.json", "-o", "a%d.exr", "--frames=0..2", "--target=gpu")
        for devices in (1, 2):
            for tree in ("good", "fast"):
                command = self.with_level([*frames, *SMALL, f"--tree={tree}", f"--gpus={devices}"])
                _, said = self.run_with_fake_driver(command, devices=devices)
                self.assertEqual(said.count("trees of the picture before: refitted"), 2, said)
                self.assertEqual(said.count(", refitted in "), 2, said)

    def test_several_gpus_render_the_picture_of_one(self):
        """The second one is slower than the others, and gets less of it."""
        arguments = ("--size=64x200", "--spp=2", "-Wno-depth-limit")
        self.render(*arguments)
        (self.folder / "a.exr").rename(self.folder / "one.exr")
        out, _ = self.render(*arguments, "--gpus=all", "--json", devices=3, fake="uneven")
        self.assert_same_bits("a.exr", "one.exr")
        samples = [gpu["samples"] for gpu in json.loads(out)["gpus"]]
        self.assertEqual((len(samples), sum(samples)), (3, 64 * 200 * 2))
        self.assertLess(samples[1], max(samples))
        _, error = self.render(*arguments, "--gpus=2", devices=3)
        self.assert_same_bits("a.exr", "one.exr")
        self.assertEqual(len(re.findall(r"^Fake 1000: \d+ samples; 40 reg", error, re.M)), 2)
        passes = ("--size=64x200", "-Wno-depth-limit", "-q")
        self.render(*passes, "--spp=9")
        (self.folder / "a.exr").rename(self.folder / "one.exr")
        for spp in (4, 9):
            self.render(
                *(*passes, f"--spp={spp}", "--checkpoint=c", "--gpus=2"), devices=2, fake="uneven"
            )
        self.assert_same_bits("a.exr", "one.exr")

        self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q")
        out, _ = self.render(
            *arguments[:2],
            *("--gpus=3", "--json"),
            devices=3,
            program=(RTSL_RUN, "x.rtslpkg"),
        )
        samples = [gpu["samples"] for gpu in json.loads(out)["gpus"]]
        self.assertEqual((len(samples), sum(samples)), (3, 64 * 200 * 2))

    def test_steps_are_counted(self):
        """Each ray is traversed once, and then one first state runs: that of the method of glass,
        that of other materials, or that of what misses."""
        options = (*SMALL, "--target=host-megakernel")
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", *options)
        out, _ = self.run_rtslc(
            "render", "scene.json", "-o", "b.exr", "--json", "--lane-use", *options
        )
        self.assert_same_bits("a.exr", "b.exr")
        counts = {one["step"]: one for one in json.loads(out)["steps"]}
        for one in counts.values():
            self.assertEqual(one["steps"], one["lanes"], one)
        taken = {name: one["steps"] for name, one in counts.items()}
        self.assertGreaterEqual(taken["begin samples"], 32 * 18 * 2)
        self.assertGreater(taken["Glass.shade.state0"], 0)
        self.assertEqual(
            taken["traversal"],
            sum(steps for name, steps in taken.items() if name.endswith(".state0")),
        )
        _, error = self.run_rtslc("render", "scene.json", "-o", "b.exr", "--lane-use", *options)
        self.assertRegex(error, r"steps of warps   lanes\n +\d+    1\.00  all\n +\d+    1\.00  tr")
        _, error = self.run_rtslc("render", "scene.json", "-o", "b.exr", "--lane-use", status=USAGE)
        self.assertIn("--lane-use: there are no lanes", error)

    def test_gpus_that_are_not_there(self):
        _, error = self.render(*SMALL, "--gpus=3", devices=2, status=DIAGNOSED)
        self.assertIn(
            "error[E1002]: `--gpus 3` is more than the 2 that the CUDA driver finds", error
        )
        _, error = self.render(*SMALL, "--gpus=some", status=USAGE)
        self.assertIn("--gpus", error)
        for option in ("--gpus=2", "--max-registers=80"):
            _, error = self.run_rtslc("render", "scene.json", "-o", "b.exr", option, status=USAGE)
            self.assertIn("no GPU renders; add `--target=gpu`", error)
        _, error = self.render(
            *("--gpus=2", "-O0", "--size=64x64"),
            program=(RTSLC, "render", str(EXAMPLES / "line-of-sight" / "city.json")),
            devices=2,
            status=DIAGNOSED,
        )
        self.assertIn("the scene writes buffers, which several GPUs cannot share", error)

    def test_every_example_goes_there(self):
        for scene in example_scenes(part=3):
            with self.subTest(scene=scene):
                self.render(*SMALL, "-q", "-O0", program=(RTSLC, "render", str(scene)))

    def test_what_is_wrong_with_a_gpu_is_said(self):
        host = "`--target=host-megakernel` renders the same picture on the CPU"
        for fake, text in UNUSABLE_DEVICES.items():
            with self.subTest(fake=fake):
                _, error = self.render(*SMALL, fake=fake, status=DIAGNOSED)
                self.assertIn("error[E1002]: " + text, error)
                self.assertIn(host, error)
        fake, text = LITTLE_MEMORY
        _, error = self.render(*SMALL, fake=fake, status=DIAGNOSED)
        self.assertIn("error[E1001]: " + text, error)
        for fake, text in FAULTS_OF_DEVICES.items():
            with self.subTest(fake=fake):
                _, error = self.render(*SMALL, fake=fake, status=INTERNAL)
                self.assertIn(text, error)
        self.assertNotIn("a.exr", self.files())

    def test_a_missing_driver_is_said_before_anything_is_compiled(self):
        (self.folder / "libcuda.so.1").write_text("no driver")
        self.write(
            "scene.json",
            (self.folder / "scene.json").read_text().replace("Glass.rtsl", "Missing.rtsl"),
        )
        _, error = self.render(*SMALL, folder=self.folder, status=DIAGNOSED)
        self.assertIn("error[E1002]: there is no CUDA driver", error)
        self.assertNotIn("Missing.rtsl", error)
        self.assertIn("--target=host-megakernel", error)

    def test_what_a_gpu_cannot_do_is_refused(self):
        for arguments, text in (
            (
                ["--fp=double"],
                "--fp: shaders on a GPU compute in single precision; give strict or fast",
            ),
            (["--gpu-arch=sm_12"], "--gpu-arch"),
        ):
            with self.subTest(arguments=arguments):
                _, error = self.render(*SMALL, *arguments, status=USAGE)
                self.assertIn(text, error)

    def test_events_are_kept(self):
        self.render(*SMALL, "-q", "--keep=all")
        self.render(*SMALL, "-q", "--exceptions")
        self.write(
            "tells.rtsl",
            "class Tells : rt_Camera { void generateRay() { print(rt_ScreenCoord); } };",
        )
        self.render(
            *SMALL,
            "-q",
            "--print",
            "-O0",
            program=(RTSLC, "render", str(self.folder / "tells.rtsl")),
        )

    @unittest.skipUnless(has_gpu(), "this machine has no GPU")
    def test_the_bits_of_the_host_megakernel(self):
        for scene in example_scenes():
            for arguments in ((), ("--exceptions",), ("--gpu-arch=sm_75",)):
                with self.subTest(scene=scene, arguments=arguments):
                    for target in ("gpu", "host-megakernel"):
                        self.run_rtslc(
                            "render",
                            scene,
                            "-o",
                            f"{target}.exr",
                            "-q",
                            *SMALL,
                            *arguments,
                            f"--target={target}",
                        )
                    self.assert_same_bits("gpu.exr", "host-megakernel.exr")

    @unittest.skipUnless(has_gpu(), "this machine has no GPU")
    def test_checkpoints_of_other_backends(self):
        arguments = ["render", "scene.json", "-q", "-Wno-depth-limit", "--size=200x150"]
        for spp, target in ((3, "gpu"), (5, "host-megakernel"), (11, "gpu"), (13, "host")):
            self.run_rtslc(
                *arguments,
                "-o",
                "a.exr",
                f"--spp={spp}",
                f"--target={target}",
                "--checkpoint=a.ckpt",
                "--checkpoint-every=1ms",
            )
        self.run_rtslc(*arguments, "-o", "whole.exr", "--spp=13")
        self.assert_same_bits("a.exr", "whole.exr")


if __name__ == "__main__":
    unittest.main()
