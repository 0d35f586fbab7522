"""Numbers and lists in documents are those of the program."""

import json
import re
import unittest

from harness import EXAMPLES, FINE, USAGE, Case

ROOT = EXAMPLES.parent
FOLDERS = (
    "bench|codegen|docs|examples|frontend|include|language|library|math|runtime|scenefile|scripts"
    "|sema|support|tests|tools"
)


def read(path):
    return (ROOT / path).read_text(encoding="utf-8")


def constant(path, name):
    """The value of `name` in a C++ source: numbers with << and * between them."""
    text = re.search(rf"\b{name}\b *=? *([^;\n]+)", read(path)).group(1).split("//")[0]
    text = re.sub(r"std::size_t\{(\d+)\}", r"\1", text)
    text = re.sub(r"\b(0x[0-9a-f]+|\d+)[uUlL]+\b", r"\1", text).strip()
    assert re.fullmatch(r"(0x[0-9a-f]+|[0-9 *<])+", text), f"{path}: {name} is {text}"
    return eval(text)


def table(page, title):
    """{first cell: second cell} of the first table after `title`."""
    rows = {}
    for line in read(page).split(title, 1)[1].splitlines():
        if line.startswith("|"):
            cells = [cell.strip() for cell in line.split("|")[1:-1]]
            rows[cells[0]] = cells[1]
        elif rows:
            break
    return rows


def row(rows, words):
    found = [value for key, value in rows.items() if words in key]
    assert len(found) == 1, (words, rows)
    return found[0]


class Documents(Case):
    def test_classes_that_models_need(self):
        """include/rtsl/rtsl.h lists the classes of which the readers of models make objects."""
        said = re.search(
            r"They are, of glTF files:(.*?)and of OBJ and PLY files:(.*?)and for images",
            read("include/rtsl/rtsl.h"),
            re.DOTALL,
        )
        for words, folder in zip(said.groups(), ("gltf", "obj")):
            made = set()
            for path in (ROOT / "scenefile" / folder).glob("*.cpp"):
                text = path.read_text(encoding="utf-8")
                made |= set(re.findall(r'"((?:materials|textures|lights|cameras)\.\w+)"', text))
                for name in re.findall(r'materialObject\([^,]+, "(\w+)"', text):
                    made |= {f"materials.{name}", f"materials.VertexColor{name}"}
            if folder == "obj":  # a model without a camera is framed by one, whatever its format
                made.add("cameras.PerspectiveCamera")
            listed = set()
            for line in re.findall(r"(\w+): +([\w ]+)", words):
                listed |= {f"{line[0]}.{name}" for name in line[1].split()}
            self.assertEqual(listed, made, folder)

    def test_limits_of_the_language(self):
        rows = table("docs/language.md", "`limit.all`")
        local = row(rows, "a local variable or parameter")
        self.assertIn(
            f"{constant('sema/typed/TypeProperties.h', 'maxLocalBytes') >> 20} MiB (error)", local
        )
        self.assertIn(
            f"{constant('sema/typed/TypeProperties.h', 'largeLocalBytes') >> 10} KiB (warning)",
            local,
        )
        self.assertEqual(
            str(constant("sema/typed/TypeProperties.h", "maxTypeNesting")),
            row(rows, "structs and arrays"),
        )
        self.assertEqual(
            str(constant("sema/check/Program.h", "maxInheritanceDepth")),
            row(rows, "bases of a class"),
        )
        self.assertEqual(
            str(constant("frontend/syntax/TokenCheck.h", "maxBracketDepth")),
            row(rows, "brackets of any kind"),
        )
        self.assertEqual(
            str(constant("frontend/syntax/TokenCheck.h", "maxNesting")),
            row(rows, "expressions and statements"),
        )
        words = constant("runtime/device/ray/State.h", "RTSL_MAX_ATTRIBUTE_WORDS")
        self.assertEqual(f"{words} words", row(rows, "attributes of a hit"))

    def test_limits_of_the_preprocessor(self):
        rows = table("docs/language.md", "`pre.limits`")
        limit = lambda name: constant("frontend/preprocessor/Preprocessor.h", name)
        self.assertIn(str(limit("maxMacroWords")), row(rows, "macros of one file"))
        self.assertEqual(str(limit("maxConditionWords")), row(rows, "make in one condition"))
        self.assertEqual(str(limit("maxConditionOperators")), row(rows, "parentheses and signs"))
        self.assertEqual(
            f"{limit('maxMacroDepth')}, {limit('maxArgumentDepth')} deep",
            row(rows, "macros in the bodies"),
        )
        self.assertEqual(
            f"{limit('maxIncludeDepth')} deep, {limit('maxIncludes')} for one file, "
            f"{limit('maxIncludedBytes') >> 20} MB for one file",
            row(rows, "files in files"),
        )

    def accepts(self, body):
        self.write("deep.rtsl", "class Deep : rt_Material { void shade() {\n" + body + "\n} };\n")
        return "error[" not in self.run_rtslc("check", "deep.rtsl", status=None)[1]

    def test_what_is_within_the_limits_is_taken_and_what_is_not_is_refused(self):
        nesting = constant("frontend/syntax/TokenCheck.h", "maxNesting")
        brackets = constant("frontend/syntax/TokenCheck.h", "maxBracketDepth")
        chain = lambda count: "float a = 1.0; a = a" + " + a" * count + ";"
        nested = lambda count: "float a = 1.0; a = " + "(" * count + "a" + ")" * count + ";"
        branches = lambda count: "int a = 1; " + "if (a == 0) " * count + "a = 2;"
        for deep, limit in ((chain, nesting), (nested, brackets), (branches, nesting)):
            self.assertTrue(self.accepts(deep(limit - 5)))
            self.assertFalse(self.accepts(deep(limit)))

    def test_packages(self):
        page = read("docs/packages.md")
        self.assertIn(
            f"| version of the format: {constant('runtime/package/FileLayout.h', 'formatVersion')} "
            "|",
            page,
        )
        depth = constant("runtime/render/RenderOptions.h", "maxRayDepth")
        self.assertIn(
            f"| {depth + 1} numbers of 4 bytes: what `rtsl_lane_bytes` says for each depth limit "
            f"from 0 to {depth} |",
            page,
        )

    def test_ranges_are_those_of_the_schema(self):
        render = json.loads(read("docs/scene-schema.json"))["properties"]["render"]["properties"]
        text = " ".join(self.run_rtslc("render", "--help")[0].split())
        scene = EXAMPLES / "glass" / "scene.json"
        for option in ("spp", "depth", "seed"):
            low, high = render[option]["minimum"], render[option]["maximum"]
            self.assertRegex(text, rf"--{option} N [^()]*\({low} to {high}\)")
            self.run_rtslc("render", scene, "-o", "x.exr", f"--{option}", high + 1, status=USAGE)
            self.run_rtslc("check", scene, "--set", f"render.{option}={high}", status=FINE)
            _, error = self.run_rtslc(
                "check", scene, "--set", f"render.{option}={high + 1}", status=None
            )
            self.assertIn(str(high), error)

    def test_exit_statuses(self):
        self.assertIn("2 wrong arguments", read("README.md"))
        scene = EXAMPLES / "glass" / "scene.json"
        for wrong in (
            ["--set", "foo"],
            ["--depth", "-1"],
            ["--depth", "1000"],
            ["--depth", "x"],
            ["--spp", "0"],
        ):
            self.run_rtslc("render", scene, "-o", "x.exr", *wrong, status=USAGE)
        _, error = self.run_rtslc("render", scene, "-o", "a.jpg", status=USAGE)
        self.assertIn("`a.jpg` ends neither in .png nor in .exr", error)
        self.assertEqual(list(self.folder.iterdir()), [])

    def test_stages(self):
        stages = "|".join(self.stages())
        self.assertIn(f"--emit={stages}`", read("docs/how-it-works.md"))

    def test_warnings(self):
        listed, _ = self.run_rtslc("check", "-Whelp")
        ours = re.findall(r"^([a-z-]+) +(W\d+) ", listed, re.M)
        page = re.findall(r"^\| `([a-z-]+)` \| (W\d+) \|", read("docs/warnings.md"), re.M)
        self.assertGreater(len(ours), 10)
        self.assertEqual(ours, page)

    def test_files_that_documents_name_exist(self):
        missing = []
        for page in [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]:
            if (
                page.name == "extending.md"
            ):  # names files that are to be made; tests/extending checks the others
                continue
            text = page.read_text(encoding="utf-8")
            named = [ROOT / name for name in re.findall(rf"`((?:{FOLDERS})/[\w./-]+)`", text)]
            named += [
                page.parent / name for name in re.findall(r"\]\(([\w./-]+)(?:#[\w-]*)?\)", text)
            ]
            missing += [
                f"{page.name}: {path.relative_to(ROOT)}" for path in named if not path.exists()
            ]
        self.assertEqual(missing, [])

    def test_the_scene_of_the_page_is_one(self):
        text = read("docs/scene-format.md").split("```json\n", 1)[1].split("```", 1)[0]
        self.write("page.json", text)
        for name in json.loads(text)["import"] + ["knot.obj"]:
            self.write(name, (EXAMPLES / "glass" / name).read_bytes())
        self.run_rtslc("render", "page.json", "-o", "x.exr", "--size", "16x9", "--spp", "1", "-q")


if __name__ == "__main__":
    unittest.main()
