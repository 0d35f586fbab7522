//===- Builtin.cpp - the built-in functions and their properties ----------===//
#include "sema/typed/Builtin.h"

#include "language/Costs.h"

#include <algorithm>
#include <string_view>

namespace rtsl::typed {

const BuiltinInfo &info(Builtin builtin) {
  using namespace cost;
  using namespace effect;
  static constexpr BuiltinInfo table[] = {
#define RTSL_BUILTIN(id, name, effects, cost, where, formula, ...)                                 \
  {name, effects, cost, {__VA_ARGS__}},
#include "language/Builtins.def"
  };
  return table[static_cast<std::size_t>(builtin)];
}

const char *name(Builtin builtin) {
  return info(builtin).name;
}

/// "F F >F": the result, and after each space a parameter.
static std::string_view firstSignature(Builtin builtin) {
  return info(builtin).signatures.front();
}

std::size_t parameterCount(Builtin builtin) {
  const std::string_view signature = firstSignature(builtin);
  return static_cast<std::size_t>(std::count(signature.begin(), signature.end(), ' '));
}

bool isOutArgument(Builtin builtin, std::size_t index) {
  const std::string_view signature = firstSignature(builtin);
  for (std::size_t at = signature.find(' '); at != signature.npos; at = signature.find(' ', at + 1))
    if (index-- == 0)
      return signature[at + 1] == '>';
  return false;
}

std::pair<std::size_t, std::size_t> outputsOf(Builtin builtin) {
  if (!has(builtin, effect::Outputs))
    return {0, 0};
  const std::size_t parameters = parameterCount(builtin);
  std::size_t first = 0, count = 0;
  while (first < parameters && !isOutArgument(builtin, first))
    ++first;
  while (first + count < parameters && isOutArgument(builtin, first + count))
    ++count;
  return {first, count};
}

} // namespace rtsl::typed
