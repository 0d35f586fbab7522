//===- ModuleFacts.h - results of linking a module without a scene --------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "sema/typed/TypedAst.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace rtsl {

/// A payload type, and how traversal searches for hits of its rays.
struct RayTypeFacts {
  const typed::Struct *payload = nullptr;
  std::uint32_t number = 0; // from 1
  std::uint32_t search = 0; // RTSL_FIRST_HIT, RTSL_INVOKE_ANY_HIT, RTSL_IN_ORDER
};

struct MeshAttributeFacts {
  std::string name;
  const Type *type = nullptr;
  /// The offsets, as in runtime::AttributeInfo.
  std::uint32_t offset = RTSL_NOT_READ, changes[2] = {RTSL_NOT_READ, RTSL_NOT_READ};
};

struct ModuleFacts {
  /// All payload types: first those that are traced, then those that only have methods for them.
  std::vector<RayTypeFacts> rayTypes;
  /// Offsets of scratch members in the attributes of a hit, in 32-bit words. A member that no
  /// method uses has none. Members of classes with a common base do not overlap.
  std::map<const typed::Member *, std::uint32_t> attributeWords;
  /// The scratch members of materials that can be named attributes of meshes, and which of them the
  /// methods of a class read, as bits.
  std::vector<MeshAttributeFacts> meshAttributes;
  std::map<const typed::Class *, std::uint32_t> meshAttributesOfClass;
  /// RTSL_NEEDS_*: the outputs of a hit that the methods of a class read, and those of the program.
  std::map<const typed::Class *, std::uint32_t> needsOfClass;
  std::uint32_t needs = 0;
};

} // namespace rtsl
