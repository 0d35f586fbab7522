//===- Layout.h - sizes and offsets in memory -----------------------------===//
//
// The only computation of layouts: code generation, linking and the class descriptions for the
// runtime all use it. Everything is aligned to 4 bytes: a bool and an integer take 4, a vector of N
// scalars 4 N (a color as many as it has components), a matrix its columns, a struct its fields in
// order, a reference 4, a buffer an RtslBuffer.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "mlir/IR/Types.h"
#include "llvm/ADT/StringRef.h"

#include <cstdint>
#include <optional>

namespace rtsl::ir {

class ClassOp;
class StructType;

constexpr std::uint32_t memoryAlignment = 4;

/// Size in memory of a storable type, in bytes, a multiple of 4.
std::uint32_t sizeInBytes(mlir::Type type);

/// Bytes from the start of a struct to its field number `index`.
std::uint32_t fieldOffset(StructType type, unsigned index);

/// Bytes of an object's record: the class id, then the members in order (scratch members take no
/// space).
std::uint32_t recordSize(ClassOp classOp);

/// Bytes from the start of the record to a member; none for a scratch or an unknown member.
std::optional<std::uint32_t> memberOffset(ClassOp classOp, llvm::StringRef member);

} // namespace rtsl::ir
