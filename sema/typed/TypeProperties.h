//===- TypeProperties.h - queries on types --------------------------------===//
#pragma once

#include "sema/typed/Type.h"

#include <cstdint>

namespace rtsl {

/// Bytes of a value in memory: every scalar takes 4, vectors and matrices are packed. Saturates at
/// 2^62, so that the sizes of all arrays can be compared.
std::uint64_t sizeInBytes(const Type *type, std::uint32_t colorComponents = 3);

/// Scalars of a value known at compile time; a color counts as 0, because the target chooses its
/// number of components.
std::uint64_t scalarCount(const Type *type);

/// Is there a part of this kind anywhere in a value of this type?
bool contains(const Type *type, TypeKind kind);

/// The nesting depth of structs and arrays around the innermost part: `float` 0, `S[2]` with S flat
/// 2.
std::uint32_t nestingDepth(const Type *type);

/// Deeper types are rejected: no real program has them, and walks over types recurse.
constexpr std::uint32_t maxTypeNesting = 64;
/// A local variable of more bytes than this is rejected ...
constexpr std::uint64_t maxLocalBytes = 16ull << 20;
/// ... and one of more than this causes a warning: a GPU thread has a few kilobytes.
constexpr std::uint64_t largeLocalBytes = 64ull << 10;

} // namespace rtsl
