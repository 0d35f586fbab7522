//===- Machine.h - a method that traces, and what it saves ----------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/ir/Rtsl.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"

namespace rtsl::cpp {

/// A field of a method's frame, which keeps a value while the method's rays are traced.
struct FrameField {
  std::string key; // as the IR names it
  std::string name;
  const Type *type = nullptr; // null: it is not known
  unsigned neededBy = 0;      // the first line that reads it
  unsigned madeIn = 0;        // the line of what is saved
  bool isTraced = false;      // the color of a ray
  bool isReturned = false;    // what a call returned
  bool isObject = false;      // a variable that lies in the frame all the time
  bool isUnnamed = false;     // its key names an operation, not what the author called it
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

  /// The field of a saved value; null: it is not in the frame.
  const FrameField *savedField(llvm::StringRef key) const;
  bool hasFrame() const { return called || !frame.empty(); }
  /// The number of the argument that the operation reads.
  std::size_t argumentNumber(ir::CallArgumentOp argument) const;
  /// The author's type of an argument.
  const Type *argumentType(std::size_t number) const;
  /// The name for an argument that is passed as an address.
  std::string addressName(const Context &context, std::size_t number) const;
};

/// The line of an operation in a file of the author's; of one of a function in another file, the
/// line that calls it. 0: unknown.
unsigned lineOf(mlir::Location location, llvm::StringRef file);

} // namespace rtsl::cpp
