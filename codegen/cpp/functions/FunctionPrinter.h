//===- FunctionPrinter.h - a function of the author's, as a tree ----------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/functions/Literals.h"
#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

/// Values that an int can have, ends included.
struct Interval {
  std::int64_t low = 0, high = 0;
};

class FunctionPrinter {
public:
  /// `function` is null for an initialiser outside of functions, of a member of `owner` or at file
  /// level.
  FunctionPrinter(Context &context, const typed::Function *function,
                  const typed::Class *owner = nullptr);

  /// The statements of the body.
  Statements body();
  /// An initialiser outside of functions.
  Code initialiser(const typed::Expr &expr);
  /// Is it an array of numbers that are written out? C++ can make it while it compiles.
  bool isTable(const typed::Expr &expr) const;

private:
  // Statements.cpp
  void print(const typed::Stmt &stmt, Statements &out);
  void print(const std::vector<typed::StmtPtr> &statements, Statements &out);
  Statements block(const std::vector<typed::StmtPtr> &statements);
  /// The statement without its comment; what goes before it is put there.
  Statements construct(const typed::Stmt &stmt);
  /// What stands under an `if` or a loop.
  Statements nested(const typed::StmtPtr &stmt, bool &hasBraces);
  void nest(const typed::StmtPtr &stmt, Statement &under);
  /// `inHeader`: of a `for`, whose own declaration comes last.
  Statements declaration(const typed::DeclarationStmt &stmt, bool inHeader);
  Statements expressionStatement(const typed::Expr &expr);
  Statement ifStatement(const typed::IfStmt &stmt);
  Statement forStatement(const typed::ForStmt &stmt);
  Code stepOf(const typed::Expr &expr);
  Statement switchStatement(const typed::SwitchStmt &stmt);
  Statement illuminance(const typed::IlluminanceStmt &stmt);
  void noteCounter(const typed::ForStmt &stmt);

  // Expressions.cpp
  Code expr(const typed::Expr &expr);
  Code lowered(const typed::Expr &expr);
  /// In the place of an operand of an operator that binds so tightly, where the author's own
  /// parentheses stay.
  Code operand(const typed::Expr &expr, Binding atLeast);
  Code argument(const typed::Expr &expr) { return operand(expr, Binding::Assignment); }
  /// Operands in an order that C++ does not promise: what could be noticed goes into variables.
  std::vector<Code> operands(const std::vector<const typed::Expr *> &exprs, Binding atLeast);
  std::vector<Code> arguments(const std::vector<typed::ExprPtr> &exprs);
  /// In a place where control may not come, or comes more than once: nothing can be put before it.
  Code apart(const typed::Expr &expr, Binding atLeast);
  Code literal(const Type *type, const typed::Constant &constant, const std::string &spelling);
  /// The constant (Variable or Member) that the author named where the tree has its value; null:
  /// none.
  const void *namedConstant(const typed::LiteralExpr &expr) const;
  Code scalarLiteral(const Type *type, typed::Constant::Scalar value, const std::string &spelling);
  Code convert(const typed::ConvertExpr &expr);
  Code construct(const typed::ConstructExpr &expr);
  Code swizzle(const typed::SwizzleExpr &expr);
  Code conditional(const typed::ConditionalExpr &expr);
  Code hoist(const Type *type, const std::string &hint, Code value);
  std::string temporaryName(const std::string &hint);
  Code inMemory(const Type *type, Code value);

  // Operators.cpp
  Code unary(const typed::UnaryExpr &expr);
  Code binary(ast::BinaryOp op, const typed::Expr &left, const typed::Expr &right);
  /// The operator of C++; nothing: there is none that means the same.
  std::optional<Operator> plainOperator(ast::BinaryOp op, const typed::Expr &left,
                                        const typed::Expr &right);
  /// Operands of an operation that takes any number of them.
  void appendOperands(ast::BinaryOp op, const typed::Expr &expr,
                      std::vector<const typed::Expr *> &into);
  std::string functionFor(ast::BinaryOp op, const typed::Expr &left, const typed::Expr &right);
  Code assign(const typed::AssignExpr &expr, bool resultIsUsed);
  /// `target.z = from.x; target.x = from.y;`
  void assignComponents(const Code &target, const std::vector<std::uint8_t> &parts,
                        const Code &from, Statements &out);
  Code incDec(const typed::IncDecExpr &expr, bool resultIsUsed);
  /// `value + 1` or `value - 1`
  Code stepped(const Code &value, const Type *scalar, bool increment);
  std::optional<Interval> range(const typed::Expr &expr);
  std::optional<Interval> range(ast::BinaryOp op, const typed::Expr &left,
                                const typed::Expr &right);
  void compareStructs(const Type *type);

  // Places.cpp
  Code place(const typed::Expr &expr, bool storeIndices = false);
  Code index(const typed::IndexExpr &expr, bool storeIndices);
  /// With --exceptions: the index, after the state was told if it is out of range.
  Code checked(Code index, Code count) const;
  Code element(const typed::IndexExpr &expr, const Code &base, bool storeIndices);
  Code bufferElement(const typed::IndexExpr &expr);
  Code lengthOf(const Code &buffer, std::optional<std::size_t> dimension);
  Code length(const typed::LengthExpr &expr);
  /// Can the expression stand in the text more than once, at no cost?
  bool isSimple(const typed::Expr &expr) const;
  /// The components of a vector that a place stands for, and the vector; empty: not a part.
  std::vector<std::uint8_t> components(const typed::Expr &place, const typed::Expr *&vector) const;
  Effects indexEffects(const typed::Expr &place);

  // Calls.cpp
  Code call(const typed::CallExpr &expr);
  Code methodCall(const typed::MethodCallExpr &expr);
  Code callWith(const Code &callee, std::vector<Code> first, const typed::Function &function,
                const std::vector<typed::ExprPtr> &args, const Type *result);
  Code valueThen(const Type *type, const std::string &hint, const Code &call,
                 const Statements &after);
  bool canBind(const typed::Expr &place) const;

  // Builtins.cpp
  Code builtin(const typed::BuiltinExpr &expr);
  Code withOutputs(const std::string &callee, const typed::BuiltinExpr &expr,
                   std::size_t firstOutput);
  Code print(const typed::BuiltinExpr &expr);
  Code tracePayload(const typed::BuiltinExpr &expr);

  // Payloads.cpp
  /// `ignoreIntersection();` or `terminateRay();` as statements; empty if the expression is
  /// neither.
  Statements hitAnswer(const typed::Expr &expr);
  Code endOfAnyHit(const typed::BuiltinExpr &expr);
  /// After a call of what may end `anyHit`: nothing more happens.
  void leaveIfAnswered();
  bool mayEndAnyHit() const;

  Context &context;
  const typed::Function *function;
  const typed::Class *owner;
  Statements *before = nullptr;                 // statements that go before the one being made
  bool isInLambda = false;                      // these are not the function's own
  std::set<std::string> usedNames, temporaries; // the latter are of variables of its own
  std::set<const typed::Variable *> readVariables, mentionedVariables, hoistedDeclarations;
  std::map<const typed::Variable *, Interval> counters;

  std::map<const typed::Expr *, Code> replaced; // parts that stand elsewhere, as what they are here
  bool isNested = true;                         // parts with effects are not among them

  friend class StateWriter;
};

/// Does it lie in a record, a struct or an array, where bools have 32 bits?
bool isInMemory(const typed::Expr &expr);
/// `for (rtsl::Lights lights(rt, arguments); lights.next();)`, without a body.
Statement lightLoop(const std::string &lights, std::vector<Code> arguments);

} // namespace rtsl::cpp
