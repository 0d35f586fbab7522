//===- ParserTest.cpp - declarations, statements and the dump -------------===//
#include "Parsed.h"

#include <gtest/gtest.h>

namespace rtsl {
namespace {

using test::Parsed;

/// The dump of a text without mistakes.
std::string tree(const std::string &text) {
  const Parsed parsed(text);
  EXPECT_EQ(parsed.messages(), "");
  return parsed.tree();
}

/// The dump of the statements of a function, without what is around them.
std::string statements(const std::string &text) {
  const std::string whole = tree("void f() {\n" + text + "\n}\n");
  const std::string head = "unit\n  function void f\n    block\n";
  EXPECT_EQ(whole.substr(0, head.size()), head);
  std::string result;
  for (std::size_t at = head.size(); at < whole.size();) {
    const std::size_t end = whole.find('\n', at);
    result += whole.substr(at + 6, end + 1 - at - 6);
    at = end + 1;
  }
  return result;
}

//===----------------------------------------------------------------------===//
// Declarations
//===----------------------------------------------------------------------===//

TEST(Declarations, ClassToTheEndOfTheFile) {
  EXPECT_EQ(tree("class Sphere : rt_Primitive;\n"
                 "public vec3 center = vec3(0), unused;\n"
                 "private float radius2;\n"
                 "scratch vec3 n;\n"
                 "const int N = 3;\n"
                 "void constructor(vec3 c, float r) { center = c; }\n"
                 "void intersect() { }"),
            "unit\n"
            "  class Sphere : rt_Primitive (to the end of the file)\n"
            "    member public vec3 center\n"
            "      call vec3\n"
            "        int 0\n"
            "    member public vec3 unused\n"
            "    member private float radius2\n"
            "    member scratch vec3 n\n"
            "    member const int N\n"
            "      int 3\n"
            "    function void constructor\n"
            "      parameter vec3 c\n"
            "      parameter float r\n"
            "      block\n"
            "        expression\n"
            "          assign =\n"
            "            name center\n"
            "            name c\n"
            "    function void intersect\n"
            "      block\n");
}

TEST(Declarations, SeveralClassesStructsFunctionsAndConstants) {
  EXPECT_EQ(tree("import std.cameras;\n"
                 "import \"lib/glass.rtsl\";\n"
                 "struct Hit { float t, u; vec3 p[2]; };\n"
                 "const float Pi = 3.14, Tau = 6.28;\n"
                 "float area(float r);\n"
                 "class A : rt_Material { public rt_Texture albedo; void shade() {} };\n"
                 "float area(float r) { return Pi; }\n"
                 "class B : A { };\n"),
            "unit\n"
            "  import std.cameras\n"
            "  import \"lib/glass.rtsl\"\n"
            "  struct Hit\n"
            "    field float t\n"
            "    field float u\n"
            "    field vec3[2] p\n"
            "  constant const float Pi\n"
            "    float 3.14\n"
            "  constant const float Tau\n"
            "    float 6.28\n"
            "  prototype float area\n"
            "    parameter float r\n"
            "  function float area\n"
            "    parameter float r\n"
            "    block\n"
            "      return\n"
            "        name Pi\n"
            "  class A : rt_Material\n"
            "    member public rt_Texture albedo\n"
            "    function void shade\n"
            "      block\n"
            "  class B : A\n");
}

TEST(Declarations, Parameters) {
  EXPECT_EQ(
      tree("void f(const in float a, out vec3 b, inout float[2] c, const float d[3], int) {}\n"
           "void g(void) {}\n"),
      "unit\n"
      "  function void f\n"
      "    parameter const float a\n"
      "    parameter out vec3 b\n"
      "    parameter inout float[2] c\n"
      "    parameter const float[3] d\n"
      "    parameter int\n"
      "    block\n"
      "  function void g\n"
      "    block\n");
}

TEST(Declarations, DimensionsBehindTheNameAreTheOuterOnes) {
  EXPECT_EQ(tree("class A : rt_Material;\n"
                 "public vec3 vertices[];\n"
                 "public float[][] grid;\n"
                 "const vec4[2] a[3], b = 1;\n"
                 "const float c[N + 1][M];\n"),
            "unit\n"
            "  class A : rt_Material (to the end of the file)\n"
            "    member public vec3[] vertices\n"
            "    member public float[][] grid\n"
            "    member const vec4[3][2] a\n"
            "    member const vec4[2] b\n"
            "      int 1\n"
            "    member const float[...][M] c\n"
            "      size: binary +\n"
            "        name N\n"
            "        int 1\n");
}

TEST(Declarations, InitializerLists) {
  EXPECT_EQ(tree("const float a[2][2] = {{1, 2}, {3, 4,},};\nconst float b[] = {};\n"),
            "unit\n"
            "  constant const float[2][2] a\n"
            "    list\n"
            "      list\n"
            "        int 1\n"
            "        int 2\n"
            "      list\n"
            "        int 3\n"
            "        int 4\n"
            "  constant const float[] b\n"
            "    list\n");
}

TEST(Declarations, StraySemicolonsDoNoHarm) {
  EXPECT_EQ(tree("; struct A { ; float x; }; void f() { }; class B : A { ; void g() { }; };"),
            "unit\n"
            "  struct A\n"
            "    field float x\n"
            "  function void f\n"
            "    block\n"
            "  class B : A\n"
            "    function void g\n"
            "      block\n");
}

TEST(Declarations, HaveTheirPlaces) {
  const Parsed parsed("class A : rt_Material;\n"
                      "public float[2] aa = 1, bb;\n"
                      "void f(inout vec3 p) { }\n");
  const ast::ClassDecl &declared = parsed.unit->classes.at(0);
  const auto text = [&](SourceRange range) { return std::string(parsed.sources.text(range)); };
  EXPECT_EQ(text(declared.range), "class A : rt_Material;\n"
                                  "public float[2] aa = 1, bb;\n"
                                  "void f(inout vec3 p) { }");
  EXPECT_EQ(text(declared.base.range), "rt_Material");
  EXPECT_EQ(text(declared.members[0].range), "public float[2] aa = 1");
  EXPECT_EQ(text(declared.members[0].accessRange), "public");
  EXPECT_EQ(text(declared.members[0].type.range), "float[2]");
  EXPECT_EQ(text(declared.members[0].type.dimensions[0].range), "[2]");
  EXPECT_EQ(text(declared.members[1].range), "bb");
  EXPECT_EQ(text(declared.members[1].name.range), "bb");
  EXPECT_EQ(text(declared.functions[0].range), "void f(inout vec3 p) { }");
  EXPECT_EQ(text(declared.functions[0].parameters[0].range), "inout vec3 p");
  EXPECT_EQ(text(declared.functions[0].body->range), "{ }");
}

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

TEST(Statements, DeclareVariables) {
  EXPECT_EQ(statements("float a = 1, b[2]; const vec3[2] c; Hit h; float[n] d;"),
            "variable float a\n"
            "  int 1\n"
            "variable float[2] b\n"
            "variable const vec3[2] c\n"
            "variable Hit h\n"
            "variable float[n] d\n");
}

TEST(Statements, AreExpressions) {
  EXPECT_EQ(statements("f(); a[i] = b; a[i][j].x++; hit(t); ;"), "expression\n"
                                                                 "  call f\n"
                                                                 "expression\n"
                                                                 "  assign =\n"
                                                                 "    index\n"
                                                                 "      name a\n"
                                                                 "      name i\n"
                                                                 "    name b\n"
                                                                 "expression\n"
                                                                 "  unary postfix ++\n"
                                                                 "    member .x\n"
                                                                 "      index\n"
                                                                 "        index\n"
                                                                 "          name a\n"
                                                                 "          name i\n"
                                                                 "        name j\n"
                                                                 "expression\n"
                                                                 "  call hit\n"
                                                                 "    name t\n"
                                                                 "empty\n");
}

TEST(Statements, GiveAnElseToTheNearestIf) {
  EXPECT_EQ(statements("if (a) if (b) x; else y;\nif (c) { if (d) x; } else if (e) y; else z;"),
            "if\n"
            "  name a\n"
            "  if\n"
            "    name b\n"
            "    expression\n"
            "      name x\n"
            "  else\n"
            "    expression\n"
            "      name y\n"
            "if\n"
            "  name c\n"
            "  block\n"
            "    if\n"
            "      name d\n"
            "      expression\n"
            "        name x\n"
            "else\n"
            "  if\n"
            "    name e\n"
            "    expression\n"
            "      name y\n"
            "  else\n"
            "    expression\n"
            "      name z\n");
}

TEST(Statements, Loop) {
  EXPECT_EQ(statements("for (int i = 0; i < n; i++) continue;\n"
                       "for (i = 0, j = 1; ; ) break;\n"
                       "for (;; i++) { }\n"
                       "while (a) { b; }\n"
                       "do a; while (b);"),
            "for\n"
            "  variable int i\n"
            "    int 0\n"
            "  condition: binary <\n"
            "    name i\n"
            "    name n\n"
            "  step: unary postfix ++\n"
            "    name i\n"
            "  continue\n"
            "for\n"
            "  expression\n"
            "    comma\n"
            "      assign =\n"
            "        name i\n"
            "        int 0\n"
            "      assign =\n"
            "        name j\n"
            "        int 1\n"
            "  break\n"
            "for\n"
            "  empty\n"
            "  step: unary postfix ++\n"
            "    name i\n"
            "  block\n"
            "while\n"
            "  name a\n"
            "  block\n"
            "    expression\n"
            "      name b\n"
            "do\n"
            "  expression\n"
            "    name a\n"
            "  while: name b\n");
}

TEST(Statements, Switch) {
  EXPECT_EQ(statements("switch (a) { case 1: case 2 + 1: b; break; default: return c; }"),
            "switch\n"
            "  name a\n"
            "  case\n"
            "    int 1\n"
            "  case\n"
            "    binary +\n"
            "      int 2\n"
            "      int 1\n"
            "  expression\n"
            "    name b\n"
            "  break\n"
            "  default\n"
            "  return\n"
            "    name c\n");
}

TEST(Statements, Illuminance) {
  EXPECT_EQ(statements("illuminance (P) c += d;\n"
                       "illuminance (P, N, 1.57) { }\n"
                       "if (a) illuminance (P) ;\n"
                       "x = illuminance (P);\n"
                       "float illuminance = 1;"),
            "illuminance\n"
            "  name P\n"
            "  expression\n"
            "    assign +=\n"
            "      name c\n"
            "      name d\n"
            "illuminance\n"
            "  name P\n"
            "  name N\n"
            "  float 1.57\n"
            "  block\n"
            "if\n"
            "  name a\n"
            "  illuminance\n"
            "    name P\n"
            "    empty\n"
            "expression\n"
            "  assign =\n"
            "    name x\n"
            "    call illuminance\n"
            "      name P\n"
            "variable float illuminance\n"
            "  int 1\n");
}

//===----------------------------------------------------------------------===//
// Comments and layout
//===----------------------------------------------------------------------===//

TEST(Comments, DirectlyAboveBelongToWhatIsBelow) {
  EXPECT_EQ(tree("// The head of the file.\n"
                 "\n"
                 "// Not this one:\n"
                 "\n"
                 "/* A block\n"
                 "   of two lines. */\n"
                 "// And a line.\n"
                 "class A : rt_Material;\n"
                 "\n"
                 "// index of refraction\n"
                 "public float ior; // dropped\n"
                 "public float k;\n"
                 "// the work\n"
                 "void shade() {\n"
                 "  // first\n"
                 "  float a = 1; /* dropped */\n"
                 "\n"
                 "    /* a block\n"
                 "     * with stars\n"
                 "     */\n"
                 "  a = 2;\n"
                 "  // at the end: dropped\n"
                 "}\n"),
            "unit\n"
            "  // The head of the file.\n"
            "  /* A block\n"
            "     of two lines. */\n"
            "  // And a line.\n"
            "  class A : rt_Material (to the end of the file)\n"
            "    // index of refraction\n"
            "    member public float ior\n"
            "    member public float k\n"
            "    // the work\n"
            "    function void shade\n"
            "      block\n"
            "        // first\n"
            "        variable float a\n"
            "          int 1\n"
            "        /* a block\n"
            "         * with stars\n"
            "         */\n"
            "        expression\n"
            "          assign =\n"
            "            name a\n"
            "            int 2\n");
}

TEST(Comments, DirectlyAboveTheFirstDeclarationAreItsOwn) {
  const Parsed parsed("// about A\nclass A : rt_Material;\n");
  EXPECT_EQ(parsed.unit->comment, "");
  EXPECT_EQ(parsed.unit->classes.at(0).comment, "// about A");
}

TEST(Comments, AboveImportsAreTheHeadOfTheFile) {
  const Parsed parsed("// about the file\nimport std.cameras;\nclass A : rt_Material;\n");
  EXPECT_EQ(parsed.unit->comment, "// about the file");
  EXPECT_EQ(parsed.unit->classes.at(0).comment, "");
}

TEST(Comments, AfterAMemberContinueInTheirColumn) {
  const Parsed parsed("class A : rt_Material {\n"
                      "  float a; // about a,\n"
                      "           // and more\n"
                      "  float b; // about b\n"
                      "  // about c\n"
                      "  float c;\n"
                      "};\n");
  std::string comments;
  for (const ast::VariableDecl &variable : parsed.unit->classes.at(0).members)
    comments += variable.name.text + ": " + variable.comment + "\n";
  EXPECT_EQ(comments, "a: \nb: \nc: // about c\n");
}

TEST(Layout, CarriageReturnsTabsAndMarksDoNotMatter) {
  const std::string plain = "class A : rt_Material;\n// c\nvoid shade() {\n  a = 1;\n}\n";
  std::string windows = "\xEF\xBB\xBF";
  for (const char c : plain)
    windows += c == '\n' ? std::string("\r\n") : std::string(1, c == ' ' ? '\t' : c);
  std::string expected = tree(plain);
  std::string result = tree(windows);
  // The comment keeps its own tab.
  const std::size_t at = result.find("//\tc");
  ASSERT_NE(at, std::string::npos);
  result[at + 2] = ' ';
  EXPECT_EQ(result, expected);
}

TEST(Layout, NoNewlineAtTheEnd) {
  EXPECT_EQ(tree("void f() { } // the end"), "unit\n  function void f\n    block\n");
  EXPECT_EQ(tree("void f() { } /* the end **/"), "unit\n  function void f\n    block\n");
}

} // namespace
} // namespace rtsl
