//===- ScratchMembers.h - scratch members, and where they lie in a hit ----===//
//
// A class with scratch members has a struct `Scratch` of them, which its methods take: in
// `intersect` it is a variable of that call, elsewhere what the hit that won has stored. A material
// finds a primitive's attribute by name and type, so equal ones have the same place
// (codegen/link/steps/PlaceAttributes.cpp). Classes that derive from one another share one
// `Scratch`, with the members of all.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/Effects.h"

#include <optional>
#include <vector>

namespace rtsl::cpp {

/// The base of all bases of a class, or itself.
const typed::Class &rootOf(const typed::Class &definition);

class ScratchMembers {
public:
  ScratchMembers(const typed::Module &module, typed::EffectsOf &effects)
      : module(module), effects(effects) {}

  /// Classes that share a `Scratch`: all with the same root.
  std::vector<const typed::Class *> family(const typed::Class &definition) const;
  bool has(const typed::Class &definition);

private:
  const typed::Module &module;
  typed::EffectsOf &effects;
  std::map<const typed::Class *, std::optional<bool>> known; // by root
};

} // namespace rtsl::cpp
