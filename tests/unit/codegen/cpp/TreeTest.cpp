// The tree that is printed as C++: where it needs parentheses, braces and line breaks, and its
// text.
#include "codegen/cpp/tree/Print.h"

#include <gtest/gtest.h>

namespace rtsl::cpp {
namespace {

const Code a = name("a"), b = name("b"), c = name("c");

std::string text(const Code &code) {
  return print(code);
}
Code minus(const Code &code) {
  return unary(UnaryOperator::Minus, code);
}
Code sum(const Code &x, const Code &y) {
  return binary(Operator::Add, x, y);
}
Code product(const Code &x, const Code &y) {
  return binary(Operator::Multiply, x, y);
}
Code both(const Code &x, const Code &y) {
  return binary(Operator::And, x, y);
}
Code either(const Code &x, const Code &y) {
  return binary(Operator::Or, x, y);
}

TEST(TreeExpressions, HaveTheParenthesesThatTheirOperatorsNeed) {
  EXPECT_EQ(text(sum(a, product(b, c))), "a + b * c");
  EXPECT_EQ(text(product(sum(a, b), c)), "(a + b) * c");
  EXPECT_EQ(text(sum(sum(a, b), c)), "a + b + c");
  EXPECT_EQ(text(sum(a, sum(b, c))), "a + (b + c)");
  EXPECT_EQ(text(binary(Operator::Subtract, a, binary(Operator::Subtract, b, c))), "a - (b - c)");
  EXPECT_EQ(text(member(sum(a, b), "x")), "(a + b).x");
  EXPECT_EQ(text(memberOfPointer(call("f", {a}), "x")), "f(a)->x");
  EXPECT_EQ(text(subscript(a, sum(b, c))), "a[b + c]");
  EXPECT_EQ(text(call("f", {sum(a, b), comma(b, c)})), "f(a + b, (b, c))");
  EXPECT_EQ(text(sum(conditional(a, b, c), a)), "(a ? b : c) + a");
  EXPECT_EQ(text(conditional(conditional(a, b, c), a, conditional(b, a, c))),
            "(a ? b : c) ? a : b ? a : c");
  EXPECT_EQ(text(assign(a, assign(b, c))), "a = b = c");
  EXPECT_EQ(text(assign(Operator::Add, a, sum(b, c))), "a += b + c");
  EXPECT_EQ(text(member(unary(UnaryOperator::Dereference, a), "x")), "(*a).x");
}

TEST(TreeExpressions, HaveParenthesesWhereTheyHelpReaders) {
  EXPECT_EQ(text(either(both(a, b), c)), "(a && b) || c");
  EXPECT_EQ(text(both(both(a, b), c)), "a && b && c");
  EXPECT_EQ(text(both(a, both(b, c))), "a && (b && c)");
  EXPECT_EQ(text(binary(Operator::Less, sum(a, b), c)), "(a + b) < c");
  EXPECT_EQ(text(binary(Operator::ShiftLeft, a, sum(b, c))), "a << (b + c)");
  EXPECT_EQ(
      text(binary(Operator::BitOr, binary(Operator::BitOr, a, b), binary(Operator::BitAnd, a, c))),
      "a | b | (a & c)");
}

TEST(TreeExpressions, KeepSignsApart) {
  EXPECT_EQ(text(minus(minus(a))), "-(-a)");
  EXPECT_EQ(text(sum(a, minus(b))), "a + (-b)");
  EXPECT_EQ(text(binary(Operator::Subtract, a, product(minus(b), c))), "a - (-b * c)");
  EXPECT_EQ(text(binary(Operator::Subtract, a, unary(UnaryOperator::Decrement, b))), "a - (--b)");
  EXPECT_EQ(text(binary(Operator::Subtract, a, member(minus(b), "x"))), "a - (-b).x");
  EXPECT_EQ(text(product(a, minus(b))), "a * -b");
  EXPECT_EQ(text(integer(-7)), "-7");
  EXPECT_EQ(text(integer(-2147483648LL)), "std::numeric_limits<int>::min()");
}

TEST(TreeExpressions, KeepTheAuthorsParenthesesOnce) {
  EXPECT_EQ(text(product(parentheses(sum(a, b)), c)), "(a + b) * c");
  EXPECT_EQ(text(sum(parentheses(product(a, b)), c)), "(a * b) + c");
  EXPECT_EQ(text(parentheses(parentheses(sum(a, b)))), "(a + b)");
}

TEST(TreeExpressions, AreComparedByStructure) {
  EXPECT_TRUE(same(sum(a, b), parentheses(sum(name("a"), parentheses(name("b"))))));
  EXPECT_FALSE(same(sum(a, b), sum(b, a)));
  EXPECT_FALSE(same(sum(a, b), binary(Operator::Subtract, a, b)));
  EXPECT_FALSE(same(assign(a, b), assign(Operator::Add, a, b)));
  EXPECT_FALSE(same(a, Code()));
  EXPECT_TRUE(same(Code(), Code()));
  EXPECT_FALSE(same(lambda({}), lambda({}))); // their effects are unknown
}

TEST(TreeExpressions, ListTheNamesThatTheyMention) {
  const Code code = call("f", {member(a, "x"), lambda({returning(b)})});
  EXPECT_TRUE(mentions(code, "a"));
  EXPECT_TRUE(mentions(code, "b"));
  EXPECT_TRUE(mentions(code, "f"));
  EXPECT_FALSE(mentions(code, "x")) << "a member is no variable";
  EXPECT_TRUE(contains(code, member(a, "x")));
  EXPECT_FALSE(contains(code, member(a, "y")));
}

TEST(TreeExpressions, DetectZerosAndOpposites) {
  for (const Code &zero : {integer(0), literal("0.0f", true), boolean(false), list("", {}),
                           construct("glm::vec3", {literal("0.0f", true)})})
    EXPECT_TRUE(isZero(zero)) << print(zero);
  for (const Code &other : {integer(1), minus(literal("0.0f", true)),
                            construct("glm::vec2", {integer(0), integer(1)}), a})
    EXPECT_FALSE(isZero(other)) << print(other);
  EXPECT_EQ(text(negated(a)), "!a");
  EXPECT_EQ(text(negated(unary(UnaryOperator::Not, parentheses(both(a, b))))), "a && b");
  EXPECT_EQ(text(negated(both(a, b))), "!(a && b)");
}

TEST(TreeVariables, DoNotNameATypeTwice) {
  EXPECT_EQ(print(declaration("Ray", "r", list("Ray", {a, b}))), "Ray r{a, b};\n");
  EXPECT_EQ(print(declaration("Ray", "r", list("", {}))), "Ray r{};\n");
  EXPECT_EQ(print(declaration("Ray", "r", member(list("Ray", {a}), "x"))), "Ray r = Ray{a}.x;\n");
  EXPECT_EQ(print(declaration("Ray", "r", list("Other", {a}))), "Ray r = Other{a};\n");
  EXPECT_EQ(print(declaration("static constexpr", "rtsl::array<int, 2>", "t",
                              array("rtsl::array<int, 2>", {integer(1), integer(2)}))),
            "static constexpr rtsl::array<int, 2> t{{1, 2}};\n");
  EXPECT_EQ(print(declaration("float", "x", comma(a, b))), "float x = (a, b);\n");
}

TEST(TreeVariables, AreArraysOfC) {
  Statement table = declaration("static constexpr", "int", "t", list("", {integer(1), integer(2)}));
  table.declarators.front().isCArray = true;
  EXPECT_EQ(print(table), "static constexpr int t[] = {1, 2};\n");
}

TEST(TreeStatements, HaveBracesWhereTheyNeedThem) {
  const Statement one = statement(a), other = statement(b);
  EXPECT_EQ(print(branch(c, {one})), "if (c)\na;\n");
  EXPECT_EQ(print(branch(c, {one, other})), "if (c) {\na;\nb;\n}\n");
  EXPECT_EQ(print(branch(c, {})), "if (c) {\n}\n");
  EXPECT_EQ(print(branch(c, {declaration("int", "i", a)})), "if (c) {\nint i = a;\n}\n");
  Statement commented = one;
  commented.comment = "// why";
  EXPECT_EQ(print(branch(c, {commented})), "if (c) {\n// why\na;\n}\n");
  EXPECT_EQ(print(branch(c, {branch(a, {one})})), "if (c)\nif (a)\na;\n");
}

TEST(TreeStatements, GiveAnElseToItsIf) {
  Statement inner = branch(a, {statement(b)});
  Statement outer = branch(c, {inner});
  outer.otherwise = {statement(a)};
  EXPECT_EQ(print(outer), "if (c) {\nif (a)\nb;\n}\nelse\na;\n");
  Statement chain = branch(c, {statement(a)});
  chain.otherwise = {inner};
  EXPECT_EQ(print(chain), "if (c)\na;\nelse if (a)\nb;\n");
}

TEST(TreeStatements, KeepWhatTheAuthorWroteAroundThem) {
  Statement one = statement(a);
  one.comment = "// above";
  one.trailing = "// behind";
  one.place = SourcePlace{"a \"b\".rtsl", 7};
  one.hasSpace = true;
  EXPECT_EQ(print(Statements{statement(b), one}),
            "b;\n\n// above\n#line 7 \"a \\\"b\\\".rtsl\"\na; // behind\n");
}

TEST(TreeStatements, PrintLoopsAndSwitches) {
  Statement counting = simple(StatementKind::For);
  counting.init = {declaration("int", "i", integer(0))};
  counting.value = binary(Operator::Less, name("i"), b);
  counting.step = unary(UnaryOperator::Increment, name("i"));
  counting.body = {statement(a)};
  EXPECT_EQ(print(counting), "for (int i = 0; i < b; ++i)\na;\n");
  Statement choice = simple(StatementKind::Switch);
  choice.value = a;
  choice.arms = {{{integer(1), integer(-2)}, false, true, {simple(StatementKind::Break)}},
                 {{}, true, false, {returning(b)}}};
  EXPECT_EQ(print(choice),
            "switch (a) {\ncase 1:\ncase -2: {\nbreak;\n}\ndefault:\nreturn b;\n}\n");
}

TEST(TreeStatements, ListWhatTheyAssign) {
  EXPECT_EQ(assignedName(statement(assign(a, b))), "a");
  EXPECT_EQ(assignedName(statement(assign(member(a, "x"), b))), "");
  EXPECT_EQ(assignedName(statement(a)), "");
  EXPECT_EQ(text(assignedValue(statement(assign(Operator::Add, a, b)))), "a + b");
  EXPECT_TRUE(mentions(branch(c, {statement(assign(a, b))}), "b"));
  EXPECT_FALSE(mentions(declaration("int", "i", b), "i")) << "a declaration makes the name";
}

TEST(TreeDeclarations, PrintFunctions) {
  Function made;
  made.specifiers = "inline";
  made.result = "float";
  made.name = "f";
  Parameter unread = byValue("int", "i");
  unread.isUnread = true;
  Parameter unnamed = byPointer("void", "p");
  unnamed.isCommented = true;
  made.parameters = {byReference("State", "rt"), byConstReference("Ray", "ray"), unread, unnamed};
  const std::string head = "inline float f(State &rt, const Ray &ray, [[maybe_unused]] int i, "
                           "void */*p*/)";
  EXPECT_EQ(print(declare(made)), head + ";\n") << "a prototype";
  made.body = Statements{returning(a)};
  EXPECT_EQ(print(declare(made)), head + " {\nreturn a;\n}\n");
  made.caught = "rtsl::EndOfAnyHit";
  EXPECT_EQ(print(declare(made)),
            head + " try {\nreturn a;\n} catch (const rtsl::EndOfAnyHit &) {\n}\n");
}

TEST(TreeDeclarations, PrintMethodsAndTemplates) {
  Function method;
  method.specifiers = "virtual";
  method.result = "void";
  method.name = "g";
  method.isConst = method.isOverride = true;
  EXPECT_EQ(print(declare(method)), "virtual void g() const override;\n");
  Function made;
  made.templateParameters = "typename Visit";
  made.result = "void";
  made.name = "visit";
  made.parameters = {byValue("Visit", "at")};
  made.body = Statements{statement(call("at", {integer(3), a}))};
  EXPECT_EQ(print(declare(made)),
            "template <typename Visit>\nvoid visit(Visit at) {\nat(3, a);\n}\n");
}

TEST(TreeDeclarations, PrintStructs) {
  Struct made;
  made.name = "Ray";
  EXPECT_EQ(print(declareStruct("Ray")), "struct Ray;\n");
  EXPECT_EQ(print(declare(made)), "struct Ray {\n};\n");
  made.base = "Base";
  made.members = {declare(Using{"Base::Base"}),
                  declare(Variable{"static constexpr", "const char *", {"name", string("x")}})};
  Variable flag = {{}, "bool", {"isLit", {}}};
  flag.bits = 1;
  appendApart(made.members, declare(flag));
  made.members.back().trailing = "// of line 3";
  EXPECT_EQ(print(declare(made, "// A ray.")),
            "// A ray.\nstruct Ray : Base {\nusing Base::Base;\n"
            "static constexpr const char * name = \"x\";\n\nbool isLit : 1; // of line 3\n};\n");
}

TEST(TreeDeclarations, PrintEnumsAndNamespaces) {
  const Declaration ids = declare(Enum{"Id", "unsigned", {{"A", 1u}, {"B", std::nullopt}}});
  EXPECT_EQ(print(ids), "enum class Id : unsigned { A = 1, B };\n");
  EXPECT_EQ(print(declare(Namespace{"shaders", {declare(Alias{"Color", "rtsl::Color<3>"})}})),
            "namespace shaders {\n\nusing Color = rtsl::Color<3>;\n\n} // namespace shaders\n");
  EXPECT_EQ(print(declare(Namespace{"", {ids}})),
            "namespace {\n\n" + print(ids) + "\n} // namespace\n");
}

TEST(TreeDeclarations, PrintWhatStandsAboveAFile) {
  Declarations file = {declare(OnlyComment{}, "// Made by rtslc."), declare(Define{"RTSL_FAST"}),
                       declare(Include{"rtsl/shader.h"})};
  file[1].trailing = "// why";
  appendApart(file, declareStruct("Ray"));
  file.back().comment = "/// Rays.";
  file.back().place = SourcePlace{"a.rtsl", 2};
  EXPECT_EQ(print(file), "// Made by rtslc.\n#define RTSL_FAST // why\n#include <rtsl/shader.h>\n\n"
                         "/// Rays.\n#line 2 \"a.rtsl\"\nstruct Ray;\n");
}

TEST(TreeDeclarations, ArePutApartByEmptyLines) {
  Declarations all;
  appendApart(all, Declarations());
  EXPECT_TRUE(all.empty());
  appendApart(all, {declareStruct("A"), declareStruct("B")});
  appendApart(all, {declareStruct("C"), declareStruct("D")});
  append(all, {declareStruct("E")});
  EXPECT_EQ(print(all), "struct A;\nstruct B;\n\nstruct C;\nstruct D;\nstruct E;\n");
}

} // namespace
} // namespace rtsl::cpp
