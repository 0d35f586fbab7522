"""rtslc explain SCENE: what is left out and why; and that --keep changes no picture."""

import json
import os
import pathlib
import re
import shutil
import unittest

from harness import USAGE, Case, example_scenes

SMALL = ("--size", "32x18", "--spp", "2", "-q")

# A scene in which much is left out: a class without objects, a method that nothing runs, results
# that are not read, a scratch member that is not read, a material that reads no normal, a ray type
# that is never sent, no lights, one class everywhere.
SHADERS = """
class Eye : rt_Camera {
  public vec3 position;
  void generateRay() { rt_RayOrigin = position; rt_RayDirection = vec3(rt_ScreenCoord - 0.5, -1.0); }
};
class Ball : rt_Primitive {
  public float radius = 1.0;
  scratch float depth;
  void intersect() {
    vec3 d = rt_RayDirection;
    float b = dot(rt_RayOrigin, d), a = dot(d, d), q = b * b - a * (dot(rt_RayOrigin, rt_RayOrigin) - radius * radius);
    depth = q;
    if (q > 0.0)
      hit((-b - sqrt(q)) / a);
  }
  void computeBounds() { rt_BoundMin = vec3(-radius); rt_BoundMax = vec3(radius); }
  void computeNormal() { rt_GeometricNormal = rt_HitPoint; }
  void computeTextureCoordinates() { rt_TextureUV = rt_HitPoint.xy; rt_TextureUVW = rt_HitPoint; }
};
class Paint : rt_Material {
  public color tint;
  color unusedHelper() { return tint + tint; }
  void shade() {
    rt_SampleColor = tint * rt_TextureUV.x;
    illuminance (rt_HitPoint) { rt_SampleColor += rt_LightColor; }
  }
};
class Unlit : rt_Material {
  public color tint;
  void shade() { rt_SampleColor = tint * rt_TextureUV.x; }
};
class Lamp : rt_Light {
  public vec3 position;
  void illumination() {
    rt_LightDirection = position - rt_HitPoint;
    rt_LightDistance = 1.0;
    rt_LightColor = color(1.0);
  }
};
struct Probe { float distance; };
class Answering : Unlit {
  void closestHit(inout Probe probe) { probe.distance = rt_HitDistance; }
};
"""
SCENE = {
    "rtsl": 1,
    "import": ["all.rtsl"],
    "camera": {"class": "Eye", "position": [0, 0, 4]},
    "materials": {"red": {"class": "Answering", "tint": [1, 0.2, 0.1]}},
    "objects": [{"primitive": {"class": "Ball"}, "material": "red"}],
    "render": {"size": [16, 16], "spp": 2},
}


class Explain(Case):
    level = "-O0"

    def write_scene(self, **changes):
        self.write("all.rtsl", SHADERS)
        self.write("scene.json", json.dumps({**SCENE, **changes}, indent=1))

    def entries(self, *arguments, savings=False):
        """{item: {subject: (needed, reason, line)}} of the scene. With savings it is compiled once
        more for each item."""
        others = () if savings else ("--no-savings",)
        out, _ = self.run_rtslc("explain", "scene.json", "--json", *others, *arguments)
        self.document = json.loads(out)
        return {
            item["item"]: {
                e["subject"]: (e["needed"], e["reason"], e.get("place", {}).get("line"))
                for e in item["entries"]
            }
            for item in self.document["items"]
        }

    def line(self, text):
        return 1 + next(i for i, line in enumerate(SHADERS.split("\n")) if text in line)

    def test_each_item_says_what_is_needed_and_by_which_line(self):
        self.write_scene()
        items = self.entries(savings=True)
        needed = {
            (item, subject)
            for item, entries in items.items()
            for subject, entry in entries.items()
            if entry[0]
        }
        left_out = {
            (item, subject)
            for item, entries in items.items()
            for subject, entry in entries.items()
            if not entry[0]
        }
        for one in (
            ("classes", "Ball"),
            ("methods", "Ball.intersect"),
            ("states", "Answering.shade"),
            ("methods", "Ball.computeTextureCoordinates"),
            ("outputs", "computeTextureCoordinates"),
        ):
            self.assertIn(one, needed)
        for one in (
            ("classes", "Paint"),
            ("methods", "Ball.computeNormal"),
            ("states", "Answering.closestHit(Probe)"),
            ("outputs", "computeNormal"),
            ("outputs", "computeDerivatives"),
            ("attributes", "depth"),
            ("outputs", "rt_TextureUVW of Ball.computeTextureCoordinates"),
            ("parameters", "Ball.radius"),
            ("dispatch", "rt_Primitive.intersect"),
            ("lights", "illuminance"),
            ("events", "print"),
            ("events", "exceptions"),
        ):
            self.assertIn(one, left_out)
        self.assertEqual(
            items["methods"]["Ball.computeTextureCoordinates"][1:],
            (
                "read by `Answering.shade`",
                self.line("void shade() { rt_SampleColor = tint * rt_TextureUV.x; }"),
            ),
        )
        self.assertEqual(items["classes"]["Paint"][2], self.line("class Paint"))
        self.assertIn("(0, 0, 4)", items["parameters"]["Eye.position"][1])
        saved = {item["item"]: item["saved"] for item in self.document["items"]}
        self.assertGreater(saved["parameters"]["instructions"], 0)
        self.assertGreater(saved["dispatch"]["instructions"], 0)
        self.assertEqual(saved["meshes"]["memoryBytes"], 0)

    def test_what_only_code_reads_that_never_runs(self):
        """A member is left out if the number of another member shows that nothing reads it."""
        self.write(
            "more.rtsl",
            """
            class Layered : rt_Material {
              public float detail = 0.0;
              public float depth = 1.0;
              public float tone = 0.5;
              float deeper(float d) { return d > 0.0 ? depth * d : 1.0; }
              void shade() { rt_SampleColor = color(tone * deeper(detail)); }
            };
            """,
        )
        ball = SCENE["objects"][0]["primitive"]
        for detail, isNeeded in ((0, False), (0.5, True)):
            self.write_scene(
                **{"import": ["all.rtsl", "more.rtsl"]},
                objects=[
                    {
                        "primitive": ball,
                        "material": {"class": "Layered", "detail": detail, "depth": n, "tone": n},
                    }
                    for n in (1, 2)
                ],
                materials={},
            )
            parameters = self.entries("--no-savings")["parameters"]
            self.assertTrue(parameters["Layered.tone"][0])
            self.assertEqual(parameters["Layered.depth"][0], isNeeded, parameters)

    def test_functions_have_the_names_of_the_source(self):
        """Overloads by their parameters, definitions of base classes by these."""
        self.write(
            "more.rtsl",
            """
            class Twice : Unlit {
              color tone(float x) { return x * tint; }
              color tone(vec2 x, int n) { return tone(x[n & 1]); }
              void shade() { rt_SampleColor = tone(rt_TextureUV, rt_Depth); Unlit::shade(); }
            };
            """,
        )
        self.write_scene(
            **{"import": ["all.rtsl", "more.rtsl"]},
            materials={"red": {"class": "Twice", "tint": [1, 0.2, 0.1]}},
        )
        methods = self.entries()["methods"]
        self.assertEqual(methods["Twice.tone(vec2, int)"][:2], (True, "called by `Twice.shade`"))
        self.assertEqual(
            methods["Twice.tone(float)"][:2], (True, "called by `Twice.tone(vec2, int)`")
        )
        self.assertEqual(methods["Twice.Unlit::shade"][:2], (True, "called by `Twice.shade`"))

    def test_what_a_scene_adds_is_needed(self):
        self.write_scene(materials={"red": {"class": "Paint", "tint": [1, 0.2, 0.1]}})
        items = self.entries()
        self.assertEqual(
            items["lights"]["illuminance"][:2],
            (False, "the scene has no lights: the loop is removed"),
        )
        self.assertTrue(items["outputs"]["computeNormal"][0])  # a shadow ray would leave the hit
        self.assertFalse(items["methods"]["Paint.unusedHelper"][0])

    def test_meshes_lose_what_no_material_reads(self):
        self.write(
            "triangle.obj",
            "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nvn 0 0 1\nf 1/1/1 2/2/1 3/3/1\n",
        )
        self.write_scene(objects=[{"mesh": "triangle.obj", "material": "red"}])
        meshes = self.entries(savings=True)["meshes"]
        self.assertEqual(
            [
                meshes[name][0]
                for name in ("normals of triangle.obj", "texture coordinates of triangle.obj")
            ],
            [False, True],
        )
        saved = {item["item"]: item["saved"] for item in self.document["items"]}
        self.assertEqual(saved["meshes"]["memoryBytes"], 3 * 3 * 4)
        self.assertEqual(saved["mesh-attributes"]["memoryBytes"], 0)

    def test_text_names_every_left_out_thing_with_its_line(self):
        self.write_scene()
        text, _ = self.run_rtslc("explain", "scene.json")
        self.assertRegex(text, r"left out +Paint +all\.rtsl:\d+ +it has no objects")
        self.assertRegex(
            text,
            r"needed +Ball\.computeTextureCoordinates +all\.rtsl:\d+ +read by `Answering\.shade`",
        )
        kept, _ = self.run_rtslc("explain", "scene.json", "--keep=dispatch,meshes")
        self.assertRegex(kept, r"Choices between classes +\S+ +\S+ +kept")

    def test_measure_renders_each_item_in_pairs(self):
        self.write_scene()
        self.entries("--measure", "--size", "16x9", "--pairs", "10")
        measured = {one["kept"]: one for one in self.document["measurements"]}
        self.assertLessEqual({"classes", "dispatch", "outputs", "parameters", "all"}, set(measured))
        for name, one in measured.items():
            self.assertTrue(one["sameImage"], name)
            self.assertEqual(one["pairs"], 10)
            self.assertGreater(one["seconds"], 0)
            self.assertLessEqual(one["slower"]["low"], one["slower"]["median"])
            self.assertLessEqual(one["slower"]["median"], one["slower"]["high"])

    def test_keeping_changes_no_picture(self):
        # The second scene's material reads no normal, and sends shadow rays, for which the runtime
        # does.
        self.write_scene(
            materials={"red": {"class": "Paint", "tint": [1, 0.2, 0.1]}},
            lights=[{"class": "Lamp", "position": [3, 1, 2]}],
        )
        (self.folder / "scene.json").rename(self.folder / "lit.json")
        self.write_scene()
        # Code is kept or left out before traces are compiled, and before machine code is optimised:
        # the examples have one kind of trace each, in turn, without optimisation.
        traces = ("recurse", "split")
        rows = [
            (self.folder / scene, f"--trace={trace}", "-O2")
            for scene in ("scene.json", "lit.json")
            for trace in traces
        ]
        rows += [
            (scene, f"--trace={traces[number % 2]}")
            for number, scene in enumerate(example_scenes(part=1, parts=6))
        ]
        for scene, *options in rows:
            for picture, kept in (("a.exr", []), ("b.exr", ["--keep=all"])):
                self.run_rtslc("render", scene, "-o", picture, *SMALL, *options, *kept)
            self.assert_same_bits("a.exr", "b.exr", f"{scene} {options}")

    def test_methods_that_are_left_out_draw_no_numbers_of_others(self):
        """A primitive draws numbers for coordinates, which one of the materials reads."""
        shaders = (
            "class Eye : rt_Camera { void generateRay() { rt_RayOrigin = vec3(0.0, 0.0, 2.0);"
            " rt_RayDirection = vec3(rt_ScreenCoord - vec2(0.5), -1.0); } };\n"
            "class Dust : rt_Primitive { void intersect() { hit(2.0 + rand()); }\n"
            "void computeBounds() { rt_BoundMin = vec3(-4.0); rt_BoundMax = vec3(4.0); }\n"
            "void computeNormal() { rt_GeometricNormal = vec3(rand(), rand(), 1.0); }\n"
            "void computeTextureCoordinates() { rt_TextureUV = vec2(rand(), rand()); } };\n"
            "class Plain : rt_Material { void shade() { rt_SampleColor = color(rand()); } };\n"
            "class Reads : rt_Material { void shade() { rt_SampleColor = color(rand()); vec3 n ="
            " rt_ShadingNormal; if (rt_TextureUV.x + n.x < 0.0) rt_SampleColor = color(9.0); } };\n"
        )
        self.write("dust.rtsl", shaders)
        for material in ("Plain", "Reads"):
            scene = {
                "rtsl": 1,
                "import": ["dust.rtsl"],
                "camera": {"class": "Eye"},
                "materials": {"dust": {"class": material}},
                "objects": [{"primitive": {"class": "Dust"}, "material": "dust"}],
                "render": {"size": [16, 12], "spp": 2},
            }
            self.write("dust.json", json.dumps(scene))
            for kept in ([], ["--keep=methods"]):
                picture = f"{material}{len(kept)}.exr"
                self.run_rtslc("render", "dust.json", "-o", picture, "-q", *kept)
                self.assert_same_bits("Plain0.exr", picture, (material, kept))

    def test_a_package_that_keeps_everything_renders_the_same(self):
        self.write_scene()
        pictures = []
        for kept in ([], ["--keep=all"]):
            self.run_rtslc("pack", "scene.json", "-o", "x.rtslpkg", "-q", *kept)
            self.run_package("x.rtslpkg", "-o", "x.exr", "--target=host")
            pictures.append((self.folder / "x.exr").read_bytes())
        self.assertEqual(*pictures)

    def ptx(self, *arguments):
        return self.run_rtslc("compile", "scene.json", "--emit=ptx", *arguments)[0]

    UNUSED = {
        "blue": {"class": "Paint", "tint": [0, 0, 1]},
        "green": {"class": "Answering", "tint": [0, 1, 0]},
    }

    def test_objects_that_nothing_refers_to_leave_the_program_as_it_is(self):
        self.write_scene()
        without = self.ptx()
        self.write_scene(materials={**SCENE["materials"], **self.UNUSED})
        self.assertEqual(self.ptx(), without)
        self.assertGreater(len(self.ptx("--keep=objects")), len(without) + 500)
        items = self.entries(savings=True)
        self.assertEqual(
            items["objects"]["material blue"][:2], (False, "nothing that is used refers to it")
        )
        self.assertEqual(items["objects"]["material red"][:2], (True, "referred to by objects.0"))
        self.assertEqual(items["classes"]["Paint"][:2], (False, "nothing refers to its objects"))
        self.assertTrue(items["classes"]["Answering"][0])
        self.assertIn(
            "in the code", items["parameters"]["Answering.tint"][1]
        )  # a green one that nothing has does not differ
        saved = {item["item"]: item["saved"] for item in self.document["items"]}
        self.assertGreater(saved["objects"]["instructions"], 10)

    def change_methods(self, items):
        """Empties the void methods that are left out, where no class needs one of that name. How
        many there were."""
        needed = {
            subject.split(".")[-1]
            for item in ("methods", "states")
            for subject, entry in items[item].items()
            if entry[0]
        }
        changed = 0
        for item in self.document["items"]:
            for entry in item["entries"] if item["item"] in ("methods", "states") else []:
                if (
                    entry["needed"]
                    or entry["subject"].split(".")[-1] in needed
                    or "built" in entry["reason"]
                    or "place" not in entry
                ):
                    continue
                path = self.folder / entry["place"]["file"]
                if (
                    self.folder not in path.parents
                ):  # a file of the library, which all programs share
                    continue
                lines = path.read_text().split("\n")
                start = sum(len(line) + 1 for line in lines[: entry["place"]["line"] - 1])
                text = "\n".join(lines)
                if "void " not in lines[entry["place"]["line"] - 1]:
                    continue
                begin = text.index("{", start)
                depth, end = 1, begin + 1
                while depth > 0:
                    depth += {"{": 1, "}": -1}.get(text[end], 0)
                    end += 1
                # Lines stay where they are, and so do the places of everything else.
                path.write_text(
                    text[: begin + 1] + "\n" * text.count("\n", begin, end) + text[end - 1 :]
                )
                changed += 1
        return changed

    def test_what_is_left_out_can_change_without_changing_the_program(self):
        changed = 0
        for example in example_scenes(part=3):
            for old in self.folder.iterdir():
                shutil.rmtree(old) if old.is_dir() else old.unlink()
            shutil.copytree(example.parent, self.folder, dirs_exist_ok=True)
            text = example.read_text()
            for other in set(
                re.findall(r'"(\.\./[^"]+)"', text)
            ):  # shaders and meshes of other examples
                shutil.copy(example.parent / other, self.folder)
                text = text.replace(f'"{other}"', f'"{pathlib.Path(other).name}"')
            self.write("scene.json", text)
            items = self.entries("--no-savings")
            before = self.ptx(
                "-O0"
            )  # programs that are equal before they are optimised are equal afterwards
            here = self.change_methods(items)
            scene = json.loads((self.folder / "scene.json").read_text())
            for kind in ("textures", "materials"):  # numbers of objects that nothing refers to
                for name, description in scene.get(kind, {}).items():
                    if not items["objects"][f"{kind[:-1]} {name}"][0]:
                        description.update(
                            {
                                key: value * 1.5
                                for key, value in description.items()
                                if isinstance(value, float)
                            }
                        )
            (self.folder / "scene.json").write_text(json.dumps(scene))
            self.assertEqual(self.ptx("-O0"), before, example)
            changed += here
        self.assertGreater(changed, 0)

    def test_lights_are_used_where_a_shader_looks_for_them(self):
        lights = [{"class": "Lamp", "position": [3, 1, 2]}]
        self.write_scene(lights=lights)
        lit = self.entries("--no-savings")
        self.assertEqual(lit["objects"]["lights.0 (Lamp)"][:2], (False, "no `illuminance` runs"))
        self.assertFalse(lit["classes"]["Lamp"][0])
        self.write_scene(
            lights=lights, materials={"red": {"class": "Paint", "tint": [1, 0.2, 0.1]}}
        )
        lit = self.entries("--no-savings")
        self.assertTrue(lit["objects"]["lights.0 (Lamp)"][0])
        self.assertTrue(lit["classes"]["Lamp"][0])

    def test_what_is_referred_to_through_others_is_used(self):
        self.write(
            "all.rtsl",
            SHADERS
            + """
class Plain : rt_Texture { public color value; void lookup() { rt_TextureColor = value; } };
class Twice : rt_Texture { public rt_Texture inner; void lookup() { rt_TextureColor = 2.0 * inner.lookup(); } };
class Papered : rt_Material { public rt_Texture paper; void shade() { rt_SampleColor = paper.lookup(); } };
""",
        )
        scene = {
            **SCENE,
            "textures": {
                "a": {"class": "Plain", "value": [1, 2, 3]},
                "b": {"class": "Twice", "inner": "a"},
                "c": {"class": "Twice", "inner": "b"},
                "d": {"class": "Plain", "value": [3, 2, 1]},
            },
            "materials": {
                "red": {"class": "Papered", "paper": "b"},
                "rest": {"class": "Papered", "paper": "c"},
            },
        }
        self.write("scene.json", json.dumps(scene))
        objects = self.entries("--no-savings")["objects"]
        self.assertEqual(
            {name: entry[0] for name, entry in objects.items()},
            {
                "texture a": True,
                "texture b": True,
                "texture c": False,
                "texture d": False,
                "material red": True,
                "material rest": False,
            },
        )
        self.assertEqual(objects["texture a"][1], "referred to by texture b")

    def test_what_members_refer_to_decides_what_is_called(self):
        self.write(
            "all.rtsl",
            SHADERS
            + """
class Layer : rt_Material { color at() { return color(0.5); } void shade() { rt_SampleColor = at(); } };
class Red : Layer { color at() { return color(0.5, 0.0, 0.0); } };
class Coat : Layer { public Layer inner; color at() { return 0.5 * inner.at(); } };
""",
        )
        inner = {"class": "Coat", "inner": {"class": "Red"}}
        self.write("scene.json", json.dumps({**SCENE, "materials": {"red": inner}}))
        entries = self.entries()
        self.assertEqual(entries["states"]["Coat.shade"][0], True)
        self.assertEqual(
            entries["states"]["Red.shade"][:2], (False, "no surface has this material")
        )
        self.assertEqual(
            entries["dispatch"]["Layer.at"][:2], (False, "always `Red`, called directly")
        )

        inner["inner"] = {"class": "Coat", "inner": {"class": "Layer"}}
        scene = {**SCENE, "materials": {"red": inner, "blue": {"class": "Red"}}}
        first, *rest = SCENE["objects"]
        scene["objects"] = [{**first, "material": "red"}, {**first, "material": "blue"}, *rest]
        self.write("scene.json", json.dumps(scene))
        entries = self.entries()
        self.assertEqual(entries["states"]["Red.shade"][0], True)
        self.assertEqual(entries["dispatch"]["Layer.at"][:2], (True, "one of `Layer`, `Coat`"))

    def test_what_is_left_out_is_checked_all_the_same(self):
        self.write_scene(
            materials={**SCENE["materials"], "blue": {"class": "Paint", "tnt": [0, 0, 1]}}
        )
        for command in (
            ("render", "scene.json", "-o", "a.exr"),
            ("compile", "scene.json", "--emit=ptx"),
            ("pack", "scene.json", "-o", "x.rtslpkg"),
        ):
            _, error = self.run_rtslc(*command, status=1)
            self.assertIn("class `Paint` has no member `tnt`", error)

    def test_unused_objects_change_no_picture(self):
        pictures = []
        for materials in (SCENE["materials"], {**SCENE["materials"], **self.UNUSED}):
            self.write_scene(materials=materials)
            for arguments in (
                ("--trace=recurse",),
                ("--trace=split",),
                ("--traversal=device",),
                ("--target=host-megakernel",),
                ("--keep=objects",),
            ):
                self.run_rtslc("render", "scene.json", "-o", "a.exr", *SMALL, *arguments)
                pictures.append((self.folder / "a.exr").read_bytes())
        self.assertEqual(len(set(pictures)), 1)

    def test_index_checks_are_needed_where_they_change_the_program(self):
        def shade(index):
            return SHADERS.replace(
                "void shade() { rt_SampleColor = tint * rt_TextureUV.x; }",
                "void shade() { float a[4] = float[4](1.0, 2.0, 3.0, 4.0); rt_SampleColor = tint * "
                "a[%s]; }" % index,
            )

        for index, isNeeded in (
            ("2", False),
            ("int(rt_HitDistance) & 3", False),
            ("int(rt_HitDistance)", True),
        ):
            self.write_scene()
            self.write("all.rtsl", shade(index))
            self.assertEqual(self.ptx() != self.ptx("--unchecked"), isNeeded, index)
            # Whether it is possible to tell that an index is in range depends on the level.
            entries = self.entries("--no-savings", "-O2")
            self.assertEqual(entries["events"]["index checks"][0], isNeeded, index)

    def test_prints_are_needed_where_a_shader_that_runs_prints(self):
        self.write_scene()
        self.write(
            "all.rtsl",
            SHADERS.replace(
                "illuminance (rt_HitPoint)", 'print("paint"); illuminance (rt_HitPoint)'
            ),
        )
        self.assertEqual(
            self.entries("--no-savings")["events"]["print"][:2], (False, "no `print` runs")
        )

    def test_ptx_of_a_scene_is_bound_to_it(self):
        self.write_scene()
        bound, _ = self.run_rtslc("compile", "scene.json", "--emit=ssa")
        self.assertRegex(bound, r"@radius : f32 .*rtsl\.bound")
        kept, _ = self.run_rtslc("compile", "scene.json", "--emit=ssa", "--keep=parameters")
        self.assertNotIn("rtsl.bound", kept)

    def test_picture_without_graphviz(self):
        self.write_scene()
        with_dot, _ = self.run_rtslc("explain", "--states", "--format=svg", "all.rtsl")
        self.assertTrue(with_dot.startswith("<svg"), with_dot[:200])

        def without_programs():
            os.environ["PATH"] = str(self.folder)

        (message,) = self.diagnose(
            "explain",
            "--states",
            "--format=svg",
            "all.rtsl",
            "-o",
            "states.svg",
            prepare=without_programs,
        )
        self.assert_message([message], "E0900", "cannot find `dot` of Graphviz")
        self.assertIn("--format=dot", str(message["notes"]))
        self.assertFalse((self.folder / "states.svg").exists())

        self.write("dot", "#!/bin/sh\necho 'syntax error in line 1' >&2\nexit 3\n")
        (self.folder / "dot").chmod(0o755)
        (message,) = self.diagnose(
            "explain", "--states", "--format=svg", "all.rtsl", prepare=without_programs
        )
        self.assert_message([message], "E0901", "failed: syntax error in line 1")

    def test_without_savings(self):
        self.write_scene()
        whole = self.entries(savings=True)
        self.assertTrue(all("saved" in item for item in self.document["items"]))
        self.assertEqual(self.entries(), whole)
        self.assertFalse(any("saved" in item for item in self.document["items"]))
        text, _ = self.run_rtslc("explain", "scene.json", "--no-savings")
        self.assertIn("What its program needs:\n", text)
        self.assertNotIn("savings", text)
        self.assertIn("needed    Answering", text)

    def test_usage(self):
        self.write_scene()
        for arguments, text in (
            (("explain", "all.rtsl"), "give a scene, or --states"),
            (("explain", "scene.json", "--measure", "--pairs=9"), "--pairs"),
            (
                ("explain", "scene.json", "--measure", "--states"),
                "cannot be combined with --states",
            ),
            (
                ("explain", "scene.json", "--no-savings", "--states"),
                "cannot be combined with --states",
            ),
            (("explain", "scene.json", "--format=svg"), "only --states has pictures"),
            (
                ("render", "scene.json", "-o", "a.exr", "--keep=everything"),
                "`everything` is none of all|objects|classes",
            ),
            (("compile", "all.rtsl", "--emit=ir", "--keep=all"), "a file alone keeps everything"),
        ):
            with self.subTest(arguments):
                _, error = self.run_rtslc(*arguments, status=USAGE)
                self.assertIn(text, error)


if __name__ == "__main__":
    unittest.main()
