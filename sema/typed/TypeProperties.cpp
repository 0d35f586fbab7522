//===- TypeProperties.cpp - queries on types ------------------------------===//
//
// All of these recurse over the nesting of a type, which `maxTypeNesting` bounds.
//
//===----------------------------------------------------------------------===//
#include "sema/typed/TypeProperties.h"

#include "sema/typed/TypedAst.h"

#include <algorithm>

namespace rtsl {

static constexpr std::uint64_t saturated = 1ull << 62;

static std::uint64_t saturatingMultiply(std::uint64_t a, std::uint64_t b) {
  std::uint64_t product = 0;
  return __builtin_mul_overflow(a, b, &product) ? saturated : std::min(product, saturated);
}

/// The sum of `leaf` over all parts of a type that are not structs or arrays.
template <typename Leaf>
static std::uint64_t sumOverParts(const Type *type, const Leaf &leaf) {
  if (type->is(TypeKind::Array))
    return saturatingMultiply(type->count, sumOverParts(type->element, leaf));
  if (!type->is(TypeKind::Struct))
    return leaf(type);
  std::uint64_t sum = 0;
  for (const typed::Field &field : type->structure->fields)
    sum = std::min(saturated, sum + sumOverParts(field.type, leaf));
  return sum;
}

std::uint64_t sizeInBytes(const Type *type, std::uint32_t colorComponents) {
  return sumOverParts(type, [colorComponents](const Type *part) -> std::uint64_t {
    switch (part->kind) {
    case TypeKind::Color:
      return 4ull * colorComponents;
    case TypeKind::Class:
      return 4;
    case TypeKind::Buffer:
      return 20;
    default:
      return 4ull * part->componentCount();
    }
  });
}

std::uint64_t scalarCount(const Type *type) {
  return sumOverParts(type,
                      [](const Type *part) -> std::uint64_t { return part->componentCount(); });
}

bool contains(const Type *type, TypeKind kind) {
  if (type->is(kind))
    return true;
  if (type->is(TypeKind::Array) || type->is(TypeKind::Buffer) || type->is(TypeKind::Vector))
    return contains(type->element, kind);
  if (type->is(TypeKind::Struct))
    for (const typed::Field &field : type->structure->fields)
      if (contains(field.type, kind))
        return true;
  return false;
}

std::uint32_t nestingDepth(const Type *type) {
  if (type->is(TypeKind::Array) || type->is(TypeKind::Buffer))
    return 1 + nestingDepth(type->element);
  std::uint32_t depth = 0;
  if (type->is(TypeKind::Struct)) {
    for (const typed::Field &field : type->structure->fields)
      depth = std::max(depth, nestingDepth(field.type));
    ++depth;
  }
  return depth;
}

} // namespace rtsl
