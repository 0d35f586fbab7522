"""Primitives and cameras of the library whose values leave nothing to see: each is named, with what
is wrong, and its picture is black; those with other values are seen."""

import json
import unittest

from exr_files import channels
from harness import Case

FLAT = {"range": [0, 1], "low": [-1, -1, -1], "high": [1, 1, 1]}
CURVE = [[-1, 0, 0, 0.3], [-0.5, 0, 0, 0.3], [0.5, 0, 0, 0.3], [1, 0, 0, 0.3]]
QUADRIC = {"class": "Quadric", "coefficients": [1, 1, 1], "level": 0.8}
CAMERA = {"class": "PerspectiveCamera", "constructor": [[0.1, 0.2, 4], [0, 0, 0], [0, 1, 0]]}


def made(name, *arguments, **members):
    return {"class": name, "constructor": list(arguments), **members}


VISIBLE = [
    made("Disk", [0, 0, 0], [0, 0.4, 1], 1, 0.5),
    made("Torus", [0, 0, 0], [0, 1, 0.2], 0.8, 0.3),
    made("Cone", [-1, 0, 0], [1, 0.3, 0], 0.4, 0),
    made("Cylinder", [-1, 0, 0], [1, 0.3, 0], 0.4),
    made("Capsule", [-1, 0, 0], [1, 0.3, 0], 0.4),
    made("Parallelogram", [-1, -1, 0], [2, 0, 0.3], [0, 2, 0.1]),
    {"class": "HeightField", **FLAT, "heights": [[0, 1], [1, 0]]},
    {"class": "Curve", "points": CURVE},
    {"class": "Sphere", "center": [0, 0, 0], "radius": 0.5},
    {"class": "Box", "low": [-1, -1, 0], "high": [1, 1, 0]},
    QUADRIC,
    {**QUADRIC, "coefficients": [1, 0, -1], "level": 0},
    {**QUADRIC, "coefficients": [2e9, 2e9, 2e9], "level": 1e9},
    {**QUADRIC, "coefficients": [1e30, 1e30, 1e30], "level": 1e30},
]

NO_BALL = "in its box the form is between 0 and 3, and `level` is"
INVISIBLE = [
    ("its `normal` is 0", made("Disk", [0, 0, 0], [0, 0, 0], 1, 0)),
    ("its `hole` is as large as its `radius`", made("Disk", [0, 0, 0], [1, 1, 1], 1, 1)),
    ("its `axis` is 0", made("Torus", [0, 0, 0], [0, 0, 0], 0.8, 0.3)),
    ("its radii are 0", made("Cone", [-1, -1, -1], [1, 1, 1], 0, 0)),
    ("one of its sides is 0", made("Parallelogram", [0, 0, 0], [1, 1, 1], [0, 0, 0])),
    (
        "its sides are parallel",
        made("Parallelogram", [0, 0, 0], [0.1, 0.3, 0.7], [-0.3, -0.9, -2.1]),
    ),
    (
        "`low` and `high` of its box are equal along x",
        {"class": "HeightField", **FLAT, "high": [-1, 1, 1], "heights": [[0, 1], [1, 0]]},
    ),
    (
        "none of its `points` has a radius above 0",
        {"class": "Curve", "points": [[-1, -1, 0, 0], [0, 0, 0, -1], [1, 0, 0, 0], [1, 1, 0, 0]]},
    ),
    (
        "the square of its radius, 1e+20, is too large for a float",
        {"class": "Sphere", "center": [0, 0, 0], "radius": 1e20},
    ),
    (
        "the square of its radius, 1e-30, is 0 as a float",
        {"class": "Sphere", "center": [0, 0, 0], "radius": 1e-30},
    ),
    ("its `coefficients` are 0", {**QUADRIC, "coefficients": [0, 0, 0]}),
    (f"{NO_BALL} 3", {**QUADRIC, "level": 3}),
    (f"{NO_BALL} -1", {**QUADRIC, "level": -1}),
]

POINT = [[1, 2, 3], [1, 2, 3], [0, 1, 0]]
ONE_POINT = "`eye` and `target` are one point"
ALIKE = "its rays are all the same, because `up` is 0 or along `gaze`, or `uv0` is `uv1`"
BLIND = [
    *(
        (ONE_POINT, {"class": name, "constructor": POINT})
        for name in (
            "PerspectiveCamera",
            "OrthographicCamera",
            "FisheyeCamera",
            "PanoramaCamera",
            "ThinLensCamera",
            "TiltShiftCamera",
        )
    ),
    *(
        (why, made("PinholeCamera", [0, 0, 4], up, gaze, [-1, -1], [1, 1], 2))
        for why, up, gaze in (
            ("its `gaze` is 0", [0, 1, 0], [0, 0, 0]),
            (ALIKE, [0, 0, 0], [0, 0, -1]),
            (ALIKE, [0, 0, 2], [0, 0, -1]),
        )
    ),
]


class Invisible(Case):
    def scene(self, primitives, camera=CAMERA, engine="classic"):
        scene = {
            "rtsl": 1,
            "import": ["std"],
            "camera": camera,
            "objects": [
                {"primitive": one, "material": {"class": "Emitter", "isTwoSided": True}}
                for one in primitives
            ],
            "background": [0, 0, 0],
            "render": {"size": [24, 16], "spp": 1, "engine": engine},
        }
        self.write("scene.json", json.dumps(scene))

    def warnings(self):
        """Of the scene, as (class at the caret, message)."""
        text = (self.folder / "scene.json").read_text()
        found = []
        for command in (["check"], ["render", "-o", "a.exr", "-q", "-O0"]):
            _, error = self.run_rtslc(*command, "scene.json", "--diagnostics=json")
            said = []
            for diagnostic in json.loads(error)["diagnostics"] if error else []:
                self.assertEqual(diagnostic["code"], "W2800")
                begin, end = (diagnostic["range"][at]["offset"] for at in ("begin", "end"))
                said.append((text[begin:end], diagnostic["message"]))
            found.append(said)
        self.assertEqual(*found)
        return found[0]

    def is_black(self):
        return not any(channels((self.folder / "a.exr").read_bytes())["R"])

    def test_primitives_that_no_ray_hits(self):
        self.scene([one for _, one in INVISIBLE])
        self.assertEqual(
            self.warnings(),
            [
                (one["class"], f"primitive `{one['class']} (objects.{i})` is invisible: {why}")
                for i, (why, one) in enumerate(INVISIBLE)
            ],
        )
        self.assertTrue(self.is_black())

    def test_others_are_seen(self):
        for one in VISIBLE:
            with self.subTest(one=one):
                self.scene([one])
                self.assertEqual(self.warnings(), [])
                self.assertFalse(self.is_black())

    def test_boxes_without_area_are_named_once(self):
        self.scene([made("Parallelogram", [0, 0, 0], [1, 0, 0], [0, 0, 0])])
        [(_, message)] = self.warnings()
        self.assertIn("is a line without width", message)

    def test_meshes_without_area(self):
        """Such as a lamp whose triangles have all their corners on a line; one triangle is enough
        to be seen, at one key."""
        self.write("flat.obj", "v 0 0 0\nv 1 1 0\nv 2 2 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n")
        self.write("some.obj", "v 0 0 0\nv 1 1 0\nv 2 2 0\nv 1 2 0\nf 1 2 3\nf 2 4 3\n")
        flat = "mesh `flat.obj` is invisible: none of its triangles has an area"
        for mesh, expected in (
            ("flat.obj", [("flat.obj", flat)]),
            ("some.obj", []),
            ({"keys": ["flat.obj", "some.obj"]}, []),
        ):
            with self.subTest(mesh=mesh):
                self.scene([made("Disk", [0, 0, 0], [0, 0, 1], 1, 0)])
                scene = json.loads((self.folder / "scene.json").read_text())
                scene["objects"] = [{"mesh": mesh, "material": {"class": "Lambert"}}]
                self.write("scene.json", json.dumps(scene))
                self.assertEqual(self.warnings(), expected)

    def test_cameras_without_rays(self):
        for why, camera in BLIND:
            with self.subTest(camera=camera):
                self.scene([{"class": "Box", "low": [-9, -9, -9], "high": [9, 9, 9]}], camera)
                name = camera["class"]
                self.assertEqual(
                    self.warnings(), [(name, f"the camera `{name}` does not see the scene: {why}")]
                )
                self.assertEqual(self.is_black(), why != ALIKE)

    def test_classes_of_authors(self):
        """Which have names of the library, and other members, say nothing of themselves."""
        self.write(
            "own.rtsl",
            """
            class Disk : rt_Primitive {
              public float axes = 0.0;
              void intersect() { hit(1.0); }
              void computeBounds() { rt_BoundMin = vec3(-1.0); rt_BoundMax = vec3(1.0); }
              void computeNormal() { rt_GeometricNormal = vec3(0.0, 0.0, 1.0); }
            };
            """,
        )
        self.scene([{"class": "Disk"}])
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"] = ["std.cameras", "std.materials", "own.rtsl"]
        self.write("scene.json", json.dumps(scene))
        self.assertEqual(self.warnings(), [])


if __name__ == "__main__":
    unittest.main()
