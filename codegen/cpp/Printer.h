//===- Printer.h - the two workers of the C++ printer ---------------------===//
//
// `ModulePrinter` knows types, names, signatures and the order of a file; `FunctionPrinter` prints
// one function. The latter's member functions are in a file for each concern: Expressions,
// Operators, Builtins, Places, Calls and Statements.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/Effects.h"
#include "codegen/cpp/EmitCpp.h"
#include "codegen/cpp/Literals.h"
#include "codegen/cpp/Names.h"
#include "codegen/cpp/SourceNotes.h"
#include "codegen/cpp/tree/Print.h"
#include "codegen/link/ModuleFacts.h"
#include "sema/typed/Analysis.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <unordered_set>
#include <vector>

namespace rtsl::cpp {

/// Values that an int can have, ends included.
struct Interval {
  std::int64_t low = 0, high = 0;
};

// states/StateWriter.h
struct StateProgram;
struct FrameField;
struct Machine;
class StateWriter;

/// A method that traces and is called through references: it runs on a frame of its own, which
/// begins with what it is given and returns.
struct CalledMethod {
  std::string symbol;                        // of its declaration in the IR
  std::string slot;                          // what the IR calls it in every class
  const typed::Class *definition = nullptr;  // the first that has it
  const typed::Function *function = nullptr; // and what it has
  std::string step;                          // where it begins: `Filter_follow`
  std::string structure; // of what it is given, in the references to the class: `Follow`
  // as the IR passes it; null: where a result goes that stays whole
  std::vector<const typed::Variable *> given;
  std::vector<std::string> fields;   // of these
  std::vector<std::int32_t> offsets; // in the IR
  std::string returned;              // the field of the result; empty: there is none
};

class ModulePrinter {
public:
  /// `states`: what traces, split; null: traces are calls.
  ModulePrinter(const typed::Module &module, const ModuleFacts &facts, const Options &options,
                Diagnostics &diagnostics, const StateProgram *states);
  Declarations file();

  /// `inMemory`: as it lies in a record, a struct or an array, where a bool has 32 bits.
  std::string type(const Type *type, bool inMemory = false);
  std::string memoryType(const Type *type) { return this->type(type, true); }
  /// `{}`, or the zero of a number: what a variable without an initialiser holds.
  Code zero(const Type *type);
  /// A color of so many components, or of one that all have; of three it is RGB, whatever a color
  /// has here.
  Code colorOf(std::vector<Code> components);

  /// Does the function ask for the ray's state, or for its class's scratch members?
  bool takesState(const typed::Function &function);
  bool takesScratch(const typed::Function &function);
  /// May a call of the function, or of one that overrides it, end `anyHit`?
  bool mayAnswerHit(const typed::Function &function);
  /// `in` parameters that C++ takes by reference to const.
  bool isByReference(const typed::Variable &parameter, const typed::Function &function);
  /// Is it an `out` parameter that the function may leave, or read, as it is? Then that is zero.
  bool beginsAsZero(const typed::Variable &parameter, const typed::Function &function) const;
  /// The parameter's name, or one for a parameter that has none.
  std::string parameterName(const typed::Function &function, std::size_t number) const;
  /// A method that is called through references of a class; declares it there.
  void useThroughReference(const std::string &className, const std::string &method,
                           const typed::Function *function);
  void unsupported(SourceRange range, const std::string &what);
  /// Of a declaration in the IR; null: there is no such method.
  const CalledMethod *calledMethod(const std::string &symbol) const;
  /// The struct of what it is given: `FilterRef::Follow`.
  std::string structureOf(const CalledMethod &called) const;
  /// The C++ names that mean something in every method of a class: those at file level, and those
  /// of the class.
  const std::set<std::string> &namesInFile() const;
  std::set<std::string> namesInClass(const typed::Class &definition) const;

  /// Where the text stands, if that is to be printed.
  std::optional<SourcePlace> lineDirective(SourceRange range) const;
  std::optional<SourcePlace> lineDirective(SourceRange ofFile, unsigned line) const;

  const typed::Module &module;
  const ModuleFacts &facts;
  const Options &options;
  Names names;
  EffectsOf effects;
  typed::HitAnswers hitAnswers;
  SourceNotes notes;
  bool failed = false;
  std::set<const Type *> comparedStructs; // that need an operator ==
  bool throwsFromAnyHit = false;          // some answer stands where no `return` can

private:
  // constants of numbers that were printed as constexpr
  std::unordered_set<std::string> constexprNames;

  // Declarations.cpp
  Declaration structure(const typed::Struct &structure);
  Declaration constant(const typed::Variable &constant);
  bool isConstexpr(const Type *type, const typed::Constant *value, const std::string &name,
                   const Code &initialiser);
  Declarations freeFunctions();
  struct Mentions;
  Mentions mentionsOf(const typed::Function &function);
  Parameter parameter(const typed::Function &function, std::size_t number,
                      const Mentions &mentions);
  Function signature(const typed::Function &function, bool isMethod);
  Declaration function(const typed::Function &function, bool isMethod);
  Declaration classDefinition(const typed::Class &definition);
  Declarations ownMembers(const typed::Class &definition);
  Declarations methodsOfBases(const typed::Class &definition);
  Declaration member(const typed::Member &member);
  std::optional<Declaration> scratchStructure(const typed::Class &definition);
  Declarations heading() const;
  Declarations exported() const;
  Declaration classNumbers() const;
  bool isOverridden(const typed::Function &function) const;
  bool overrides(const typed::Function &function) const;

  // HitErrors.cpp
  Declarations hitErrors();

  // Attributes.cpp
  const typed::Class &top(const typed::Class &definition) const;
  std::vector<const typed::Class *> family(const typed::Class &definition) const;
  bool hasScratch(const typed::Class &definition);

  // States.cpp
  void findStates();
  /// Is the method printed as its states in this class? Has it become part of those of others?
  bool isSplit(const typed::Class &definition, const typed::Function &method) const;
  bool isPartOfStates(const typed::Function &function) const;
  /// The name in C++ of the first state of a method that rays start, or others call.
  std::string nameOfMachine(const typed::Class &definition, const typed::Function &method) const;
  Declarations stateMachine(const typed::Class &definition, const typed::Function &method);
  Machine machineOf(const typed::Class &definition, const typed::Function &method,
                    std::set<std::string> &taken);
  std::optional<Declaration> frameStructure(Machine &machine, std::set<std::string> &taken);
  void nameGiven(const Machine &machine, Statements &body);
  Declaration stateFunction(const Machine &machine, StateWriter &writer, std::size_t number);
  bool differsIn(const typed::Class &derived, const typed::Function &method) const;
  Declarations inheritedStateMachines(const typed::Class &definition);
  std::string meaningOf(const typed::Function &method, const FrameField &field);

  // RunState.cpp
  Declarations stepNumbers() const;
  Statements beginMethod(const typed::Class &definition, const typed::Function &method,
                         const typed::Struct *payload);
  Declarations runState();
  Statements describeStates() const;
  bool isRunBySteps(const std::string &slot) const; // "shade" and "miss", if anything traces

  // CalledMethods.cpp
  void findCalledMethods();
  const std::set<std::string> &typeNames() const; // of the author's structs and classes
  std::string stepName(const typed::Class &definition, const std::string &function);
  const CalledMethod *calledMethod(const typed::Class &definition,
                                   const typed::Function &method) const;
  Declarations callStructures(const std::string &className);
  Statements runCalledMethod(const CalledMethod &called);

  // Payloads.cpp
  std::optional<Declaration> rayType(const typed::Struct &structure) const;
  std::vector<const typed::Function *> payloadMethods(const typed::Class &definition,
                                                      const std::string &name) const;
  Statements callPayloadMethods(const char *base, const char *name);
  Declarations payloadSlots();
  Statements describePayloads();

  // Entries.cpp
  struct ThroughReference {
    std::string method;
    const typed::Function *function; // null: lookup, lookupFloat
  };
  Declarations references();
  Function referenceMethod(const ThroughReference &through);
  Statements lookUp(const std::string &className, bool isColor);
  Statements callThroughReference(const std::string &className, const typed::Function &function);
  Declarations referenceMethods();
  Statements callSlotMethod(const typed::Class &definition, const char *name);
  Declarations slots();
  std::vector<const typed::Class *> classesBelow(const std::string &className) const;
  Statements dispatch(const std::vector<const typed::Class *> &classes,
                      const std::function<Statements(const typed::Class &)> &run,
                      bool mayBeNone = false);
  /// The object that the runtime names, as one of this class; what the hit so far has stored for
  /// it.
  Code objectOf(const typed::Class &definition) const;
  Code storedScratch(const typed::Class &definition) const;
  /// The ray's payload; whether it is of that type.
  Code payloadAt(const typed::Struct &payload) const;
  Code carries(const typed::Struct &payload) const;
  /// With a variable for the ray's state in front.
  Statements withState(const Statements &body) const;
  const typed::Function *findMethod(const typed::Class &definition,
                                    const typed::Function &like) const;

  // Description.cpp
  Declarations description(); // of what slots() and others have printed
  Declarations describeStructs();
  Statement describeClass(const typed::Class &definition);
  Code describeConstructor(const Code &described, const typed::Function &constructor) const;
  Code describeMember(const Code &described, const std::string &className,
                      const typed::Member &member) const;
  Statements describeFeatures() const;

  /// `shadeAfterTrace1(rt, frame)`, on an object.
  struct MethodCall {
    std::string method;
    std::vector<Code> arguments;
    Code on(const Code &object) const { return callMember(object, method, arguments); }
  };
  /// A state that runs when a ray is back.
  struct Step {
    std::string name; // its number in C++
    const typed::Class *definition = nullptr;
    const typed::Function *method = nullptr;
    MethodCall call;
  };
  std::vector<Step> steps;
  std::set<std::string> stepNames;
  std::map<std::pair<const typed::Class *, std::string>, MethodCall>
      firstCalls;                                // by class and method
  std::vector<std::string> frames, calledFrames; // the structs
  const bool mayReferToNothing;                  // some reference
  const bool lookupsNest;                        // some texture looks up another
  std::vector<CalledMethod> calledMethods;

  const StateProgram *states;
  /// The states of each method of each class, by the names that the IR has and whether the method
  /// has a frame of its own.
  std::map<std::tuple<std::string, std::string, bool>, std::vector<mlir::func::FuncOp>> statesOf;
  mutable std::set<std::string> fileNames, fileTypes; // that namesInFile() and typeNames() give
  Diagnostics &diagnostics;
  std::map<std::string, std::vector<ThroughReference>> referenced; // by class
  std::map<const typed::Class *, std::optional<bool>> scratchOfFamily;
  std::set<const typed::Class *> withHitErrors; // that hitErrors() has printed
  // that slots() has printed, by base and method
  std::vector<std::pair<std::string, std::string>> filledSlots;
};

class FunctionPrinter {
public:
  /// `function` is null for an initialiser outside of functions, of a member of `owner` or at file
  /// level.
  FunctionPrinter(ModulePrinter &module, const typed::Function *function,
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

  ModulePrinter &module;
  const typed::Function *function;
  const typed::Class *owner;
  Statements *before = nullptr;                 // statements that go before the one being made
  bool isInLambda = false;                      // these are not the function's own
  std::set<std::string> usedNames, temporaries; // the latter are of variables of its own
  std::set<const typed::Variable *> readVariables, mentionedVariables, hoistedDeclarations;
  std::map<const typed::Variable *, Interval> counters;

  std::map<const typed::Expr *, Code> replaced; // parts that stand elsewhere, as what they are here
  bool isNested = true;                         // parts with effects are not among them

  friend class ModulePrinter;
  friend class StateWriter;
};

/// `inline void name(RtslState *ray, RtslRef object)`, which the runtime calls.
Function slotFunction(const std::string &name, Statements body);
/// `program.slots().name = &slots::function;`
Statement setSlot(const std::string &name, const std::string &function);
/// The method that a class has for a slot of language/Slots.def or SamplingSlots.def; null: none.
const typed::Function *slotMethod(const typed::Class &definition, const char *name);
/// Does it lie in a record, a struct or an array, where bools have 32 bits?
bool isInMemory(const typed::Expr &expr);
std::string join(const std::vector<std::string> &parts, const char *between);
bool endsInReturn(const Statements &statements);
/// `for (rtsl::Lights lights(rt, arguments); lights.next();)`, without what it runs.
Statement lightLoop(const std::string &lights, std::vector<Code> arguments);

} // namespace rtsl::cpp
