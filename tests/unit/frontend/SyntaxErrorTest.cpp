//===- SyntaxErrorTest.cpp - mistakes, their places and what survives them ===//
//
// Each text states all of its messages: one that is not expected fails its test, so that no slip
// gives two.
//
//===----------------------------------------------------------------------===//
#include "Parsed.h"

#include "frontend/lex/Tokenizer.h"

#include <gtest/gtest.h>

namespace rtsl {
namespace {

using test::inFunction;
using test::messages;
using test::Parsed;

//===----------------------------------------------------------------------===//
// Semicolons
//===----------------------------------------------------------------------===//

TEST(MissingSemicolon, PointsBehindThePreviousWord) {
  EXPECT_EQ(Parsed("void f() {\n"
                   "  vec3 a = b // why\n"
                   "\n"
                   "  c = a;\n"
                   "}\n")
                .shown(),
            "test.rtsl:2:13: error[E0112]: missing `;` after `b`\n"
            "  |\n"
            "2 |   vec3 a = b // why\n"
            "  |             ^\n"
            "help: insert `;`\n"
            "  |\n"
            "2 |   vec3 a = b; // why\n"
            "  |             +\n"
            "\n");
}

TEST(MissingSemicolon, IsTheOnlyMessageWhereverItIsMissing) {
  EXPECT_EQ(inFunction("a = b"), "E0112 2:6-2:6 missing `;` after `b`\n");
  EXPECT_EQ(inFunction("float a"), "E0112 2:8-2:8 missing `;` after `a`\n");
  EXPECT_EQ(inFunction("foo(a)"), "E0112 2:7-2:7 missing `;` after `)`\n");
  EXPECT_EQ(inFunction("{ return }"), "E0112 2:9-2:9 missing `;` after `return`\n");
  EXPECT_EQ(inFunction("return"), "") << "it takes what follows as its value";
  EXPECT_EQ(inFunction("break"), "E0112 2:6-2:6 missing `;` after `break`\n");
  EXPECT_EQ(inFunction("do { } while (a)"), "E0112 2:17-2:17 missing `;` after `)`\n");
  EXPECT_EQ(inFunction("{ a = b }"), "E0112 2:8-2:8 missing `;` after `b`\n");
  EXPECT_EQ(inFunction("{ a }"), "E0112 2:4-2:4 missing `;` after `a`\n");
  EXPECT_EQ(inFunction("a = b if (c) d;"), "E0112 2:6-2:6 missing `;` after `b`\n");
  EXPECT_EQ(messages("class A : rt_Light;\npublic float a = 1\npublic float b\nvoid f() { }\n"),
            "E0112 2:19-2:19 missing `;` after `1`\n"
            "E0112 3:15-3:15 missing `;` after `b`\n");
  EXPECT_EQ(messages("class A : rt_Light\npublic float a;\n"),
            "E0112 1:19-1:19 missing `;` after `rt_Light`\n");
  EXPECT_EQ(messages("import std.cameras\nvoid f() { }"),
            "E0112 1:19-1:19 missing `;` after `cameras`\n");
  EXPECT_EQ(messages("const float a = 1"), "E0112 1:18-1:18 missing `;` after `1`\n");
}

TEST(MissingSemicolon, BehindAClassOrStruct) {
  EXPECT_EQ(Parsed("class A : rt_Light {\n"
                   "  public float a;\n"
                   "}\n"
                   "\n"
                   "class B : A { };\n")
                .shown(),
            "test.rtsl:3:2: error[E0112]: missing `;` after class `A`\n"
            "  |\n"
            "3 | }\n"
            "  |  ^\n"
            "help: insert `;`\n"
            "  |\n"
            "3 | };\n"
            "  |  +\n"
            "\n");
  EXPECT_EQ(messages("struct S { float a; }\nvoid f() { }"),
            "E0112 1:22-1:22 missing `;` after struct `S`\n");
}

TEST(MissingSemicolon, LosesNothing) {
  const Parsed parsed(
      "class A : rt_Light {\n  void f() {\n    a = 1\n    b = 2\n  }\n}\nclass B : A { };\n");
  EXPECT_EQ(parsed.tree(), "unit\n"
                           "  class A : rt_Light\n"
                           "    function void f\n"
                           "      block\n"
                           "        expression\n"
                           "          assign =\n"
                           "            name a\n"
                           "            int 1\n"
                           "        expression\n"
                           "          assign =\n"
                           "            name b\n"
                           "            int 2\n"
                           "  class B : A\n");
}

//===----------------------------------------------------------------------===//
// Brackets
//===----------------------------------------------------------------------===//

TEST(Brackets, UnclosedOnesAreShownWhereTheyOpen) {
  EXPECT_EQ(Parsed("void f() {\n  c = mix(a, (b + 1);\n  d = 2;\n}\n").shown(),
            "test.rtsl:2:10: error[E0113]: `(` is never closed\n"
            "  |\n"
            "2 |   c = mix(a, (b + 1);\n"
            "  |          ^\n"
            "help: insert `)`\n"
            "  |\n"
            "2 |   c = mix(a, (b + 1));\n"
            "  |                     +\n"
            "\n");
  EXPECT_EQ(inFunction("a[1 = 2;"), "E0113 2:2-2:3 `[` is never closed\n");
  EXPECT_EQ(inFunction("foo(a[1);"), "E0113 2:6-2:7 `[` is never closed\n");
  EXPECT_EQ(inFunction("foo(bar(baz(1);"), "E0113 2:4-2:5 `(` is never closed\n");
  EXPECT_EQ(inFunction("if (a { b; }"), "E0113 2:4-2:5 `(` is never closed\n");
  EXPECT_EQ(inFunction("for (int i = 0; i < n; i++ { b; }"), "E0113 2:5-2:6 `(` is never closed\n");
  EXPECT_EQ(inFunction("for (int i = foo(1; i < n; i++) { b; }"),
            "E0113 2:17-2:18 `(` is never closed\n");
  EXPECT_EQ(inFunction("{ foo(1 }"), "E0113 2:6-2:7 `(` is never closed\n");
}

TEST(Brackets, AnUnclosedBraceIsFoundByIndentation) {
  EXPECT_EQ(Parsed("class A : rt_Material;\n"
                   "void shade() {\n"
                   "  if (a) {\n"
                   "    b = 1;\n"
                   "}\n"
                   "void other() {\n"
                   "}\n")
                .shown(),
            "test.rtsl:3:10: error[E0113]: `{` is never closed\n"
            "  |\n"
            "3 |   if (a) {\n"
            "  |          ^\n"
            "4 |     b = 1;\n"
            "5 | }\n"
            "  | - indented like the end of an outer block\n"
            "\n");
  EXPECT_EQ(messages("void f() {\n  a;\n"), "E0113 1:10-1:11 `{` is never closed\n");
  EXPECT_EQ(messages("void f() { a; "), "E0113 1:10-1:11 `{` is never closed\n");
  EXPECT_EQ(messages("void f() { a; } void g() {"), "E0113 1:26-1:27 `{` is never closed\n");
}

TEST(Brackets, OnesTooManyAreShown) {
  EXPECT_EQ(inFunction("a = b);"), "E0114 2:6-2:7 unmatched `)`\n");
  EXPECT_EQ(inFunction("a = b];"), "E0114 2:6-2:7 unmatched `]`\n");
  EXPECT_EQ(messages("void f() { a; } }\nvoid g() { }\n"), "E0114 1:17-1:18 unmatched `}`\n");
  EXPECT_EQ(Parsed("void f() {\n  a; }\n  b;\n}\n").shown(),
            "test.rtsl:4:1: error[E0114]: unmatched `}`\n"
            "  |\n"
            "2 |   a; }\n"
            "  |      - all brackets were closed here\n"
            "3 |   b;\n"
            "4 | }\n"
            "  | ^\n"
            "\n");
}

TEST(Brackets, OfTheWrongKindAreShownWithTheOneTheyClose) {
  EXPECT_EQ(Parsed("void f() {\n  foo(a];\n}\n").shown(),
            "test.rtsl:2:8: error[E0111]: expected `)`, found `]`\n"
            "  |\n"
            "2 |   foo(a];\n"
            "  |      - ^\n"
            "  |      |\n"
            "  |      opened here\n"
            "help: replace `]` by `)`\n"
            "  |\n"
            "2 |   foo(a);\n"
            "  |        ~\n"
            "\n");
}

//===----------------------------------------------------------------------===//
// Declarations
//===----------------------------------------------------------------------===//

TEST(DeclarationErrors, MethodsWithoutBody) {
  EXPECT_EQ(
      Parsed("class A : rt_Material;\nvoid shade()\nvoid BSDF();\nvoid emission() { }\n").shown(),
      "test.rtsl:2:6: error[E0117]: method `shade` has no body\n"
      "  |\n"
      "2 | void shade()\n"
      "  |      ^^^^^\n"
      "\n"
      "test.rtsl:3:6: error[E0117]: method `BSDF` has no body\n"
      "  |\n"
      "3 | void BSDF();\n"
      "  |      ^^^^\n"
      "\n");
  EXPECT_EQ(messages("class A : rt_Material { void shade(vec3 a) };"),
            "E0117 1:30-1:35 method `shade` has no body\n");
  EXPECT_EQ(messages("void f() const { a; }\nvoid g() { }\n"),
            "E0121 1:10-1:15 `const` is not an RTSL qualifier\n");
}

TEST(DeclarationErrors, FunctionsWithoutReturnType) {
  EXPECT_EQ(Parsed("class A : rt_Light;\nconstructor(float a) { }\nvoid f() { }\n").shown(),
            "test.rtsl:2:1: error[E0124]: function `constructor` has no return type\n"
            "  |\n"
            "2 | constructor(float a) { }\n"
            "  | ^^^^^^^^^^^\n"
            "help: insert `void`\n"
            "  |\n"
            "2 | void constructor(float a) { }\n"
            "  | +++++\n"
            "\n");
}

TEST(DeclarationErrors, Classes) {
  EXPECT_EQ(messages("class A { };\nvoid f() { }\n"), "");
  EXPECT_EQ(messages("class A;\n"),
            "E0171 1:1-1:8 class `A` has neither a base nor members of its own\n");
  EXPECT_EQ(messages("class : rt_Light { };\n"), "E0111 1:7-1:8 expected a name, found `:`\n");
  EXPECT_EQ(
      messages("class A : public rt_Light { };\n"),
      "E0119 1:11-1:17 `public` is not allowed here: RTSL has only one kind of inheritance\n");
  EXPECT_EQ(messages("class A : rt_Light {\npublic:\n  public float a;\n};\n"),
            "E0119 2:1-2:8 `public:` is not allowed here: write `public` before each member\n");
  EXPECT_EQ(messages("class A : rt_Light {\n  return 1;\n  void f() { }\n};\n"),
            "E0111 2:3-2:9 expected a member, found `return`\n");
}

TEST(DeclarationErrors, NothingFollowsAClassToTheEndOfTheFile) {
  EXPECT_EQ(Parsed("class A : rt_Light;\nfloat a;\nclass B : A { };\n").shown(),
            "test.rtsl:3:1: error[E0118]: `class A : rt_Light;` extends to the end of "
            "the file: a class cannot follow it\n"
            "  |\n"
            "1 | class A : rt_Light;\n"
            "  |       - begins here\n"
            "2 | float a;\n"
            "3 | class B : A { };\n"
            "  | ^^^^^\n"
            "  = note: a file of several declarations is written `class A : rt_Light { ... };`\n"
            "\n");
  EXPECT_EQ(messages("class A : rt_Light;\nstruct S { float a; };\nimport std.lights;\n"),
            "E0118 2:1-2:7 `class A : rt_Light;` extends to the end of the file: a "
            "struct cannot follow it\n"
            "E0118 3:1-3:7 `class A : rt_Light;` extends to the end of the file: an "
            "import cannot follow it\n");
}

TEST(DeclarationErrors, Qualifiers) {
  EXPECT_EQ(messages("class A : rt_Light;\npublic private float a;\nconst const float b = 1;\n"),
            "E0120 2:8-2:15 `private` contradicts or repeats `public`\n"
            "E0120 3:7-3:12 `const` contradicts or repeats `const`\n");
  EXPECT_EQ(messages("void f(in out float a, public float b) { }\n"),
            "E0120 1:11-1:14 `out` contradicts or repeats `in`\n"
            "E0119 1:24-1:30 `public` is not allowed here: it is for members of classes\n");
  EXPECT_EQ(
      messages("struct S { public float a; const float b; inout float c; };\n"),
      "E0119 1:12-1:18 `public` is not allowed here: it is for members of classes\n"
      "E0119 1:28-1:33 `const` is not allowed here: the fields of a struct have no qualifiers\n"
      "E0119 1:43-1:48 `inout` is not allowed here: it is for parameters and "
      "output buffers\n");
  EXPECT_EQ(messages("public void f() { in float a; }\n"),
            "E0119 1:1-1:7 `public` is not allowed here: functions have no qualifiers\n"
            "E0119 1:19-1:21 `in` is not allowed here: it is for parameters\n");
  EXPECT_EQ(messages("uniform float a;\nvarying highp vec2 b;\nstatic const float c = 1;\n"),
            "E0121 1:1-1:8 `uniform` is not an RTSL qualifier\n"
            "E0121 2:1-2:8 `varying` is not an RTSL qualifier\n"
            "E0116 2:9-2:14 RTSL has no precision qualifiers\n"
            "E0121 3:1-3:7 `static` is not an RTSL qualifier\n");
}

TEST(DeclarationErrors, WhatFollowsDefaultIsAClass) {
  EXPECT_EQ(messages("default A : rt_Material { float f() { return 1.0; } };\n"),
            "E0111 1:9-1:10 expected `class`, found `A`\n");
  EXPECT_EQ(messages("class A : rt_Material { };\ndefault const float x = 1.0;\n"),
            "E0111 2:9-2:14 expected `class`, found `const`\n");
  for (const std::string token :
       {"struct S { float a; };", "import std.lights;", "void f() { }", "{ }", ";", ""})
    EXPECT_NE(messages("default " + token + "\n").find("expected `class`"), std::string::npos)
        << token;
  EXPECT_EQ(Parsed("default struct S { float a; };\n").shown().find("in a function"),
            std::string::npos);
}

/// All of the grammar, with a space between tokens, of which each is left out, written twice, or
/// replaced: there is a message, or the text is right.
TEST(DeclarationErrors, AnyTokenMayBeMissing) {
  const std::string text =
      "import std . lights ; import \"a.rtsl\" ; struct S { float a [ 2 ] ; } ; const int N = 2 ; "
      "default class D : rt_Material { void shade ( ) ; float f ( in vec3 v , inout float y ) { "
      "return v . x + y ; } } ; class H { float g ( ) { return 1.0 ; } } ; "
      "class A : rt_Material ; public optional rt_Texture t ; public float k in [ 0 , 1 ] = 0.5 , "
      "j = 1.0 ; void shade ( ) { float a [ ] = { 1.0 , 2.0 } ; for ( int i = 0 ; i < 2 ; ++ i ) "
      "{ if ( i == 1 ) continue ; else a [ i ] += 1.0 ; } while ( true ) { break ; } do { } while "
      "( "
      "false ) ; switch ( N ) { case 1 : break ; default : } illuminance ( rt_HitPoint ) "
      "rt_SampleColor = rt_LightColor * ( - a [ 0 ] ? 1.0 : 2.0 ) ; }";
  std::vector<std::string> tokens;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    tokens.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  const std::vector<std::string> others = {
      "",  "class", "default", "struct", "import", "public", "const", "return", "for", "x",
      "1", "{",     "}",       "(",      ")",      "[",      "]",     ";",      ":",   ","};
  for (std::size_t i = 0; i < tokens.size(); ++i)
    for (const std::string &other : others)
      for (const bool isReplaced : {true, false}) {
        std::string changed;
        for (std::size_t j = 0; j < tokens.size(); ++j)
          changed += (j == i ? other + " " : "") + (j == i && isReplaced ? "" : tokens[j] + " ");
        messages(changed); // which reads all that the message refers to
      }
}

TEST(DeclarationErrors, Variables) {
  EXPECT_EQ(inFunction("float = 3;"), "") << "an assignment to something called float";
  EXPECT_EQ(inFunction("const float;"), "E0111 2:12-2:13 expected a name, found `;`\n");
  EXPECT_EQ(inFunction("float a = ;"), "E0111 2:11-2:12 expected an expression, found `;`\n");
  EXPECT_EQ(inFunction("float a = 1, ;"), "E0111 2:14-2:15 expected a name, found `;`\n");
  EXPECT_EQ(inFunction("float a b;"), "E0111 2:9-2:10 expected `;`, found `b`\n");
  EXPECT_EQ(inFunction("float a[2] = {1, 2 3};"),
            "E0111 2:20-2:21 expected `,` or `}`, found `3`\n");
  EXPECT_EQ(inFunction("float a[2] = {1, , 3};"),
            "E0111 2:18-2:19 expected an expression, found `,`\n");
  EXPECT_EQ(messages("float a 3;\nvoid f() { }"), "E0111 1:9-1:10 expected `;`, found `3`\n");
  EXPECT_EQ(messages("struct S { float f() { } };"),
            "E0111 1:18-1:19 expected a field, found function `f`\n");
}

TEST(DeclarationErrors, Parameters) {
  EXPECT_EQ(messages("void f(float a float b, vec3 c) { x y z; }\n"),
            "E0111 1:16-1:21 expected `,` or `)`, found `float`\n"
            "E0111 1:39-1:40 expected `;`, found `z`\n");
  EXPECT_EQ(messages("void f(float a,) { }\n"), "E0111 1:16-1:17 expected a type, found `)`\n");
  EXPECT_EQ(messages("void f(, float a) { }\n"), "E0111 1:8-1:9 expected a parameter, found `,`\n");
}

TEST(DeclarationErrors, Imports) {
  EXPECT_EQ(messages("import ;\nimport std.;\nimport std.a b;\nimport <a>;\n"),
            "E0111 1:8-1:9 expected a module or a file in quotes, found `;`\n"
            "E0111 2:12-2:13 expected the name of a module, found `;`\n"
            "E0111 3:14-3:15 expected `;`, found `b`\n"
            "E0111 4:8-4:9 expected a module or a file in quotes, found `<`\n");
}

TEST(DeclarationErrors, StatementsOutsideOfFunctions) {
  EXPECT_EQ(messages("if (a) { b; }\nvoid f() { }\n"),
            "E0111 1:1-1:3 expected a declaration, found `if`\n");
  EXPECT_EQ(messages("a = 3;\nvoid f() { }\n"), "E0111 1:3-1:4 expected a name, found `=`\n");
  EXPECT_EQ(messages("3;\nvoid f() { }\n"), "E0111 1:1-1:2 expected a declaration, found `3`\n");
}

//===----------------------------------------------------------------------===//
// Statements and expressions
//===----------------------------------------------------------------------===//

TEST(StatementErrors, AreReportedOnceEach) {
  EXPECT_EQ(inFunction("if a > 3 { b; }"), "E0111 2:4-2:5 expected `(`, found `a`\n");
  EXPECT_EQ(inFunction("if () b;"), "E0111 2:5-2:6 expected an expression, found `)`\n");
  EXPECT_EQ(inFunction("if (a b) { c; } else { d; }"), "E0111 2:7-2:8 expected `)`, found `b`\n");
  EXPECT_EQ(inFunction("else { a; }"), "E0111 2:1-2:5 expected a statement, found `else`\n");
  EXPECT_EQ(inFunction("for (int i = 0, i < 3; i++) { }"),
            "E0111 2:19-2:20 expected `;`, found `<`\n");
  EXPECT_EQ(inFunction("for (int i = 0; i < 3) { }"), "E0111 2:22-2:23 expected `;`, found `)`\n");
  EXPECT_EQ(inFunction("while { a; }"), "E0111 2:7-2:8 expected `(`, found `{`\n");
  EXPECT_EQ(inFunction("do { a; } until (b);"),
            "E0111 2:11-2:16 expected `while`, found `until`\n");
  EXPECT_EQ(inFunction("switch (a) { case 1 b; default: c; }"),
            "E0111 2:21-2:22 expected `:`, found `b`\n");
  EXPECT_EQ(inFunction("illuminance { a; }"), "E0111 2:13-2:14 expected `;`, found `{`\n");
  EXPECT_EQ(inFunction("illuminance () { a; }"), "");
  EXPECT_EQ(inFunction("illuminance (P,) { a; }"),
            "E0111 2:16-2:17 expected an expression, found `)`\n");
}

TEST(StatementErrors, ElseHasANote) {
  EXPECT_EQ(Parsed("void f() { else a; }").diagnostics.all().at(0).notes.at(0),
            "there is no `if` that it could belong to");
}

TEST(ExpressionErrors, AreReportedOnceEach) {
  EXPECT_EQ(inFunction("a = = b;"), "E0111 2:5-2:6 expected an expression, found `=`\n");
  EXPECT_EQ(inFunction("a = b +;"), "E0111 2:8-2:9 expected an expression, found `;`\n");
  EXPECT_EQ(inFunction("a = 3 4;"), "E0111 2:7-2:8 expected `;`, found `4`\n");
  EXPECT_EQ(inFunction("a = (b c) + d;"), "E0111 2:8-2:9 expected `,` or `)`, found `c`\n");
  EXPECT_EQ(inFunction("f(a b);"), "E0111 2:5-2:6 expected `,` or `)`, found `b`\n");
  EXPECT_EQ(inFunction("f(, a);"), "E0111 2:3-2:4 expected an expression, found `,`\n");
  EXPECT_EQ(inFunction("f(a, );"), "E0111 2:6-2:7 expected an expression, found `)`\n");
  EXPECT_EQ(inFunction("a[1 2] = 3;"), "E0111 2:5-2:6 expected `]`, found `2`\n");
  EXPECT_EQ(inFunction("a[b(1 2)] = 3;"), "E0111 2:7-2:8 expected `,` or `)`, found `2`\n");
  EXPECT_EQ(inFunction("a[1 +] = 3;"), "E0111 2:6-2:7 expected an expression, found `]`\n");
  EXPECT_EQ(inFunction("a ? b;"), "E0111 2:6-2:7 expected `:`, found `;`\n");
  EXPECT_EQ(inFunction("a.3;"), "E0111 2:2-2:4 expected `;`, found `.3`\n");
  EXPECT_EQ(inFunction("a. = 3;"), "E0111 2:4-2:5 expected a name, found `=`\n");
  EXPECT_EQ(inFunction("a[] = 3;"), "E0123 2:2-2:4 expected an index between `[` and `]`\n");
  EXPECT_EQ(inFunction("3(4);"), "E0122 2:1-2:2 expression is not callable\n");
  EXPECT_EQ(inFunction("(a)(b);"), "E0122 2:1-2:4 expression is not callable\n");
  EXPECT_EQ(inFunction("f()[1](2);"), "E0122 2:1-2:7 expression is not callable\n");
  EXPECT_EQ(inFunction("f({1, 2});"), "E0111 2:3-2:4 expected an expression, found `{`\n");
}

TEST(ExpressionErrors, HabitsOfC) {
  EXPECT_EQ(Parsed("void f() {\n  a->b = c;\n}\n").shown(),
            "test.rtsl:2:4: error[E0111]: expected `.`, found `->`\n"
            "  |\n"
            "2 |   a->b = c;\n"
            "  |    ^^\n"
            "help: replace `->` by `.`\n"
            "  |\n"
            "2 |   a.b = c;\n"
            "  |    ~\n"
            "\n");
  EXPECT_EQ(Parsed("void f() {\n  a = (float)b;\n}\n").shown(),
            "test.rtsl:2:7: error[E0127]: RTSL has no casts\n"
            "  |\n"
            "2 |   a = (float)b;\n"
            "  |       ^^^^^^^\n"
            "help: replace `(float)` by `float(`\n"
            "  |\n"
            "2 |   a = float(b;\n"
            "  |       ~~~~~~\n"
            "help: insert `)`\n"
            "  |\n"
            "2 |   a = (float)b);\n"
            "  |               +\n"
            "\n");
}

TEST(Recovery, EachStatementGivesItsOwnMessage) {
  EXPECT_EQ(messages("void f() {\n"
                     "  a = = 1;\n"
                     "  if (b +) { c d e; }\n"
                     "  float x = 3 $ 4;\n"
                     "  good();\n"
                     "  for (;;) { y = ; }\n"
                     "}\n"
                     "void g() { z z z }\n"
                     "class A { }\n"
                     "class B : A { float; };\n"),
            "E0111 2:7-2:8 expected an expression, found `=`\n"
            "E0111 3:10-3:11 expected an expression, found `)`\n"
            "E0111 3:18-3:19 expected `;`, found `e`\n"
            "E0103 4:15-4:16 unknown character `$`\n"
            "E0111 6:18-6:19 expected an expression, found `;`\n"
            "E0111 8:16-8:17 expected `;`, found `z`\n"
            "E0112 9:12-9:12 missing `;` after class `A`\n"
            "E0111 10:20-10:21 expected a name, found `;`\n");
}

TEST(Recovery, KeepsWhatWasUnderstood) {
  const Parsed parsed("void f() {\n"
                      "  float a = , b = 2;\n"
                      "  c = +;\n"
                      "  d(1 2);\n"
                      "  if (e !) g();\n"
                      "  float h i;\n"
                      "  j k 3;\n"
                      "  return m;\n"
                      "}\n");
  EXPECT_EQ(parsed.tree(), "unit\n"
                           "  function void f\n"
                           "    block\n"
                           "      variable float a\n"
                           "        error\n"
                           "      variable float b\n"
                           "        int 2\n"
                           "      expression\n"
                           "        error\n"
                           "      expression\n"
                           "        error\n"
                           "      if\n"
                           "        error\n"
                           "        expression\n"
                           "          call g\n"
                           "      variable float h\n"
                           "      variable j k\n"
                           "      return\n"
                           "        name m\n");
}

/// Leaves out or repeats each word of a file in turn, and looks how many messages that one slip
/// gives.
TEST(Recovery, OneSlipGivesOneMessage) {
  const std::string text =
      "// A dielectric.\n"
      "import std.fresnel;\n"
      "\n"
      "class Glass : rt_Material;\n"
      "\n"
      "public float ior = 1.5, weights[2] = {1., 2.f};\n"
      "private rt_Texture tint;\n"
      "scratch vec3 n;\n"
      "\n"
      "void constructor(float i, vec3 a[2]) { ior = i; }\n"
      "\n"
      "float fresnel(float c) {\n"
      "  float r = (1 - ior) / (1 + ior), q[3];\n"
      "  return r * r + (1 - r * r) * pow(1 - c, 5);\n"
      "}\n"
      "\n"
      "void shade() {\n"
      "  color c = trace(rt_HitPoint, reflect(d, n)) * fresnel(dot(a, b).x);\n"
      "  if (c.x > 3 && !done) f(); else if (b) { x.xy = y.yx; } else return;\n"
      "  for (int i = 0; i < 10; ++i) a[i].x += float[3](1, 2, 3)[i];\n"
      "  while (true) { x--; break; }\n"
      "  do { ; } while (x <= 3 ? false : true);\n"
      "  switch (x) { case 1: case 2: y = 3; break; default: print(\"%f\", x); }\n"
      "  illuminance (rt_HitPoint, n, 1.57) {\n"
      "    c += rt_LightColor * tint.lookup();\n"
      "  }\n"
      "  rt_SampleColor = c;\n"
      "}\n";
  SourceManager sources;
  const FileId file = sources.add("test.rtsl", text);
  Diagnostics diagnostics(sources);
  const TokenList list = tokenize(file, diagnostics);
  ASSERT_FALSE(diagnostics.hasErrors());
  std::size_t slips = 0, silent = 0, several = 0;
  for (const Token &token : list.tokens) {
    if (token.begin == token.end)
      continue;
    const std::string word = text.substr(token.begin, token.end - token.begin);
    for (const bool isRepeated : {false, true}) {
      std::string slip = text;
      if (isRepeated)
        slip.insert(token.begin, word + " ");
      else
        slip.erase(token.begin, word.size());
      const Parsed parsed(slip);
      const std::size_t count = parsed.diagnostics.errorCount();
      ++slips;
      silent += count == 0; // still RTSL: `+` for `++`, say
      several += count > 1;
      EXPECT_LE(count, 2u) << slip.substr(token.begin > 40 ? token.begin - 40 : 0, 80) << "\n"
                           << parsed.messages();
    }
  }
  EXPECT_GT(slips, 500u);
  EXPECT_LT(silent * 4, slips);
  EXPECT_LT(several * 50, slips) << "more than 2 of 100 slips give a second message";
}

} // namespace
} // namespace rtsl
