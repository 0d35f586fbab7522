//===- Members.h - the members of a class, and its constructor ------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <string>
#include <vector>

namespace rtsl {

/// The constructor of a class, its own or inherited; null if there is none.
const typed::Function *findConstructor(const typed::Class &info);

/// All members of a class that its record holds or that `intersect` writes, inherited ones first.
std::vector<const typed::Member *> allMembers(const typed::Class &info);

/// Is it a class of images, which the library implements?
inline bool isSampler(const std::string &className) {
  return className == "sampler2D" || className == "sampler3D";
}

} // namespace rtsl
