"""Cameras of the library beside simpler ones that show the same."""

import json
import struct
import unittest

from exr_files import channels
from harness import Case

EYE = [[0, 0, 5], [0, 0, 0], [0, 1, 0]]
BALL = {"primitive": {"class": "Sphere", "center": [0, 0, 0]}, "material": {"class": "Emitter"}}


class Lenses(Case):
    def red(self, camera, **objects):
        """Of each pixel of the picture."""
        scene = {
            "rtsl": 1,
            "import": ["std"],
            "camera": {"constructor": EYE, **camera},
            **objects,
            "render": {"size": [24, 16], "spp": 4},
        }
        self.write("scene.json", json.dumps(scene))
        self.run_rtslc("render", "scene.json", "-o", "a.exr", "-q", "-O0")
        bits = channels((self.folder / "a.exr").read_bytes())["R"]
        return struct.unpack(f"<{len(bits)}f", struct.pack(f"<{len(bits)}I", *bits))

    def assert_alike(self, one, other, pixels):
        """All but so many pixels, in which samples at edges may see the other side."""
        different = sum(abs(a - b) > 1e-5 for a, b in zip(one, other))
        self.assertLessEqual(different, pixels)
        self.assertGreater(len(set(one)), 2)

    def test_what_is_in_focus_is_sharp(self):
        """Squares on a plane at right angles to the line of sight, and on a tilted one."""
        squares = {"class": "Emitter", "isTwoSided": True, "radianceMap": {"class": "Checker"}}
        lens = {"focusDistance": 5, "lensRadius": 0.5}
        for camera, up in (
            ({"class": "ThinLensCamera"}, [0, 8, 0]),
            ({"class": "TiltShiftCamera"}, [0, 8, 0]),
            ({"class": "TiltShiftCamera", "tilt": [0, 60]}, [0, 4, -4 * 3**0.5]),
        ):
            corner = [-4, -0.5 * up[1], -0.5 * up[2]]
            plane = {"class": "Parallelogram", "constructor": [corner, [8, 0, 0], up]}
            objects = [{"primitive": plane, "material": squares}]
            sharp = self.red({"class": "PerspectiveCamera"}, objects=objects)
            with self.subTest(camera=camera):
                self.assert_alike(self.red({**camera, **lens}, objects=objects), sharp, 4)

    def test_focus_at_infinity(self):
        for name in ("ThinLensCamera", "TiltShiftCamera"):
            far, farther = (
                self.red({"class": name, "focusDistance": distance}, objects=[BALL])
                for distance in (1e9, 3e38)
            )
            self.assert_alike(far, farther, 2)

    def test_up_along_the_line_of_sight(self):
        """The picture is that of another direction, which the library documents."""
        for eye, up, other in (
            ([0, 5, 0], [0, 1, 0], [0, 0, -1]),
            ([0, -5, 0], [0, 0, 0], [0, 0, -1]),
            ([0, 0, 5], [0, 0, -2], [0, 1, 0]),
        ):
            known, chosen = (
                self.red(
                    {"class": "PerspectiveCamera", "constructor": [eye, [0, 0, 0], direction]},
                    objects=[{**BALL, "primitive": {"class": "Sphere", "center": [0.7, 0.5, 0.6]}}],
                )
                for direction in (other, up)
            )
            self.assert_alike(known, chosen, 0)


if __name__ == "__main__":
    unittest.main()
