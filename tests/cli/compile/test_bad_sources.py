"""Sources that cannot be read, are not RTSL, or are far too large."""

import os
import unittest

from harness import DIAGNOSED, Case, bounded

MATERIAL = "class Grey : rt_Material;\n\nvoid shade() {\n  rt_SampleColor = color(0.5);\n}\n"


class BadSources(Case):
    def test_missing_file(self):
        self.assert_message(self.diagnose("check", "nowhere.rtsl"), "E0100", "No such file")

    def test_folder(self):
        (self.folder / "folder.rtsl").mkdir()
        self.assert_message(self.diagnose("check", "folder.rtsl"), "E0100", "directory")

    def test_unreadable_file(self):
        os.chmod(self.write("secret.rtsl", MATERIAL), 0)
        self.assert_message(
            self.diagnose("check", "secret.rtsl", unprivileged=True), "E0100", "Permission denied"
        )

    def test_empty_file(self):
        self.write("empty.rtsl", "")
        self.assert_message(self.diagnose("check", "empty.rtsl"), "E0102")

    def test_binary_file(self):
        self.write("binary.rtsl", bytes(range(256)) * 64)
        self.assert_message(self.diagnose("check", "binary.rtsl"), "E0101")

    def test_ten_megabytes_of_zeros(self):
        self.write("zeros.rtsl", b"\0" * 10_000_000)
        self.assert_message(self.diagnose("check", "zeros.rtsl"), "E0101")

    def test_ten_megabytes_of_comment(self):
        self.write("long.rtsl", "/*" + "x" * 10_000_000 + "*/\n" + MATERIAL)
        self.run_rtslc("check", "long.rtsl")

    def test_ten_megabytes_of_one_expression(self):
        self.write("wide.rtsl", MATERIAL.replace("0.5", "0.5" + " + 0.1" * 1_400_000))
        _, error = self.run_rtslc("check", "wide.rtsl", status=DIAGNOSED)
        self.assertLess(len(error), 10_000, "the message must not print the line as a whole")

    def test_ten_megabytes_of_code(self):
        statement = "  rt_SampleColor = color(0.5);\n"
        self.write("many.rtsl", MATERIAL.replace(statement, statement * 330_000))
        self.run_rtslc("check", "many.rtsl")

    def test_unterminated_comment(self):
        self.write("comment.rtsl", MATERIAL + "\n  /* no end\n")
        self.assert_message(
            self.diagnose("check", "comment.rtsl"), "E0104", line=7, column=3, file="comment.rtsl"
        )

    def test_two_hundred_thousand_parentheses(self):
        self.write("deep.rtsl", MATERIAL.replace("0.5", "(" * 200_000))
        self.assert_message(self.diagnose("check", "deep.rtsl"), "E0109", "256", line=4)

    def test_many_errors_end_at_the_limit(self):
        self.write(
            "many.rtsl",
            MATERIAL.replace("color(0.5)", "unknown0")
            + "".join(f"void f{i}() {{ unknown{i} = 1; }}\n" for i in range(100)),
        )
        self.assertEqual(len(self.diagnose("check", "many.rtsl")), 20)

    def test_every_form_of_message_names_the_place(self):
        self.write("typo.rtsl", MATERIAL.replace("rt_SampleColor", "rt_SampelColor"))
        _, error = self.run_rtslc("check", "typo.rtsl", status=DIAGNOSED)
        self.assertIn("typo.rtsl:4:3", error)
        self.assertIn("rt_SampleColor", error)
        self.assertIn("^", error)

    def test_errors_leave_the_old_output_alone(self):
        self.write("broken.rtsl", MATERIAL.replace(";\n}", "\n}"))
        self.write("out.mlir", "what was here")
        self.run_rtslc("compile", "broken.rtsl", "--emit=ir", "-o", "out.mlir", status=DIAGNOSED)
        self.assertEqual((self.folder / "out.mlir").read_text(), "what was here")
        self.assertEqual(self.files(), ["broken.rtsl", "out.mlir"])

    def test_output_is_a_folder(self):
        self.write("grey.rtsl", MATERIAL)
        (self.folder / "out").mkdir()
        self.assert_message(
            self.diagnose("compile", "grey.rtsl", "--emit=ir", "-o", "out"), "E0902", "out"
        )

    def test_output_folder_is_missing(self):
        self.write("grey.rtsl", MATERIAL)
        self.assert_message(
            self.diagnose("compile", "grey.rtsl", "--emit=ir", "-o", "nowhere/out"), "E0902"
        )

    def test_full_disk(self):
        self.write("grey.rtsl", MATERIAL)
        self.assert_message(
            self.diagnose("compile", "grey.rtsl", "--emit=ir", "-o", "/dev/full"),
            "E0902",
            "No space",
        )
        with open("/dev/full", "w") as full:
            _, error = self.run_rtslc(
                "compile", "grey.rtsl", "--emit=ir", status=DIAGNOSED, stdout=full
            )
        self.assertIn("No space", error)


class BoundedSources(Case):
    """What is wrong in a large way is refused in little time and memory."""

    def refuse(self, text, code, containing="", **place):
        self.write("bad.rtsl", text)
        messages = self.diagnose("check", "bad.rtsl", prepare=bounded)
        self.assert_message(messages, code, containing, **place)
        return messages[0]

    def test_functions_that_call_each_other(self):
        text = (
            "float f0(float x);\n"
            + "".join(f"float f{i + 1}(float x) {{ return f{i}(x); }}\n" for i in range(3000))
            + "float f0(float x) { return f3000(x); }\n"
        )
        self.write("bad.rtsl", text)
        messages = self.diagnose("check", "bad.rtsl", prepare=bounded)
        self.assertEqual([m["code"] for m in messages], ["E0512"], messages)
        self.assertIn(
            "only `trace` and calls through members may be recursive", messages[0]["notes"][1]
        )

    def test_a_circle_of_classes(self):
        text = "".join(f"class C{i} : C{(i + 1) % 5000} {{ }};\n" for i in range(5000))
        self.refuse(text, "E0400", line=1)

    def test_a_circle_of_imports(self):
        for i in range(300):
            self.write(f"f{i}.rtsl", f'import "f{(i + 1) % 300}.rtsl";\nconst int c{i} = {i};\n')
        self.run_rtslc("check", "f0.rtsl", prepare=bounded)
        self.write("f7.rtsl", 'import "f8.rtsl";\nconst int c7 = nothing;\n')
        self.assert_message(
            self.diagnose("check", "f0.rtsl", prepare=bounded),
            "E0200",
            "nothing",
            line=2,
            file="f7.rtsl",
        )

    def test_labels_that_are_there_already(self):
        labels = "".join(f"  case {i}: break;\n" for i in range(20_000))
        text = "void f(int i) {\n  switch (i) {\n" + labels + "  case 77: break;\n  }\n}\n"
        message = self.refuse(text, "E0506", "case 77", line=20_003)
        self.assertEqual(message["labels"][0]["range"]["begin"]["line"], 80)

    def test_a_local_array_of_four_gigabytes(self):
        self.refuse(
            "void f() {\n  float x[1073741824];\n  x[0] = 1.0;\n}\n", "E0605", "4294967296", line=2
        )
        self.refuse(
            "void f() {\n  float x[8192][16384];\n  x[0][0] = 1.0;\n}\n",
            "E0607",
            "536870912",
            line=2,
        )
        self.refuse(
            "void f() {\n  float x[65536][65536][65536];\n  x[0][0][0] = 1.0;\n}\n", "E0605", line=2
        )

    def test_a_line_of_a_megabyte(self):
        text = "const int a[] = {" + "1, " * 340_000 + "b};\n"
        message = self.refuse(text, "E0200", "`b`", line=1, column=len(text) - 3)
        _, error = self.run_rtslc("check", "bad.rtsl", status=DIAGNOSED)
        self.assertLess(len(error), 2000)
        self.refuse("float f() { return " + "x" * 1_000_000 + "; }\n", "E0200", line=1, column=20)
        self.refuse(
            "float f() { return " + "(" * 500_000 + "1.0" + ")" * 500_000 + "; }\n", "E0109", line=1
        )

    def test_literals_out_of_range(self):
        for literal, code in (
            ("2147483648", "E0601"),
            ("-2147483649", "E0601"),
            ("4294967296u", "E0601"),
            ("0x100000000", "E0601"),
            ("040000000000", "E0601"),
            ("1e39", "E0602"),
            ("1" * 5000, "E0601"),
            ("1e999999999999", "E0602"),
            ("9" * 5000 + ".0", "E0602"),
        ):
            with self.subTest(literal=literal[:20]):
                kind = "float" if code == "E0602" else "uint" if literal.endswith("u") else "int"
                self.refuse(f"const {kind} x = {literal};\n", code, line=1)

    def test_inheritance_ten_thousand_deep(self):
        text = (
            "class C0 : rt_Light { public float power; };\n"
            + "".join(f"class C{i + 1} : C{i} {{ }};\n" for i in range(10_000))
            + (
                "class Last : C10000 {\n  void illumination() { rt_LightColor = color(powr); }\n"
                "};\n"
            )
        )
        self.write("bad.rtsl", text)
        deep, unknown = self.diagnose("check", "bad.rtsl", prepare=bounded)
        self.assert_message([deep], "E0423", "C257", line=258)
        self.assert_message([unknown], "E0200", "powr", line=10_003)
        self.assertEqual(unknown["fixes"][0]["replacement"], "power")


if __name__ == "__main__":
    unittest.main()
