//===- BoxCases.h - boxes of every bad kind, and their oracle -------------===//
#pragma once

#include "Generators.h"

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::numerics {

struct Box {
  device::Vec3 lower, upper;
};

/// The smallest box that holds both.
Box boxAround(device::Vec3 a, device::Vec3 b);

/// A box and a ray that is aimed at it, or nearly.
struct BoxCase {
  Ray ray;
  Box box;

  /// Whether the ray meets the box, exactly, ends and sides included. Such a box must be entered;
  /// entering one too many costs time, not a hit.
  bool meetsExactly() const;
  std::string text() const {
    return ray.text() + ", box " + show(box.lower) + " " + show(box.upper);
  }
};

/// One way in which boxes are hard; `make` gives the case of that number.
struct BoxKind {
  const char *name, *description;
  BoxCase (*make)(Random &random, std::uint64_t number);
};
const std::vector<BoxKind> &boxKinds();

} // namespace rtsl::numerics
