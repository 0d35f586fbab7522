//===- TypeProperties.h - questions about types ---------------------------===//
#pragma once

#include "sema/typed/Type.h"

#include <cstdint>

namespace rtsl {

/// Bytes of a value in memory: every scalar takes 4, vectors and matrices are packed, a color
/// counts as three floats. Saturates at 2^62, so that the size of any array that can be written
/// down is safe to compare.
std::uint64_t sizeInBytes(const Type *type);

/// Scalars of a value known at compile time; a color counts as none, for its number is the target's
/// choice.
std::uint64_t scalarCount(const Type *type);

/// Is there a part of this kind anywhere in a value of this type?
bool contains(const Type *type, TypeKind kind);

/// How many structs and arrays lie around the innermost part: `float` 0, `S[2]` with S flat 2.
std::uint32_t nestingDepth(const Type *type);

/// Deeper types are refused: nobody writes them, and every walk over a type recurses.
constexpr std::uint32_t maxTypeNesting = 64;
/// A local variable of more bytes than this is refused ...
constexpr std::uint64_t maxLocalBytes = 16ull << 20;
/// ... and one of more than this is worth a warning: a GPU thread has a few kilobytes.
constexpr std::uint64_t largeLocalBytes = 64ull << 10;

} // namespace rtsl
