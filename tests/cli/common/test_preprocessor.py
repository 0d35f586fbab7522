"""-I, -D, -U, -E and -MD, and files that are included from a disk."""

import json
import os
import pathlib
import shutil
import subprocess
import unittest

from harness import DIAGNOSED, EXAMPLES, USAGE, Case

GREY = """#include "lib/grey.rtsl"
#ifdef FINE
#include <fine.rtsl>
#else
#define ROUGHNESS 0.5
#endif
class Grey : rt_Material;
public float roughness = ROUGHNESS;
void shade() { rt_SampleColor = grey(roughness); }
"""
LIB_GREY = '#pragma once\n#include "shared.rtsl"\n'
SHARED = "color grey(float x) { return color(x); }\n"
FINE = "#define ROUGHNESS 0.125\n"


class Preprocessor(Case):
    def setUp(self):
        super().setUp()
        (self.folder / "lib").mkdir()
        (self.folder / "more folders").mkdir()
        self.write("grey.rtsl", GREY)
        self.write("lib/grey.rtsl", LIB_GREY)
        self.write("lib/shared.rtsl", SHARED)
        self.write("more folders/fine.rtsl", FINE)

    def test_folders_and_macros(self):
        self.run_rtslc("check", "grey.rtsl")
        out, _ = self.run_rtslc(
            "compile", "grey.rtsl", "--emit=typed-ast", "-DFINE", "-Imore folders"
        )
        self.assertIn("0.125", out)
        out, _ = self.run_rtslc(
            "compile", "-D", "FINE=1", "-U", "FINE", "grey.rtsl", "--emit=typed-ast"
        )
        self.assertIn("0.5", out)
        out, _ = self.run_rtslc(
            "compile", "-U", "FINE", "-D", "FINE", "-I", "more folders", "-E", "grey.rtsl"
        )
        self.assertIn("roughness = 0.125;", out)

    def test_a_file_that_is_not_there(self):
        diagnostics = self.diagnose("check", "-D", "FINE", "grey.rtsl")
        self.assert_message(diagnostics, "E0144", "`fine.rtsl`", 3, 10, "grey.rtsl")
        self.assertEqual(
            diagnostics[0]["notes"],
            ["`<...>` is searched only in the folders of `-I`, and none was given"],
        )
        diagnostics = self.diagnose(
            "check", "-D", "FINE", "-I", "lib", "-I", "nowhere", "grey.rtsl"
        )
        self.assertEqual(diagnostics[0]["notes"], ["searched in `lib`, `nowhere`"])
        self.write("near.rtsl", '#include "lib/gray.rtsl"\nimport "lib/gray.rtsl";\n')
        diagnostics = self.diagnose("check", "near.rtsl")
        self.assert_message(diagnostics, "E0144", "`lib/gray.rtsl`", 1, 10)
        self.assertEqual(diagnostics[0]["fixes"][0]["replacement"], "lib/grey.rtsl")
        self.write("near.rtsl", 'import "lib/gray.rtsl";\n')
        diagnostics = self.diagnose("check", "near.rtsl")
        self.assert_message(diagnostics, "E0144", "`lib/gray.rtsl`", 1)
        self.assertIn("did you mean `lib/grey.rtsl`?", diagnostics[0]["notes"])

    def test_imports_look_where_includes_do(self):
        self.write(
            "importing.rtsl", 'import "shared.rtsl";\nfloat f() { return luminance(grey(1.0)); }\n'
        )
        self.run_rtslc("check", "importing.rtsl", status=DIAGNOSED)
        self.run_rtslc("check", "-I", "lib", "importing.rtsl")
        # One in an included file looks beside that file.
        self.write(
            "including.rtsl",
            '#include "lib/importing.rtsl"\nfloat f() { return luminance(grey(1.0)); }\n',
        )
        self.write("lib/importing.rtsl", 'import "shared.rtsl";\n')
        self.run_rtslc("check", "including.rtsl")

    def test_files_that_cannot_be_included(self):
        self.write("secret.rtsl", SHARED).chmod(0)
        self.write("binary.rtsl", b"\x7fELF\x00\x01\xff")
        os.mkfifo(self.folder / "pipe.rtsl")
        cases = {
            "secret.rtsl": ("E0145", 1),
            "lib": ("E0144", 1),
            "binary.rtsl": ("E0101", 1),
            "pipe.rtsl": ("E0144", 1),
            "/dev/zero": ("E0144", 1),
            "main.rtsl": ("E0147", 1),
        }
        for name, (code, line) in cases.items():
            with self.subTest(name=name):
                self.write("main.rtsl", f'#include "{name}"\nfloat f() {{ return 1.0; }}\n')
                self.assert_message(
                    self.diagnose("check", "main.rtsl", unprivileged=True), code, line=line
                )
        self.write("empty.rtsl", "")
        self.write("main.rtsl", '#include "empty.rtsl"\nfloat f() { return 1.0; }\n')
        self.run_rtslc("check", "main.rtsl")

    def test_standard_input_includes_from_the_working_folder(self):
        out, _ = self.run_rtslc("compile", "-E", "-", stdin=GREY.encode())
        self.assertIn("color grey(float x)", out)

    def test_options_that_make_no_sense(self):
        for options in (
            ["-D", "2D"],
            ["-D", "=1"],
            ["-D", "defined"],
            ["-D", "__LINE__=2"],
            ["-U", "a b"],
            ["-D", "A=\n1"],
            ["-D", ""],
        ):
            with self.subTest(options=options):
                _, error = self.run_rtslc("check", "grey.rtsl", *options, status=USAGE)
                self.assertIn(options[0], error)
        _, error = self.run_rtslc("compile", "grey.rtsl", status=USAGE)
        self.assertIn("--emit", error)

    def test_what_is_written_can_be_read_again(self):
        text, _ = self.run_rtslc("compile", "-E", "grey.rtsl")
        self.assertEqual(text.splitlines()[0], '#line 1 "lib/shared.rtsl"')
        self.write("again.rtsl", text)
        first, _ = self.run_rtslc("compile", "grey.rtsl", "--emit=ir")
        second, _ = self.run_rtslc("compile", "again.rtsl", "--emit=ir")
        self.assertEqual(first, second)
        sources = sorted(EXAMPLES.glob("*/*.rtsl"))
        for source in sources:  # which import one another
            shutil.copy(source, self.folder)
        for source in sources:
            text, _ = self.run_rtslc("compile", "--emit=preprocessed", source.name)
            self.write("again.rtsl", text)
            self.assertEqual(
                self.run_rtslc("compile", source.name, "--emit=ast"),
                self.run_rtslc("compile", "again.rtsl", "--emit=ast"),
            )

    def test_dependencies(self):
        self.write(
            "a b#$.rtsl", 'import "grey.rtsl";\n#include <fine.rtsl>\nconst float a = ROUGHNESS;\n'
        )
        rule = (
            "out\\ file.ir: \\\n  a\\ b\\#$$.rtsl \\\n  more\\ folders/fine.rtsl \\\n"
            "  grey.rtsl \\\n  lib/grey.rtsl \\\n"
            "  lib/shared.rtsl\n"
        )
        self.run_rtslc(
            "compile", "-I", "more folders", "a b#$.rtsl", "--emit=ir", "-o", "out file.ir", "-MD"
        )
        self.assertEqual((self.folder / "out file.d").read_text(), rule)
        for stage in ("ast", "typed-ast", "ssa"):
            self.run_rtslc(
                "compile",
                "-I",
                "more folders",
                "a b#$.rtsl",
                f"--emit={stage}",
                "-o",
                "out file.ir",
                "-MD",
                "-MF",
                "deps",
            )
            self.assertEqual((self.folder / "deps").read_text(), rule)
        self.run_rtslc("check", "grey.rtsl", "-MD", "-MF", "stamp.d", "-MT", "stamp")
        self.assertEqual(
            (self.folder / "stamp.d").read_text(),
            "stamp: \\\n  grey.rtsl \\\n  lib/grey.rtsl \\\n  lib/shared.rtsl\n",
        )
        self.run_rtslc("check", "grey.rtsl", "-MD")
        self.assertTrue((self.folder / "grey.d").read_text().startswith("grey.d: \\\n  grey.rtsl"))

    @unittest.skipUnless(shutil.which("make"), "needs make")
    def test_dependencies_of_a_picture_and_a_package(self):
        glass = self.folder / "glass"
        shutil.copytree(EXAMPLES / "glass", glass)
        small = [
            "glass/scene.json",
            "--set",
            "render.size=[8, 8]",
            "--set",
            "render.spp=1",
            "-q",
            "-MD",
        ]
        self.run_rtslc("render", *small, "-o", "out.png")
        self.run_rtslc(
            "pack", "glass/scene.json", "-q", "-MD", "-o", "out.rtslpkg", "-MF", "package.d"
        )
        for name, target in (("out.d", "out.png"), ("package.d", "out.rtslpkg")):
            lines = (self.folder / name).read_text().split(" \\\n  ")
            self.assertEqual(lines[:2], [f"{target}:", "glass/scene.json"])
            self.assertIn("glass/Glass.rtsl", lines)
            self.assertTrue(any(line.strip().endswith((".obj", ".ply")) for line in lines), lines)

    def test_make_understands_the_dependencies(self):
        self.write("a b#$.rtsl", '#include "lib/shared.rtsl"\n')
        self.run_rtslc("compile", "a b#$.rtsl", "--emit=ast", "-o", "out.ast", "-MD")
        self.write("Makefile", "out.ast: ; @echo again\n-include out.d\n")
        make = lambda: subprocess.run(
            ["make", "-s"], cwd=self.folder, capture_output=True, text=True, check=True
        ).stdout
        self.assertEqual(make(), "")
        shared = self.folder / "lib/shared.rtsl"
        newer = (self.folder / "out.ast").stat().st_mtime + 10
        os.utime(shared, (newer, newer))
        self.assertEqual(make(), "again\n")

    def test_nothing_is_written_after_errors(self):
        self.write("wrong.rtsl", '#include "lib/grey.rtsl"\nfloat f() { return missing; }\n')
        self.run_rtslc("compile", "wrong.rtsl", "--emit=ir", "-o", "out", "-MD", status=DIAGNOSED)
        self.run_rtslc("check", "wrong.rtsl", "-MD", status=DIAGNOSED)
        self.run_rtslc("check", "grey.rtsl", "-MD", "-MF", "nowhere/x.d", status=DIAGNOSED)
        self.assertEqual(
            [name for name in self.files() if name.endswith(".d") or name == "out"], []
        )

    def test_fixes_stay_out_of_included_files(self):
        included = self.write("lib/wrong.rtsl", "float f() { return 1.0 }\n")
        self.write("main.rtsl", '#include "lib/wrong.rtsl"\nfloat g() { return f() }\n')
        self.run_rtslc("check", "--fix", "main.rtsl", status=DIAGNOSED)
        self.assertEqual(included.read_text(), "float f() { return 1.0 }\n")
        self.assertIn("return f(); }", (self.folder / "main.rtsl").read_text())
        self.run_rtslc("check", "--fix", "lib/wrong.rtsl", status=0)
        self.assertEqual(included.read_text(), "float f() { return 1.0; }\n")

    def test_json_names_macros_and_includes(self):
        self.write("main.rtsl", '#include "lib/macros.rtsl"\nfloat g() { return TWICE(1.0); }\n')
        self.write(
            "lib/macros.rtsl", "#define TWICE(x) (x * missing)\nfloat f() { return other; }\n"
        )
        diagnostics = self.diagnose("check", "main.rtsl")
        by_message = {d["message"]: d for d in diagnostics}
        macro = by_message["unknown name `missing`"]
        self.assertEqual(
            (
                macro["range"]["file"],
                macro["range"]["begin"]["line"],
                macro["range"]["begin"]["column"],
            ),
            ("main.rtsl", 2, 20),
        )
        self.assertEqual(
            [
                (l["message"], l["range"]["file"], l["range"]["begin"]["column"])
                for l in macro["labels"]
            ],
            [
                ("in this use of macro `TWICE`", "main.rtsl", 20),
                ("expanded from macro `TWICE`", "lib/macros.rtsl", 23),
            ],
        )
        included = by_message["unknown name `other`"]
        self.assertEqual(included["range"]["file"], "lib/macros.rtsl")
        self.assertEqual(included["notes"], ["included from main.rtsl:1"])

    def test_shaders_of_a_scene(self):
        self.glass_scene()
        (self.folder / "common").mkdir()
        glass = self.folder / "Glass.rtsl"
        text = glass.read_text()
        (self.folder / "sub").mkdir()
        # From the scene's folder, though the shader lies elsewhere, and with what the command line
        # defines.
        (self.folder / "sub" / "Glass.rtsl").write_text(
            '#include "common/one.rtsl"\n#if ONE != 1\n#error no\n#endif\n' + text
        )
        self.write("common/one.rtsl", "#ifndef ONE\n#define ONE 1\n#endif\n")
        scene = json.loads((self.folder / "scene.json").read_text())
        scene["import"] = [
            "sub/Glass.rtsl" if name == "Glass.rtsl" else name for name in scene["import"]
        ]
        self.assertIn("sub/Glass.rtsl", scene["import"])
        self.write("scene.json", json.dumps(scene))
        elsewhere = self.folder / "elsewhere"
        elsewhere.mkdir()
        arguments = [
            "render",
            self.folder / "scene.json",
            "-o",
            "a.png",
            "--size",
            "16x9",
            "--spp",
            "1",
        ]
        self.folder, folder = elsewhere, self.folder
        try:
            self.run_rtslc(*arguments)
            self.assertEqual(
                [d["code"] for d in self.diagnose(*arguments, "-D", "ONE=2")], ["E0149"]
            )
        finally:
            self.folder = folder


if __name__ == "__main__":
    unittest.main()
