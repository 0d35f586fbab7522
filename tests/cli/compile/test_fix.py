"""rtslc check --fix: what it writes, and what it leaves alone."""

import json
import os
import unittest

from harness import DIAGNOSED, Case

BEFORE = """class Grey : rt_Material;

public float3 tint

void shade() {
  float x = saturate(tint.x)
  int n = x * 2.0;
  rt_SampleColor = color(lerp(x, 0.5f, 1f / n));
}
"""
AFTER = """class Grey : rt_Material;

public vec3 tint;

void shade() {
  float x = clamp(tint.x, 0.0, 1.0);
  int n = int(x * 2.0);
  rt_SampleColor = color(mix(x, 0.5f, 1.0f / n));
}
"""


# A shader with habits of CUDA, HLSL, OptiX and C++; each mistake has one certain fix.
HABITS = """using namespace optix;
class Clay extends rt_Material {
  layout(location = 0) public float3 tint;
  __device__ __forceinline__ static float weight(const float &x, int n) const {
    auto sum = x;
    [unroll] for (int i = 0; i < n; ++i)
      sum += (float) i * std::abs(x);
    return sum;
  }
  virtual void shade() override {
    auto d = optixGetWorldRayDirection();
    let far = d.x > 1.0 and d->y > 1.0 or not isnan(d.z);
    if (not far and d.x < FLT_MAX)
      rt_SampleColor = color((float)(int) d.x, __sinf(d->y), fminf(RayTCurrent(), 1.0));
  }
};
"""
PLAIN = """
class Clay : rt_Material {
  public vec3 tint;
  float weight(const float x, int n) {
    float sum = x;
    for (int i = 0; i < n; ++i)
      sum += float(i) * abs(x);
    return sum;
  }
  void shade() {
    vec3 d = rt_RayDirection;
    bool far = d.x > 1.0 && d.y > 1.0 || !isnan(d.z);
    if (!far && d.x < 3.40282347e38)
      rt_SampleColor = color(float(int(d.x)), sin(d.y), min(rt_HitDistance, 1.0));
  }
};
"""


class Fixes(Case):
    def fix(self, *files, status=DIAGNOSED):
        return self.run_rtslc("check", "--fix", *files, status=status)

    def test_common_slips(self):
        path = self.write("grey.rtsl", BEFORE)
        rounds = 0
        while (
            path.read_text() != AFTER and rounds < 3
        ):  # the types are looked at once the syntax is right
            _, error = self.fix("grey.rtsl", status=None)
            self.assertRegex(
                error, r"\ngrey.rtsl: \d+ mistakes? fixed\n(\d+ mistakes? left:\n\n|$)"
            )
            self.assertEqual(" left:" in error, path.read_text() != AFTER, error)
            rounds += 1
        self.assertEqual(path.read_text(), AFTER)
        out, error = self.fix("grey.rtsl", status=0)
        self.assertEqual((out, error, path.read_text()), ("", "", AFTER))

    def test_habits_of_other_languages(self):
        path = self.write("clay.rtsl", HABITS)
        before = ""
        while before != (before := path.read_text()):
            self.fix("clay.rtsl", status=None)
        self.assertEqual(before, PLAIN)

    def test_standard_input_goes_to_standard_output(self):
        out, _ = self.run_rtslc(
            "check", "--fix", "-", stdin=b"float3 f() { return float3(1); }\n", status=DIAGNOSED
        )
        self.assertEqual(out, "vec3 f() { return vec3(1); }\n")

    def test_several_files_and_what_they_import(self):
        self.write("a.rtsl", 'import "c.rtsl";\nfloat2 a() { return c(); }\n')
        self.write("b.rtsl", "float3 b() { return vec3(1); }\n")
        self.write("c.rtsl", "float2 c() { return vec2(1); }\n")
        _, error = self.fix("a.rtsl", "b.rtsl", status=0)
        for name in "abc":
            self.assertIn(f"{name}.rtsl: 1 mistake fixed\n", error)
            self.assertNotIn("float", (self.folder / f"{name}.rtsl").read_text())
        self.run_rtslc("check", "a.rtsl", "b.rtsl")

    def test_more_mistakes_than_are_usually_shown(self):
        path = self.write(
            "many.rtsl", "".join(f"float3 f{i}() {{ return vec3(1); }}\n" for i in range(50))
        )
        _, error = self.fix("many.rtsl", status=0)
        self.assertIn("many.rtsl: 50 mistakes fixed\n", error)
        self.assertNotIn("float3", path.read_text())

    def test_the_status_is_that_of_the_corrected_files(self):
        path = self.write("a.rtsl", "float3 a() { return vec3(1); }\n")
        _, error = self.fix("a.rtsl", status=0)
        self.assertIn("error[E0201]", error)  # what was fixed is shown
        self.assertTrue(error.endswith("\na.rtsl: 1 mistake fixed\n"), error)
        # What no fix is certain for is left,
        path.write_text("float3 a() { return vec3(radus); }\n")
        _, error = self.fix("a.rtsl", status=DIAGNOSED)
        left = error.split("\na.rtsl: 1 mistake fixed\n1 mistake left:\n\n")[1]
        self.assertRegex(left, r"^a.rtsl:1:\d+: error\[E0200\]: unknown name `radus`\n")
        # and what comes to light once the syntax is right.
        path.write_text("float a() { float b = 1.0 return nothing + b; }\n")
        _, error = self.fix("a.rtsl", status=DIAGNOSED)
        self.assertIn("\na.rtsl: 1 mistake fixed\n1 mistake left:\n\na.rtsl:1:", error)
        # As JSON there is one document.
        path.write_text("float3 a() { return vec3(radus); }\n")
        _, error = self.run_rtslc(
            "check", "--fix", "a.rtsl", "--diagnostics=json", status=DIAGNOSED
        )
        document, end = json.JSONDecoder().raw_decode(error)
        self.assertEqual(len(document["diagnostics"]), 2, error)
        self.assertEqual(
            error[end:].split("\n")[1:], ["a.rtsl: 1 mistake fixed", "1 mistake left", ""]
        )
        # Nothing is left in a scene's shaders.
        path.write_text("float3 a() { return vec3(1); }\n")
        self.write("b.rtsl", "float2 b() { return vec2(1); }\n")
        self.fix("b.rtsl", "a.rtsl", "-MD", "-MF", "rule", status=0)
        self.assertIn("a.rtsl", (self.folder / "rule").read_text())

    def test_guesses_change_nothing(self):
        text = "float f(float radius) { return radus; }\ndouble g() { return 1.0; }\n"
        path = self.write("guess.rtsl", text)
        _, error = self.fix("guess.rtsl")
        self.assertEqual(path.read_text(), text)
        self.assertNotIn("fixed", error)
        messages = self.diagnose("check", "guess.rtsl")
        self.assertEqual(
            [fix["sure"] for message in messages for fix in message["fixes"]], [False, False]
        )

    def test_overlapping_fixes_wait_for_the_next_run(self):
        path = self.write("nested.rtsl", "int f(float x) { return lerp(x, 1.0, 0.5) + frac(x); }\n")
        for _ in range(3):
            self.fix("nested.rtsl", status=None) if self.run_messages("nested.rtsl") else None
        self.assertEqual(
            path.read_text(), "int f(float x) { return int(mix(x, 1.0, 0.5) + fract(x)); }\n"
        )

    def run_messages(self, name):
        done = self.run_rtslc("check", name, "--diagnostics=json", status=None)
        return json.loads(done[1])["diagnostics"]

    def test_all_files_or_none(self):
        self.write("a.rtsl", "float3 a() { return vec3(1); }\n")
        locked = self.folder / "locked"
        locked.mkdir()
        (locked / "b.rtsl").write_text("float3 b() { return vec3(1); }\n")
        os.chmod(locked, 0o555)
        self.addCleanup(os.chmod, locked, 0o755)
        os.chmod(self.folder, 0o777)
        _, error = self.run_rtslc(
            "check", "--fix", "a.rtsl", "locked/b.rtsl", status=DIAGNOSED, unprivileged=True
        )
        self.assertIn("rtslc: ", error)
        self.assertIn("float3", (self.folder / "a.rtsl").read_text())
        self.assertIn("float3", (locked / "b.rtsl").read_text())


if __name__ == "__main__":
    unittest.main()
