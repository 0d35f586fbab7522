#include "ErrorText.h"

#include "scenefile/json/JsonValue.h"

#include <gtest/gtest.h>

using namespace rtsl::scene;
using rtsl::scene::test::errorOf;

namespace {

std::string errorOfText(const std::string &text) {
  return errorOf([&] { parseJson(text, "s.json"); });
}

std::string where(const JsonValue &value) {
  return std::to_string(value.line) + ":" + std::to_string(value.column) + "+" +
         std::to_string(value.length);
}

} // namespace

TEST(JsonValue, EveryValueHasItsPosition) {
  JsonValue root = parseJson(
      "{\n  \"name\": \"a\\\"b\",\n\t\"list\": [1, -2.5e3,\r\n    true,null , {\"x\":{}}]\n}",
      "s.json");
  EXPECT_EQ(where(root), "1:1+1");
  EXPECT_EQ(where(*root.find("name")), "2:12+4"); // inside the quotes, as written
  EXPECT_EQ(root.find("name")->string, "a\"b");
  const JsonValue &list = *root.find("list");
  EXPECT_EQ(where(list), "3:10+1");
  ASSERT_EQ(list.elements.size(), 5u);
  EXPECT_EQ(where(list.elements[0]), "3:11+1");
  EXPECT_TRUE(list.elements[0].isInteger);
  EXPECT_EQ(where(list.elements[1]), "3:14+6");
  EXPECT_EQ(list.elements[1].number, -2500);
  EXPECT_FALSE(list.elements[1].isInteger);
  EXPECT_EQ(where(list.elements[2]), "4:5+4");
  EXPECT_EQ(where(list.elements[3]), "4:10+4");
  EXPECT_EQ(where(list.elements[4]), "4:17+1");
  EXPECT_EQ(where(*list.elements[4].find("x")), "4:22+1");
  EXPECT_EQ(root.members[1].first.line, 3u);
  EXPECT_EQ(root.members[1].first.column, 3u);
  EXPECT_EQ(root.members[1].first.length, 4u);
}

TEST(JsonValue, AByteOrderMarkIsNoColumn) {
  JsonValue root = parseJson("\xEF\xBB\xBF{\"a\": 1}", "s.json");
  EXPECT_EQ(where(*root.find("a")), "1:7+1");
}

TEST(JsonValue, SyntaxErrorsPointAtTheToken) {
  EXPECT_EQ(errorOfText("{\n  \"a\": 1,\n}"),
            "s.json:3:1+1: jsonSyntax: this is not JSON: unexpected '}'; expected string literal "
            "(note JSON allows no comma after the last element)");
  EXPECT_EQ(errorOfText("{\"a\" 1}"),
            "s.json:1:6+1: jsonSyntax: this is not JSON: unexpected number literal; expected ':'");
  EXPECT_EQ(errorOfText("[1, 2"),
            "s.json:1:6+1: jsonSyntax: this is not JSON: unexpected end of input; expected ']'");
  EXPECT_EQ(errorOfText("[1 \"two\"]"),
            "s.json:1:4+5: jsonSyntax: this is not JSON: unexpected string literal; expected ']'");
  EXPECT_EQ(errorOfText(""), "s.json:1:1+1: jsonSyntax: this is not JSON: unexpected end of input; "
                             "expected '[', '{', or a literal");
  EXPECT_EQ(errorOfText("{} x"),
            "s.json:1:4+1: jsonSyntax: this is not JSON: invalid literal; expected end of input");
  EXPECT_EQ(errorOfText("{ // hm\n}"),
            "s.json:1:3+1: jsonSyntax: this is not JSON: invalid literal; expected string literal "
            "(note JSON has no comments)");
  EXPECT_EQ(errorOfText("{\"a\": 1e999}"),
            "s.json:1:7+5: outOfRange: `1e999` is too large: the largest number is 1.8e+308");
  EXPECT_NE(errorOfText("[\"\xff\"]").find("jsonSyntax"), std::string::npos);
}

TEST(JsonValue, AKeyGivenTwiceIsAnErrorWithBothPlaces) {
  EXPECT_EQ(errorOfText("{\"a\": 1,\n \"b\": {\"c\": 1,\n \"c\": 2}}"),
            "s.json:3:3+1: duplicateKey: key `c` is given twice (2:9 it is given here first)");
}

TEST(JsonValue, DeepNestingIsRefusedWithoutRecursion) {
  EXPECT_EQ(errorOfText(std::string(100000, '[')),
            "s.json:1:257+1: jsonSyntax: nested deeper than 256 levels");
  EXPECT_EQ(errorOfText(std::string(256, '[') + std::string(256, ']')), "no error");
}

TEST(Override, ReplacesAddsAndAppends) {
  JsonValue root = parseJson(
      "{\"textures\": {\"checks\": {\"scale\": 4}}, \"objects\": [{\"mesh\": \"a.ply\"}]}",
      "s.json");
  applyOverride(root, "textures.checks.scale=8");
  EXPECT_EQ(root.find("textures")->find("checks")->find("scale")->number, 8);
  applyOverride(root, "objects.0.mesh=my meshes/b=c.ply");
  EXPECT_EQ(root.find("objects")->elements[0].find("mesh")->string, "my meshes/b=c.ply");
  EXPECT_TRUE(root.find("objects")->elements[0].find("mesh")->fromOverride);
  applyOverride(root, "objects.1={\"mesh\": \"c.ply\"}");
  EXPECT_EQ(root.find("objects")->elements.size(), 2u);
  applyOverride(root, "render.spp=64"); // the section was not there
  EXPECT_EQ(root.find("render")->find("spp")->number, 64);
  applyOverride(root, "textures.checks.on=true");
  EXPECT_TRUE(root.find("textures")->find("checks")->find("on")->boolean);
}

TEST(Override, ReportsWhatIsWrong) {
  auto error = [](const std::string &text) {
    JsonValue root = parseJson(
        "{\"textures\": {\"checks\": {\"scale\": 4}}, \"objects\": [{\"mesh\": \"a.ply\"}]}",
        "s.json");
    return errorOf([&] { applyOverride(root, text); });
  };
  // Columns count from the option.
  EXPECT_EQ(error("nothing"),
            "--set nothing:1:7+7: badOverride: an override is written `path.to.key=value`");
  EXPECT_EQ(error("textures.cheks.scale=1"),
            "--set textures.cheks.scale=1:1:16+5: badOverride: `textures` has no `cheks` "
            "(fix `checks`)");
  EXPECT_EQ(error("objects.7.mesh=x"), "--set objects.7.mesh=x:1:15+1: badOverride: `objects` has "
                                       "1 element: index 7 is out of range");
  EXPECT_EQ(error("objects.first=x"), "--set objects.first=x:1:15+5: badOverride: `objects` is a "
                                      "list: `first` is not an index");
  EXPECT_EQ(error("textures.checks.scale.x=1"),
            "--set textures.checks.scale.x=1:1:29+1: badOverride: `textures.checks.scale` is a "
            "number, which cannot contain `x`");
  EXPECT_EQ(error("a..b=1"),
            "--set a..b=1:1:9+0: badOverride: the path of an override has an empty part");
}
