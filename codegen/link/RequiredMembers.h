//===- RequiredMembers.h - which members a scene must set -----------------===//
#pragma once

#include "sema/typed/Effects.h"
#include "sema/typed/TypedAst.h"

#include <map>
#include <optional>
#include <set>

namespace rtsl {

/// Facts about the classes of a module, which do not depend on what a scene needs of them.
class RequiredMembers {
public:
  explicit RequiredMembers(const typed::Module &module) : module(module) {}

  /// Must objects of the class be given a value for the member? It is public, has no default, is
  /// not written by the constructor, and some function of the class reads it. Whether a reference
  /// is empty shows when the object is complete, and a buffer may be empty: neither counts.
  bool has(const typed::Class &info, const typed::Member &member);

private:
  struct Uses {
    std::set<const void *> read, written;
  };
  const Uses &usesOf(const typed::Class &info);

  const typed::Module &module;
  std::optional<typed::EffectsOf> effects; // once there is a constructor
  std::map<const typed::Class *, Uses> known;
};

} // namespace rtsl
