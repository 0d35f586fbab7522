//===- StateWriter.h - the body of a state --------------------------------===//
//
// Walks the structured IR of a state. What is computed once and used once becomes part of the
// expression that uses it, unless something in between would change it; the rest gets a variable
// under the author's name.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/Printer.h"
#include "codegen/cpp/States.h"
#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/MapVector.h"

namespace rtsl::cpp {

/// What stays in the frame of a method while its rays are traced.
struct FrameField {
  std::string slot; // as the IR names it
  std::string name, type;
  unsigned neededBy = 0; // the first line that reads it
  unsigned madeIn = 0;   // the line of what is saved
  bool isTraced = false; // a color that a ray brought back
  bool isReturned = false; // what a call returned
  bool isObject = false; // a variable that lies in the frame all the time
};

/// What the states of one method share.
struct Machine {
  const typed::Class *definition = nullptr;
  const typed::Function *method = nullptr;
  std::string file; // that has the method
  std::vector<mlir::func::FuncOp> states;
  std::vector<FrameField> frame;
  std::string frameName = "frame", callName = "call"; // of the parameters
  std::map<std::string, std::string> stepOf;          // by the symbol of the state
  const CalledMethod *called = nullptr;               // the method is called through references
  std::map<std::string, const CalledMethod *> callBefore; // what has returned when a state begins; null: it cannot be shown

  bool hasFrame() const { return called || !frame.empty(); }
  /// Which of what it is given the operation asks for.
  std::size_t given(ir::CallArgumentOp argument) const;
  /// The author's type of what is given.
  const Type *givenType(std::size_t number) const;
  /// The name for what is given by its address.
  std::string addressName(const ModulePrinter &printer, std::size_t number) const;
};

/// Does the evaluation write what lies at the address that it is given as this operand?
bool changes(ir::EvaluateOp op, std::size_t operand);

/// Does the operation write what lies at an address, or in a part of it?
bool writesTo(mlir::Operation *op, mlir::Value address);

/// The line of an operation in a file of the author's; of one of a function in another file, the
/// line that calls it. 0: unknown.
unsigned lineOf(mlir::Location location, llvm::StringRef file);

/// What a value is called among people: as the author calls it, or after the operation that makes it.
std::string nameFor(mlir::Value value);

/// Is it the compiler's name for what `&&` or `||` has come to?
bool isOwnName(llvm::StringRef name);

/// Does a text of C++ name the variable, or the place `frame.x`?
bool mentions(const std::string &text, const std::string &name);

/// The opposite of a condition.
Code negated(const Code &code);

/// `condition ? first : second`, of values of a type in C++.
std::string choose(const std::string &condition, const std::string &first, const std::string &second, const std::string &type);

class StateWriter {
public:
  StateWriter(ModulePrinter &module, const SourceTable &source, Machine &machine);

  /// The statements of a state, without braces.
  std::string body(mlir::func::FuncOp state);
  /// The C++ type of a value; empty if it cannot be told.
  std::string typeOf(mlir::Value value);
  /// The same by the name that a value has in the frame, where all that is saved are constants.
  std::string typeOfSlot(const std::string &slot, mlir::Type type);
  /// What a value is called: as nameFor() says, or in the frame.
  std::string nameOfValue(mlir::Value value);
  /// A name of the IR as C++ writes it: `m[0]` is m0, `ray.origin` ray_origin, and the state's `HitPoint` hitPoint.
  std::string spelling(llvm::StringRef name);
  bool usesScratch = false; // of the state that was written last
  /// The author's type of a variable that stays whole, or of a part of one; null: it is not known.
  const Type *declaredType(mlir::Value address);

private:
  /// What reading or writing meets: "var x", "state RayOrigin", "frame i", "random"; `any` is everything.
  struct Touches {
    std::set<std::string> reads, writes;
    bool readsAny = false, writesAny = false;
    void add(const Touches &other);
  };
  static bool meet(const Touches &a, const Touches &b);

  struct Pending {
    Code code;
    Touches touches;
    std::set<mlir::Operation *> mentions; // the variables in the code
    unsigned usesLeft = 0;
    bool isPure = true;     // no effects of its own
    bool isTrivial = false; // may stand in the text more than once
  };
  struct Statement {
    std::string comment, text;
    bool hasSpace = false; // an empty line above
    mlir::Operation *declares = nullptr; // a variable whose declaration this is, to be joined with its first assignment
    mlir::Operation *assigns = nullptr;  // `x = value;`
    std::string value;
    bool isDeclaration = false;
    mlir::Value made;        // what `type name = value;` is the variable of
    std::string whole, from; // a field of `whole` gets that of `from`, or zero
    std::set<mlir::Operation *> mentions;
  };
  using Statements = std::vector<Statement>;
  /// A vector with components replaced, one after the other.
  struct Insertion {
    struct Part {
      std::string component, index, value; // "x", or empty: the one at `index`
    };
    mlir::Value before; // all of them
    std::string vector; // that, in C++
    std::vector<Part> parts;
    std::string text() const; // `rtsl::with<0>(v, value)`
    /// `v.x`
    static std::string place(const std::string &vector, const Part &part);
  };

  // StateWriter.cpp
  void operation(mlir::Operation &op, Statements &out);
  void spawnPayload(ir::SpawnPayloadOp op);
  std::string call(ir::ReturnOp op);
  void leave(ir::ReturnOp op, Statements &out);
  void unsupported(mlir::Operation &op);

  // StateStatements.cpp
  void block(mlir::Block &block, Statements &out);
  std::optional<Code> takeCondition(ir::IfOp op, Statements &out, Statement &taken);
  std::string takeName(ir::IfOp op, const std::string &name, Statements &out);
  void choice(ir::IfOp op, Statements &out);
  void loop(ir::LoopOp op, Statements &out);
  void switchOver(ir::SwitchOp op, Statements &out);
  std::string text(const Statements &statements);
  std::string under(const Statements &statements);
  std::string lights(ir::LoopOp op, mlir::Block *&lit, std::string &name);
  std::string counter(ir::LoopOp op, const std::string &condition, Statements &out, Statements &body);
  void joinDeclarations(Statements &statements);

  // StateStores.cpp
  void evaluate(ir::EvaluateOp op, Statements &out);
  void clear(ir::ClearOp op, Statements &out);
  void store(ir::StoreOp op, Statements &out);
  std::string assignment(const std::string &target, const std::string &value, mlir::Value made);
  void joinFields(mlir::Value address, ir::FieldOp from, const std::string &target, const std::string &value, Statements &out);

  // StateOrder.cpp
  std::string keyOf(mlir::Value address);
  void note(mlir::Value address, Touches &touches, bool isWritten);
  Touches touchesOf(mlir::Operation *op);
  void emit(Statements &out, std::string text);
  void materialise(mlir::Value value, Statements &out, bool isNew = false);
  bool isReplacedBy(mlir::Value before, mlir::Value value);
  std::string named(mlir::Value value, Statements &out);
  void flush(const Touches &touches, Statements &out);
  void flushBefore(mlir::Operation &op, Statements &out);
  void define(mlir::Operation &op, Code code, Touches touches, bool isPure, Statements &out);

  // StateExpressions.cpp
  Code use(mlir::Value value, const std::string &type = {});
  Code constant(mlir::Value value, const std::string &type);
  Code place(mlir::Value address);
  Code opposite(mlir::Value condition, const Code &code);
  Code expression(const SourceTable::Entry &entry, mlir::ValueRange operands, bool &isCompound);
  void nameConstants(const typed::Expr &expr);

  // StateNames.cpp
  std::string varType(ir::VarOp variable);
  const std::string &nameOf(ir::VarOp variable);
  std::string freshName(const std::string &wanted);

  ModulePrinter &module;
  const SourceTable &source;
  Machine &machine;
  FunctionPrinter printer;
  std::set<std::string> taken, always;
  llvm::MapVector<mlir::Value, Pending> pending;
  llvm::DenseMap<mlir::Value, std::string> declared;
  std::map<std::string, mlir::Value> latest; // of the values that have a variable, by what they are called
  llvm::DenseMap<mlir::Operation *, std::string> variableNames;
  llvm::DenseMap<mlir::Operation *, std::string> variableTypes;
  std::set<mlir::Operation *> mentioned; // by the statement that is being put together
  Touches consumed;
  llvm::DenseMap<mlir::Value, Insertion> insertions;
  std::map<unsigned, std::string> comments;          // of statements, by line, until they are printed
  std::set<unsigned> spaces;                         // lines of statements with an empty line above, likewise
  unsigned currentLine = 0;
  llvm::DenseMap<mlir::Operation *, std::string> elementIndices; // of addresses
  std::vector<const typed::Variable *> constants;                // of the author's functions, that the state names
  bool hasRefused = false;
  std::string spawned; // the arguments of the ray that is traced when the state ends
};

} // namespace rtsl::cpp
