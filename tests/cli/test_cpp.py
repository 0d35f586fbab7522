"""rtslc compile --emit=cpp: bad input and bad outputs, names, dependencies; and that the manual knows every option."""

import os
import pathlib
import re
import subprocess
import unittest

from harness import DIAGNOSED, EXAMPLES, FINE, RTSLC, USAGE, Case

ROOT = EXAMPLES.parent


class Cpp(Case):
    def test_errors_keep_the_old_output(self):
        shader = self.write("a.rtsl", "float f(float x) { return y; }\n")
        out = self.write("a.cpp", "old")
        self.run_rtslc("compile", shader, "--emit=cpp", "-o", out, status=DIAGNOSED)
        self.assertEqual(out.read_text(), "old")
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["a.cpp", "a.rtsl"])

    def test_output_that_cannot_be_written(self):
        shader = self.write("a.rtsl", "float f(float x) { return x; }\n")
        (self.folder / "folder").mkdir()
        _, error = self.run_rtslc("compile", shader, "--emit=cpp", "-o", "folder", status=DIAGNOSED)
        self.assertIn("folder", error)
        with open("/dev/full", "wb") as full:
            _, error = self.run_rtslc("compile", shader, "--emit=cpp", status=DIAGNOSED, stdout=full)
        self.assertIn("No space left", error)

    def test_what_cpp_cannot_be_made_of(self):
        self.run_rtslc("compile", EXAMPLES / "glass/scene.json", "--emit=cpp", status=USAGE)

    def test_methods_that_trace(self):
        split, _ = self.run_rtslc("compile", EXAMPLES / "glass/Glass.rtsl", "--emit=cpp")
        self.assertEqual(split, self.run_rtslc("compile", EXAMPLES / "glass/Glass.rtsl", "--emit=cpp", "--trace=split")[0])
        self.assertIn("struct ShadeFrame {", split)
        self.assertIn("// needed by line 40: `vec3 refracted = refract(direction, ...`", split)
        self.assertNotIn("rtsl::trace(", split)
        recurse, _ = self.run_rtslc("compile", EXAMPLES / "glass/Glass.rtsl", "--emit=cpp", "--trace=recurse")
        self.assertIn("rtsl::trace(rt, rt.HitPoint, reflected)", recurse)
        self.assertNotIn("Frame", recurse)

    def test_arrays_stay_whole_in_states(self):
        shader = self.write("table.rtsl", """class Table : rt_Material;
            void shade() {
              float table[4];
              for (int i = 0; i < 4; ++i) table[i] = float(i);
              color c = trace(rt_HitPoint, rt_ShadingNormal);
              rt_SampleColor = c * table[rt_Depth];
            }
            """)
        text, _ = self.run_rtslc("compile", shader, "--emit=cpp")
        self.assertIn("rtsl::array<float, 4> table; // needed by line 6: `float table[4]`", text)
        self.assertIn("rt.SampleColor = rtsl::traced(rt) * frame.table[rt.Depth];", text)
        self.assertEqual(text, self.run_rtslc("compile", shader, "--emit=cpp", "--trace=split")[0])

    def test_a_member_called_rtsl(self):
        shader = self.write("names.rtsl", "class A : rt_Texture; public float rtsl = 1.0; void lookup() "
                            "{ rt_TextureColor = color(rtsl); }")
        text, _ = self.run_rtslc("compile", shader, "--emit=cpp")
        self.assertIn("float rtsl2 = 1.0f;", text)

    def test_names_that_cpp_has_taken(self):
        shader = self.write("my-names.rtsl", """
            struct Ray { float template; vec3 Color; };
            float this_(float signed) { return signed; }
            float delete(float rt, float std) { Ray glm = Ray(rt, vec3(std)); float namespace = glm.template; return this_(namespace); }
            """)
        text, _ = self.run_rtslc("compile", shader, "--emit=cpp")
        self.assertIn("namespace my_names {", text)
        self.assertIn("inline float delete_(float rt_, float std_) {", text)
        self.assertIn("Ray glm_{rt_, glm::vec3(std_)};", text)
        self.assertIn("float namespace_ = glm_.template_;", text)

    def test_line_directives_and_dependencies(self):
        self.write("b.rtsl", "float half(float x) { return 0.5 * x; }\n")
        shader = self.write("a.rtsl", 'import "b.rtsl";\nfloat f(float x) {\n  return half(x);\n}\n')
        self.run_rtslc("compile", shader, "--emit=cpp", "-o", "a.cpp", "--line-directives", "-MD", "-MF", "a.d")
        self.assertIn(f'#line 3 "{shader}"\n  return half(x);', (self.folder / "a.cpp").read_text())
        rule = (self.folder / "a.d").read_text()
        self.assertTrue(rule.startswith("a.cpp:"), rule)
        for name in ("a.rtsl", "b.rtsl"):
            self.assertIn(name, rule)

    def test_the_manual_knows_every_option_of_compile(self):
        manual = (ROOT / "tools/man/rtslc.1").read_text().replace("\\-", "-")
        text, _ = self.run_rtslc("compile", "--help")
        options = set(re.findall(r"--[a-z-]+(?= |,|$)", "\n".join(line[:28] for line in text.splitlines()))) - {"--help"}
        self.assertGreater(len(options), 8)
        self.assertEqual([option for option in sorted(options) if option not in manual], [])

    def test_completion_knows_commands_and_stages(self):
        script = f"""source {ROOT}/tools/completion/rtslc.bash
            COMP_WORDS=({RTSLC} com); COMP_CWORD=1; _rtslc; echo "${{COMPREPLY[@]}}"
            COMP_WORDS=({RTSLC} compile --emit = cp); COMP_CWORD=4; _rtslc; echo "${{COMPREPLY[@]}}\""""
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.split("\n")[:2], ["compile compare", "cpp"], done)


if __name__ == "__main__":
    unittest.main()
