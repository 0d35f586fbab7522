// Each rewrite of printed statements, on the smallest statements that it changes or leaves alone.
#include "codegen/cpp/cleanup/CleanUp.h"
#include "codegen/cpp/cleanup/Braces.h"
#include "codegen/cpp/cleanup/ConditionalAssignments.h"
#include "codegen/cpp/cleanup/CountedLoops.h"
#include "codegen/cpp/cleanup/FieldAssignments.h"
#include "codegen/cpp/cleanup/FlagConditions.h"
#include "codegen/cpp/cleanup/JoinDeclarations.h"
#include "codegen/cpp/cleanup/OverwrittenZeros.h"
#include "codegen/cpp/tree/Print.h"

#include <gtest/gtest.h>

namespace rtsl::cpp {
namespace {

const Code a = name("a"), b = name("b"), c = name("c"), x = name("x"), i = name("i");
const Code zero = literal("0.0f", true);

/// `target = value;` of the variable `x` or `i`.
Statement set(const Code &target, const Code &value, bool isTemporary = false) {
  Statement made = statement(assign(target, value));
  made.written.identity = target->name == "i" ? &i : &x;
  made.written.type = target->name == "i" ? "int" : "float";
  made.written.isTemporary = isTemporary;
  return made;
}

Statement open(const Code &variable, const Code &otherwise) {
  Statement made = declaration("float", variable->name, otherwise);
  made.written.identity = variable->name == "i" ? &i : &x;
  made.isOpen = true;
  return made;
}

Statement commented(Statement made, const std::string &comment) {
  made.comment = comment;
  return made;
}

/// `at` has to be the last statement, also afterwards.
template <typename Rewrite>
std::string rewritten(Statements block, const Rewrite &rewrite) {
  std::size_t at = block.size() - 1;
  rewrite(block, at);
  EXPECT_EQ(at, block.size() - 1);
  return print(block);
}

TEST(OverwrittenZeros, AreRemoved) {
  EXPECT_EQ(rewritten({set(x, zero), set(x, a)}, removeOverwrittenZero), "x = a;\n");
  EXPECT_EQ(rewritten({statement(a), set(member(x, "f"), list("", {})), set(member(x, "f"), a)},
                      removeOverwrittenZero),
            "a;\nx.f = a;\n");
}

TEST(OverwrittenZeros, StayWhereTheyMatter) {
  const auto stays = [](const Statements &block) {
    EXPECT_EQ(rewritten(block, removeOverwrittenZero), print(block));
  };
  stays({set(x, zero), set(x, call("f", {x}))});
  stays({set(x, a), set(x, b)});
  stays({set(x, zero), set(i, b)});
  stays({set(x, zero), statement(assign(Operator::Add, x, b))});
  stays({commented(set(x, zero), "// why"), set(x, a)});
  stays({set(member(x, "f"), zero), set(member(x, "f"), call("f", {x}))}); // may read it
}

Statement setField(const std::string &field, const Code &value) {
  Statement made = set(member(x, field), value);
  made.field.all = {"f", "g"};
  made.field.isCopy = value->is(ExpressionKind::Member);
  return made;
}

TEST(FieldAssignments, BecomeOne) {
  EXPECT_EQ(rewritten({setField("f", member(a, "f")), setField("g", member(a, "g"))},
                      joinFieldAssignments),
            "x = a;\n");
  EXPECT_EQ(rewritten({setField("f", zero), setField("g", integer(0))}, joinFieldAssignments),
            "x = {};\n");
  EXPECT_EQ(rewritten({set(x, list("", {})), setField("f", member(a, "f")),
                       setField("g", member(a, "g"))},
                      joinFieldAssignments),
            "x = a;\n");
}

TEST(FieldAssignments, StayIfTheyAreNotACopy) {
  const auto stays = [](const Statements &block) {
    EXPECT_EQ(rewritten(block, joinFieldAssignments), print(block));
  };
  stays({setField("f", member(a, "f")), setField("g", member(b, "g"))});
  stays({setField("f", member(a, "g")), setField("g", member(a, "f"))});
  stays({setField("f", zero), setField("g", member(a, "g"))});
  stays({setField("g", member(a, "g"))});
  Statement ofOtherType = setField("g", member(a, "g"));
  ofOtherType.field.isCopy = false;
  stays({setField("f", member(a, "f")), ofOtherType});
}

std::string withFlag(const Statements &block, const Statements &after = {}) {
  Statements body = block;
  append(body, after);
  std::size_t at = block.size() - 1;
  inlineFlag(body, at, body, "frame");
  EXPECT_TRUE(body[at].is(StatementKind::If));
  return print(body);
}

TEST(FlagConditions, AreInlined) {
  const Statement flag = set(x, binary(Operator::Or, a, b), /*isTemporary=*/true);
  EXPECT_EQ(withFlag({flag, branch(x, {statement(c)})}), "if (a || b)\nc;\n");
  EXPECT_EQ(withFlag({commented(flag, "// why"), branch(negated(x), {statement(c)})}),
            "// why\nif (!(a || b))\nc;\n");
  const Statement read = declaration("float", "y", member(name("frame"), "y"));
  EXPECT_EQ(withFlag({flag, read, branch(x, {statement(c)})}),
            "float y = frame.y;\nif (a || b)\nc;\n");
}

TEST(FlagConditions, StayWhereTheyAreReadAgain) {
  const auto stays = [](const Statements &block, const Statements &after = {}) {
    Statements all = block;
    append(all, after);
    EXPECT_EQ(withFlag(block, after), print(all));
  };
  const Statement flag = set(x, a, /*isTemporary=*/true), test = branch(x, {statement(c)});
  stays({flag, test}, {statement(x)});
  stays({set(x, a), test}); // the author's
  stays({flag, statement(b), test});
  const Code saved = member(name("frame"), "y");
  stays({set(x, call("f", {saved}), true), declaration("float", "y", saved), test});
}

TEST(FlagUpdates, BecomeOperators) {
  EXPECT_EQ(rewritten({set(x, a), branch(x, {set(x, b)})}, joinFlagUpdate), "x = a && b;\n");
  EXPECT_EQ(rewritten({set(x, a), branch(negated(x), {set(x, b)})}, joinFlagUpdate),
            "x = a || b;\n");
  EXPECT_EQ(rewritten({set(x, a), branch(c, {set(x, b)})}, joinFlagUpdate),
            "x = a;\nif (c)\nx = b;\n");
}

std::string joined(const Code &condition, const Code &first, const Code &second,
                   Statements before = {}) {
  before.push_back(branch(condition, {set(x, first)}));
  before.back().otherwise = {set(x, second)};
  return rewritten(before, [](Statements &block, std::size_t &at) {
    joinConditionalAssignments(block, at, block);
  });
}

TEST(ConditionalAssignments, BecomeOne) {
  EXPECT_EQ(joined(c, a, b), "x = c ? a : b;\n");
  EXPECT_EQ(joined(c, boolean(true), b), "x = c || b;\n");
  EXPECT_EQ(joined(c, a, boolean(false)), "x = c && a;\n");
  EXPECT_EQ(joined(c, a, c), "x = c && a;\n");
  EXPECT_EQ(joined(negated(c), a, c), "x = c || a;\n");
}

TEST(ConditionalAssignments, InlineNamesOfTheCompiler) {
  Statement named = declaration("bool", "c", call("f", {}));
  EXPECT_EQ(joined(c, a, c, {named}), "bool c = f();\nx = c && a;\n");
  named.written.isTemporary = true;
  EXPECT_EQ(joined(c, a, c, {named}), "x = f() && a;\n");
}

TEST(ConditionalAssignments, HaveOneType) {
  const Code value = construct("glm::bvec2", {a});
  EXPECT_EQ(print(choose(c, value, b, "glm::bvec2", /*isVectorOfBools=*/true)),
            "c ? glm::bvec2(a) : glm::bvec2(b)");
}

std::string counted(const Code &condition, Statements body, const Statements &after = {}) {
  Statements all = {open(i, integer(0)), set(i, a), loop(condition, std::move(body))};
  append(all, after);
  std::size_t at = 2;
  makeCountedLoop(all, at, all);
  return print(all);
}

TEST(CountedLoops, BecomeFor) {
  const Statement step = set(i, call("rtsl::add", {i, integer(1)}));
  const Code below = binary(Operator::Less, i, b);
  EXPECT_EQ(counted(below, {statement(c), step}), "for (int i = a; i < b; ++i)\nc;\n");
  EXPECT_EQ(counted(binary(Operator::And, below, c), {statement(c), step}),
            "for (int i = a; i < b && c; ++i)\nc;\n");
  for (const std::string &left :
       {counted(below, {statement(c), step}, {statement(i)}), // is read later
        counted(below, {branch(c, {simple(StatementKind::Continue)}), step}),
        counted(binary(Operator::LessEqual, i, b), {statement(c), step}), // may overflow
        counted(below, {step, statement(c)})})
    EXPECT_NE(left.find("while ("), std::string::npos) << left;
}

std::string declared(Statements block) {
  joinDeclarations(block);
  return print(block);
}

TEST(JoinDeclarations, DeclaresWhereTheFirstValueIs) {
  EXPECT_EQ(declared({open(x, zero), statement(c), commented(set(x, a), "// why"), statement(x)}),
            "c;\n// why\nfloat x = a;\nx;\n");
  EXPECT_EQ(declared({open(x, zero), statement(c)}), "c;\n");
  EXPECT_EQ(declared({open(x, zero), branch(c, {set(x, a)}), statement(x)}),
            "float x = 0.0f;\nif (c)\nx = a;\nx;\n");
}

TEST(Braces, StandRoundWhatIsLong) {
  Statement test = branch(c, {statement(a)}, /*hasBraces=*/true);
  test.otherwise = {branch(a, {statement(b)})};
  setBraces(test);
  EXPECT_FALSE(test.hasBraces);
  EXPECT_TRUE(test.otherwiseHasBraces);
  Statement choice = simple(StatementKind::Switch);
  choice.arms = {{{integer(1)}, false, false, {declaration("int", "y", a)}},
                 {{}, true, true, {returning(b)}}};
  setBraces(choice);
  EXPECT_TRUE(choice.arms[0].hasBraces);
  EXPECT_FALSE(choice.arms[1].hasBraces);
}

TEST(CleanUp, WorksFromTheInside) {
  Statements body = {open(x, zero), set(x, a, true)};
  body.push_back(branch(x, {set(x, b, true)}));
  body.push_back(branch(x, {branch(c, {set(i, a)})}));
  body.back().body.front().otherwise = {set(i, b)};
  cleanUp(body, "frame");
  EXPECT_EQ(print(body), "if (a && b)\ni = c ? a : b;\n");
}

} // namespace
} // namespace rtsl::cpp
