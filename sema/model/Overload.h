//===- Overload.h - which of several functions a call means ---------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <string>
#include <vector>

namespace rtsl {

/// The properties of a function that overload resolution uses.
struct Signature {
  struct Parameter {
    const Type *type = nullptr;
    ast::Direction direction = ast::Direction::In;
  };
  const Type *result = nullptr;
  std::vector<Parameter> parameters;
};

/// The best candidate for arguments of these types, by GLSL's rules (GLSL 4.60, 6.1): a candidate
/// is better than another if no argument needs a worse conversion and one a better one. Exact types
/// are better than conversions; conversions are not ranked among one another. `out` and `inout`
/// parameters take exactly their type.
struct Resolution {
  int chosen = -1;       // index of the candidate; -1: none or ambiguous
  std::vector<int> ties; // the best candidates, if there are several
};
Resolution resolveOverload(const std::vector<Signature> &candidates,
                           const std::vector<const Type *> &arguments);

/// `vec3 mix(vec3, vec3, float)`, for messages.
std::string describe(const std::string &name, const Signature &signature);
/// `float, vec3`
std::string describe(const std::vector<const Type *> &types);

} // namespace rtsl
