//===- MemoryAccesses.h - memory that operations read and write -----------===//
//
// The one analysis of memory on the IR: of single operations here, and of functions with their
// callees in Recompute.h (WriteSummary) and, before they are inlined, in ShareCalls.cpp.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"

#include <set>
#include <tuple>

namespace rtsl::ir {

/// Something that can be read and written.
struct MemoryLocation {
  enum class Kind : std::uint8_t {
    Variable,
    State,     // a state variable of the ray
    Frame,     // a slot of the frame
    Object,    // a variable that lies in the frame
    Payload,   // of the ray that runs the shader
    Argument,  // of a function on its own frame: an address of its caller's
    Random,    // the sequence of random numbers
    Attribute, // of the hit
    Scene,     // members, tables and buffers
    Unknown
  };
  Kind kind;
  std::string name;
  bool operator<(const MemoryLocation &other) const {
    return std::tie(kind, name) < std::tie(other.kind, other.name);
  }
};

/// The memory that is read and written; `any` is all of it.
struct MemoryAccesses {
  std::set<MemoryLocation> reads, writes;
  bool readsAny = false, writesAny = false;
  void add(const MemoryAccesses &other);
};

/// Does one write what the other reads or writes? If not, they may be exchanged.
bool conflict(const MemoryAccesses &a, const MemoryAccesses &b);
MemoryLocation locationOf(mlir::Value address);
/// The accesses of an operation and of those nested in it.
MemoryAccesses accessesOf(mlir::Operation *op);

/// Does the evaluation write what lies at the address that it has as this operand?
bool changes(ir::EvaluateOp op, std::size_t operand);
/// Has the evaluation no effect but its value?
bool changesNothing(ir::EvaluateOp op);
/// Does the operation write what lies at an address, or in a part of it?
bool writesTo(mlir::Operation *op, mlir::Value address);

} // namespace rtsl::ir
