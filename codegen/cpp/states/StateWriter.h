//===- StateWriter.h - the body of a state --------------------------------===//
//
// Walks the structured IR of a state. What is computed once and used once becomes part of the
// expression that uses it, unless something in between would change it; the rest gets a variable
// under the author's name.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/functions/FunctionPrinter.h"
#include "codegen/cpp/states/States.h"
#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/MapVector.h"

#include <tuple>

namespace rtsl::cpp {

/// What stays in the frame of a method while its rays are traced.
struct FrameField {
  std::string slot; // as the IR names it
  std::string name;
  const Type *type = nullptr; // null: it is not known
  unsigned neededBy = 0;      // the first line that reads it
  unsigned madeIn = 0;        // the line of what is saved
  bool isTraced = false;      // a color that a ray brought back
  bool isReturned = false;    // what a call returned
  bool isObject = false;      // a variable that lies in the frame all the time
};

/// What the states of one method share.
struct Machine {
  const typed::Class *definition = nullptr;
  const typed::Function *method = nullptr;
  std::string file;       // that has the method
  std::string slot, name; // of the method, in the IR and in C++
  std::vector<mlir::func::FuncOp> states;
  std::vector<std::string> functions; // what C++ calls them
  std::vector<FrameField> frame;
  // the struct of it, as the class names it and as others do; empty: there is none
  std::string frameStruct, frameType;
  std::string frameName = "frame", callName = "call"; // of the parameters
  std::map<std::string, std::string> stepOf;          // by the symbol of the state
  const CalledMethod *called = nullptr;               // the method is called through references
  // what has returned when a state begins; null: it cannot be shown
  std::map<std::string, const CalledMethod *> callBefore;

  std::set<std::string> joins; // states that begin where others have come together, by symbol

  bool hasFrame() const { return called || !frame.empty(); }
  /// The number of the argument that the operation reads.
  std::size_t given(ir::CallArgumentOp argument) const;
  /// The author's type of what is given.
  const Type *givenType(std::size_t number) const;
  /// The name for what is given by its address.
  std::string addressName(const Context &context, std::size_t number) const;
};

/// Does the evaluation write what lies at the address that it is given as this operand?
bool changes(ir::EvaluateOp op, std::size_t operand);

/// Does the operation write what lies at an address, or in a part of it?
bool writesTo(mlir::Operation *op, mlir::Value address);

/// The line of an operation in a file of the author's; of one of a function in another file, the
/// line that calls it. 0: unknown.
unsigned lineOf(mlir::Location location, llvm::StringRef file);

/// A readable name for a value: the author's, or one after the operation that makes it.
std::string nameFor(mlir::Value value);

/// Is it the compiler's name for the result of `&&` or `||`?
bool isOwnName(llvm::StringRef name);

class StateWriter {
public:
  StateWriter(Context &context, const SourceTable &source, Machine &machine);

  /// The statements of a state.
  Statements body(mlir::func::FuncOp state);
  /// The author's type of a value; null if it is not known.
  const Type *typeOf(mlir::Value value);
  /// The same by the name that a value has in the frame, where all that is saved are constants.
  const Type *typeOfSlot(const std::string &slot, mlir::Type type);
  /// The name of a value: nameFor(), or that of its field in the frame.
  std::string nameOfValue(mlir::Value value);
  /// A name of the IR as C++ writes it: `m[0]` is m0, `ray.origin` ray_origin, and the state's
  /// `HitPoint` hitPoint.
  std::string spelling(llvm::StringRef name);
  bool usesScratch = false; // of the state that was written last
  /// The author's type of a variable that stays whole, or of a part of one; null: it is not known.
  const Type *declaredType(mlir::Value address);

private:
  /// Something that can be read and written: a variable of the state, of the ray or of the frame,
  /// ...
  struct Location {
    enum class Kind : std::uint8_t { Variable, State, Frame, Object, Payload, Argument, Random };
    Kind kind;
    std::string name;
    bool operator<(const Location &other) const {
      return std::tie(kind, name) < std::tie(other.kind, other.name);
    }
  };
  /// The memory that is read and written; `any` is all of it.
  struct Touches {
    std::set<Location> reads, writes;
    bool readsAny = false, writesAny = false;
    void add(const Touches &other);
  };
  static bool meet(const Touches &a, const Touches &b);

  struct Pending {
    Code code;
    Touches touches;
    unsigned usesLeft = 0;
    bool isPure = true;     // no effects of its own
    bool isTrivial = false; // may stand in the text more than once
  };
  /// A vector with components replaced, one after the other.
  struct Insertion {
    struct Part {
      std::optional<std::size_t> component; // nothing: the one at `index`
      Code index, value;
    };
    mlir::Value before; // all of them
    Code vector;        // that, in C++
    std::vector<Part> parts;
    Code code() const; // `rtsl::with<0>(v, value)`
    /// `v.x`
    static Code place(const Code &vector, const Part &part);
  };

  // StateWriter.cpp
  void operation(mlir::Operation &op, Statements &out);
  /// The result of an operation is this, made of the operands that were used for it; or it is the
  /// same wherever it stands in the state.
  void make(mlir::Operation &op, Code code, Statements &out);
  void makeAnywhere(mlir::Operation &op, Code code, Statements &out);
  const FrameField *savedField(llvm::StringRef slot) const;
  void write(ir::VarOp op, Statements &out);
  void write(ir::LoadOp op, Statements &out);
  void write(ir::CopyOp op, Statements &out);
  void write(ir::ElementOp op, Statements &out);
  void write(ir::FrameLoadOp op, Statements &out);
  void write(ir::FrameStoreOp op, Statements &out);
  void write(ir::ExpressionOp op, Statements &out);
  void write(ir::SpawnOp op);
  void write(ir::SpawnPayloadOp op);
  void write(ir::RandOp op, Statements &out);
  void write(ir::IlluminateOp op, Statements &out);
  void write(ir::CallArgumentOp op, Statements &out);
  void write(ir::CallResultOp op, Statements &out);
  void write(ir::CallReturnedOp op, Statements &out);
  Code call(ir::ReturnOp op);
  void leave(ir::ReturnOp op, Statements &out);
  void unsupported(mlir::Operation &op);

  // StateValues.cpp
  void infix(mlir::Operation &op, Operator sign, Statements &out);
  void write(mlir::vector::ExtractOp op, Statements &out);
  void write(mlir::vector::InsertOp op, Statements &out);
  void write(mlir::vector::FromElementsOp op, Statements &out);
  void write(mlir::vector::BroadcastOp op, Statements &out);
  void write(mlir::vector::ShuffleOp op, Statements &out);
  void write(mlir::arith::XOrIOp op, Statements &out);
  void write(mlir::arith::AndIOp op, Statements &out);
  void write(mlir::arith::OrIOp op, Statements &out);
  void write(mlir::arith::AddIOp op, Statements &out);
  void write(mlir::arith::CmpIOp op, Statements &out);
  void write(mlir::arith::SelectOp op, Statements &out);

  // StateStatements.cpp
  void block(mlir::Block &block, Statements &out);
  void choice(ir::IfOp op, Statements &out);
  void loop(ir::LoopOp op, Statements &out);
  void switchOver(ir::SwitchOp op, Statements &out);
  std::optional<Statement> lights(ir::LoopOp op, mlir::Block *&lit, std::string &name);
  void nameOpenDeclarations(Statements &out);

  // StateStores.cpp
  void write(ir::EvaluateOp op, Statements &out);
  void write(ir::ClearOp op, Statements &out);
  void write(ir::StoreOp op, Statements &out);
  Code assignment(const Code &target, const Code &value, mlir::Value made);
  WrittenVariable written(ir::VarOp variable);
  WrittenField writtenField(ir::StoreOp op);

  // StateOrder.cpp
  Location locationOf(mlir::Value address);
  void note(mlir::Value address, Touches &touches, bool isWritten);
  Touches touchesOf(mlir::Operation *op);
  Statement &emit(Statements &out, Statement statement);
  Statement &emit(Statements &out, Code code) { return emit(out, statement(std::move(code))); }
  void materialise(mlir::Value value, Statements &out, bool isNew = false);
  bool isReplacedBy(mlir::Value before, mlir::Value value);
  Code named(mlir::Value value, Statements &out);
  void flush(const Touches &touches, Statements &out);
  void flushBefore(mlir::Operation &op, Statements &out);
  void define(mlir::Operation &op, Code code, Touches touches, bool isPure, Statements &out);

  // StateExpressions.cpp
  Code use(mlir::Value value, const Type *type = nullptr);
  Code constant(mlir::Value value, const Type *type);
  Code place(mlir::Value address);
  Code frameField(const std::string &field) const { return member(name(machine.frameName), field); }
  Code opposite(mlir::Value condition, const Code &code);
  void replaceLeaves(const SourceTable::Entry &entry, mlir::ValueRange operands);
  Code expression(const SourceTable::Entry &entry, mlir::ValueRange operands);
  void nameConstants(const typed::Expr &expr);

  // StateNames.cpp
  const Type *vec3();
  const Type *varType(ir::VarOp variable);
  const std::string &nameOf(ir::VarOp variable);
  std::string freshName(const std::string &wanted);

  Context &context;
  const SourceTable &source;
  Machine &machine;
  FunctionPrinter printer;
  std::set<std::string> taken, always;
  bool isAlways(const std::string &name) const {
    return always.count(name) || context.namesInFile().count(name);
  }
  llvm::MapVector<mlir::Value, Pending> pending;
  llvm::DenseMap<mlir::Value, std::string> declared;
  // of the values that have a variable, by what they are called
  std::map<std::string, mlir::Value> latest;
  llvm::DenseMap<mlir::Operation *, std::string> variableNames;
  llvm::DenseMap<mlir::Operation *, const Type *> variableTypes;
  // what is read of the variable that counts lights
  llvm::DenseMap<mlir::Operation *, Code> lightNumbers;
  Touches consumed;
  llvm::DenseMap<mlir::Value, Insertion> insertions;
  std::map<unsigned, std::string> comments; // of statements, by line, until they are printed
  std::set<unsigned> spaces; // lines of statements with an empty line above, likewise
  unsigned currentLine = 0;
  llvm::DenseMap<mlir::Operation *, Code> elementIndices; // of addresses
  std::vector<const typed::Variable *> constants; // of the author's functions, that the state names
  bool hasRefused = false;
  std::vector<Code> spawned; // the arguments of the ray that is traced when the state ends
};

} // namespace rtsl::cpp
