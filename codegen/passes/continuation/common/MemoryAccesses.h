//===- MemoryAccesses.h - memory that operations read and write -----------===//
#pragma once

#include "codegen/ir/Rtsl.h"

#include <set>
#include <tuple>

namespace rtsl::cpp {

/// Something that can be read and written: a variable of the state, of the ray or of the frame, ...
struct MemoryLocation {
  enum class Kind : std::uint8_t { Variable, State, Frame, Object, Payload, Argument, Random };
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
/// Of an operation and what is nested in it.
MemoryAccesses accessesOf(mlir::Operation *op);

/// Does the evaluation write what lies at the address that it has as this operand?
bool changes(ir::EvaluateOp op, std::size_t operand);
/// Does the operation write what lies at an address, or in a part of it?
bool writesTo(mlir::Operation *op, mlir::Value address);

} // namespace rtsl::cpp
