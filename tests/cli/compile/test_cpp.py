"""rtslc compile --emit=cpp: bad input and bad outputs, names, dependencies; and that the manual
lists every option."""

import os
import pathlib
import re
import shutil
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
        for stage in ("cpp", "reflection", "ptx"):
            _, error = self.run_rtslc(
                "compile", shader, f"--emit={stage}", "-o", "folder", status=DIAGNOSED
            )
            self.assertIn("cannot write `folder`: Is a directory", error)
            _, error = self.run_rtslc(
                "compile", shader, f"--emit={stage}", "-o", "no/where", status=DIAGNOSED
            )
            self.assertIn("cannot write `no/where`: No such file or directory", error)
            _, error = self.run_rtslc(
                "compile", shader, f"--emit={stage}", "-o", "/dev/full", status=DIAGNOSED
            )
            self.assertIn("cannot write `/dev/full`: No space left on device", error)
            with open("/dev/full", "wb") as full:
                _, error = self.run_rtslc(
                    "compile", shader, f"--emit={stage}", status=DIAGNOSED, stdout=full
                )
            self.assertIn("cannot write to standard output: No space left", error)
        self.assertEqual(sorted(p.name for p in self.folder.iterdir()), ["a.rtsl", "folder"])
        self.assertEqual(list((self.folder / "folder").iterdir()), [])

    def test_a_full_disk_keeps_the_old_output(self):
        shader = self.write("a.rtsl", "float f(float x) { return x; }\n")
        # A file system of 8 kB in a name space of its own, where the user may have one.
        for stage in ("cpp", "reflection", "ptx"):
            script = f"""mount -t tmpfs -o size=8k none full && cd full && echo old > out && head -c 9000 /dev/zero > filler 2>/dev/null
                {RTSLC} compile {shader} --emit={stage} -MD -o out; echo "status $?"; cat out; ls -A"""
            (self.folder / "full").mkdir(exist_ok=True)
            done = subprocess.run(
                ["unshare", "--mount", "--map-root-user", "bash", "-c", script],
                cwd=self.folder,
                capture_output=True,
                text=True,
            )
            if "status" not in done.stdout:
                self.skipTest("no file system can be mounted: " + done.stderr)
            self.assertIn("No space left on device", done.stderr)
            self.assertEqual(done.stdout.splitlines(), ["status 1", "old", "filler", "out"])

    def test_a_read_only_folder(self):
        shader = self.write("a.rtsl", "float f(float x) { return x; }\n")
        closed = self.folder / "closed"
        closed.mkdir()
        (closed / "out").write_text("old")
        closed.chmod(0o555)
        for stage in ("cpp", "reflection", "ptx"):
            _, error = self.run_rtslc(
                "compile",
                shader,
                f"--emit={stage}",
                "-o",
                closed / "out",
                status=DIAGNOSED,
                unprivileged=True,
            )
            self.assertIn(f"cannot write `{closed / 'out'}`: Permission denied", error)
        self.assertEqual([p.name for p in closed.iterdir()], ["out"])
        self.assertEqual((closed / "out").read_text(), "old")

    def test_dependencies_that_cannot_be_written(self):
        shader = self.write("a.rtsl", "float f(float x) { return x; }\n")
        out = self.write("a.cpp", "old")
        (self.folder / "folder").mkdir()
        for rule in ("folder", "/dev/full", "no/where.d"):
            _, error = self.run_rtslc(
                "compile", shader, "--emit=cpp", "-o", out, "-MD", "-MF", rule, status=DIAGNOSED
            )
            self.assertIn(f"cannot write `{rule}`", error)
            self.assertEqual(out.read_text(), "old")
        self.assertEqual(
            sorted(p.name for p in self.folder.iterdir()), ["a.cpp", "a.rtsl", "folder"]
        )

    def test_what_cpp_cannot_be_made_of(self):
        self.run_rtslc("compile", EXAMPLES / "glass/scene.json", "--emit=cpp", status=USAGE)

    def test_methods_that_trace(self):
        split, _ = self.run_rtslc("compile", EXAMPLES / "glass/Glass.rtsl", "--emit=cpp")
        self.assertEqual(
            split,
            self.run_rtslc("compile", EXAMPLES / "glass/Glass.rtsl", "--emit=cpp", "--trace=split")[
                0
            ],
        )
        self.assertIn("struct ShadeFrame {", split)
        self.assertIn("// needed by line 40: `vec3 refracted = refract(direction, ...`", split)
        self.assertNotIn("rtsl::trace(", split)
        recurse, _ = self.run_rtslc(
            "compile", EXAMPLES / "glass/Glass.rtsl", "--emit=cpp", "--trace=recurse"
        )
        self.assertIn("rtsl::trace(rt, rt.HitPoint, reflected)", recurse)
        self.assertNotIn("Frame", recurse)

    def test_arrays_stay_whole_in_states(self):
        shader = self.write(
            "table.rtsl",
            """class Table : rt_Material;
            void shade() {
              float table[4];
              for (int i = 0; i < 4; ++i) table[i] = float(i);
              color c = trace(rt_HitPoint, rt_ShadingNormal);
              rt_SampleColor = c * table[rt_Depth];
            }
            """,
        )
        text, _ = self.run_rtslc("compile", shader, "--emit=cpp")
        self.assertIn("rtsl::array<float, 4> table; // needed by line 6: `float table[4]`", text)
        self.assertIn("rt.SampleColor = rtsl::traced(rt) * frame.table[rt.Depth];", text)
        self.assertEqual(text, self.run_rtslc("compile", shader, "--emit=cpp", "--trace=split")[0])

    def test_a_member_called_rtsl(self):
        shader = self.write(
            "names.rtsl",
            "class A : rt_Texture; public float rtsl = 1.0; void lookup() "
            "{ rt_TextureColor = color(rtsl); }",
        )
        text, _ = self.run_rtslc("compile", shader, "--emit=cpp")
        self.assertIn("float rtsl2 = 1.0f;", text)

    def test_names_that_cpp_has_taken(self):
        shader = self.write(
            "my-names.rtsl",
            """
            struct Ray { float template; vec3 Color; };
            float this_(float signed) { return signed; }
            float delete(float rt, float std) { Ray glm = Ray(rt, vec3(std)); float namespace = glm.template; return this_(namespace); }
            """,
        )
        text, _ = self.run_rtslc("compile", shader, "--emit=cpp")
        self.assertIn("namespace my_names {", text)
        self.assertIn("inline float delete_(float rt_, float std_) {", text)
        self.assertIn("Ray glm_{rt_, glm::vec3(std_)};", text)
        self.assertIn("float namespace_ = glm_.template_;", text)

    def test_line_directives_and_dependencies(self):
        self.write("b.rtsl", "float half(float x) { return 0.5 * x; }\n")
        shader = self.write(
            "a.rtsl", 'import "b.rtsl";\nfloat f(float x) {\n  return half(x);\n}\n'
        )
        self.run_rtslc(
            "compile", shader, "--emit=cpp", "-o", "a.cpp", "--line-directives", "-MD", "-MF", "a.d"
        )
        self.assertIn(f'#line 3 "{shader}"\n  return half(x);', (self.folder / "a.cpp").read_text())
        rule = (self.folder / "a.d").read_text()
        self.assertTrue(rule.startswith("a.cpp:"), rule)
        for name in ("a.rtsl", "b.rtsl"):
            self.assertIn(name, rule)

    def commands(self):
        text, _ = self.run_rtslc("--help")
        found = re.findall(r"^  ([a-z]+) ", text.split("Subcommands:")[1].split("\n\n")[0], re.M)
        self.assertGreater(len(found), 6)
        return [command for command in found if command != "help"]  # which has no options

    def options(self, command):
        text, _ = self.run_rtslc(command, "--help")
        found = {
            option
            for line in text.splitlines()
            for option in re.findall(r"(?:^ +|,)(--?[A-Za-z][A-Za-z-]*)", line[:28])
        }
        return found - {"-h", "--help"}

    def test_the_manual_knows_every_command_and_option(self):
        manual = (ROOT / "tools/man/rtslc.1").read_text().replace("\\-", "-")
        for command in self.commands():
            self.assertIn(f".B rtslc {command}\n", manual)
            self.assertIn(f".TP\n.B {command}\n", manual)
            self.assertGreater(len(self.options(command)), 4)
            self.assertEqual(
                [
                    o
                    for o in self.options(command)
                    if not re.search(re.escape(o) + "(?![a-z-])", manual)
                ],
                [],
                command,
            )
        text, _ = self.run_rtslc("compile", "--help")
        stages = re.search(r"--emit ([a-z|-]+)", text)[1].split("|")
        said = re.search(r"what to write: (.*)\.", manual)[1].replace(" or ", ", ").split(", ")
        self.assertEqual(sorted(said), sorted(stages))

    def test_the_manual_is_well_formed(self):
        if not shutil.which("man"):
            self.skipTest("man is not installed")
        done = subprocess.run(
            ["man", "--warnings", "-E", "UTF-8", "-l", ROOT / "tools/man/rtslc.1"],
            capture_output=True,
            text=True,
            env=dict(os.environ, MANWIDTH="100", PAGER="cat"),
        )
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def complete(self, *words):
        script = (
            f"source {ROOT}/tools/completion/rtslc.bash; COMP_WORDS=({RTSLC} {' '.join(words)}); "
            f'COMP_CWORD={len(words)}; _rtslc; echo "${{COMPREPLY[@]}}"'
        )
        return set(
            subprocess.run(
                ["bash", "-c", script], capture_output=True, text=True, check=True
            ).stdout.split()
        )

    def test_completion_knows_every_command_and_option(self):
        self.assertEqual(
            self.complete("''") - {"--help", "--version", "help"}, set(self.commands())
        )
        self.assertLessEqual(set(self.commands()), self.complete("help", "''"))
        for command in self.commands():
            missing = {
                option for option in self.options(command) if option.startswith("--")
            } - self.complete(command, "--")
            self.assertEqual(missing, set(), command)

    def test_completion_knows_commands_and_stages(self):
        script = f"""source {ROOT}/tools/completion/rtslc.bash
            COMP_WORDS=({RTSLC} com); COMP_CWORD=1; _rtslc; echo "${{COMPREPLY[@]}}"
            COMP_WORDS=({RTSLC} compile --emit = cp); COMP_CWORD=4; _rtslc; echo "${{COMPREPLY[@]}}"
            COMP_WORDS=({RTSLC} new t); COMP_CWORD=2; _rtslc; echo "${{COMPREPLY[@]}}\""""
        done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
        self.assertEqual(done.stdout.split("\n")[:3], ["compile compare", "cpp", "texture"], done)


if __name__ == "__main__":
    unittest.main()
