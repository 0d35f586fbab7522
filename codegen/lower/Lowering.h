//===- Lowering.h - the two workers of lowering ---------------------------===//
//
// `ModuleLowering` knows types, symbols and which functions are still to do; `FunctionLowering`
// does one function. The latter's member functions are in a file for each concern: LowerStmts,
// LowerExprs, LowerPlaces, LowerOperators, LowerConstruct, LowerCalls and LowerBuiltins.
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
/// columns; of a struct or an array the address of where it lies (read it before anything else may
/// change it); of void nothing.
using Parts = llvm::SmallVector<Value, 4>;

/// One function to be lowered. A method is lowered once for each class whose objects run it, so
/// that what it calls on itself is known. `inIntersect`: on behalf of `intersect`, where scratch
/// members are variables. `isHidden`: a definition of a base class that only `Base::function()`
/// runs on such objects; of what the engine calls this is an ordinary function.
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
  /// Does its payload come with the ray?
  bool takesPayload() const { return isStateMethod() && !function->parameters.empty(); }
  /// Does it work on the scratch members of the `intersect` that calls it?
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
  /// The function for a key; declares it and puts it on the list of what is to do at the first
  /// call.
  mlir::func::FuncOp function(const FunctionKey &key);
  /// The name of a dispatch slot: the method's, with parameter types where the name alone is not
  /// enough.
  std::string slotName(const typed::Function &method) const;
  /// Scratch members of a class, inherited ones first.
  std::vector<const typed::Member *> scratchMembers(const typed::Class *concrete) const;

  mlir::Location location(SourceRange range);
  /// Reports what cannot be lowered yet.
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
  Emitter emitter; // of what stands at module level
  llvm::DenseMap<const Type *, mlir::Type> types;
  std::map<FunctionKey, mlir::func::FuncOp> functions;
  std::set<std::string> symbols;
  std::deque<FunctionKey> pending;
};

/// A place in memory: something behind an address, or components of a vector there.
struct Place {
  const Type *type = nullptr;
  Value address; // of the whole vector where components are meant
  Value guard;   // i1: the place exists; null: it does
  bool isPartOfVector = false;
  llvm::SmallVector<unsigned, 4> components; // constant ones, or
  Value component;                           // one that is computed
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
  /// Evaluates into memory that nothing else refers to.
  void lowerInto(const typed::Expr &expr, Value address);
  Parts lowerLiteral(const Type *type, const typed::Constant &constant,
                     llvm::StringRef name = "constant");
  /// The address of a constant struct or array whose memory is known; `name` is for people.
  Value table(llvm::StringRef name, const Type *type, llvm::ArrayRef<std::int32_t> words);
  /// The same for an expression; null if it is no constant struct or array.
  Value tableOf(const typed::Expr &expr, llvm::StringRef name);
  /// Appends the memory of an expression; false if the expression has other parts than constants.
  bool appendWords(const typed::Expr &expr, llvm::SmallVectorImpl<std::int32_t> &words);
  /// Calls `make` at the start of the function, and returns what it returns.
  Value atStart(llvm::function_ref<Value()> make);
  /// Whether a constant expression is arithmetic that is widened later, so that what the checker
  /// has made of it does not count.
  bool isComputedWhenRun(const typed::Expr &constant);
  /// The value of such a constant, made at the start of the function.
  Parts computedOnce(const void *constant, const typed::Expr &value);
  Parts lowerVariable(const typed::Variable &variable);
  Parts lowerConstant(const typed::Member &member);
  Parts lowerIndex(const typed::IndexExpr &expr);
  Parts lowerLength(const typed::LengthExpr &expr);
  Parts lowerIncDec(const typed::IncDecExpr &expr);
  Parts lowerAssign(const typed::AssignExpr &expr);
  Parts lowerConditional(const typed::ConditionalExpr &expr);
  Parts lowerShortCircuit(const typed::BinaryExpr &expr);
  /// The same value, safe from what happens later: structs and arrays are copied.
  Parts snapshot(Parts parts, const Type *type);

  // LowerSource.cpp
  /// The expression as one operation, if it is to be kept whole and can be.
  std::optional<Parts> lowerWhole(const typed::Expr &expr);
  bool collectLeaves(const typed::Expr &expr, std::vector<const typed::Expr *> &leaves) const;
  bool isKept(const typed::Expr &expr) const;
  Value wholeExpression(SourceTable::Kind kind, const typed::Expr &expr,
                        std::vector<const typed::Expr *> leaves, llvm::ArrayRef<Value> operands,
                        mlir::Type type);

  // LowerEvaluations.cpp
  /// What an evaluation works on: operands, what they stand for, and what is copied back.
  struct Evaluation {
    /// `into`: where the value goes; null: nowhere yet.
    explicit Evaluation(Value into);

    std::vector<const typed::Expr *> leaves;
    llvm::SmallVector<Value, 8> operands;
    llvm::SmallVector<std::int32_t, 4> changed;            // numbers of operands
    llvm::DenseMap<const typed::Variable *, Value> places; // of variables that are written
    std::set<typed::StateVariable> states;                 // that are written
    std::vector<std::pair<Place, Value>> outputs;
    bool isNested = false; // parts with effects stay where they are
    bool hasResult = true;
  };
  /// The expression as one operation that reads and writes variables where they lie; nothing if
  /// that is not possible. With `into` its value goes there.
  std::optional<Parts> lowerEvaluation(const typed::Expr &expr, Value into = nullptr);
  Parts makeEvaluation(const typed::Expr &expr, const Evaluation &evaluation, Value into);
  /// The same for parts that change what others look at; nothing if the expression traces.
  std::optional<Parts> lowerNested(const typed::Expr &expr, bool hasResult, Value into = nullptr);
  std::optional<Parts> lowerOneByOne(const typed::Expr &expr, Value into = nullptr);
  bool openPlaces(const typed::Expr &expr, Evaluation &evaluation);
  void gather(const typed::Expr &expr, Evaluation &evaluation, bool isTop);
  bool mentionsMemory(const typed::Expr &expr);
  /// Is it a constant matrix? Expressions have it under its name, as they have constant structs and
  /// arrays.
  static bool isNamedMatrix(const typed::Variable &variable);
  bool staysWhole(const typed::Expr &target);
  /// An expression whose value nobody asks for.
  void lowerDiscarded(const typed::Expr &expr);
  Value variableOf(llvm::StringRef name, const Type *type);

  // LowerPlaces.cpp
  Place place(const typed::Expr &expr);
  Place indexPlace(const typed::IndexExpr &expr);
  Place bufferPlace(const typed::IndexExpr &expr);
  Parts load(const Place &place);
  void store(const Parts &parts, const Place &place);
  Parts loadFrom(Value address, const Type *type);
  void storeTo(const Parts &parts, Value address, const Type *type);
  Value temporary(llvm::StringRef name, const Type *type);
  /// An index, clamped to [0, count - 1] if indices are checked.
  Value clampedIndex(const typed::Expr &index, Value count);
  Value clampedIndex(const typed::Expr &index, std::uint32_t count);

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
  /// Copies arguments in: values, and addresses of temporaries.
  struct CopyOut {
    Place target;
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
  void lowerTracePayload(const typed::BuiltinExpr &expr);
  Parts lowerIlluminate(const typed::BuiltinExpr &expr);
  void lowerPrint(const typed::BuiltinExpr &expr);
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
  /// A value of `type` to go on with behind an error.
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

  // In `intersect` and on its behalf
  llvm::DenseMap<const typed::Member *, Value> scratch;
  Value accepted; // address of a bool: has this intersection reported a hit that counts?
  bool commitsScratch = false;
  bool mayEndAnyHit = false; // it is `anyHit`, or a function that may run on its behalf

  // Constant structs and arrays, made once at the start of the function.
  llvm::DenseMap<std::pair<mlir::Type, mlir::Attribute>, Value> tables;
  std::map<const typed::Variable *, Value>
      globalAggregates;                            // constants of the file that are no literals
  std::map<const void *, Parts> computedConstants; // by variable or member
  std::map<const typed::Expr *, bool> computedWhenRun;
  mlir::Operation *lastAtStart = nullptr; // of what makes them
};

inline bool isAggregate(const Type *type) {
  return type->is(TypeKind::Struct) || type->is(TypeKind::Array) || type->is(TypeKind::Buffer);
}
/// Passed to functions by address.
inline bool livesInMemory(const Type *type) {
  return isAggregate(type) || type->isMatrix();
}

} // namespace rtsl::lowering
