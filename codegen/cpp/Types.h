//===- Types.h - types and zeros in C++ -----------------------------------===//
#pragma once

#include "codegen/cpp/Names.h"
#include "codegen/cpp/Requirements.h"
#include "codegen/cpp/tree/Expression.h"

namespace rtsl::cpp {

class Types {
public:
  Types(const Names &names, std::uint32_t colorComponents, Requirements &required)
      : names(names), colorComponents(colorComponents), required(required) {}

  std::string of(const Type *type) { return spelled(type, false); }
  /// The type of a value in a record, a struct or an array, where a bool has 32 bits.
  std::string inMemory(const Type *type) { return spelled(type, true); }
  /// `{}`, or the zero of a number: the value of a variable without an initialiser.
  Code zero(const Type *type) const;
  /// A color of these components, or of one for all. Three are RGB, whatever a color has here.
  Code color(std::vector<Code> components) const;

private:
  std::string spelled(const Type *type, bool inMemory);

  const Names &names;
  const std::uint32_t colorComponents;
  Requirements &required;
};

} // namespace rtsl::cpp
