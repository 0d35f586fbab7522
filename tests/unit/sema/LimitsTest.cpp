//===- LimitsTest.cpp - long chains and deep nesting ----------------------===//
//
// What no author writes but a generator may: it is checked or refused, in reasonable time and
// without overflowing the stack.
//
//===----------------------------------------------------------------------===//
#include "Harness.h"

#include "sema/check/Program.h"
#include "sema/typed/TypeProperties.h"

#include <gtest/gtest.h>

using namespace rtsl;
using namespace rtsl::test;

namespace {

std::string repeat(unsigned count, const std::string &text) {
  std::string result;
  for (unsigned i = 0; i != count; ++i)
    result += text;
  return result;
}

/// Replaces every `#` by a number and every `@` by the number after it.
std::string numbered(unsigned count, const std::string &pattern) {
  std::string result;
  for (unsigned i = 0; i != count; ++i)
    for (char c : pattern)
      result += c == '#' ? std::to_string(i) : c == '@' ? std::to_string(i + 1) : std::string(1, c);
  return result;
}

TEST(Limits, ChainsOfOperatorsUpToALimit) {
  EXPECT_EQ(render(*checkText("float f(float x) { return x" + repeat(200, " + x") + "; }")), "");
}

TEST(Limits, TooDeepTreesAreBuiltByHandAndRefused) {
  // The parser has limits of its own; sema is given a tree that is deeper than its own limit all
  // the same.
  SourceManager sources;
  Diagnostics diagnostics(sources);
  const FileId file = sources.add("deep.rtsl", std::string(64, ' '));
  const SourceRange range{file, 0, 8};
  auto number = [&] {
    auto literal = std::make_unique<ast::IntLiteral>();
    literal->value = 1;
    literal->spelling = "1";
    literal->range = range;
    return literal;
  };
  auto chain = [&](unsigned length) {
    ast::ExprPtr expr = number();
    for (unsigned i = 0; i != length; ++i) {
      auto sum = std::make_unique<ast::BinaryExpr>();
      sum->op = ast::BinaryOp::Add;
      sum->left = std::move(expr);
      sum->right = number();
      sum->range = range;
      expr = std::move(sum);
    }
    return expr;
  };
  auto constant = [&](const std::string &name, ast::ExprPtr value) {
    ast::VariableDecl declaration;
    declaration.isConst = true;
    declaration.name = {name, range};
    declaration.type.name = {"int", range};
    declaration.type.range = range;
    declaration.init = std::move(value);
    declaration.range = range;
    return declaration;
  };
  ast::TranslationUnit unit;
  unit.file = file;
  unit.constants.push_back(constant("good", chain(maxTreeDepth - 10)));
  unit.constants.push_back(constant("bad", chain(maxTreeDepth + 10)));
  ast::ExprPtr nested = number();
  for (unsigned i = 0; i != maxRecursion + 10; ++i) {
    auto minus = std::make_unique<ast::UnaryExpr>();
    minus->op = ast::UnaryOp::BitNot;
    minus->operand = std::move(nested);
    minus->range = {file, 0, 20 + i % 7};
    nested = std::move(minus);
  }
  unit.constants.push_back(constant("nested", std::move(nested)));
  auto module = check({&unit}, {}, diagnostics);
  ASSERT_EQ(diagnostics.all().size(), 2u);
  EXPECT_EQ(diagnostics.all()[0].code, Code::expressionTooDeep);
  EXPECT_EQ(diagnostics.all()[1].code, Code::expressionTooDeep);
  ASSERT_EQ(module->constants.size(), 3u);
  ASSERT_TRUE(module->constants[0]->constant);
  EXPECT_EQ(module->constants[0]->constant->scalars[0].i, static_cast<int>(maxTreeDepth) - 9);
  EXPECT_FALSE(module->constants[1]->constant);
}

TEST(Limits, TooDeepStatementsAreRefused) {
  SourceManager sources;
  Diagnostics diagnostics(sources);
  const FileId file = sources.add("deep.rtsl", std::string(64, ' '));
  const SourceRange range{file, 0, 8};
  ast::TranslationUnit unit;
  unit.file = file;
  auto function = [&](const std::string &name, ast::StmtPtr inner) {
    ast::FunctionDecl declaration;
    declaration.name = {name, range};
    declaration.returnType.name = {"void", range};
    declaration.body = std::make_unique<ast::CompoundStmt>();
    declaration.body->body.push_back(std::move(inner));
    return declaration;
  };
  ast::StmtPtr blocks = std::make_unique<ast::CompoundStmt>();
  for (unsigned i = 0; i != maxRecursion + 10; ++i) {
    auto outer = std::make_unique<ast::CompoundStmt>();
    outer->body.push_back(std::move(blocks));
    outer->range = {file, 0, 9};
    blocks = std::move(outer);
  }
  unit.functions.push_back(function("blocks", std::move(blocks)));
  ast::StmtPtr branches;
  for (unsigned i = 0; i != maxRecursion + 10; ++i) {
    auto outer = std::make_unique<ast::IfStmt>();
    auto condition = std::make_unique<ast::BoolLiteral>();
    condition->range = range;
    outer->condition = std::move(condition);
    outer->thenStmt = std::make_unique<ast::CompoundStmt>();
    outer->elseStmt = std::move(branches);
    outer->range = {file, 0, 10};
    branches = std::move(outer);
  }
  unit.functions.push_back(function("branches", std::move(branches)));
  check({&unit}, {}, diagnostics);
  ASSERT_EQ(diagnostics.all().size(), 2u);
  EXPECT_EQ(diagnostics.all()[0].code, Code::statementTooDeep);
  EXPECT_EQ(diagnostics.all()[1].code, Code::statementTooDeep);
}

TEST(Limits, ListsWhereTheSyntaxHasNoneAreRefused) {
  // The grammar has lists in initialisers alone; a tree that another program makes may have them
  // anywhere.
  SourceManager sources;
  Diagnostics diagnostics(sources);
  const FileId file = sources.add("list.rtsl", std::string(64, ' '));
  const SourceRange range{file, 4, 8};
  auto list = std::make_unique<ast::InitializerListExpr>();
  list->range = range;
  auto negated = std::make_unique<ast::UnaryExpr>();
  negated->op = ast::UnaryOp::Minus;
  negated->operand = std::move(list);
  negated->range = {file, 3, 8};
  ast::TranslationUnit unit;
  unit.file = file;
  ast::VariableDecl declaration;
  declaration.isConst = true;
  declaration.name = {"x", range};
  declaration.type.name = {"float", range};
  declaration.init = std::move(negated);
  unit.constants.push_back(std::move(declaration));
  check({&unit}, {}, diagnostics);
  ASSERT_EQ(diagnostics.all().size(), 1u);
  EXPECT_EQ(diagnostics.all()[0].code, Code::misplacedInitializerList);
  EXPECT_EQ(diagnostics.all()[0].range, range);
}

TEST(Limits, StructsNestToALimit) {
  const std::string flat = "struct S0 { float x; };\n";
  EXPECT_EQ(checkText(flat + numbered(60, "struct S@ { S# inner; };\n"))->numbers(), "");
  const std::unique_ptr<Checked> deep =
      checkText(flat + numbered(maxTypeNesting + 5, "struct S@ { S# inner; };\n"));
  EXPECT_EQ(deep->numbers().substr(0, 5), "E0606");
}

TEST(Limits, AThousandStructsInAChainDoNotOverflow) {
  const std::unique_ptr<Checked> deep =
      checkText("struct S0 { float x; };\n" + numbered(5000, "struct S@ { S# inner; };\n"));
  EXPECT_TRUE(deep->diagnostics.hasErrors());
}

TEST(Limits, StructsAndConstantsThatNeedEachOtherUpToALimit) {
  const std::unique_ptr<Checked> checked =
      checkText(numbered(400, "struct S# { float x[N#]; };\n"
                              "const int N# = S@(float[1](1.0)) == S@(float[1](1.0)) ? 1 : 2;\n") +
                "struct S400 { float x[1]; };\n");
  EXPECT_NE(checked->numbers().find("E0606"), std::string::npos);
}

TEST(Limits, ArraysNestToALimit) {
  EXPECT_EQ(checkText("void f() { float x" + repeat(maxTypeNesting + 1, "[1]") + "; }")->numbers(),
            "E0606");
}

TEST(Limits, ConstantsThatComeInOrderMayDependOnOneAnother) {
  EXPECT_EQ(
      checkText("const int c0 = 1;\n" + numbered(3000, "const int c@ = c# + 1;\n"))->numbers(), "");
}

TEST(Limits, ConstantsInTheWrongOrderUpToALimit) {
  const std::string last = "const int c1000 = 1;\n";
  const std::unique_ptr<Checked> checked =
      checkText(numbered(1000, "const int c# = c@ + 1;\n") + last);
  EXPECT_NE(checked->numbers().find("E0611"), std::string::npos);
}

TEST(Limits, ClassesInAChainUpToALimit) {
  const std::string first = "class C0 : rt_Light { public float power; };\n";
  const std::string last =
      "class Last : C255 { void illumination() { rt_LightColor = color(power); } };\n";
  const std::unique_ptr<Checked> checked =
      checkText(first + numbered(255, "class C@ : C# { };\n") + last);
  EXPECT_EQ(render(*checked), "");
  EXPECT_TRUE(checked->module->findClass("Last")->derivesFrom(checked->module->findClass("C0")));
  EXPECT_EQ(checked->module->findClass("Last")->root, "rt_Light");
}

TEST(Limits, TenThousandClassesInAChain) {
  const std::unique_ptr<Checked> checked = checkText(
      "class C0 : rt_Light { public float power; };\n" + numbered(10000, "class C@ : C# { };\n") +
      "class Last : C10000 { void illumination() { rt_LightColor = color(power); } };\n");
  EXPECT_EQ(checked->numbers(), "E0423");
  const Diagnostic &diagnostic = checked->diagnostics.all().front();
  EXPECT_EQ(checked->sources.text(diagnostic.range), "C257");
}

TEST(Limits, TenThousandClassesSideBySide) {
  const std::unique_ptr<Checked> checked = checkText(
      "class Base : rt_Light { public float power; float half() { return 0.5 * power; } };\n" +
      numbered(10000,
               "class C# : Base { void illumination() { rt_LightColor = color(half()); } };\n"));
  EXPECT_EQ(render(*checked), "");
}

TEST(Limits, TenThousandClassesInACircle) {
  const std::unique_ptr<Checked> checked =
      checkText(numbered(10000, "class C# : C@ { };\n") + "class C10000 : C0 { };\n");
  EXPECT_EQ(checked->numbers(), "E0400"); // and nothing of the chain that is left of the cycle
}

TEST(Limits, TenThousandFunctionsInAChain) {
  const std::unique_ptr<Checked> checked =
      checkText("float f0() { return 1.0; }\n" + numbered(10000, "float f@() { return f#(); }\n"));
  EXPECT_EQ(render(*checked), "");
}

TEST(Limits, ManyErrorsInOneRun) {
  const std::unique_ptr<Checked> checked =
      checkText("void f() {\n" + numbered(50, "  x@;\n") + "}\n");
  EXPECT_EQ(checked->diagnostics.errorCount(), 50u);
}

TEST(Limits, ABodyWithManyVariables) {
  EXPECT_EQ(
      checkText("void f() {\n" + numbered(3000, "  float x# = 1.0; x#++;\n") + "}\n")->numbers(),
      "");
}

/// Whatever is wrong with a text, its messages have places in it and its module can be looked at.
void expectWholeResult(const std::string &text) {
  const std::unique_ptr<Checked> checked = checkText(text);
  for (const Diagnostic &diagnostic : checked->diagnostics.all()) {
    ASSERT_TRUE(diagnostic.range.isValid()) << diagnostic.message;
    ASSERT_LE(diagnostic.range.begin, diagnostic.range.end) << diagnostic.message;
    ASSERT_LE(diagnostic.range.end, checked->sources.text(diagnostic.range.file).size())
        << diagnostic.message;
  }
  const std::string dump = typed::dump(*checked->module);
  EXPECT_EQ(dump.find('\0'), std::string::npos);
}

TEST(Robustness, CallsOfFunctionsThatWereNeverDefined) {
  const std::unique_ptr<Checked> checked =
      checkText("float later(float x);\nfloat f() { return later(1.0); }");
  EXPECT_EQ(checked->numbers(), "E0214");
  EXPECT_NE(typed::dump(*checked->module).find("call later : float"), std::string::npos);
}

TEST(Robustness, EveryLineMayBeMissing) {
  for (const std::string &path : languageFiles("accepted.rtsl")) {
    const std::string text = readFile(path);
    for (std::size_t begin = 0; begin < text.size();) {
      const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
      expectWholeResult(text.substr(0, begin) + text.substr(end));
      begin = end;
    }
  }
}

} // namespace
