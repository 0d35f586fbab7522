"""Scenes for tests of footprints of rays."""

import json
import math

from harness import Case, numbers_of
from image_files import png

EYE = """
class Eye : rt_Camera {
  public vec3 eye = vec3(0.3, 0.2, 2.0);
  public vec3 forward = vec3(0.1, 0.05, -1.0);
  public vec3 right = vec3(0.2, 0.0, 0.0);
  public vec3 up = vec3(0.0, 0.1, 0.0);
  void generateRay() {
    rt_RayOrigin = eye;
    rt_RayDirection = forward + (2.0 * rt_ScreenCoord.x - 1.0) * right + (2.0 * rt_ScreenCoord.y - 1.0) * up;
  }
};
"""

PLANE = {"class": "Parallelogram", "constructor": [[0, 0, 0], [1, 0, 0], [0, 1, 0]]}
WAYS = (
    [],
    ["--trace=recurse", "--traversal=device"],
    ["--trace=split", "--undefined=nan"],
    ["--target=host-megakernel"],
    ["--target=host-megakernel", "--organisation=wavefront"],
    ["--keep=all", "--threads=1"],
)


def add(a, b, scale=1.0):
    return [x + scale * y for x, y in zip(a, b)]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return [a[i - 2] * b[i - 1] - a[i - 1] * b[i - 2] for i in range(3)]


def unit(a):
    return [x / math.sqrt(dot(a, a)) for x in a]


class FootprintCase(Case):
    def scene(self, shaders, objects, size=(3, 2), camera=None, **more):
        self.write("shaders.rtsl", EYE + shaders)
        scene = {
            "rtsl": 1,
            "import": [
                "std.cameras",
                "std.primitives",
                "std.materials",
                "std.textures",
                "shaders.rtsl",
            ],
            "camera": camera or {"class": "Eye"},
            "objects": objects,
            "render": {"engine": "classic", "size": list(size), "spp": 1, "depth": 4},
            **more,
        }
        self.write("scene.json", json.dumps(scene))

    def printed(self, *options):
        output, _ = self.run_rtslc("render", "scene.json", "--print", "-q", "-o", "x.exr", *options)
        return [numbers_of(line) for line in output.splitlines()]

    def assert_close(self, got, expected, relative=2e-4, message=""):
        if isinstance(expected, list):
            most = max(abs(x) for x in expected)
            for x, y in zip(got, expected):
                self.assertAlmostEqual(x, y, delta=relative * most + 1e-12, msg=message)
        else:
            self.assertAlmostEqual(
                got, expected, delta=relative * abs(expected) + 1e-12, msg=message
            )

    def same_bits(self, ways=WAYS):
        pictures = {}
        for way in ways:
            self.run_rtslc("render", "scene.json", "-q", "-o", "x.exr", *way)
            pictures.setdefault((self.folder / "x.exr").read_bytes(), []).append(way)
        self.assertEqual(len(pictures), 1, list(pictures.values()))

    def items(self, report):
        """Subjects, and whether they are needed, wherever they are in the report."""
        if isinstance(report, dict):
            if "subject" in report:
                yield report["subject"], report.get("needed", report.get("isNeeded"))
            report = list(report.values())
        if isinstance(report, list):
            for one in report:
                yield from self.items(one)

    def checkerboard(self, size=256, squares=2, **image):
        self.write(
            "board.png",
            png(size, size, lambda x, y: [255 * ((x // squares + y // squares) & 1)] * 3),
        )
        return {"file": "board.png", "colorSpace": "linear", **image}


class MeshCase(FootprintCase):
    """One triangle with normals and texture coordinates."""

    CORNERS = ([-2, -2, 0], [3, -1.5, 0.5], [0, 2.5, -0.5])
    BENT = ([-0.5, 0, 1], [0.6, -0.2, 0.9], [0.1, 0.7, 0.8])
    PLACED = ([0.1, 0.2], [0.9, 0.1], [0.4, 0.8])

    def bent_mesh(self, **attributes):
        text = "".join(f"v {x} {y} {z}\n" for x, y, z in self.CORNERS)
        text += "".join("vn %.9f %.9f %.9f\n" % tuple(unit(n)) for n in self.BENT)
        text += "".join(f"vt {u} {v}\n" for u, v in self.PLACED)
        self.write("bent.obj", text + "f 1/1/1 2/2/2 3/3/3\n")
        return {"mesh": "bent.obj", "attributes": attributes}
