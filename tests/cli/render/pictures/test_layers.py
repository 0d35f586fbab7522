"""`rtslc render --aov`: views as layers of one EXR file."""

import json
import signal
import struct
import subprocess
import time
import unittest

from exr_files import attributes, channels
from harness import RTSLC, SECONDS, USAGE, Case, deep

SMALL = ("--size", "50x37")  # not whole tiles
VIEWS = ("albedo", "normals", "depth", "id", "occlusion")


class Layers(Case):
    def setUp(self):
        super().setUp()
        self.glass_scene()

    def render(self, name, *options):
        out, _ = self.run_rtslc(
            "render", "scene.json", "-o", name, "-Wno-depth-limit", *SMALL, *options
        )
        return out

    def assert_layers(self, name, views, picture, *options):
        """The picture has the channels of `picture`, and each layer those of its view."""
        found = channels((self.folder / name).read_bytes())
        expected = channels((self.folder / picture).read_bytes())
        for view in views:
            self.render("view.exr", f"--engine={view}", *options)
            of_view = channels((self.folder / "view.exr").read_bytes())
            for channel, words in of_view.items():
                if view != "depth":
                    expected[f"{view}.{channel}"] = words
            if view == "depth":
                expected["depth.Z"] = next(iter(of_view.values()))
        self.assertEqual(sorted(found), sorted(expected))
        for channel in expected:
            self.assertEqual(found[channel], expected[channel], channel)

    def test_a_layer_is_what_its_view_renders(self):
        for way in (
            ["--spp=3"],
            ["--spp=2", "--engine=path"],
            ["--spp=2", "--target=host-megakernel"],
            ["--spp=2", "--trace=split"],
            ["--spp=2", "--color=mono"],
            ["--spp=2", "--color=spectral:4"],
            ["--spp=2", "--crop=5,6,40,30"],
            ["--spp=2", "--seed=9"],
        ):
            with self.subTest(way=way):
                self.render("whole.exr", *way)
                views = VIEWS if way == ["--spp=3"] else ("normals", "depth")
                self.render("layers.exr", "--aov=" + ",".join(views), *way)
                self.assert_layers(
                    "layers.exr",
                    views,
                    "whole.exr",
                    *[option for option in way if "engine" not in option],
                )

    def test_the_samples_are_those_of_the_picture(self):
        document = json.loads(self.render("layers.exr", "--time=200ms", "--aov=albedo", "--json"))
        self.render("whole.exr", f"--spp={document['spp']}")
        self.assert_layers("layers.exr", ["albedo"], "whole.exr", f"--spp={document['spp']}")

    def test_layers_of_a_rendering_that_was_resumed(self):
        self.render("part.exr", "--spp=2", "--checkpoint=a.ckpt")
        self.render("layers.exr", "--spp=5", "--checkpoint=a.ckpt", "--aov=id", "--aov=id,normal")
        self.render("whole.exr", "--spp=5")
        self.assert_layers("layers.exr", ["id", "normals"], "whole.exr", "--spp=5")

    def test_other_commands_read_the_picture_alone(self):
        for color in ("rgb", "mono"):
            self.render("whole.exr", "--spp=1", f"--color={color}")
            self.render("layers.exr", "--spp=1", f"--color={color}", "--aov=id,depth")
            out, _ = self.run_rtslc("compare", "whole.exr", "layers.exr", "--json")
            self.assertEqual(json.loads(out)["rmse"], 0)

    @deep
    def test_ctrl_c_leaves_layers_out(self):
        running = subprocess.Popen(
            [
                RTSLC,
                "render",
                "scene.json",
                "-o",
                "a.exr",
                "--time=10m",
                "--aov=normals,id",
                *SMALL,
            ],
            cwd=self.folder,
            stderr=subprocess.PIPE,
            text=True,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )
        for _ in range(SECONDS * 10):
            if (self.folder / "a.exr").exists():
                break
            time.sleep(0.1)
        running.send_signal(signal.SIGINT)
        _, error = running.communicate(timeout=SECONDS)
        self.assertEqual(running.returncode, 130, error)
        self.assertIn("W2867", error)
        self.assertIn("stopped by SIGINT before the picture had the layers `normals`, `id`", error)
        self.assertEqual(sorted(channels((self.folder / "a.exr").read_bytes())), ["B", "G", "R"])

    def test_mistakes_of_a_view_are_found_before_rendering(self):
        self.glass_scene(render={"engine": "programs"}, rayGeneration={"class": "Flat"})
        scene = json.loads((self.folder / "scene.json").read_text())
        del scene["camera"]
        self.write(
            "Flat.rtsl",
            "class Flat : rt_RayGeneration;\nvoid generate() { rt_SampleColor = color(0.5); }\n",
        )
        scene["import"].append("Flat.rtsl")
        self.write("scene.json", json.dumps(scene))
        self.render("a.exr", "--spp=1")
        messages = self.diagnose("render", "scene.json", "-o", "b.exr", "--spp=1", "--aov=normals")
        self.assert_message(messages, "E0803", "a scene for the engine `normals` needs a `camera`")
        self.assertFalse((self.folder / "b.exr").exists())

    def test_bad_values(self):
        for options, part in (
            (["-o", "a.exr", "--aov=path"], "albedo"),
            (["-o", "a.exr", "--aov=normale"], "normals"),
            (["-o", "a.png", "--aov=normals"], "only EXR files have layers"),
            (["-o", "-", "--aov=normals"], "only EXR files have layers"),
        ):
            with self.subTest(options=options):
                _, error = self.run_rtslc("render", "scene.json", *options, status=USAGE)
                self.assertIn(part, error)


if __name__ == "__main__":
    unittest.main()
