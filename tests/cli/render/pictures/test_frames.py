"""Which part of a scene is rendered: `--crop`, `--camera`, `--frame` and `--frames`."""

import json
import signal
import struct
import subprocess
import time
import unittest

from exr_files import attributes, channels
from harness import DIAGNOSED, RTSLC, SECONDS, USAGE, Case, deep

SMALL = ("--size", "50x37")  # not whole tiles

ODD = """class Odd : rt_Material;
void shade() {
  float unused = 1.0;
  float x = rand();
  rt_SampleColor = color(x);
}
"""

# Of frames 0, 5, 9 and 20.
MOVING = {
    "rtsl": 1,
    "import": ["std"],
    "camera": {"class": "PerspectiveCamera", "constructor": [[0, 0, 5], [0, 0, 0], [0, 1, 0]]},
    "materials": {"clay": {"class": "Lambert"}, "gray": {"class": "Lambert"}},
    "objects": [
        {
            "primitive": {"class": "Sphere", "center": [0, 0, 0], "radius": 1},
            "material": {"frames": {"0": "clay", "9": "gray"}, "interpolate": "step"},
        },
        {
            "primitive": {"class": "Sphere", "center": [2, 0, 0], "radius": 1},
            "material": "clay",
            "transform": {"frames": {"0": {"scale": 1}, "20": {"scale": 2}}},
        },
    ],
    "lights": [
        {
            "class": "SphereLight",
            "center": [0, 4, 0],
            "radius": 1,
            "radiance": {"frames": {"0": 3, "5": 0}},
        }
    ],
}


class Parts(Case):
    def setUp(self):
        super().setUp()
        self.glass_scene()

    def render(self, name, *options, **more):
        out, _ = self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            name,
            "-Wno-depth-limit",
            "--spp=3",
            *SMALL,
            *options,
            **more,
        )
        return out

    def change(self, **changes):
        scene = json.loads((self.folder / "scene.json").read_text())
        scene.update(changes)
        self.write("scene.json", json.dumps(scene))
        return scene

    def refuse(self, part, *options):
        _, error = self.run_rtslc("render", "scene.json", "-o", "a.png", *options, status=USAGE)
        self.assertIn(part, error)


class Crop(Parts):
    def pixels(self, name):
        """The bits of each pixel: rows of (B, G, R)."""
        data = (self.folder / name).read_bytes()
        left, _, right, _ = struct.unpack("<4i", attributes(data)["dataWindow"])
        width = right - left + 1
        pixels = list(zip(*channels(data).values()))
        return [pixels[i : i + width] for i in range(0, len(pixels), width)]

    def cut(self, name, x0, y0, x1, y1):
        """The pixels of a picture that lie in a part of it."""
        return [row[x0:x1] for row in self.pixels(name)[y0:y1]]

    def test_it_has_the_bits_of_the_whole_picture(self):
        for way in (
            [],
            ["--traversal=device", "--threads=1"],
            ["--target=host-megakernel"],
            ["--time=5m"],
            ["--trace=split"],
        ):
            self.render("whole.exr", *way)
            for crop in ((0, 0, 50, 37), (3, 2, 4, 3), (17, 5, 50, 36)):
                with self.subTest(way=way, crop=crop):
                    self.render("crop.exr", "--crop={},{},{},{}".format(*crop), *way)
                    header = attributes((self.folder / "crop.exr").read_bytes())
                    x0, y0, x1, y1 = crop
                    self.assertEqual(
                        struct.unpack("<4i", header["dataWindow"]), (x0, y0, x1 - 1, y1 - 1)
                    )
                    self.assertEqual(struct.unpack("<4i", header["displayWindow"]), (0, 0, 49, 36))
                    self.assertEqual(self.pixels("crop.exr"), self.cut("whole.exr", *crop))

    def test_counts_and_png(self):
        document = json.loads(self.render("a.png", "--crop=10,10,20,15", "--json"))
        self.assertEqual((document["samples"], document["pixels"]), (150, 50))
        self.assertEqual(struct.unpack(">2I", (self.folder / "a.png").read_bytes()[16:24]), (10, 5))

    def test_of_a_package(self):
        self.run_rtslc("pack", "scene.json", "-o", "a.rtslpkg")
        self.render("a.exr", "--crop=10,10,20,15", "--target=host-megakernel")
        crop = "--crop=10,10,20,15"
        self.run_package("a.rtslpkg", "-o", "b.exr", "--target=host", crop, "--spp=3", *SMALL)
        self.assert_same_bits("a.exr", "b.exr")

    def test_samples_that_are_not_finite_are_named_by_their_place_in_the_whole(self):
        self.write(
            "Bad.rtsl",
            "class Bad : rt_Miss;\nvoid miss() { rt_SampleColor = color(1.0 / (rt_RayDirection.x * "
            "0.0)); }\n",
        )
        scene = self.change(background={"class": "Bad"}, objects=[])
        self.change(**{"import": scene["import"] + ["Bad.rtsl"]})
        for way in ([], ["--target=host-megakernel"]):
            document = json.loads(
                self.render("a.exr", "--crop=20,10,22,12", "--json", "-Wno-not-finite", *way)
            )
            self.assertEqual(document["notFinite"][0]["pixel"], [20, 10], way)
            self.assertEqual(document["samplesNotFinite"], 12)

    def test_bad_values(self):
        for crop in (
            "1",
            "1,2,3",
            "1,2,3,4,5",
            "5,5,5,9",
            "5,9,9,9",
            "-1,0,3,3",
            "a,b,c,d",
            "0,0,1e3,4",
            "0, 0,3,3",
            "0,0,999999,3",
        ):
            with self.subTest(crop=crop):
                self.refuse(
                    "give x0,y0,x1,y1 in pixels from the top left, such as 0,0,64,48",
                    f"--crop={crop}",
                )
        messages = self.diagnose("render", "scene.json", "-o", "a.png", *SMALL, "--crop=0,0,51,3")
        self.assert_message(
            messages, "E0805", "the crop 0,0,51,3 is outside of a picture of 50x37 pixels"
        )


class Cameras(Parts):
    def setUp(self):
        super().setUp()
        scene = json.loads((self.folder / "scene.json").read_text())
        self.front = scene.pop("camera")
        self.top = json.loads(json.dumps(self.front))
        self.top["constructor"]["eye"] = [0.5, 3, 4]
        scene["cameras"] = {"front": self.front, "top": self.top}
        self.write("scene.json", json.dumps(scene))

    def test_they_are_chosen_by_name(self):
        self.render("first.exr")
        self.render("front.exr", "--camera=front")
        self.render("top.exr", "--camera=top")
        self.render("set.exr", "--set", "camera=top")
        self.change(camera="top", cameras={"front": self.front, "top": self.top})
        self.render("scene.exr")
        self.change(camera=self.top, cameras={})
        self.render("object.exr")
        for one, other in (("first", "front"), ("top", "set"), ("top", "scene"), ("top", "object")):
            self.assert_same_bits(f"{one}.exr", f"{other}.exr")
        self.assertNotEqual(
            (self.folder / "top.exr").read_bytes(), (self.folder / "front.exr").read_bytes()
        )

    def test_others_are_not_in_the_program(self):
        self.write(
            "Odd.rtsl",
            "class Odd : rt_Camera;\nvoid generateRay() { rt_RayOrigin = vec3(123.456); "
            "rt_RayDirection = vec3(0.0, 0.0, 1.0); }\n",
        )
        scene = json.loads((self.folder / "scene.json").read_text())
        self.change(
            **{
                "import": scene["import"] + ["Odd.rtsl"],
                "cameras": {**scene["cameras"], "odd": {"class": "Odd"}},
            }
        )
        for camera in ("front", "odd"):
            text, _ = self.run_rtslc(
                "compile", "scene.json", "--emit=ir", "--set", f"camera={camera}"
            )
            self.assertEqual("Odd" in text, camera == "odd")

    def test_mistakes(self):
        self.assert_message(
            self.diagnose("render", "scene.json", "-o", "a.png", "--camera=frond"),
            "E0806",
            "there is no camera `frond`; there are `front`, `top`",
        )
        self.change(
            cameras={
                "front": self.front,
                "bad": {"class": "PinholeCamera", "constructor": {"eye": 1}},
            }
        )
        self.run_rtslc("render", "scene.json", "-o", "a.png", "--size=8x8", "--spp=1")
        messages = self.diagnose("check", "scene.json")
        self.assertTrue(messages)


class Frames(Parts):
    def setUp(self):
        super().setUp()
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["background"] = {"frames": {"0": [0, 0, 0], "4": [1, 0.5, 0]}}
        scene["camera"]["constructor"]["eye"] = {"frames": {"0": [0, 1, 5], "2": [0, 2, 5]}}
        self.write("scene.json", json.dumps(scene))

    def fixed(self, name, eye, background):
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["background"] = background
        scene["camera"]["constructor"]["eye"] = eye
        self.write("fixed.json", json.dumps(scene))
        self.run_rtslc("render", "fixed.json", "-o", name, "-Wno-depth-limit", "--spp=3", *SMALL)

    def test_values_of_a_frame(self):
        for frame, eye, background in (
            (0, [0, 1, 5], [0, 0, 0]),
            (1, [0, 1.5, 5], [0.25, 0.125, 0]),
            (3, [0, 2, 5], [0.75, 0.375, 0]),
            (0.5, [0, 1.25, 5], [0.125, 0.0625, 0]),
        ):
            with self.subTest(frame=frame):
                self.render("frame.exr", f"--frame={frame}")
                self.render("set.exr", "--set", f"frame={frame}")
                self.fixed("fixed.exr", eye, background)
                self.assert_same_bits("frame.exr", "fixed.exr")
                self.assert_same_bits("set.exr", "fixed.exr")
        self.render("default.exr")
        self.render("frame.exr", "--frame=0")
        self.assert_same_bits("default.exr", "frame.exr")

    def test_numbered_pictures(self):
        self.render("frame.%04d.exr", "--frames=1..3", "-q")
        self.assertEqual(
            [file for file in self.files() if file.startswith("frame")],
            ["frame.0001.exr", "frame.0002.exr", "frame.0003.exr"],
        )
        for frame in (1, 2, 3):
            self.render("one.exr", f"--frame={frame}")
            self.assert_same_bits("one.exr", f"frame.000{frame}.exr")
        self.render("%d.exr", "--frames=10..10", "--checkpoint=%d.ckpt")
        self.assertTrue({"10.exr", "10.ckpt"} <= set(self.files()))

    def test_frames_that_only_move_have_one_code_and_trees_that_follow(self):
        """What moves is in tables: the second frame and those after it are not compiled."""
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["background"] = [0.1, 0.2, 0.3]
        scene["camera"]["constructor"]["eye"] = [0, 1, 5]
        scene["objects"][0]["transform"] = {
            "translate": {"frames": {"0": [0.1, 0, 0], "4": [1, 0.5, 0]}}
        }
        self.write("scene.json", json.dumps(scene))
        ways = ([], ["--target=host-megakernel"], ["--trace=split", "--traversal=device"])
        for way in (*ways, ["--aov=albedo,depth"]):  # views are programs, too
            options = ("--frames=0..2", "-Wno-depth-limit", "--spp=3", *SMALL, *way)
            _, said = self.run_rtslc("render", "scene.json", "-o", "frame.%04d.exr", *options)
            self.assertEqual(said.count("machine code of the picture before: "), 2, said)
            self.assertEqual(said.count("trees of the picture before: refitted"), 2, said)
            for frame in (0, 1, 2):
                self.render("one.exr", f"--frame={frame}", *way)
                self.assert_same_bits("one.exr", f"frame.000{frame}.exr")

    def test_a_checkpoint_is_of_one_frame(self):
        self.render("a.exr", "--frame=1", "--checkpoint=a.ckpt")
        arguments = [
            "render",
            "scene.json",
            "-o",
            "b.exr",
            "--spp=3",
            *SMALL,
            "--checkpoint=a.ckpt",
        ]
        self.assert_message(
            self.diagnose(*arguments, "--frame=2"), "E0907", "depends on the scene at frame 1"
        )

    def test_the_first_mistake_ends_a_sequence(self):
        self.change(ambient={"frames": {"0": 0, "1": "dark"}, "interpolate": "step"})
        _, error = self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "f%d.png",
            "--frames=0..3",
            "--spp=1",
            *SMALL,
            status=DIAGNOSED,
        )
        self.assertEqual(error.count("is a color, not a string"), 1)
        self.assertEqual([file for file in self.files() if file.endswith(".png")], ["f0.png"])

    @deep
    def test_ctrl_c_ends_a_sequence(self):
        running = subprocess.Popen(
            [RTSLC, "render", "scene.json", "-o", "f%d.exr", "--frames=0..9", "--time=5m", *SMALL],
            cwd=self.folder,
            stderr=subprocess.PIPE,
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.default_int_handler),
        )
        for _ in range(SECONDS * 10):
            if (self.folder / "f0.exr").exists():
                break
            time.sleep(0.1)
        running.send_signal(signal.SIGINT)
        running.communicate(timeout=SECONDS)
        self.assertEqual(running.returncode, 130)
        self.assertFalse((self.folder / "f1.exr").exists())

    def test_mistakes_in_key_frames(self):
        self.change(background={"frames": {"0": [0, 0, 0], "last": [1, 1, 1]}})
        self.assert_message(
            self.diagnose("check", "scene.json"),
            "E0804",
            "a key of `frames` is the number of a frame, not `last`",
        )

    def test_bad_values(self):
        for options, part in (
            (["--frame=soon"], "`soon` is not a number"),
            (["--frame=inf"], "`inf` is not a number"),
            (["--frames=3"], "`3` is no range of frames; write the first and the last: `0..47`"),
            (["--frames=3..1"], "frame 3 comes after frame 1"),
            (["--frames=0..x"], "--frames"),
            (["--frames=0..9999999"], "1000000"),
            (["--frames=0..3"], "`a.png` needs one place for the number of the frame"),
            (["--frames=0..3", "-o", "%d.%d.png"], "needs one place for the number of the frame"),
            (["--frames=0..3", "-o", "%d.png", "--frame=1"], "`--frame` is one frame"),
            (["--frames=0..3", "-o", "%d.png", "--watch"], "`--watch` renders one picture"),
            (["--frames=0..3", "-o", "%d.png", "--json"], "a JSON document describes one picture"),
            (
                ["--frames=0..3", "-o", "%d.png", "--checkpoint=a"],
                "`a` needs one place for the number",
            ),
        ):
            with self.subTest(options=options):
                arguments = [] if "-o" in options else ["-o", "a.png"]
                _, error = self.run_rtslc(
                    "render", "scene.json", *arguments, *options, status=USAGE
                )
                self.assertIn(part, error)


class FramesOfScenes(Parts):
    def test_a_frame_of_a_scene_without_any_is_a_warning(self):
        text = "W2800]: all frames are the same: no value of the scene has key frames"
        for options in (["--frame", "3"], ["--frames", "0..2"]):
            name = "a.png" if options[0] == "--frame" else "a%d.png"
            arguments = ["render", "scene.json", "-o", name, "--spp=1", *SMALL, *options]
            for more, count in (
                ([], 1),
                (["-Wno-scene"], 0),
                (["--set", 'ambient={"frames": {"0": 0, "9": 1}}'], 0),
            ):
                with self.subTest(options=options, more=more):
                    _, error = self.run_rtslc(*arguments, *more)
                    self.assertEqual(error.count(text), count, error)
        _, error = self.run_rtslc(*arguments[:5], *SMALL, "--set", "frame=3")
        self.assertNotIn(text, error)

    def test_shaders_are_checked_once_for_all_frames(self):
        self.write("Odd.rtsl", ODD)
        scene = json.loads(json.dumps(MOVING))
        scene["import"].append("Odd.rtsl")
        scene["materials"]["gray"]["class"] = "Odd"
        self.write("scene.json", json.dumps(scene, indent=1))
        _, error = self.run_rtslc("check", "scene.json")
        self.assertEqual(error.count("warning"), 1, error)
        self.write("Odd.rtsl", ODD.replace("color(x)", "colour(x)"))
        self.assert_message(self.diagnose("check", "scene.json"), "E0202", "`colour`")

    def test_check_finds_mistakes_of_other_frames(self):
        """Those of key frames, each once, and no warnings: a light may be dark at times."""
        self.write("scene.json", json.dumps(MOVING, indent=1))
        self.assertEqual(self.run_rtslc("check", "scene.json"), ("", ""))
        wrong = json.loads(json.dumps(MOVING))
        wrong["objects"][0]["material"]["frames"]["9"] = "cly"
        wrong["objects"][1]["transform"]["frames"]["20"]["scale"] = 0
        wrong["ambient"] = "blue"
        self.write("scene.json", json.dumps(wrong, indent=1))
        self.assertEqual(
            sorted((one["code"], one["message"]) for one in self.diagnose("check", "scene.json")),
            [
                ("E0804", "`ambient` is a color, not a string"),
                ("E0805", "this transform flattens its objects"),
                ("E0806", "no texture or material is named `cly`"),
            ],
        )


if __name__ == "__main__":
    unittest.main()
