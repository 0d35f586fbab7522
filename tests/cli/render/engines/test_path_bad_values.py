"""The engine `path`: materials whose methods write values that mean nothing."""

import unittest

from harness import EXAMPLES
from path_case import BALL, SHADERS, PathCase


class BadValues(PathCase):
    def test_densities_of_0_absorb(self):
        """A material whose `sampleBSDF` writes a density of 0, and no value, sends out what shines,
        and no NaN."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Absorbs : Own {
  void sampleBSDF() { rt_LightDirection = normal(); rt_BSDFValue = color(0.0); rt_PDF = 0.0; }
};
""",
        )
        self.scene([(BALL, {"class": "Absorbs", "albedo": 0, "glow": 0.25})], spp=4)
        self.assert_gray(0.25, 1e-6)

    def test_values_that_are_no_numbers_are_left_out(self):
        """A BSDF that is NaN in half of its samples: the picture is that of the others, and the
        message says which line it was."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Broken : Own {
  void sampleBSDF() {
    rt_LightDirection = normal();
    rt_PDF = -1.0;
    float zero = rt_RayDirection.x - rt_RayDirection.x;
    rt_BSDFValue = color(rand() < 0.5 ? zero / zero : 0.0);
  }
};
""",
        )
        self.scene([(BALL, {"class": "Broken", "albedo": 0, "glow": 0.25})], spp=16, depth=2)
        self.assert_gray(0.25, 1e-6)
        _, messages = self.run_rtslc("render", "scene.json", "-o", "a.exr")
        self.assertIn("were infinite or not a number", messages)
        self.assertIn("zero / zero", messages)

    def test_values_below_0_are_left_out(self):
        """A BSDF that is negative in half of its samples: the picture is that of the others, and
        the message says which class it was, with the line of the engine that found it."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Below : Own {
  void sampleBSDF() {
    rt_LightDirection = normal();
    rt_PDF = -1.0;
    rt_BSDFValue = color(rand() < 0.5 ? -0.5 : 0.0);
  }
};
""",
        )
        self.scene([(BALL, {"class": "Below", "albedo": 0, "glow": 0.25})], spp=16, depth=2)
        self.assert_gray(0.25, 1e-6)
        _, messages = self.run_rtslc("render", "scene.json", "-o", "a.exr")
        self.assertIn("were infinite or not a number", messages)
        self.assertIn("min(rt_BSDFValue) < 0.0 ? color(sqrt(-1.0))", messages)
        self.assertRegex(
            messages,
            "W2800.*`sampleBSDF` of `Below` wrote negative values for [0-9]+ of 512 directions",
        )

    def test_values_without_a_density_are_left_out(self):
        """A BSDF with a value for half of the directions that it draws with a density of 0: the
        picture is that of the others, and the message says which class it was, with the line of the
        engine that found it."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Lost : Own {
  void sampleBSDF() {
    rt_LightDirection = normal();
    rt_PDF = 0.0;
    rt_BSDFValue = color(rand() < 0.5 ? 1.0 : 0.0);
  }
};
""",
        )
        self.scene([(BALL, {"class": "Lost", "albedo": 0, "glow": 0.25})], spp=16, depth=2)
        for engine in ("path", "volume"):
            self.assert_gray(0.25, 1e-6, "--engine", engine)
            _, messages = self.run_rtslc("render", "scene.json", "-o", "a.exr", "--engine", engine)
            self.assertRegex(messages, "W2865.*were infinite or not a number", engine)
            self.assertIn("rt_BSDFValue / rt_PDF", messages, engine)
            self.assertRegex(
                messages, "W2800.*`sampleBSDF` of `Lost` drew [0-9]+ of 512 directions", engine
            )


class Check(PathCase):
    """`rtslc check` tries the methods of materials."""

    def said(self, *options):
        """What `rtslc check` says of the scene, and `rtslc render` of an animation of two frames,
        where nothing is said twice."""
        _, checked = self.run_rtslc("check", "scene.json", *options)
        frames = ("--frames", "0..1", "-o", "a.%d.exr", "-q", self.level)
        _, rendered = self.run_rtslc("render", "scene.json", *frames, *options)
        rendered = "".join(
            part for part in rendered.split("\n\n") if "all frames are the same" not in part
        )
        return checked, rendered

    def test_directions_of_another_length(self):
        """Twice as long: the cosine counts twice. Of a mirror's there is none."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Long : Half {
  void sampleBSDF() { Half::sampleBSDF(); rt_LightDirection *= 2.0; }
};
class LongMirror : Mirror {
  void sampleBSDF() { Mirror::sampleBSDF(); rt_LightDirection *= 2.0; }
};
""",
        )
        for name, is_named in (("Long", True), ("LongMirror", False), ("Half", False)):
            self.scene([(BALL, {"class": name})], spp=1)
            for messages in self.said("-Wno-sampling-method"):
                self.assertEqual(
                    "`sampleBSDF` of `Long` drew 512 of 512 directions with a length other than 1, "
                    "such as 2: light counts by the cosine" in messages,
                    is_named,
                    messages,
                )

    def test_check_tries_the_methods_of_materials(self):
        """Values below 0, values that are no numbers, and directions without a density."""
        self.write(
            "shaders.rtsl",
            SHADERS
            + """
class Below : Own { void BSDF() { rt_BSDFValue = color(rt_LightDirection.x < 0.0 ? -0.5 : 0.5); } };
class NoNumber : Own {
  void sampleBSDF() {
    rt_LightDirection = normal();
    rt_PDF = 1.0;
    rt_BSDFValue = color(0.0 / (rt_BSDFSeed.x < 0.5 ? 0.0 : 1.0));
  }
};
class Lost : Own {
  void sampleBSDF() { rt_LightDirection = normal(); rt_BSDFValue = color(1.0); rt_PDF = 0.0; }
};
class Dark : rt_Material {
  public float sign = 1.0;
  void emission() { rt_EmissionColor = color(sign * sqrt(rt_RayDirection.x)); }
};
""",
        )
        said = {}
        for name in ("Below", "NoNumber", "Lost", "Own"):
            self.scene([(BALL, {"class": name})], spp=1)
            _, said[name] = self.run_rtslc("check", "scene.json")
        self.assertRegex(
            said["Below"], "W2800.*`BSDF` of `Below` wrote negative values for [0-9]+ of 512"
        )
        self.assertIn('"class": "Below"', said["Below"])
        self.assertRegex(
            said["NoNumber"],
            "`sampleBSDF` of `NoNumber` wrote values that are infinite or not a number",
        )
        self.assertRegex(said["Lost"], "`sampleBSDF` of `Lost` drew 512 of 512 directions")
        for sign, what in (
            (-1, "negative values"),
            (1, "values that are infinite or not a number"),
        ):
            self.scene([(BALL, {"class": "Dark", "sign": sign})], spp=1)
            _, error = self.run_rtslc("check", "scene.json")
            self.assertRegex(error, f"W2800.*`emission` of `Dark` wrote {what} for [0-9]+ of 512")
        self.assertEqual(said["Own"], "")

    def test_materials_of_the_library_have_no_such_values(self):
        for example in ("cornell/room.json", "product-shot/scene.json", "metal/scene.json"):
            self.assertEqual(self.run_rtslc("check", EXAMPLES / example)[1], "", example)


if __name__ == "__main__":
    unittest.main()
