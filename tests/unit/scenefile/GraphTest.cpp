#include "ErrorText.h"

#include "scenefile/SceneFile.h"

#include <gtest/gtest.h>

using namespace rtsl::scene;
using rtsl::runtime::Placement;
using rtsl::scene::test::errorOf;

namespace {

SceneDescription parse(const std::string &more) {
  return parseScene("{\"rtsl\": 1, \"camera\": {\"class\": \"Camera\"},\n" + more + "}", "s.json");
}

std::string parseError(const std::string &more) {
  return errorOf([&] { parse(more); });
}

/// "x y z" of a translation.
std::string position(const Placement &placement) {
  std::string text;
  for (double x : placement.transform.still().columns[3])
    text += (text.empty() ? "" : " ") + std::to_string(int(x));
  return text;
}

const std::string leaf = R"("a": {"mesh": "a.ply", "material": "m"})";

} // namespace

TEST(SceneGraph, GivesAnInstanceForEachWayDown) {
  const SceneDescription scene = parse(R"("objects": [{"mesh": "o.ply", "material": "m"}],
"nodes": {
  "field": {"children": ["pair", {"child": "pair", "transform": {"scale": 2, "translate": [0, 0, 10]}},
                         {"primitive": {"class": "S"}, "material": "m", "mask": 4}]},
  "pair": {"children": ["a", {"child": "a", "transform": {"translate": [3, 0, 0]}}], "transform": {"translate": [0, 5, 0]}},
  )" + leaf + R"(},
"root": "field")");
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.roots, std::vector<std::string>{"root"});
  ASSERT_EQ(scene.objects[0].placements.size(), 1u);
  EXPECT_TRUE(scene.objects[0].placements[0].transform.still().isIdentity());
  EXPECT_EQ(scene.objects[1].name.text, "a");
  std::vector<std::string> positions;
  for (const Placement &placement : scene.objects[1].placements)
    positions.push_back(position(placement));
  EXPECT_EQ(positions, (std::vector<std::string>{"0 5 0", "3 5 0", "0 10 10", "6 10 10"}));
  ASSERT_EQ(scene.objects[2].placements.size(), 1u);
  EXPECT_EQ(scene.objects[2].placements[0].mask, 4u);
}

TEST(SceneGraph, RootsShareInstances) {
  const SceneDescription scene = parse("\"nodes\": {" + leaf + R"(,
  "b": {"children": ["a", {"child": "a", "transform": {"translate": [1, 0, 0]}}]}},
"roots": {"all": "b", "one": "a"})");
  EXPECT_EQ(scene.roots, (std::vector<std::string>{"all", "one"}));
  ASSERT_EQ(scene.objects.size(), 1u);
  ASSERT_EQ(scene.objects[0].placements.size(), 2u);
  EXPECT_EQ(scene.objects[0].placements[0].roots, 3u);
  EXPECT_EQ(scene.objects[0].placements[1].roots, 1u);
}

TEST(SceneGraph, OneRootMayLeadToTheSamePlaceSeveralTimes) {
  const SceneDescription scene = parse("\"nodes\": {" + leaf + R"(,
  "two": {"children": ["a", "a"]}, "three": {"children": ["two", "a"]}},
"roots": {"two": "two", "three": "three", "again": "two", "one": "a"})");
  ASSERT_EQ(scene.objects.size(), 1u);
  std::vector<std::uint32_t> roots;
  for (const Placement &placement : scene.objects[0].placements)
    roots.push_back(placement.roots);
  EXPECT_EQ(roots, (std::vector<std::uint32_t>{15, 7, 2}));
}

TEST(SceneGraph, MayBeVeryDeep) {
  std::string nodes = leaf;
  constexpr int depth = 10000;
  for (int i = 0; i < depth; ++i)
    nodes += ", \"n" + std::to_string(i) + "\": {\"child\": \"" +
             (i ? "n" + std::to_string(i - 1) : "a") +
             "\", \"transform\": {\"translate\": [1, 0, 0]}}";
  const SceneDescription scene =
      parse("\"nodes\": {" + nodes + "}, \"root\": \"n" + std::to_string(depth - 1) + "\"");
  ASSERT_EQ(scene.objects.size(), 1u);
  EXPECT_EQ(position(scene.objects[0].placements[0]), "10000 0 0");
}

TEST(SceneGraph, NeedsARoot) {
  EXPECT_EQ(parseError("\"nodes\": {" + leaf + "}, \"roots\": {}"),
            "s.json:2:62+1: outOfRange: `roots` is empty: it needs at least one name with its "
            "node, such as {\"world\": \"house\"}");
}

TEST(SceneGraph, TellsAllMistakes) {
  EXPECT_EQ(parseError(R"("nodes": {"a": {"mesh": "a.ply"},
"b": {"children": []},
"c": {"children": ["bee", 3, "a"]},
"d": {"mesh": "x", "children": ["a"], "material": "m"},
"e": {"child": "a", "transform": {"scale": 0}, "mask": 3}},
"root": "f")"),
            "s.json:2:16+1: missingKey: a node needs a `material`\n"
            "s.json:3:19+1: outOfRange: a node needs at least one child\n"
            "s.json:4:21+3: unknownName: no node is named `bee`\n"
            "s.json:4:27+1: wrongType: a child is a node or the name of one, not a "
            "number\n"
            "s.json:5:6+1: missingKey: a node has one of `mesh`, `primitive`, `light`, `model`, "
            "`child` and `children`\n"
            "s.json:6:49+4: unknownKey: a node has no key `mask`\n"
            "s.json:7:10+1: unknownName: no node is named `f`");
}

TEST(SceneGraph, RefusesCyclesAndTooManyInstances) {
  EXPECT_EQ(parseError("\"nodes\": {" + leaf + R"(,
"b": {"children": ["a", "c"]},
"c": {"children": ["a", {"child": "d"}]},
"d": {"child": "b"}}, "root": "a")"),
            "s.json:5:17+1: referenceCycle: the node `b` is below itself: b > c > d > b");
  EXPECT_EQ(parseError("\"nodes\": {" + leaf + R"(,
"b": {"children": ["nowhere", "c", "d"]},
"c": {"children": ["b", "b"]},
"d": {"child": "e"},
"e": {"child": "d"}}, "root": "a")"),
            "s.json:3:21+7: unknownName: no node is named `nowhere`\n"
            "s.json:4:21+1: referenceCycle: the node `b` is below itself: b > c > b\n"
            "s.json:6:17+1: referenceCycle: the node `d` is below itself: d > e > d");
  std::string doubled = leaf;
  std::string below = "a";
  for (int i = 0; i < 40; ++i) {
    const std::string name = "n" + std::to_string(i);
    doubled += ", \"" + name + "\": {\"children\": [\"" + below + "\", \"" + below + "\"]}";
    below = name;
  }
  EXPECT_EQ(parseError("\"nodes\": {" + doubled + "},\n\"root\": \"n39\""),
            "s.json:3:10+3: outOfRange: the graph has more than 67108864 instances");
  EXPECT_EQ(parseError("\"nodes\": {" + leaf + "}"),
            "s.json:2:10+1: missingKey: a scene with `nodes` needs a `root`, the node that rays "
            "enter");
  EXPECT_EQ(parseError("\"nodes\": {" + leaf + "}, \"root\": \"a\", \"roots\": {}"),
            "s.json:2:62+1: unknownKey: a scene has one `root` or several `roots`, not both");
}

TEST(SceneGraph, BlamesTheTransformThatFlattens) {
  EXPECT_EQ(parseError("\"nodes\": {" + leaf + R"(,
"b": {"child": "a", "transform": {"scale": [1, 1, 1e-6]}},
"c": {"children": ["b", "b"], "transform":
  {"scale": [1, 1e-3, 1]}}}, "root": "c")"),
            "no error");
  EXPECT_EQ(parseError("\"nodes\": {" + leaf + R"(,
"b": {"child": "a", "transform": {"scale": [1, 1, 1e-6]}},
"c": {"children": ["b", "b"], "transform":
  {"scale": [1e3, 1e3, 1]}}}, "root": "c")"),
            "s.json:3:34+1: degenerateGeometry: this transform flattens `a`, or nearly so: the "
            "condition number of the path from the root would be more than 1e+08");
}

TEST(SceneGraph, WarnsOfNodesOutsideOfTheScene) {
  const SceneDescription scene =
      parse("\"nodes\": {" + leaf + ",\n\"b\": {\"child\": \"a\"}}, \"root\": \"a\"");
  ASSERT_EQ(scene.warnings.size(), 1u);
  EXPECT_EQ(scene.warnings[0].message,
            "the node `b` is not part of the scene: no root leads to it");
  EXPECT_EQ(scene.warnings[0].place->line, 3u);
}

TEST(SceneGraph, HasSelectorsAndVariablesForEachWayDown) {
  const SceneDescription scene = parse(R"("variables": {"v": 1},
"nodes": {
  )" + leaf + R"(,
  "lod": {"selector": {"class": "Near"}, "children": ["a", {"child": "a", "id": 5}], "id": 3},
  "two": {"children": ["lod", {"child": "lod", "variables": {"v": 2}, "transform": {"translate": [1, 0, 0]}}]}},
"root": "two")");
  ASSERT_EQ(scene.selectors.size(), 2u);
  EXPECT_EQ(scene.selectors[1].children, 2u);
  EXPECT_EQ(scene.selectors[1].toWorld.still().columns[3][0], 1);
  EXPECT_EQ(scene.selectors[1].above, 0u);
  ASSERT_EQ(scene.objects.size(), 1u);
  const auto &placements = scene.objects[0].placements;
  ASSERT_EQ(placements.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(placements[i].selector, 1 + i / 2);
    EXPECT_EQ(placements[i].childOfSelector, i % 2);
    EXPECT_EQ(placements[i].id, i % 2 ? 5 : 3);
    EXPECT_EQ(placements[i].scope->find("v")->second->number, i / 2 + 1.0);
    EXPECT_EQ(placements[i].scope->find("w"), nullptr);
  }
}
