//===- ExpressionTest.cpp - expressions and literals ----------------------===//
#include "Parsed.h"

#include <gtest/gtest.h>

#include <limits>

namespace rtsl {
namespace {

using namespace ast;
using test::Parsed;

// In the order of BinaryOp and UnaryOp.
const char *const binary[] = {"*",  "/",  "%",  "+", "-", "<<", ">>", "<",  ">", "<=",
                              ">=", "==", "!=", "&", "^", "|",  "&&", "^^", "||"};
const char *const unary[] = {"+", "-", "!", "~", "++", "--", "++", "--"};

/// The expression with a pair of brackets around each operation: shows how it was understood.
std::string grouped(const Expr *expr) {
  if (!expr)
    return "";
  const auto list = [](const std::vector<ExprPtr> &exprs) {
    std::string result;
    for (const ExprPtr &element : exprs)
      result += (result.empty() ? "" : ", ") + grouped(element.get());
    return result;
  };
  switch (expr->kind) {
  case ExprKind::IntLiteral:
    return static_cast<const IntLiteral &>(*expr).spelling;
  case ExprKind::FloatLiteral: {
    const auto &literal = static_cast<const FloatLiteral &>(*expr);
    return literal.spelling + literal.suffix;
  }
  case ExprKind::BoolLiteral:
    return static_cast<const BoolLiteral &>(*expr).value ? "true" : "false";
  case ExprKind::StringLiteral:
    return "'" + static_cast<const StringLiteral &>(*expr).value + "'";
  case ExprKind::Name:
    return static_cast<const NameExpr &>(*expr).name;
  case ExprKind::Paren:
    return "{" + grouped(static_cast<const ParenExpr &>(*expr).inner.get()) + "}";
  case ExprKind::Unary: {
    const auto &node = static_cast<const UnaryExpr &>(*expr);
    const std::string op = unary[static_cast<int>(node.op)];
    const bool isPostfix = node.op == UnaryOp::PostIncrement || node.op == UnaryOp::PostDecrement;
    const std::string operand = grouped(node.operand.get());
    return "(" + (isPostfix ? operand + op : op + operand) + ")";
  }
  case ExprKind::Binary: {
    const auto &node = static_cast<const BinaryExpr &>(*expr);
    return "(" + grouped(node.left.get()) + " " + binary[static_cast<int>(node.op)] + " " +
           grouped(node.right.get()) + ")";
  }
  case ExprKind::Assign: {
    const auto &node = static_cast<const AssignExpr &>(*expr);
    return "(" + grouped(node.target.get()) + " " +
           (node.compound ? binary[static_cast<int>(node.op)] : "") + "= " +
           grouped(node.value.get()) + ")";
  }
  case ExprKind::Conditional: {
    const auto &node = static_cast<const ConditionalExpr &>(*expr);
    return "(" + grouped(node.condition.get()) + " ? " + grouped(node.whenTrue.get()) + " : " +
           grouped(node.whenFalse.get()) + ")";
  }
  case ExprKind::Comma: {
    const auto &node = static_cast<const CommaExpr &>(*expr);
    return "(" + grouped(node.left.get()) + ", " + grouped(node.right.get()) + ")";
  }
  case ExprKind::Call: {
    const auto &node = static_cast<const CallExpr &>(*expr);
    return (node.receiver ? grouped(node.receiver.get()) + "." : "") + node.callee.text + "(" +
           list(node.args) + ")";
  }
  case ExprKind::Construct: {
    const auto &node = static_cast<const ConstructExpr &>(*expr);
    std::string type = node.type.name.text;
    for (const ArrayDimension &dimension : node.type.dimensions)
      type += "<" + grouped(dimension.size.get()) + ">";
    return type + "(" + list(node.args) + ")";
  }
  case ExprKind::Member: {
    const auto &node = static_cast<const MemberExpr &>(*expr);
    return "(" + grouped(node.base.get()) + "." + node.member.text + ")";
  }
  case ExprKind::Index: {
    const auto &node = static_cast<const IndexExpr &>(*expr);
    return "(" + grouped(node.base.get()) + "[" + grouped(node.index.get()) + "])";
  }
  case ExprKind::InitializerList:
    return "[" + list(static_cast<const InitializerListExpr &>(*expr).elements) + "]";
  case ExprKind::Error:
    return "error";
  }
  return "?";
}

struct ParsedExpression {
  explicit ParsedExpression(const std::string &text)
      : parsed("void f() { return " + text + ";\n}") {
    if (!parsed.unit->functions.empty())
      for (const StmtPtr &stmt : parsed.unit->functions[0].body->body)
        if (stmt->kind == StmtKind::Return)
          expr = static_cast<const ReturnStmt &>(*stmt).value.get();
  }
  Parsed parsed;
  const Expr *expr = nullptr;
};

/// How an expression without mistakes was understood.
std::string understood(const std::string &text) {
  const ParsedExpression expression(text);
  EXPECT_EQ(expression.parsed.messages(), "") << text;
  return grouped(expression.expr);
}

TEST(Expressions, BindByThePrecedenceOfGlsl) {
  EXPECT_EQ(understood("a + b * c"), "(a + (b * c))");
  EXPECT_EQ(understood("a * b + c"), "((a * b) + c)");
  EXPECT_EQ(understood("a << b + c"), "(a << (b + c))");
  EXPECT_EQ(understood("a < b << c"), "(a < (b << c))");
  EXPECT_EQ(understood("a == b < c"), "(a == (b < c))");
  EXPECT_EQ(understood("a & b == c"), "(a & (b == c))");
  EXPECT_EQ(understood("a ^ b & c"), "(a ^ (b & c))");
  EXPECT_EQ(understood("a | b ^ c"), "(a | (b ^ c))");
  EXPECT_EQ(understood("a && b | c"), "(a && (b | c))");
  EXPECT_EQ(understood("a ^^ b && c"), "(a ^^ (b && c))");
  EXPECT_EQ(understood("a || b ^^ c"), "(a || (b ^^ c))");
  EXPECT_EQ(understood("a ? b : c || d"), "(a ? b : (c || d))");
  EXPECT_EQ(understood("a = b || c, d"), "((a = (b || c)), d)");
  EXPECT_EQ(understood("-a * !b"), "((-a) * (!b))");
  EXPECT_EQ(understood("-a.x[i]++"), "(-(((a.x)[i])++))");
  EXPECT_EQ(understood("- -a"), "(-(-a))");
  EXPECT_EQ(understood("--a"), "(--a)");
  EXPECT_EQ(understood("~a % ++b"), "((~a) % (++b))");
}

TEST(Expressions, AreLeftAssociative) {
  EXPECT_EQ(understood("a - b - c"), "((a - b) - c)");
  EXPECT_EQ(understood("a / b * c % d"), "(((a / b) * c) % d)");
  EXPECT_EQ(understood("a << b >> c"), "((a << b) >> c)");
  EXPECT_EQ(understood("a < b > c <= d >= e"), "((((a < b) > c) <= d) >= e)");
  EXPECT_EQ(understood("a == b != c"), "((a == b) != c)");
  EXPECT_EQ(understood("a && b && c"), "((a && b) && c)");
  EXPECT_EQ(understood("a, b, c"), "((a, b), c)");
}

TEST(Expressions, AssignFromTheRight) {
  EXPECT_EQ(understood("a = b = c"), "(a = (b = c))");
  EXPECT_EQ(understood("a ? b : c ? d : e"), "(a ? b : (c ? d : e))");
  EXPECT_EQ(understood("a ? b ? c : d : e"), "(a ? (b ? c : d) : e)");
  EXPECT_EQ(understood("a ? b : c = d"), "(a ? b : (c = d))");
  EXPECT_EQ(understood("a = b ? c : d"), "(a = (b ? c : d))");
  EXPECT_EQ(understood("a ? b, c : d"), "(a ? (b, c) : d)");
  EXPECT_EQ(understood("a ? b = c : d"), "(a ? (b = c) : d)");
  EXPECT_EQ(understood("a += b"), "(a += b)");
  EXPECT_EQ(understood("a -= b *= c /= d %= e"), "(a -= (b *= (c /= (d %= e))))");
  EXPECT_EQ(understood("a <<= b >>= c &= d ^= e |= f"), "(a <<= (b >>= (c &= (d ^= (e |= f)))))");
}

TEST(Expressions, CallFunctionsMethodsAndConstructors) {
  EXPECT_EQ(understood("f()"), "f()");
  EXPECT_EQ(understood("max(a, b + 1)"), "max(a, (b + 1))");
  EXPECT_EQ(understood("vec3(1)"), "vec3(1)");
  EXPECT_EQ(understood("albedo.lookup().x"), "(albedo.lookup().x)");
  EXPECT_EQ(understood("a.b.c(d)"), "(a.b).c(d)");
  EXPECT_EQ(understood("a[i].f(j)"), "(a[i]).f(j)");
  EXPECT_EQ(understood("float[3](1, 2, 3)[i]"), "(float<3>(1, 2, 3)[i])");
  EXPECT_EQ(understood("float[2][n + 1](a, b)"), "float<2><(n + 1)>(a, b)");
  EXPECT_EQ(understood("float[](1, 2).length()"), "float<>(1, 2).length()");
  EXPECT_EQ(understood("f((a, b), c = d)"), "f({(a, b)}, (c = d))");
}

TEST(Expressions, UseNamesOfBuiltInsAndIlluminanceFreely) {
  EXPECT_EQ(understood("inside + illuminance * trace.max"),
            "(inside + (illuminance * (trace.max)))");
  EXPECT_EQ(understood("illuminance(x)"), "illuminance(x)");
}

TEST(Expressions, KeepParentheses) {
  EXPECT_EQ(understood("(a + (b)) * c"), "({(a + {b})} * c)");
}

TEST(Expressions, OfUsualDepthAreNotRefused) {
  std::string sum = "1";
  for (int i = 0; i < 990; ++i)
    sum += " + 1";
  EXPECT_EQ(ParsedExpression(sum).parsed.messages(), "");
  EXPECT_EQ(ParsedExpression(std::string(250, '(') + "1" + std::string(250, ')')).parsed.messages(),
            "");
}

TEST(Literals, OfIntegers) {
  const auto value = [](const std::string &text) {
    const ParsedExpression expression(text);
    EXPECT_EQ(expression.parsed.messages(), "");
    const auto &literal = static_cast<const IntLiteral &>(*expression.expr);
    EXPECT_EQ(literal.kind, ExprKind::IntLiteral);
    EXPECT_EQ(literal.spelling, text);
    return std::make_pair(literal.value, literal.isUnsigned);
  };
  EXPECT_EQ(value("0"), std::make_pair(std::uint64_t{0}, false));
  EXPECT_EQ(value("0u"), std::make_pair(std::uint64_t{0}, true));
  EXPECT_EQ(value("42"), std::make_pair(std::uint64_t{42}, false));
  EXPECT_EQ(value("4294967295U"), std::make_pair(std::uint64_t{4294967295}, true));
  EXPECT_EQ(value("052"), std::make_pair(std::uint64_t{42}, false));
  EXPECT_EQ(value("0x2a"), std::make_pair(std::uint64_t{42}, false));
  EXPECT_EQ(value("0XFFu"), std::make_pair(std::uint64_t{255}, true));
  EXPECT_EQ(value("18446744073709551614").first, 18446744073709551614u);
  EXPECT_EQ(value("99999999999999999999999").first, std::numeric_limits<std::uint64_t>::max());
}

TEST(Literals, OfFloats) {
  const auto parts = [](const std::string &text) {
    const ParsedExpression expression(text);
    EXPECT_EQ(expression.parsed.messages(), "");
    EXPECT_EQ(expression.expr->kind, ExprKind::FloatLiteral) << text;
    const auto &literal = static_cast<const FloatLiteral &>(*expression.expr);
    return literal.spelling + "|" + literal.suffix;
  };
  EXPECT_EQ(parts("1."), "1.|");
  EXPECT_EQ(parts(".5"), ".5|");
  EXPECT_EQ(parts("1.5"), "1.5|");
  EXPECT_EQ(parts("1e5"), "1e5|");
  EXPECT_EQ(parts("1E-5f"), "1E-5|f");
  EXPECT_EQ(parts("1.e+5F"), "1.e+5|f");
  EXPECT_EQ(parts("1.f"), "1.|f");
  EXPECT_EQ(parts(".5lf"), ".5|lf");
  EXPECT_EQ(parts("012.5LF"), "012.5|lf");
}

TEST(Literals, OfTruthAndText) {
  EXPECT_EQ(understood("true == false"), "(true == false)");
  EXPECT_EQ(understood(R"(print("a \"b\" \\ \n\t|", 1))"), "print('a \"b\" \\ \n\t|', 1)");
  EXPECT_EQ(understood("print(\"\xC3\xA9 // no comment\")"), "print('\xC3\xA9 // no comment')");
}

TEST(Expressions, HaveTheirPlaces) {
  const ParsedExpression expression("a + bb * (c)");
  const auto at = [&](const Expr &expr) {
    return std::string(expression.parsed.sources.text(expr.range));
  };
  const auto &sum = static_cast<const BinaryExpr &>(*expression.expr);
  const auto &product = static_cast<const BinaryExpr &>(*sum.right);
  EXPECT_EQ(at(sum), "a + bb * (c)");
  EXPECT_EQ(expression.parsed.sources.text(sum.opRange), "+");
  EXPECT_EQ(at(*sum.left), "a");
  EXPECT_EQ(at(product), "bb * (c)");
  EXPECT_EQ(at(*product.right), "(c)");
}

} // namespace
} // namespace rtsl
