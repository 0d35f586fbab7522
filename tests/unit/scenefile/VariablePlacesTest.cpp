//===- VariablePlacesTest.cpp - where variables could set members ---------===//
#include "ErrorText.h"
#include "tests/unit/runtime/FakeProgram.h"

#include "scenefile/SceneFile.h"
#include "scenefile/graph/VariablePlaces.h"

#include <gtest/gtest.h>

using namespace rtsl::scene;
using rtsl::scene::test::errorOf;

namespace {

/// `more` begins in line 3.
SceneDescription parse(const std::string &more) {
  return parseScene("{\"rtsl\": 1, \"camera\": {\"class\": \"Camera\", \"eye\": [0, 0, 5], "
                    "\"gaze\": [0, 0, -1], \"up\": [0, 1, 0]},\n\n" +
                        more + "}",
                    "s.json");
}

const std::string graph =
    R"("materials": {"m": {"class": "M", "texture": "t"}, "other": {"class": "M"}},
"textures": {"t": {"class": "T", "below": ["u", 3]}, "u": {"class": "U"}, "v": {"class": "V"}},
"nodes": {
  "a": {"primitive": {"class": "P"}, "material": "m"},
  "b": {"primitive": {"class": "Q", "constructor": [1]}, "material": {"class": "W"}},
  "pair": {"selector": {"class": "S"}, "children": ["a",
    {"child": "b"}]},
  "row": {"children": ["pair", "pair", "a"], "variables": {"more": {"class": "X"}}},
  "elsewhere": {"child": "row"}
},
"root": "row")";

} // namespace

TEST(VariablePlaces, NodesOnTheWayToTheRoot) {
  const SceneDescription scene = parse(graph);
  VariablePlaces places(scene);
  const auto named = [&](const char *name) { return places.of(*findObject(scene, name)); };
  const std::string fromA = "`a` (line 6), `pair` (line 8), `row` (line 10) or the scene";
  EXPECT_EQ(named("m"), fromA);
  EXPECT_EQ(named("t"), fromA); // by way of the material
  EXPECT_EQ(named("u"), fromA);
  EXPECT_EQ(named("v"), "the scene"); // of which there is no use
  EXPECT_EQ(named("other"), "the scene");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(places.of(*scene.objects[0].primitive), fromA);
  EXPECT_EQ(places.of(*scene.objects[1].primitive), ""); // made by its constructor
  EXPECT_EQ(places.of(*scene.objects[1].material.object),
            "`b` (line 7), a node (line 9), `pair` (line 8), `row` (line 10) or the scene");
  EXPECT_EQ(places.of(*scene.selectors.at(0).object.object),
            "`pair` (line 8), `row` (line 10) or the scene");
  const JsonValue *inVariable = scene.scopes.back()->find("more")->second;
  EXPECT_EQ(places.of(objectInPlace(*inVariable, "x")),
            "`a` (line 6), `b` (line 7), `pair` (line 8), `row` (line 10), a node (line 9) or the "
            "scene");
  EXPECT_EQ(places.of(*scene.camera), "the scene");
}

TEST(VariablePlaces, ElementsOfObjects) {
  const SceneDescription scene = parse(R"("materials": {"m": {"class": "M"}},
"objects": [{"primitive": {"class": "P"}, "material": "m"},
{"name": "ball", "primitive": {"class": "P"}, "material": "m"}])");
  VariablePlaces places(scene);
  EXPECT_EQ(places.of(*findObject(scene, "m")),
            "`objects.0` (line 4), `ball` (line 5) or the scene");
  EXPECT_EQ(places.of(*scene.objects[1].primitive), "`ball` (line 5) or the scene");
}

TEST(VariablePlaces, NoMoreThanSix) {
  std::string objects;
  for (int i = 0; i < 9; ++i)
    objects += std::string(i ? ",\n" : "") + R"({"mesh": "a.ply", "material": "m"})";
  const SceneDescription scene =
      parse(R"("materials": {"m": {"class": "M"}}, "objects": [)" + objects + "]");
  EXPECT_EQ(VariablePlaces(scene).of(*findObject(scene, "m")),
            "`objects.0` (line 3), `objects.1` (line 4), `objects.2` (line 5), `objects.3` (line "
            "6), `objects.4` (line 7), `objects.5` (line 8), 3 more or the scene");
}

TEST(VariablePlaces, AreInMessages) {
  const auto program = rtsl::runtime::test::fakeProgram();
  for (rtsl::runtime::ClassInfo &info : program->classes)
    for (rtsl::runtime::MemberInfo &member : info.members)
      member.isRequired |= info.name == "Everything" && member.name == "i";
  const auto build = [&](const std::string &material, const std::string &variables) {
    return buildScene(
        parse("\"materials\": {\"m\": " + material +
              "},\n\"nodes\": {\"a\": {\"primitive\": {\"class\": \"Sphere\", \"constructor\": "
              "[[0, 0, 0], 1]}, \"material\": \"m\"},\n\"top\": {\"child\": \"a\"" +
              variables + "}}, \"root\": \"top\""),
        program);
  };
  const auto messages = [&](const std::string &variables) {
    return errorOf([&] { build(R"({"class": "Everything", "f": 1})", variables); });
  };
  const std::string ofInt = "member `i` of `m` is read, but not set and without a default";
  EXPECT_NE(messages("").find(ofInt + ": set it, or a variable of this name in `a` (line 4), `top` "
                                      "(line 5) or the scene"),
            std::string::npos)
      << messages("");
  EXPECT_EQ(messages(R"(, "variables": {"i": 3})").find(ofInt), std::string::npos);
}
