"""Sources that cannot be read, are not RTSL, or are far too large."""

import os
import unittest

from harness import DIAGNOSED, Case

MATERIAL = "class Grey : rt_Material;\n\nvoid shade() {\n  rt_SampleColor = color(0.5);\n}\n"


class BadSources(Case):
    def test_missing_file(self):
        self.assert_message(self.diagnose("check", "nowhere.rtsl"), "E0100", "No such file")

    def test_folder(self):
        (self.folder / "folder.rtsl").mkdir()
        self.assert_message(self.diagnose("check", "folder.rtsl"), "E0100", "directory")

    def test_unreadable_file(self):
        os.chmod(self.write("secret.rtsl", MATERIAL), 0)
        self.assert_message(self.diagnose("check", "secret.rtsl", unprivileged=True), "E0100", "Permission denied")

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
        self.assert_message(self.diagnose("check", "comment.rtsl"), "E0104", line=7, column=3, file="comment.rtsl")

    def test_two_hundred_thousand_parentheses(self):
        self.write("deep.rtsl", MATERIAL.replace("0.5", "(" * 200_000))
        self.assert_message(self.diagnose("check", "deep.rtsl"), "E0109", "256", line=4)

    def test_many_errors_end_at_the_limit(self):
        self.write("many.rtsl", MATERIAL.replace("color(0.5)", "unknown0") +
                   "".join(f"void f{i}() {{ unknown{i} = 1; }}\n" for i in range(100)))
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
        self.assert_message(self.diagnose("compile", "grey.rtsl", "--emit=ir", "-o", "out"), "E0902", "out")

    def test_output_folder_is_missing(self):
        self.write("grey.rtsl", MATERIAL)
        self.assert_message(self.diagnose("compile", "grey.rtsl", "--emit=ir", "-o", "nowhere/out"), "E0902")

    def test_full_disk(self):
        self.write("grey.rtsl", MATERIAL)
        self.assert_message(self.diagnose("compile", "grey.rtsl", "--emit=ir", "-o", "/dev/full"), "E0902", "No space")
        with open("/dev/full", "w") as full:
            _, error = self.run_rtslc("compile", "grey.rtsl", "--emit=ir", status=DIAGNOSED, stdout=full)
        self.assertIn("No space", error)


if __name__ == "__main__":
    unittest.main()
