//===- Builtins.h - the signatures of the built-in functions --------------===//
#pragma once

#include "sema/model/Overload.h"

#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace rtsl {

/// The overloads of one name.
struct BuiltinOverloads {
  std::vector<Signature> signatures;
  std::vector<typed::Builtin> builtins; // of each signature
};

/// Expands the signatures of a name when it is first looked up, so that a file pays only for what
/// it uses.
class BuiltinTable {
public:
  explicit BuiltinTable(TypeContext &types) : types(types) {}

  /// Null if no built-in function has this name. `trace` and `print` list only their fixed forms.
  const BuiltinOverloads *find(const std::string &name);

private:
  TypeContext &types;
  std::unordered_map<std::string, BuiltinOverloads> expanded;
};

/// The built-in function of this name that changes an element of an output buffer in one step.
std::optional<typed::Builtin> atomicNamed(std::string_view name);

/// All names, for suggestions.
const std::vector<std::string> &builtinNames();

/// The functions that take a color.
std::vector<std::string> colorFunctionNames();

} // namespace rtsl
