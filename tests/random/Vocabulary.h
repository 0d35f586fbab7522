//===- Vocabulary.h - types and built-in functions to choose from ---------===//
#pragma once

#include "sema/model/Builtins.h"
#include "sema/typed/TypedAst.h"

#include <map>
#include <memory>
#include <string>
#include <vector>

namespace rtsl::random {

/// One overload of a built-in function.
struct BuiltinChoice {
  std::string name;
  const Signature *signature = nullptr;
  const BuiltinOverloads *overloads = nullptr; // all of that name
  std::size_t index = 0;                       // among them
};

/// What the language offers, taken from the checker's own tables: a built-in function that is added
/// there is tested here.
class Vocabulary {
public:
  static Vocabulary &get();

  TypeContext types;
  std::vector<const Type *> scalars, vectors, matrices;
  /// Built-in functions that may stand anywhere, by result and then by operation.
  std::map<const Type *, std::vector<std::vector<BuiltinChoice>>> byResult;

  /// A struct type; it lives as long as the process, as types do.
  const Type *structure(std::string name, std::vector<typed::Field> fields);

private:
  Vocabulary();
  BuiltinTable builtins;
  std::vector<std::unique_ptr<typed::Struct>> structs;
};

/// The simplest value of a type: `vec3(0.0)`.
std::string simplestValue(const Type *type);

} // namespace rtsl::random
