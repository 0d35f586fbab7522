"""rtslc compile --emit=reflection: it fits its schema, and is correct."""

import json
import unittest

from harness import DIAGNOSED, EXAMPLES, USAGE, Case

SCHEMA = json.loads((EXAMPLES.parent / "docs/reflection-schema.json").read_text())
KINDS = {"object": dict, "array": list, "string": str, "integer": int, "boolean": bool}


def complaints(value, schema, where="$"):
    """What does not fit, for the part of JSON Schema that the schema uses."""
    if "$ref" in schema:
        schema = SCHEMA["$defs"][schema["$ref"].split("/")[-1]]
    if "const" in schema and value != schema["const"]:
        yield f"{where} is {value!r}"
    if "enum" in schema and value not in schema["enum"]:
        yield f"{where} is {value!r}"
    if "type" in schema and (
        not isinstance(value, KINDS[schema["type"]])
        or schema["type"] == "integer"
        and value is True
    ):
        yield f"{where} is no {schema['type']}"
        return
    if value < schema["minimum"] if "minimum" in schema else False:
        yield f"{where} is {value!r}"
    if isinstance(value, dict):
        for name in schema.get("required", []):
            if name not in value:
                yield f"{where} misses {name}"
        for name, part in value.items():
            if name in schema.get("properties", {}):
                yield from complaints(part, schema["properties"][name], f"{where}.{name}")
            elif isinstance(schema.get("additionalProperties"), dict):
                yield from complaints(part, schema["additionalProperties"], f"{where}.{name}")
            elif schema.get("additionalProperties") is False:
                yield f"{where} has {name}"
    if isinstance(value, list) and "items" in schema:
        for i, part in enumerate(value):
            yield from complaints(part, schema["items"], f"{where}[{i}]")


class Reflection(Case):
    def reflect(self, *files):
        text, _ = self.run_rtslc("compile", *files, "--emit=reflection")
        value = json.loads(text)
        self.assertEqual(list(complaints(value, SCHEMA)), [])
        return value

    def test_the_validator_knows_what_the_schema_uses(self):
        known = {
            "$schema",
            "$ref",
            "$defs",
            "title",
            "description",
            "type",
            "properties",
            "required",
            "additionalProperties",
            "items",
            "enum",
            "const",
            "minimum",
        }

        def keywords(schema):
            yield from schema
            for named in ("properties", "$defs"):
                for part in schema.get(named, {}).values():
                    yield from keywords(part)
            for single in ("items", "additionalProperties"):
                if isinstance(schema.get(single), dict):
                    yield from keywords(schema[single])

        self.assertEqual(set(keywords(SCHEMA)) - known, set())

    def test_every_example(self):
        folders = {file.parent for file in EXAMPLES.rglob("*.rtsl")} | {
            EXAMPLES.parent / "tests/cpp/scenes"
        }
        self.assertGreater(len(folders), 2)
        for folder in sorted(folders):
            for file in sorted(folder.glob("*.rtsl")):
                value = self.reflect(file)
                try:
                    import jsonschema
                except ImportError:
                    continue
                jsonschema.Draft202012Validator(SCHEMA).validate(value)

    def test_names_that_cpp_has_taken(self):
        value = self.reflect(EXAMPLES.parent / "tests/cpp/scenes/Names.rtsl")
        names = {one["name"]: one["cpp"] for one in value["cppNames"]}
        for name, cpp in (
            ("shade", "shade_"),
            ("State", "State_"),
            ("State.template", "template_"),
            ("State.new.delete", "delete_"),
            ("lookup", "lookup_"),
            ("fields", "fields_"),
            ("Follow.union", "union_"),
            ("State.NULL", "NULL_"),
        ):
            self.assertEqual(names.get(name), cpp, names)

    def test_the_validator_complains(self):
        value = self.reflect(EXAMPLES / "glass/Sphere.rtsl")
        value["classes"][0]["members"][0]["access"] = "protected"
        del value["structs"]
        self.assertEqual(len(list(complaints(value, SCHEMA))), 2)

    def test_the_glass_example(self):
        value = self.reflect(*sorted((EXAMPLES / "glass").glob("*.rtsl")))
        classes = {one["name"]: one for one in value["classes"]}
        sphere = {one["name"]: one for one in classes["Sphere"]["members"]}
        self.assertEqual(classes["Sphere"]["recordSize"], 20)
        self.assertEqual((sphere["center"]["offset"], sphere["center"]["type"]), (4, "vec3"))
        self.assertEqual((sphere["radius"]["offset"], sphere["radius"]["default"]), (16, 1.0))
        self.assertEqual(
            [one["name"] for one in classes["Glass"]["constructor"]["parameters"]],
            ["index", "surroundings", "tint"],
        )
        shade = classes["Glass"]["methods"][0]
        self.assertTrue(shade["traces"] and shade["random"])
        self.assertIn("rt_ShadingNormal", shade["stateRead"])
        self.assertNotIn("rt_SampleColor", shade["stateRead"])
        self.assertEqual(shade["stateWritten"], ["rt_SampleColor"])
        self.assertTrue(classes["Glass"]["comment"].startswith("A smooth dielectric"))
        self.assertGreater(value["tracing"]["frameSize"], 0)

    def test_inheritance_structs_and_renamed_names(self):
        shader = self.write(
            "a.rtsl",
            """
            // What a surface is like.
            struct Surface { float template; vec3 colors[2]; bool rough; };
            class Base : rt_Texture { public Surface surface; public int count = 3; void lookup() { rt_TextureColor = color(surface.template); } };
            class Derived : Base { private float other; };
            """,
        )
        value = self.reflect(shader)
        surface = value["structs"][0]
        self.assertEqual(
            (surface["size"], [one["offset"] for one in surface["fields"]]), (32, [0, 4, 28])
        )
        self.assertEqual(surface["comment"], "What a surface is like.")
        derived = value["classes"][1]
        self.assertEqual(
            [(one["name"], one["declaredIn"], one["offset"]) for one in derived["members"]],
            [("surface", "Base", 4), ("count", "Base", 36), ("other", "Derived", 40)],
        )
        self.assertEqual(value["cppNames"], [{"name": "Surface.template", "cpp": "template_"}])

    def test_bad_input(self):
        self.run_rtslc(
            "compile", self.write("a.rtsl", "float f() {"), "--emit=reflection", status=DIAGNOSED
        )
        self.run_rtslc("compile", EXAMPLES / "glass/scene.json", "--emit=reflection", status=USAGE)


if __name__ == "__main__":
    unittest.main()
