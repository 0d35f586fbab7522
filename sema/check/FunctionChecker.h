//===- FunctionChecker.h - checking the body of a function ----------------===//
//
// Turns statements and expressions of the syntax tree into typed ones. The same class checks
// expressions outside of functions: array sizes, constants, members' defaults. It is implemented in
// Check*.cpp, one file per concept.
//
// An expression with an error is reported once and gets the type `error`, about which nothing more
// is reported.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/check/Program.h"
#include "sema/check/Scope.h"
#include "sema/model/Conversion.h"

#include <unordered_set>

namespace rtsl {

class FunctionChecker {
public:
  /// `scope` is the class whose names are visible, or null; `function` the one whose body is
  /// checked, or null.
  FunctionChecker(Program &program, const ClassScope *scope, typed::Function *function);

  /// Checks the body into `function`.
  void checkBody(const ast::FunctionDecl &declaration);

  /// A type as spelled. `name` is the declared name, if any: dimensions after it come first
  /// (`float[2] a[3]` is an array of three arrays of two). `allowUnsized` permits `[]` as the first
  /// dimensions; then the result is a buffer.
  const Type *resolveType(const ast::TypeName &typeName, const ast::Name *name,
                          bool allowUnsized = false);

  /// An initialiser for a variable of type `type`; converts it, and accepts `{...}`.
  typed::ExprPtr checkInitializer(const ast::Expr &init, const Type *type);

  /// The type of `float a[] = ...`: the length comes from the initialiser, which is returned in
  /// `init`.
  const Type *deduceUnsized(const ast::VariableDecl &declaration, typed::ExprPtr &init);

  /// Reports what is not constant in `init`, and returns whether it is constant. With `value`, a
  /// constant whose value depends on the target (it may contain colors) is accepted; then `value`
  /// stays null. Without, its value must be known.
  bool requireConstant(const typed::Expr &init, const std::string &what,
                       std::unique_ptr<typed::Constant> *value = nullptr);

private:
  /// How the lvalue that an expression denotes is used.
  enum class Access : std::uint8_t { Read, Write, ReadWrite };

  // CheckExpr.cpp
  typed::ExprPtr checkExpr(const ast::Expr &expr, Access access = Access::Read);
  typed::ExprPtr dispatch(const ast::Expr &expr, Access access);
  /// An expression whose value is used: not void, not a whole buffer, not a string.
  typed::ExprPtr checkValue(const ast::Expr &expr, Access access = Access::Read);
  typed::ExprPtr requireValue(typed::ExprPtr expr);
  /// An expression that may be void: a statement, or a side of a comma.
  typed::ExprPtr checkOperand(const ast::Expr &expr);
  typed::ExprPtr checkCondition(const ast::Expr &expr);
  /// Converts a reference in a condition to a bool: whether it refers to an object. Others are
  /// unchanged.
  typed::ExprPtr testReference(typed::ExprPtr expr);
  typed::ExprPtr errorExpr(SourceRange range);
  typed::ExprPtr checkIntLiteral(const ast::IntLiteral &literal, bool negated);
  typed::ExprPtr checkFloatLiteral(const ast::FloatLiteral &literal);
  typed::ExprPtr literal(const Type *type, SourceRange range, typed::Constant value,
                         std::string spelling = "");
  typed::ExprPtr checkConditional(const ast::ConditionalExpr &expr);
  /// Converts, or reports why that is impossible. `label` (if its text is not empty) points to what
  /// requires the type.
  typed::ExprPtr coerce(typed::ExprPtr expr, const Type *to, const Label &label = {});
  /// Converts what is convertible, and warns of what loses its fraction by that.
  typed::ExprPtr convertImplicitly(typed::ExprPtr expr, const Type *to);
  void explainConversion(Diagnostic &diagnostic, const typed::Expr &expr, const Type *to);
  std::string sourceText(SourceRange range) const {
    return std::string(diagnostics.sources().text(range));
  }

  // CheckName.cpp
  typed::ExprPtr checkName(const ast::NameExpr &expr, Access access);
  typed::ExprPtr checkState(const std::string &name, SourceRange range, Access access);
  typed::ExprPtr memberAccess(const typed::Member *member, SourceRange range, Access access);
  typed::ExprPtr variableAccess(const typed::Variable *variable, SourceRange range, Access access);
  void reportUnknownName(const std::string &name, SourceRange range);
  typed::ExprPtr checkMember(const ast::MemberExpr &expr, Access access);
  typed::ExprPtr checkSwizzle(typed::ExprPtr base, const ast::Name &letters, SourceRange range,
                              Access access);
  /// An element of an `out` buffer is read.
  void reportUnreadable(const typed::Expr &buffer);
  typed::ExprPtr checkIndex(const ast::IndexExpr &expr, Access access);
  /// Reports if `target` cannot be assigned to.
  bool requireTarget(const ast::Expr &source, const typed::Expr &target, const char *action);
  /// These record a use, or check it immediately. False (reported) outside of functions, where
  /// there is no state.
  bool recordState(Use::Kind kind, typed::StateVariable variable, SourceRange range);
  bool recordSpecial(Ability ability, const std::string &what, SourceRange range,
                     const typed::Member *member = nullptr);
  bool record(Use use);
  /// Why a state variable or a special function is not allowed here, as a note instead of
  /// suggesting it; empty if it is allowed, as far as is known.
  std::string whyNotHere(const std::string &name) const;
  std::vector<std::string> whatMayStandHere(std::vector<std::string> names) const;

  // CheckOperators.cpp
  typed::ExprPtr checkUnary(const ast::UnaryExpr &expr);
  typed::ExprPtr checkIncDec(const ast::UnaryExpr &expr);
  typed::ExprPtr checkBinaryChain(const ast::BinaryExpr &expr);
  typed::ExprPtr combine(const ast::BinaryExpr &expr, typed::ExprPtr left, typed::ExprPtr right);
  /// Converts both operands to the types that the operator takes and returns the result's type;
  /// null if the operator does not apply.
  const Type *operandTypes(ast::BinaryOp op, typed::ExprPtr &left, typed::ExprPtr &right,
                           bool leftFixed);
  const Type *arithmeticTypes(ast::BinaryOp op, typed::ExprPtr &left, typed::ExprPtr &right,
                              bool leftFixed);
  const Type *colorTypes(ast::BinaryOp op, typed::ExprPtr &left, typed::ExprPtr &right);
  void reportOperands(ast::BinaryOp op, SourceRange opRange, const typed::Expr &left,
                      const typed::Expr &right);
  void warnAboutConstants(ast::BinaryOp op, const typed::Expr &right);
  typed::ExprPtr checkAssign(const ast::AssignExpr &expr);

  // CheckConstruct.cpp
  typed::ExprPtr checkConstruct(const Type *type, SourceRange typeRange,
                                const std::vector<ast::ExprPtr> &args, SourceRange range);
  typed::ExprPtr constructScalar(const Type *type, typed::ExprPtr arg, SourceRange range);
  typed::ExprPtr constructVector(const Type *type, std::vector<typed::ExprPtr> args,
                                 SourceRange range);
  typed::ExprPtr constructMatrix(const Type *type, std::vector<typed::ExprPtr> args,
                                 SourceRange range);
  typed::ExprPtr constructColor(std::vector<typed::ExprPtr> args, SourceRange range);
  typed::ExprPtr constructAggregate(const Type *type, std::vector<typed::ExprPtr> args,
                                    SourceRange range);
  typed::ExprPtr constructUnsizedArray(const ast::ConstructExpr &expr);
  typed::ExprPtr checkInitializerList(const ast::InitializerListExpr &list, const Type *type);
  bool requirePieces(const Type *type, std::vector<typed::ExprPtr> &args, SourceRange range,
                     bool exact);
  typed::ExprPtr convertScalars(typed::ExprPtr arg, const Type *scalar);
  void rejectColorPiece(const Type *type, const typed::Expr &arg);

  // CheckCall.cpp
  typed::ExprPtr checkCall(const ast::CallExpr &expr);
  typed::ExprPtr checkPlainCall(const ast::CallExpr &expr);
  typed::ExprPtr checkBaseCall(const ast::CallExpr &expr);
  bool requireCallable(const typed::Function &callee, SourceRange range, bool onOtherObject);
  bool requireSameMethod(const typed::Function &callee, SourceRange range);
  typed::ExprPtr checkReceiverCall(const ast::CallExpr &expr);
  typed::ExprPtr checkLength(const ast::CallExpr &expr, typed::ExprPtr receiver);
  typed::ExprPtr checkReferenceCall(const ast::CallExpr &expr, typed::ExprPtr receiver);
  typed::ExprPtr checkUserCall(const ast::CallExpr &expr,
                               const std::vector<const typed::Function *> &candidates,
                               typed::ExprPtr receiver);
  bool mayRunAnywhere() const;
  typed::ExprPtr checkBuiltinCall(const ast::CallExpr &expr, const BuiltinOverloads &overloads);
  typed::ExprPtr checkTracePayload(const ast::CallExpr &expr);
  typed::ExprPtr checkPrint(const ast::CallExpr &expr);
  typed::ExprPtr checkAtomic(const ast::CallExpr &expr, typed::Builtin atomic);
  void reportUnknownFunction(const ast::Name &callee, SourceRange call);
  /// The access of candidates with `count` parameters to argument `index`: Write if all of them
  /// write it; otherwise Read until one has been chosen.
  static Access accessOf(const std::vector<Signature> &candidates, std::size_t count,
                         std::size_t index);
  std::vector<typed::ExprPtr> checkArguments(const std::vector<ast::ExprPtr> &args,
                                             const std::vector<Signature> &candidates);
  /// Checks those arguments again, as lvalues, that the chosen candidate writes and others read.
  void checkWritten(const std::vector<ast::ExprPtr> &args, const std::vector<Signature> &candidates,
                    int chosen, std::vector<typed::ExprPtr> &values);
  /// The chosen candidate, or -1 after an error (not reported again if an argument is broken).
  int choose(const ast::Name &callee, const std::vector<Signature> &candidates,
             const std::vector<typed::ExprPtr> &args, const std::vector<SourceRange> &places,
             SourceRange range);
  void convertArguments(const Signature &signature, std::vector<typed::ExprPtr> &args);

  // CheckStmt.cpp
  typed::StmtPtr checkStmt(const ast::Stmt &stmt);
  typed::StmtPtr dispatchStmt(const ast::Stmt &stmt);
  typed::StmtPtr checkScoped(const ast::Stmt &stmt);
  typed::StmtPtr checkCompound(const ast::CompoundStmt &stmt, bool ownScope);
  typed::StmtPtr checkDeclaration(const ast::DeclarationStmt &stmt);
  const typed::Variable *checkVariable(const ast::VariableDecl &declaration);
  typed::StmtPtr checkIf(const ast::IfStmt &stmt);
  typed::StmtPtr checkFor(const ast::ForStmt &stmt);
  typed::StmtPtr checkSwitch(const ast::SwitchStmt &stmt);
  typed::StmtPtr checkReturn(const ast::ReturnStmt &stmt);
  typed::StmtPtr checkIlluminance(const ast::IlluminanceStmt &stmt);
  typed::StmtPtr checkJump(const ast::Stmt &stmt);
  bool isDeduced(const ast::VariableDecl &declaration) const;
  const Type *reportDeduced(const ast::VariableDecl &declaration, typed::ExprPtr &init);
  void checkLocalSize(const typed::Variable &variable);

  Program &program;
  Diagnostics &diagnostics;
  TypeContext &types;
  const ClassScope *scope;
  typed::Function *function;
  const MethodModel *rules = nullptr; // of an engine method or the constructor
  FunctionFacts *facts = nullptr;
  LocalScopes locals;
  std::unordered_set<const typed::Variable *> mentioned;
  std::unordered_set<std::string> unknownNames; // already reported
  unsigned recursion = 0, treeDepth = 0;
  unsigned loops = 0, switches = 0, illuminances = 0;
  bool isLit = false; // a light was selected before, by its number
  StateSet written;   // before, by the function itself
};

/// `+`, `<<`, ...
const char *spelling(ast::BinaryOp op);

} // namespace rtsl
