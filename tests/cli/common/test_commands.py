"""The commands on good input."""

import json
import os
import re
import subprocess
import unittest
from pathlib import Path

from harness import EXAMPLES, RTSLC, Case

MATERIAL = "class Grey : rt_Material;\n\nvoid shade() {\n  rt_SampleColor = color(0.5);\n}\n"


class Commands(Case):
    def test_help_has_an_example_for_each_command(self):
        out, _ = self.run_rtslc("--help")
        for command in ("new", "check", "compile", "explain", "render", "compare"):
            self.assertIn(command, out)
            text, _ = self.run_rtslc(command, "--help")
            self.assertRegex(text, "examples?:\n  rtslc " + command)

    def test_version(self):
        out, _ = self.run_rtslc("--version")
        self.assertRegex(out, r"^rtslc \d+\.\d+\.\d+\n$")

    def assert_starts_without(self, program, *unwanted):
        done = subprocess.run(
            [os.environ["READELF"], "-d", program], stdout=subprocess.PIPE, text=True, check=True
        )
        libraries = [line for line in done.stdout.splitlines() if "NEEDED" in line]
        self.assertTrue(libraries)
        for name in unwanted:
            self.assertFalse([line for line in libraries if name in line], libraries)

    def test_checking_sources_loads_no_library_of_scenes(self):
        scenes = ("embree", "assimp", "tbb", "OpenEXR", "png", "OpenImageIO", "z3")
        self.assert_starts_without(RTSLC, *scenes)

    def test_rendering_loads_readers_of_files_when_it_needs_them(self):
        program = Path(RTSLC).with_name("rtslc-render")
        self.assert_starts_without(program, "assimp", "OpenImageIO")

    def test_checking_sources_loads_no_code_generator(self):
        pass_of_llvm = b"NVPTX Assembly Printer"
        self.assertIn(pass_of_llvm, Path(RTSLC).with_name("rtslc-render").read_bytes())
        self.assertNotIn(pass_of_llvm, Path(RTSLC).read_bytes())

    def test_check_reads_standard_input(self):
        out, error = self.run_rtslc("check", "-", stdin=MATERIAL.encode())
        self.assertEqual((out, error), ("", ""))

    def test_check_accepts_the_examples(self):
        sources = sorted(EXAMPLES.glob("*/*.rtsl"))
        self.assertTrue(sources)
        self.run_rtslc("check", *sources)

    def test_fix_mends_a_missing_semicolon(self):
        path = self.write("grey.rtsl", MATERIAL.replace(";\n}", "\n}"))
        self.run_rtslc("check", "--fix", "grey.rtsl", status=0)
        self.assertEqual(path.read_text(), MATERIAL)
        self.run_rtslc("check", "grey.rtsl")

    def test_compile_shows_every_stage(self):
        self.write("grey.rtsl", MATERIAL)
        marks = {
            "ast": "Grey",
            "typed-ast": "Grey",
            "ir": "func.func",
            "ssa": "func.func",
            "llvm": "define",
            "ptx": "Grey_shade",
        }
        for stage, mark in marks.items():
            with self.subTest(stage=stage):
                out, _ = self.run_rtslc("compile", "grey.rtsl", f"--emit={stage}")
                self.assertIn(mark, out)
                self.run_rtslc("compile", "grey.rtsl", f"--emit={stage}", "-o", "out")
                self.assertEqual((self.folder / "out").read_text(), out)
                piped, _ = self.run_rtslc(
                    "compile", "-", f"--emit={stage}", "-o", "-", stdin=MATERIAL.encode()
                )
                self.assertEqual(piped.replace("<stdin>", "grey.rtsl"), out)

    def test_output_is_the_same_on_every_run(self):
        sources = sorted((EXAMPLES / "glass").glob("*.rtsl"))
        for stage in ("ir", "ssa", "llvm"):
            first, _ = self.run_rtslc("compile", *sources, f"--emit={stage}")
            second, _ = self.run_rtslc("compile", *sources, f"--emit={stage}")
            self.assertEqual(first, second)

    def test_render_is_silent_when_piped_and_reports_as_json(self):
        self.glass_scene()
        out, error = self.run_rtslc(
            "render", "scene.json", "-o", "a.png", "--size", "32x18", "--spp", "2", "--json"
        )
        figures = json.loads(out)
        self.assertEqual(figures["samples"], 32 * 18 * 2)
        self.assertNotIn("\r", error)
        self.assertEqual(self.files().count("a.png"), 1)

    def test_a_mesh_from_anywhere(self):
        path = self.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
        self.glass_scene()
        self.run_rtslc(
            "render",
            "scene.json",
            "-o",
            "a.exr",
            "--size",
            "32x18",
            "--spp",
            "1",
            "--set",
            f"objects.3.mesh={path}",
        )

    def test_explain_says_what_each_trace_saves(self):
        glass = EXAMPLES / "glass" / "Glass.rtsl"
        text, _ = self.run_rtslc("explain", "--states", glass)
        self.assertIn("Glass.shade: 4 states, frame of 28 bytes", text)
        out, _ = self.run_rtslc("explain", "--states", "--json", glass)
        figures = json.loads(out)
        self.assertEqual([f["name"] for f in figures["functions"]], ["Glass.shade"])
        self.assertEqual(figures["frameSize"], 28)

    def test_warnings_are_turned_on_and_off(self):
        self.write("odd.rtsl", MATERIAL.replace("  rt_", "  float x = 1.0;\n  rt_"))
        _, error = self.run_rtslc("check", "odd.rtsl")
        self.assertIn(
            "odd.rtsl:4:9: warning[W2200]: `x` is never used [-Wunused-variable]\n", error
        )
        self.assertEqual(self.run_rtslc("check", "odd.rtsl", "-Wno-unused-variable"), ("", ""))
        self.assertEqual(self.run_rtslc("check", "odd.rtsl", "-Wno-all", "-Wperf"), ("", ""))
        for arguments in (
            ["-Werror"],
            ["-Werror=unused-variable"],
            ["-Wno-all", "-Werror=unused-variable"],
        ):
            _, error = self.run_rtslc("check", "odd.rtsl", *arguments, status=1)
            self.assertIn("error[W2200]: `x` is never used [-Werror=unused-variable]\n", error)
        self.run_rtslc("check", "odd.rtsl", "-Werror", "-Wno-error=unused-variable")
        self.run_rtslc("compile", "odd.rtsl", "--emit=ir", "-Werror", status=1)
        self.run_rtslc("explain", "--states", "odd.rtsl", "-Werror", status=1)
        _, error = self.run_rtslc("check", "odd.rtsl", "-Wunused-varable", status=2)
        self.assertIn(
            "there is no warning `unused-varable`; did you mean `unused-variable`?", error
        )

    def test_warnings_of_a_scene(self):
        self.glass_scene()
        render = (
            "render",
            "scene.json",
            "-o",
            "picture.png",
            "--size",
            "8x8",
            "--spp",
            "1",
            "--set",
            "objects.1.primitive.radius=0",
        )
        _, error = self.run_rtslc(*render)
        self.assertIn("[-Wscene]", error)
        self.run_rtslc(*render, "-Werror=scene", status=1)

    def test_much_live_state_is_warned_of(self):
        text = (
            "class Wide : rt_Material;\n\nvoid shade() {\n  float w[32];\n"
            "  for (int i = 0; i < 32; ++i)\n    w[i] = rand();\n  vec3 p = rt_HitPoint * rand();\n"
            "  vec4 q = vec4(rand(), rand(), rand(), rand());\n  vec4 r = q.wzyx * rand();\n"
            "  color c = trace(p, rt_RayDirection);\n  float s = p.x + p.y + p.z;\n"
            "  for (int i = 0; i < 32; ++i)\n    s += w[i];\n"
            "  rt_SampleColor = c * (s + dot(q, r) * q.x * r.y);\n}\n"
        )
        self.write("wide.rtsl", text)
        _, error = self.run_rtslc("check", "wide.rtsl", "-Wlive-state", "--diagnostics=json")
        (message,) = json.loads(error)["diagnostics"]
        self.assertEqual(
            (message["code"], message["warning"], message["range"]["begin"]["line"]),
            ("W2901", "live-state", 10),
        )
        self.assertRegex(
            message["message"], "^1[0-9][0-9] bytes .*more than 128; `w` takes the most: 128 bytes$"
        )
        self.write("narrow.rtsl", text.replace("32", "12"))
        self.assertEqual(self.run_rtslc("check", "narrow.rtsl", "-Wlive-state"), ("", ""))
        _, error = self.run_rtslc("check", "narrow.rtsl", "-Wlive-state=64")
        self.assertRegex(error, "more than 64; `w` takes the most: 48 bytes")
        self.assertEqual(self.run_rtslc("check", "narrow.rtsl", "-Wlive-state=1000"), ("", ""))
        _, error = self.run_rtslc("check", "narrow.rtsl", "-Wlive-state=much", status=2)
        self.assertIn("give a number of bytes", error)

    def test_live_state_without_a_name_is_named_by_its_line(self):
        quotients = "rand() / (" * 34
        self.write(
            "sums.rtsl",
            "class Sums : rt_Material;\n\nvoid shade() {\n"
            f"  float s = {quotients}luminance(trace(rt_HitPoint, rt_RayDirection)){')' * 34};\n"
            "  rt_SampleColor = color(s);\n}\n",
        )
        _, error = self.run_rtslc("check", "sums.rtsl", "-Wlive-state")
        self.assertRegex(
            error,
            "bytes are live across this `trace`, more than 128; the value computed in line 4 takes "
            "the most: 4 bytes",
        )
        self.assertRegex(error, r"also saved: the value computed in line 4 \(4\), ")
        self.assertNotIn("rand.2", error)

    def test_documented_warnings_are_those_of_the_compiler(self):
        out, _ = self.run_rtslc("check", "-Whelp")
        listed = [
            (name, code, "perf" if rest else "on")
            for name, code, rest in re.findall(r"^(\S+) +(W\d+)  (?:on|(with -Wperf))$", out, re.M)
        ]
        page = (EXAMPLES.parent / "docs" / "warnings.md").read_text()
        documented = re.findall(r"^\| `([a-z-]+)` \| (W\d+) \| (on|perf) \|", page, re.M)
        self.assertEqual(len(listed), out.count("\n"))
        self.assertEqual(listed, documented)

    def test_compare(self):
        self.glass_scene()
        for seed in "12":
            self.run_rtslc(
                "render",
                "scene.json",
                "-o",
                f"{seed}.exr",
                "--size",
                "32x18",
                "--spp",
                "1",
                "--seed",
                seed,
            )
        self.run_rtslc("compare", "1.exr", "1.exr")
        self.run_rtslc("compare", "1.exr", "2.exr", status=1)
        self.run_rtslc("compare", "1.exr", "2.exr", "--threshold", "10")


if __name__ == "__main__":
    unittest.main()
