//===- Builtin.h - the built-in functions and their properties ------------===//
//
// The rows of language/Builtins.def, which says what each property means. How signatures expand to
// overloads is in sema/model/Builtins.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace rtsl::typed {

enum class Builtin : std::uint8_t {
#define RTSL_BUILTIN(id, ...) id,
#include "language/Builtins.def"
};

namespace effect {
enum Effect : std::uint16_t {
  Pure = 0,
  Outputs = 1 << 0,
  Reads = 1 << 1,
  Random = 1 << 2,
  Traces = 1 << 3,
  Lights = 1 << 4,
  Samples = 1 << 5,
  Hits = 1 << 6,
  EndsHit = 1 << 7,
  Visits = 1 << 8,
  Prints = 1 << 9,
  Atomic = 1 << 10,
};
} // namespace effect

struct BuiltinInfo {
  const char *name;
  std::uint16_t effects;                    // a union of effect::Effect
  unsigned cost;                            // approximate number of instructions per component
  std::array<const char *, 8> signatures{}; // null after the last
};
const BuiltinInfo &info(Builtin builtin);
const char *name(Builtin builtin);

/// Does a call have this effect?
inline bool has(Builtin builtin, effect::Effect effect) {
  return (info(builtin).effects & effect) != 0;
}
/// No side effects, and the same value for the same arguments during a ray.
inline bool isPure(Builtin builtin) {
  return (info(builtin).effects & ~effect::Reads) == 0;
}
/// Does its value depend on the arguments alone, so that a call of constants folds?
inline bool isFoldable(Builtin builtin) {
  return info(builtin).effects == effect::Pure;
}
/// Does it change an element of an output buffer, its first argument, in one step?
inline bool isAtomic(Builtin builtin) {
  return has(builtin, effect::Atomic);
}

/// The number of parameters of its first signature.
std::size_t parameterCount(Builtin builtin);

/// Is this argument written to?
bool isOutArgument(Builtin builtin, std::size_t index);

/// The arguments that a function without other effects writes: the index of the first, and their
/// number; none: 0, 0.
std::pair<std::size_t, std::size_t> outputsOf(Builtin builtin);

} // namespace rtsl::typed
