//===- Generators.cpp -----------------------------------------------------===//
#include "Generators.h"

#include <fmt/format.h>

namespace rtsl::numerics {

std::string show(device::Vec3 v) {
  return fmt::format("({:a}, {:a}, {:a})", v.x, v.y, v.z);
}

} // namespace rtsl::numerics
