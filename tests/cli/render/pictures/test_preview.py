"""rtslc render FILE.rtsl: a standard scene that shows one class of a file."""

import json
import pathlib
import re
import unittest

from harness import DIAGNOSED, EXAMPLES, RTSLC, USAGE, Case

LIBRARY = pathlib.Path(RTSLC).parent.parent / "share/rtslc/library"
SMALL = ("--size", "32x24", "--spp", "2", "-O", "0")
KINDS = ("material", "texture", "primitive", "light", "camera")
GREY = "class Grey : rt_Material {\n  void shade() { rt_SampleColor = color(0.5); }\n};\n"
# A material, a texture and a helper class under names of the library, and functions and a struct
# under others of its names.
OWN_NAMES = """struct Scattering { float share; };
const float gradient = 0.5;
float frameAround(vec3 n) { return n.x; }
color sampleCone(float share) { return color(share); }
class Noise { float at(vec3 p) { return fract(dot(floor(6.0 * p), vec3(0.37, 0.61, 0.83))); } };
class Checker : rt_Texture {
  public Noise noise;
  void lookup() { rt_TextureColor = color(noise.at(rt_TextureUVW)); }
};
class Lambert : rt_Material {
  public rt_Texture tint;
  public Checker checks;
  void shade() {
    Scattering s = Scattering(frameAround(vec3(1.0)) * gradient);
    rt_SampleColor = sampleCone(s.share) * tint.lookup() * checks.lookup();
  }
};
"""


class Preview(Case):
    def render(self, file, *arguments, output="a.exr"):
        """Standard error of a rendering."""
        return self.run_rtslc("render", file, "-o", output, "-q", *SMALL, *arguments)[1]

    def refused(self, file, *arguments):
        """The only message."""
        before = self.files()
        (message,) = self.diagnose("render", file, "-o", "a.exr", *SMALL, *arguments)
        self.assertEqual(self.files(), before)
        return message

    def differ(self, first, second, threshold):
        self.run_rtslc("compare", first, second, "--threshold", threshold, status=DIAGNOSED)

    def same(self, first, second):
        self.assertIn("the same, bit for bit", self.run_rtslc("compare", first, second)[0])

    def test_each_scene_renders_by_itself(self):
        scenes = sorted((LIBRARY / "preview").iterdir())
        self.assertEqual(len(scenes), 7)
        for scene in scenes:
            with self.subTest(scene=scene.stem):
                self.assertEqual(self.run_rtslc("check", scene, "-Wall", "-Wperf"), ("", ""))
                self.assertEqual(self.render(scene, "-Werror"), "")

    def test_each_template_is_shown(self):
        self.write_exr("black.exr", 32, 24, 0.0)
        for kind in KINDS:
            with self.subTest(kind=kind):
                out, _ = self.run_rtslc("new", kind, f"My{kind}")
                self.assertEqual(
                    out, f"wrote My{kind}.rtsl\nnext: rtslc render My{kind}.rtsl -o My{kind}.png\n"
                )
                self.assertEqual(self.render(f"My{kind}.rtsl", "-Werror"), "")
                self.differ("black.exr", "a.exr", "0.05")
                # It is the class that is seen, not what stands for it in the scene.
                self.render(LIBRARY / f"preview/{kind}.json", output="stand-in.exr")
                self.differ("stand-in.exr", "a.exr", "0.01")

    def test_classes_of_the_library(self):
        for file in (
            "materials/Gold",
            "textures/Wood",
            "primitives/Box",
            "lights/DistantLight",
            "cameras/FisheyeCamera",
            "backgrounds/DaylightSky",
            "engines/DepthView",
            "engines/PathTracer",
        ):
            with self.subTest(file=file):
                error = self.render(LIBRARY / f"std/{file}.rtsl", "-Werror")
                self.assertEqual(error, "")

    def test_parameters_of_the_library_have_names_for_authors(self):
        """Messages and scenes name them: no `center_` that only avoids the name of a member."""
        for file in sorted((LIBRARY / "std").glob("*/*.rtsl")):
            for parameters in re.findall(r"void constructor\((.*?)\)", file.read_text(), re.S):
                self.assertNotRegex(parameters, r"_\b", file.name)

    def test_a_default_class_is_not_shown(self):
        message = self.refused(LIBRARY / "std/engines/PathTracer.rtsl", "--class", "PathBackground")
        self.assertIn("has no class `PathBackground`", message["message"])

    def test_the_last_class_that_can_be_shown(self):
        self.write(
            "a.rtsl",
            GREY
            + GREY.replace("Grey", "White").replace("0.5", "1.0")
            + "class Help { int i() { return 1; } };\n",
        )
        self.write("grey.rtsl", GREY)
        self.render("a.rtsl")
        self.render("a.rtsl", "--class", "White", output="white.exr")
        self.same("a.exr", "white.exr")
        self.render("a.rtsl", "--class", "Grey", output="grey.exr")
        self.render("grey.rtsl", output="b.exr")
        self.same("b.exr", "grey.exr")
        self.differ("white.exr", "grey.exr", "0.1")
        # Not one of an imported file.
        self.write("imports.rtsl", 'import "grey.rtsl";\nclass Help { int i() { return 1; } };\n')
        message = self.refused("imports.rtsl")
        self.assertEqual(
            (message["code"], message["message"]),
            ("E0866", "`imports.rtsl` has no class that can be shown"),
        )
        self.assertEqual(
            message["notes"][0], "`Help` is a `helper class`, of which there is no picture"
        )

    def test_classes_that_are_not_there(self):
        self.write("a.rtsl", GREY + "class Help { int i() { return 1; } };\n")
        message = self.refused("a.rtsl", "--class", "Gray")
        self.assertEqual(
            (message["code"], message["message"]), ("E0868", "`a.rtsl` has no class `Gray`")
        )
        self.assertEqual(message["notes"], ["did you mean `Grey`?", "it has `Grey`, `Help`"])
        self.assert_message(
            [self.refused("a.rtsl", "--class", "Help")],
            "E0867",
            "class `Help` cannot be shown",
            line=4,
            column=7,
        )
        self.write("b.rtsl", "float f() { return 1.0; }\n")
        self.assertEqual(self.refused("b.rtsl")["notes"][0], "it declares no class")
        self.write("scene.json", "{}")
        _, error = self.run_rtslc(
            "render", "scene.json", "-o", "a.exr", "--class", "Grey", status=USAGE
        )
        self.assertIn("`scene.json` is a scene, which names its classes", error)

    def test_what_is_missing_is_said(self):
        payload = "struct P { color c; };\n"
        for text, words in (
            (
                "class A : rt_Material { };",
                "is a material without `shade`, `sampleBSDF`, `BSDF`, `emission`",
            ),
            (
                payload + "class A : rt_Material { void closestHit(inout P p) { } };",
                "sends no rays with a payload",
            ),
            (
                payload + "class A : rt_Miss { void miss(inout P p) { } };",
                "sends no rays with a payload",
            ),
            (
                "class A : rt_Primitive { void intersect() { } };",
                "is a primitive without `computeBounds`",
            ),
            ("class A : rt_Primitive { };", "without `intersect` and `computeBounds`"),
            ("class A : rt_Exception { void exception() { } };", "of which there is no picture"),
        ):
            self.write("a.rtsl", text + "\n")
            self.assertIn(words, self.refused("a.rtsl")["notes"][0])

    def test_mistakes_are_reported_once(self):
        self.write("a.rtsl", GREY.replace("color", "colour"))
        self.assert_message([self.refused("a.rtsl")], "E0202", "colour", line=2, file="a.rtsl")
        self.write("a.rtsl", GREY.replace("void shade() {", "void shade() { float x = 1.0;"))
        error = self.render("a.rtsl")
        self.assertEqual(error.count("W2200"), 1, error)
        self.assert_message([self.refused("a.rtsl", "-Werror")], "W2200", "`x` is never used")
        self.assert_message([self.refused("missing.rtsl")], "E0100", "missing.rtsl")

    def test_materials_that_only_sample_are_shown_by_the_path_tracer(self):
        self.write(
            "a.rtsl",
            "class Mirror : rt_Material {\n  void sampleBSDF() {\n"
            "    rt_LightDirection = reflect(rt_RayDirection, rt_ShadingNormal);\n"
            "    rt_BSDFValue = color(0.9);\n    rt_PDF = -1.0;\n  }\n};\n",
        )
        self.render("a.rtsl")
        self.render("a.rtsl", "--engine", "path", output="path.exr")
        self.same("a.exr", "path.exr")
        self.write(
            "b.rtsl",
            "class Glow : rt_Material { void emission() { rt_EmissionColor = color(1.0, 0.5, 0.2); "
            "} };\n",
        )
        self.render("b.rtsl", output="b.exr")
        self.differ("a.exr", "b.exr", "0.01")
        self.write(
            "c.rtsl",
            "class Chalk : rt_Material { void BSDF() { rt_BSDFValue = color(0.2); } };\n",
        )
        self.render("c.rtsl", output="c.exr")
        self.differ("a.exr", "c.exr", "0.01")

    def test_a_ray_generation_has_its_own_engine(self):
        self.write(
            "a.rtsl",
            "class Flat : rt_RayGeneration { void generate() { rt_SampleColor = color(0.25) + 0.0 "
            "* trace(rt_RayOrigin, rt_RayDirection); } };\n",
        )
        self.render("a.rtsl")
        self.write_exr("flat.exr", 32, 24, 0.25)
        self.run_rtslc("compare", "flat.exr", "a.exr")

    def test_members_that_must_be_set(self):
        """References are to objects of the library or the file; numbers are 0, with a warning."""
        self.write(
            "a.rtsl",
            "class Tinted : rt_Material {\n  public rt_Texture tint;\n  public rt_Material below;\n"
            "  public float share;\n  public float weights[2];\n  public mat2 turn;\n"
            "  public optional rt_Texture none;\n"
            "  void shade() { rt_SampleColor = none ? color(0.0) : (0.5 + share + weights[1] + "
            "turn[1].x) * tint.lookup(); }\n};\n",
        )
        error = self.render("a.rtsl")
        for member, line in (("share", 4), ("weights", 5), ("turn", 6)):
            self.assertRegex(
                error,
                rf"a.rtsl:{line}:\d+: warning\[W2800\]: member `{member}` of `Tinted` has no "
                r"default: here it is 0",
            )
        self.render(
            "a.rtsl",
            "--set",
            "Tinted.share=0.5",
            "--set",
            "Tinted.weights=[0,0]",
            "--set",
            "Tinted.turn=[1,0,0,1]",
            "-Werror",
            output="b.exr",
        )
        self.differ("a.exr", "b.exr", "0.05")
        self.render(LIBRARY / "std/materials/BumpMap.rtsl", "-Werror")  # a Pattern and a Scatterer
        self.write(
            "b.rtsl",
            "class Onion : rt_Material { public Onion inner; void shade() { rt_SampleColor = "
            "color(0.5); } };\n",
        )
        self.assert_message(
            [self.refused("b.rtsl")],
            "E0815",
            "`Onion` cannot be shown without an object for its member `inner`, an `Onion`",
            line=1,
            column=42,
        )
        self.write(
            "c.rtsl",
            "class Way : rt_Material { public rt_Light lamp; void shade() { rt_SampleColor = "
            "color(0.5); } };\n",
        )
        self.assert_message([self.refused("c.rtsl")], "E0815", "its member `lamp`, an `rt_Light`")

    def test_an_image_must_be_given(self):
        self.write(
            "a.rtsl",
            "class Poster : rt_Material {\n  public sampler2D picture;\n"
            "  void shade() { rt_SampleColor = color(picture.sample(rt_TextureUV).r); }\n};\n",
        )
        message = self.refused("a.rtsl")
        self.assert_message(
            [message],
            "E0815",
            "`Poster` cannot be shown without an image for its member `picture`",
            line=2,
            column=20,
        )
        self.assertIn("""`--set Poster.picture='{"file": "picture.png"}'`""", message["notes"][0])
        self.render(
            "a.rtsl", "--set", f'Poster.picture={{"file": "{EXAMPLES / "cornell/picture.png"}"}}'
        )

    def test_overrides(self):
        self.run_rtslc("new", "material", "Clay")
        blue = "tint=[0.1, 0.1, 0.9]"
        self.render("Clay.rtsl", "--set", f"Clay.{blue}")
        self.render("Clay.rtsl", "--set", f"materials.Clay.{blue}", output="b.exr")
        self.same("a.exr", "b.exr")
        self.render("Clay.rtsl", output="c.exr")
        self.differ("a.exr", "c.exr", "0.05")
        self.render(
            "Clay.rtsl",
            "--set",
            "background=[0, 0, 0]",
            "--set",
            "lights=[]",
            "--set",
            "ambient=0",
            output="dark.exr",
        )
        self.write_exr("black.exr", 32, 24, 0.0)
        self.same("black.exr", "dark.exr")
        self.assertIn(
            "no member `tnt`", self.refused("Clay.rtsl", "--set", "Clay.tnt=1")["message"]
        )
        self.assertEqual(self.refused("Clay.rtsl", "--set", "Clay.tint=red")["code"], "E0804")
        for kind, path in (
            ("texture", "textures.T"),
            ("primitive", "objects.1.primitive"),
            ("light", "lights.0"),
            ("camera", "camera"),
        ):
            self.run_rtslc("new", kind, "T")
            for start in ("T", path):
                self.assertIn(
                    "no member `tnt`", self.refused("T.rtsl", "--set", f"{start}.tnt=1")["message"]
                )
            (self.folder / "T.rtsl").unlink()
        self.render(
            LIBRARY / "std/materials/Lambert.rtsl",
            "--set",
            'Lambert.albedo={"class": "Brick"}',
            "-Werror",
        )

    def test_constructors(self):
        glass = EXAMPLES / "glass/Glass.rtsl"
        message = self.refused(glass)
        self.assert_message(
            [message],
            "E0814",
            "`Glass` cannot be shown without arguments of its constructor: "
            "`float index, float surroundings, color tint`",
            line=9,
            column=6,
            file="Glass.rtsl",
        )
        # What the message proposes works, also for vectors.
        for file in (
            glass,
            EXAMPLES / "glass/Parallelogram.rtsl",
            EXAMPLES / "glass/PinholeCamera.rtsl",
        ):
            proposed = re.search(r"`--set (.*)='(.*)'` gives them", self.refused(file)["notes"][0])
            self.render(
                file, "--set", f"{proposed.group(1)}={proposed.group(2)}", "-Wno-depth-limit"
            )
        self.assertIn("`rtslc new scene NAME`", message["notes"][1])
        # A camera that derives from one of the library has the arguments of the one that it
        # replaces.
        self.write(
            "a.rtsl",
            "import std.cameras;\nclass Close : ViewCamera { void generateRay() { rt_RayOrigin = "
            "position; "
            "rt_RayDirection = toWorld(vec3(0.1 * pictureCoord(), 1.0)); } };\n",
        )
        self.render("a.rtsl", "-Werror")

    def test_names_of_the_library_are_free(self):
        for file in ("Lambert", "Checker", "Sphere", "Sky", "Solid", "BallLight"):
            with self.subTest(file=file):
                self.render(EXAMPLES / f"glass/{file}.rtsl")
        self.write("a.rtsl", OWN_NAMES)
        for name in ("Lambert", "Checker"):
            self.render("a.rtsl", "--class", name, "-Werror")
        self.write(
            "b.rtsl",
            "import std.materials;\nclass Checker : Lambert { color diffuseColor() { return "
            "color(0.2); } };\n",
        )
        self.render("b.rtsl", "-Werror")

    def test_dependencies_and_inputs(self):
        self.write("grey.inc", GREY)
        self.write("a.rtsl", '#include "grey.inc"\nclass Other : Grey { };\n')
        self.render("a.rtsl", "-MD", "-MF", "a.d")
        rule = (self.folder / "a.d").read_text()
        for name in ("a.rtsl", "grey.inc", "preview/material.json", "std/primitives/Sphere.rtsl"):
            self.assertIn(name, rule)
        self.assertNotIn("<scene", rule)
        for name in ("a.rtsl", "grey.inc"):
            before = (self.folder / name).read_text()
            (message,) = self.diagnose("render", "a.rtsl", "-o", name, "--format=exr", *SMALL)
            self.assertEqual(message["code"], "E0965")
            self.assertEqual((self.folder / name).read_text(), before)

    def test_other_options_apply(self):
        self.run_rtslc("new", "texture", "Dots")
        self.write("b.inc", "")
        out, _ = self.run_rtslc("render", "Dots.rtsl", "-o", "a.exr", "--json", *SMALL)
        self.assertEqual(json.loads(out)["samples"], 32 * 24 * 2)
        for way in (
            ["--trace=split"],
            ["--target=host-megakernel"],
            ["--color=mono"],
            ["--fp=double"],
            ["-I", "."],
            ["-D", "X=1"],
            ["--engine", "normals"],
            ["--depth", "0"],
        ):
            with self.subTest(way=way):
                self.render("Dots.rtsl", "-Werror", *way)

    def test_other_commands_take_scenes(self):
        self.write("grey.rtsl", GREY)
        (message,) = self.diagnose("pack", "grey.rtsl", "-o", "a.rtslpkg")
        self.assertEqual(message["code"], "E0865")


if __name__ == "__main__":
    unittest.main()
