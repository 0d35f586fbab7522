"""Values that are not in the code: `render.editable`."""

import json

from harness import DIAGNOSED, EXAMPLES, Case

GLASS = EXAMPLES / "glass" / "scene.json"

# Two lamps above a floor.
LAMPS = {
    "rtsl": 1,
    "import": ["std.cameras", "std.primitives", "std.materials"],
    "camera": {
        "class": "PerspectiveCamera",
        "constructor": {"eye": [0, 3, 8], "target": [0, 1, 0], "up": [0, 1, 0]},
        "fieldOfView": 50,
    },
    "materials": {
        "clay": {"class": "Lambert", "reflectance": 0.7},
        "near": {"class": "Emitter", "radiance": 9},
        "far": {"class": "Emitter", "radiance": 3},
    },
    "objects": [
        {"primitive": {"class": "Sphere", "center": [-2, 2, 0], "radius": 0.5}, "material": "near"},
        {"primitive": {"class": "Sphere", "center": [2, 3, -2], "radius": 0.7}, "material": "far"},
        {
            "primitive": {
                "class": "Parallelogram",
                "constructor": [[-4, 0, -4], [0, 0, 8], [8, 0, 0]],
            },
            "material": "clay",
        },
    ],
    "render": {"engine": "path", "depth": 4},
}


class Editable(Case):
    def ptx(self, *settings):
        output, _ = self.run_rtslc("compile", GLASS, "--emit=ptx", *self.set_all(settings))
        return output

    @staticmethod
    def set_all(settings):
        return [f"--set={setting}" for setting in settings]

    EYE = 'render.editable=["PinholeCamera"]'

    def test_code_does_not_depend_on_a_value_that_is_edited(self):
        editable = 'render.editable=["PinholeCamera","Solid.value","Sphere"]'
        changes = [
            "camera.constructor.eye=[0,2.3,7]",
            "textures.chalk.value=[0.5,0.5,0.5]",
            "objects.1.primitive.center=[-1,1.5,0.5]",
        ]
        self.assertTrue(self.ptx() != self.ptx(changes[0]))
        self.assertTrue(self.ptx(editable) == self.ptx(editable, *changes))

    def test_boxes_of_primitives_that_are_edited_are_not_in_the_code(self):
        scene = EXAMPLES / "metal" / "scene.json"
        editable = '--set=render.editable=["Sphere"]'
        bigger = "--set=objects.1.primitive.radius=0.9"
        listed, one, other = (
            self.run_rtslc("compile", scene, "--emit=ptx", *options)[0]
            for options in ([], [editable], [editable, bigger])
        )
        self.assertTrue("listed_boxes" in listed)
        self.assertFalse("listed_boxes" in one)
        self.assertTrue(one == other, "the code depends on a radius")

    def test_chances_of_lamps_that_are_edited_are_not_in_the_code(self):
        self.write("lamps.json", json.dumps(LAMPS))
        dimmer, editable = "materials.near.radiance=1", 'render.editable=["Emitter"]'

        def code(*settings):
            return self.run_rtslc("compile", "lamps.json", "--emit=ssa", *self.set_all(settings))[0]

        self.assertIn("rtsl.emitters = ", code())
        self.assertNotIn("rtsl.emitters = ", code(editable))
        self.assertEqual(code(editable), code(editable, dimmer))
        for name, settings in (("a.exr", []), ("b.exr", [editable])):
            self.run_rtslc(
                "render",
                "lamps.json",
                "-o",
                name,
                "--size=16x16",
                "--spp=4",
                "-q",
                *self.set_all([dimmer, *settings]),
            )
        self.assert_same_bits("a.exr", "b.exr")

    def test_the_picture_is_the_same(self):
        everything = (
            'render.editable=["PinholeCamera","Sphere","Glass","Solid","Checker","BallLight"]'
        )
        for options in ([], ["--trace=split"], ["--target=host-megakernel"]):
            for name, settings in (("a.exr", []), ("b.exr", [everything])):
                self.run_rtslc(
                    "render",
                    GLASS,
                    "-o",
                    name,
                    "--size=48x27",
                    "--spp=2",
                    "-q",
                    *options,
                    *self.set_all(settings),
                )
            with self.subTest(options=options):
                self.assert_same_bits("a.exr", "b.exr")

    def test_explain_says_so(self):
        output, _ = self.run_rtslc(
            "explain", GLASS, "--json", "--no-savings", *self.set_all([self.EYE])
        )
        reasons = {one["subject"]: one["reason"] for one in self.findings(json.loads(output))}
        self.assertEqual(reasons["PinholeCamera.origin"], "read from the record: editable")
        self.assertIn("in the code", reasons["Parallelogram.normal"])

    def findings(self, report):
        for value in report.values() if isinstance(report, dict) else report:
            if isinstance(value, (dict, list)):
                if isinstance(value, dict) and "subject" in value and "reason" in value:
                    yield value
                else:
                    yield from self.findings(value)

    def test_names_that_do_not_exist(self):
        for name, message in (
            ("PinholCamera", "no class is named `PinholCamera`"),
            ("Glass.tin", "class `Glass` has no member `tin`"),
            ("Glass.", "class `Glass` has no member ``"),
        ):
            with self.subTest(name=name):
                _, error = self.run_rtslc(
                    "check", GLASS, f'--set=render.editable=["{name}"]', status=DIAGNOSED
                )
                self.assertIn(message, error)
        self.write("lamps.json", json.dumps(LAMPS))
        unused = '--set=render.editable=["Torus"]'  # no file of the library is read for it
        self.assertEqual(self.run_rtslc("check", "lamps.json", unused)[1], "")
        _, error = self.run_rtslc("check", GLASS, "--set=render.editable=[1]", status=DIAGNOSED)
        self.assertIn("a name of `editable`", error)
