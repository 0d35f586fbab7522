//===- Lowering.h - the two classes of lowering ---------------------------===//
//
// `ModuleLowering` has types, symbols and the list of functions still to lower; `FunctionLowering`
// lowers one function. The latter's member functions are in a file for each concern: LowerStmts,
// LowerExprs, LowerLvalues, LowerOperators, LowerConstruct, LowerCalls and LowerBuiltins.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/formulas/Library.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/lower/Lower.h"
#include "sema/typed/Analysis.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/DenseMap.h"

#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace rtsl::lowering {

/// The value of an expression: of a scalar, vector, color or reference one value; of a matrix its
/// columns; of a struct or an array its address (read it before other code may change it); of void
/// nothing.
using Parts = llvm::SmallVector<Value, 4>;

/// One function to be lowered. A method is lowered once for each class whose objects run it, so
/// that its calls on the same object are known. `inIntersect`: for a call from `intersect`, where
/// scratch members are variables. `isHidden`: a definition that code of the object calls,
/// `Base::function()` or `shade()`; it is an ordinary function even if the engine calls one of the
/// same name.
struct FunctionKey {
  const typed::Function *function = nullptr;
  const typed::Class *concrete = nullptr;
  bool inIntersect = false;
  bool isHidden = false;

  bool operator<(const FunctionKey &other) const {
    return std::tie(function, concrete, inIntersect, isHidden) <
           std::tie(other.function, other.concrete, other.inIntersect, other.isHidden);
  }
  /// Does the engine call it?
  bool isStateMethod() const { return function && function->isStateMethod && !isHidden; }
  /// Does it get its payload from the ray?
  bool takesPayload() const { return isStateMethod() && !function->parameters.empty(); }
  /// Does it use the scratch members of the `intersect` that calls it?
  bool isForIntersect() const { return inIntersect && !isStateMethod(); }
};

class ModuleLowering {
public:
  ModuleLowering(const typed::Module &source, const LowerOptions &options, mlir::ModuleOp target);
  void run();

  // LowerTypes.cpp
  mlir::Type type(const Type *type);
  const TypeContext &languageTypes() const { return source.types; }
  mlir::Type pointer(const Type *type) { return ir::PtrType::get(this->type(type)); }

  // LowerDecls.cpp
  /// The function for a key; the first call declares it and adds it to the functions to be lowered.
  mlir::func::FuncOp function(const FunctionKey &key);
  /// The name of a dispatch slot: the method's name, with parameter types if it is overloaded.
  std::string slotName(const typed::Function &method) const;
  /// Scratch members of a class, inherited ones first.
  std::vector<const typed::Member *> scratchMembers(const typed::Class *concrete) const;

  mlir::Location location(SourceRange range);
  /// Reports a construct that is not supported yet.
  void reportUnsupported(SourceRange range, const std::string &what);

  mlir::MLIRContext *context() { return target.getContext(); }
  const LowerOptions &options;
  Library library;
  typed::HitAnswers hitAnswers;

private:
  void lowerClass(const typed::Class &definition);
  void lowerInitialize(const typed::Class &definition);
  std::string symbolOf(const FunctionKey &key);
  mlir::FunctionType functionType(const FunctionKey &key);

  const typed::Module &source;
  mlir::ModuleOp target;
  Emitter emitter; // for operations at module level
  llvm::DenseMap<const Type *, mlir::Type> types;
  std::map<FunctionKey, mlir::func::FuncOp> functions;
  std::set<std::string> symbols;
  std::deque<FunctionKey> pending;
};

/// An lvalue: an address, or components of the vector at an address.
struct Lvalue {
  const Type *type = nullptr;
  Value address; // of the whole vector if components are given
  Value guard;   // i1: whether it exists; null: it does
  bool isPartOfVector = false;
  llvm::SmallVector<unsigned, 4> components; // constant ones, or
  Value component;                           // a computed one
};

class FunctionLowering {
public:
  FunctionLowering(ModuleLowering &module, const FunctionKey &key, mlir::func::FuncOp function);
  void run();
  /// The function that sets member defaults.
  void runInitialize(const std::vector<const typed::Member *> &members);

private:
  // LowerFunction.cpp: entry and exit
  void bindParameters();
  void enterIntersect();
  void commitScratch();
  void emitReturn(const typed::Expr *value);
  void emitReturnOfZero();
  Value self();

  // LowerStmts.cpp
  void lower(const typed::Stmt &stmt);
  void lower(const typed::StmtPtr &stmt) {
    if (stmt)
      lower(*stmt);
  }
  void lowerAll(const std::vector<typed::StmtPtr> &body);
  void lowerDeclaration(const typed::Variable &variable);
  void lowerIf(const typed::IfStmt &stmt);
  void lowerLoop(const typed::Expr *condition, const typed::Stmt &body, const typed::Expr *step,
                 bool testAfter);
  void lowerSwitch(const typed::SwitchStmt &stmt);
  void lowerIlluminance(const typed::IlluminanceStmt &stmt);

  // LowerExprs.cpp
  Parts lower(const typed::Expr &expr);
  Value value(const typed::Expr &expr) { return lower(expr).front(); }
  Num number(const typed::Expr &expr) { return {emitter, value(expr)}; }
  /// Evaluates into memory that no other code refers to.
  void lowerInto(const typed::Expr &expr, Value address);
  Parts lowerLiteral(const Type *type, const typed::Constant &constant,
                     llvm::StringRef name = "constant");
  /// The address of a constant struct or array with these words; `name` is shown in printed IR and
  /// C++.
  Value table(llvm::StringRef name, const Type *type, llvm::ArrayRef<std::int32_t> words);
  /// The same for an expression; null if it is not a constant struct or array.
  Value tableOf(const typed::Expr &expr, llvm::StringRef name);
  /// Appends the words of an expression; false if not all of it is constant.
  bool appendWords(const typed::Expr &expr, llvm::SmallVectorImpl<std::int32_t> &words);
  /// Calls `make` at the start of the function, and returns what it returns.
  Value atStart(llvm::function_ref<Value()> make);
  /// Whether a constant expression contains arithmetic that is widened later, so that the checker's
  /// value must not be used.
  bool isComputedWhenRun(const typed::Expr &constant);
  /// The value of such a constant, computed at the start of the function.
  Parts computedOnce(const void *constant, const typed::Expr &value);
  Parts lowerVariable(const typed::Variable &variable);
  Parts lowerConstant(const typed::Member &member);
  Parts lowerIndex(const typed::IndexExpr &expr);
  Parts lowerLength(const typed::LengthExpr &expr);
  Parts lowerIncDec(const typed::IncDecExpr &expr);
  Parts lowerAssign(const typed::AssignExpr &expr);
  Parts lowerConditional(const typed::ConditionalExpr &expr);
  Parts lowerShortCircuit(const typed::BinaryExpr &expr);
  /// The same value, which later stores do not change: structs and arrays are copied.
  Parts snapshot(Parts parts, const Type *type);

  // LowerSource.cpp
  /// The expression as one operation, if it is to be kept whole and can be.
  std::optional<Parts> lowerWhole(const typed::Expr &expr);
  bool collectLeaves(const typed::Expr &expr, std::vector<const typed::Expr *> &leaves) const;
  bool mayRaise(const typed::Expr &expr) const;
  bool isKept(const typed::Expr &expr) const;
  Value wholeExpression(SourceTable::Kind kind, const typed::Expr &expr,
                        std::vector<const typed::Expr *> leaves, llvm::ArrayRef<Value> operands,
                        mlir::Type type);

  // LowerEvaluations.cpp
  /// An operation under construction: its operands, the expressions that they stand for, and the
  /// values that are copied back.
  struct Evaluation {
    /// `into`: the address that the value is stored to; null: not known yet.
    explicit Evaluation(Value into);

    std::vector<const typed::Expr *> leaves;
    llvm::SmallVector<Value, 8> operands;
    llvm::SmallVector<std::int32_t, 4> changed;               // numbers of operands
    llvm::DenseMap<const typed::Variable *, Value> addresses; // of written variables
    std::set<typed::StateVariable> states;                    // written
    std::vector<std::pair<Lvalue, Value>> outputs;
    std::set<const typed::Expr *> path; // to the element of an output buffer that it accesses
    bool isNested = false;              // subexpressions with effects are part of it
    bool hasResult = true;
  };
  void addIndexedPlaces(const typed::Expr &expr, Evaluation &evaluation);
  /// The index of an element that is no part of a buffer, checked by an operation of its own.
  Value checkedIndex(const typed::IndexExpr &expr);
  /// The expression as one operation that reads and writes variables in place; nothing if that is
  /// not possible. With `into` its value is stored there.
  std::optional<Parts> lowerEvaluation(const typed::Expr &expr, Value into = nullptr);
  Parts makeEvaluation(const typed::Expr &expr, const Evaluation &evaluation, Value into);
  /// The same for an expression of which one part changes what another uses; nothing if it traces.
  std::optional<Parts> lowerNested(const typed::Expr &expr, bool hasResult, Value into = nullptr);
  std::optional<Parts> lowerOneByOne(const typed::Expr &expr, Value into = nullptr);
  bool collectWritten(const typed::Expr &expr, Evaluation &evaluation);
  void gather(const typed::Expr &expr, Evaluation &evaluation, bool isTop);
  bool mentionsMemory(const typed::Expr &expr);
  /// Is it a constant matrix? Expressions refer to it by name, as to constant structs and arrays.
  static bool isNamedMatrix(const typed::Variable &variable);
  bool staysWhole(const typed::Expr &target);
  /// Evaluates an expression for its side effects.
  void lowerDiscarded(const typed::Expr &expr);
  Value variableOf(llvm::StringRef name, const Type *type);

  // LowerLvalues.cpp
  Lvalue lowerLvalue(const typed::Expr &expr);
  Lvalue indexLvalue(const typed::IndexExpr &expr);
  Lvalue bufferLvalue(const typed::IndexExpr &expr);
  Parts load(const Lvalue &lvalue);
  void store(const Parts &parts, const Lvalue &lvalue);
  Parts loadFrom(Value address, const Type *type);
  void storeTo(const Parts &parts, Value address, const Type *type);
  Value temporary(llvm::StringRef name, const Type *type);
  /// An index, clamped to [0, count - 1] if indices are checked.
  Value clampedIndex(const typed::Expr &index, Value count);
  Value clampedIndex(const typed::IndexExpr &expr);

  // LowerOperators.cpp
  Parts lowerUnary(const typed::UnaryExpr &expr);
  Parts binary(ast::BinaryOp op, const Parts &left, const Type *leftType, const Parts &right,
               const Type *rightType);
  Num arithmetic(ast::BinaryOp op, Num left, Num right, bool isSigned);
  Parts multiplyMatrices(const Parts &left, const Type *leftType, const Parts &right,
                         const Type *rightType);
  Num equality(const Parts &left, const Parts &right, const Type *type);
  Parts convert(const Parts &parts, const Type *from, const Type *to);
  Num convertScalars(Num number, const Type *from, const Type *to);

  // LowerConstruct.cpp
  Parts lowerConstruct(const typed::ConstructExpr &expr);
  void constructInto(const typed::ConstructExpr &expr, Value address);
  Parts constructMatrix(const typed::ConstructExpr &expr);
  /// All scalars of a value, in order.
  void appendScalars(const Parts &parts, const Type *type, llvm::SmallVectorImpl<Value> &scalars);

  // LowerCalls.cpp
  bool isHidden(const typed::CallExpr &expr) const;
  Parts lowerCall(const typed::CallExpr &expr, Value result = nullptr);
  Parts lowerMethodCall(const typed::MethodCallExpr &expr);
  Parts lowerLookup(const typed::MethodCallExpr &expr);
  /// An `out` or `inout` argument: the temporary that is copied to the lvalue after the call.
  struct CopyOut {
    Lvalue target;
    Value from;
  };
  void passArguments(const typed::Function &callee, const std::vector<typed::ExprPtr> &args,
                     llvm::SmallVectorImpl<Value> &values, std::vector<CopyOut> &outputs,
                     bool isDispatched);
  bool canHandOver(const typed::Function &callee, const std::vector<typed::ExprPtr> &args,
                   std::size_t index) const;
  void copyOut(const std::vector<CopyOut> &outputs);

  // LowerBuiltins.cpp, LowerBuiltinsRay.cpp
  Parts lowerBuiltin(const typed::BuiltinExpr &expr);
  std::optional<Parts> lowerRayBuiltin(const typed::BuiltinExpr &expr);
  // ... and the functions that Builtins.def names
  Parts lowerAmbient(const typed::BuiltinExpr &expr);
  Parts lowerAtomic(const typed::BuiltinExpr &expr);
  Parts lowerHit(const typed::BuiltinExpr &expr);
  Parts lowerHitAnswer(const typed::BuiltinExpr &expr);
  Parts lowerIlluminate(const typed::BuiltinExpr &expr);
  Parts lowerIlluminateBySurface(const typed::BuiltinExpr &expr);
  Parts lowerLightCount(const typed::BuiltinExpr &expr);
  Parts lowerLightMayPass(const typed::BuiltinExpr &expr);
  Parts lowerDerivative(const typed::BuiltinExpr &expr);
  Parts lowerPrint(const typed::BuiltinExpr &expr);
  Parts lowerSpaceChange(const typed::BuiltinExpr &expr);
  Parts lowerRand(const typed::BuiltinExpr &expr);
  Parts lowerTrace(const typed::BuiltinExpr &expr);
  Parts lowerTracePayload(const typed::BuiltinExpr &expr);
  Parts lowerVisitChild(const typed::BuiltinExpr &expr);
  void answerHit(typed::Builtin builtin);
  void returnIfHitAnswered();

  // Small helpers
  Num num(Value value) { return {emitter, value}; }
  Columns columns(const Parts &parts);
  Parts parts(const Columns &columns);
  unsigned colorComponents() const { return module.options.colorComponents; }
  void unsupported(SourceRange range, const std::string &what) {
    module.reportUnsupported(range, what);
  }
  /// A value of `type`, to continue after an error.
  Parts zeroOf(const Type *type);

  ModuleLowering &module;
  FunctionKey key;
  mlir::func::FuncOp function;
  Emitter emitter;

  struct Binding {
    Value address; // or
    Parts value;   // a parameter that is never assigned
  };
  llvm::DenseMap<const typed::Variable *, Binding> variables;
  Value resultAddress; // where a struct, array or matrix is returned

  // In `intersect` and helpers that it calls
  llvm::DenseMap<const typed::Member *, Value> scratch;
  Value accepted; // address of a bool: has this intersection reported a hit that counts?
  bool commitsScratch = false;
  bool mayEndAnyHit = false; // it is `anyHit`, or a function that it may call

  // Constant structs and arrays, made once at the start of the function.
  llvm::DenseMap<std::pair<mlir::Type, mlir::Attribute>, Value> tables;
  std::map<const typed::Variable *, Value>
      globalAggregates;                            // constants of the file that are not literals
  std::map<const void *, Parts> computedConstants; // by variable or member
  std::map<const typed::Expr *, bool> computedWhenRun;
  mlir::Operation *lastAtStart = nullptr; // the last operation of these values
};

inline bool isAggregate(const Type *type) {
  return type->is(TypeKind::Struct) || type->is(TypeKind::Array) || type->is(TypeKind::Buffer);
}
/// Is a value of this type passed by address?
inline bool livesInMemory(const Type *type) {
  return isAggregate(type) || type->isMatrix();
}

} // namespace rtsl::lowering
