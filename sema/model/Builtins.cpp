//===- Builtins.cpp - the signatures of the built-in functions ------------===//
#include "sema/model/Builtins.h"

#include <algorithm>
#include <string_view>

namespace rtsl {

using typed::Builtin;

namespace {
/// A built-in function and one of its signatures, as in Builtins.def.
struct Row {
  Builtin builtin;
  std::string_view signature;
};
} // namespace

static const std::vector<Row> &allRows() {
  static const std::vector<Row> rows = [] {
    std::vector<Row> all;
#define RTSL_BUILTIN(id, ...)                                                                      \
  for (const char *signature : typed::info(Builtin::id).signatures)                                \
    if (signature)                                                                                 \
      all.push_back({Builtin::id, signature});
#include "language/Builtins.def"
    return all;
  }();
  return rows;
}

std::optional<Builtin> atomicNamed(std::string_view name) {
#define RTSL_BUILTIN(id, spelling, ...)                                                            \
  if (typed::isAtomic(Builtin::id) && name == spelling)                                            \
    return Builtin::id;
#include "language/Builtins.def"
  return std::nullopt;
}

//===----------------------------------------------------------------------===//
// Expansion
//===----------------------------------------------------------------------===//

/// Components (of generic letters), columns and rows for which a row is expanded.
struct Shape {
  std::uint32_t components = 1, columns = 2, rows = 2;
};

static const Type *typeOfLetter(char letter, Shape shape, TypeContext &types) {
  auto sized = [&](const Type *scalar) {
    return shape.components == 1 ? scalar : types.vector(scalar, shape.components);
  };
  switch (letter) {
  case 'F':
  case 'v':
    return sized(types.floatType);
  case 'I':
  case 'w':
    return sized(types.intType);
  case 'U':
  case 'x':
    return sized(types.uintType);
  case 'B':
  case 'y':
    return sized(types.boolType);
  case 'f':
    return types.floatType;
  case 'i':
    return types.intType;
  case 'u':
    return types.uintType;
  case 'b':
    return types.boolType;
  case '2':
  case '3':
  case '4':
    return types.vector(types.floatType, static_cast<std::uint32_t>(letter - '0'));
  case 'c':
    return types.color;
  case 'M':
    return types.matrix(shape.columns, shape.rows);
  case 'T':
    return types.matrix(shape.rows, shape.columns);
  case 'S':
    return types.matrix(shape.columns, shape.columns);
  case 'p':
    return types.vector(types.floatType, shape.rows);
  case 'q':
    return types.vector(types.floatType, shape.columns);
  default:
    return types.voidType;
  }
}

static Signature expand(std::string_view row, Shape shape, TypeContext &types) {
  Signature signature;
  ast::Direction direction = ast::Direction::In;
  for (char letter : row) {
    if (letter == ' ')
      continue;
    if (letter == '>') {
      direction = ast::Direction::Out;
      continue;
    }
    const Type *type = typeOfLetter(letter, shape, types);
    if (!signature.result)
      signature.result = type;
    else
      signature.parameters.push_back({type, direction});
    direction = ast::Direction::In;
  }
  return signature;
}

/// The shapes to which the letters of a row expand.
static std::vector<Shape> shapesOf(std::string_view row) {
  auto hasOneOf = [&](const char *letters) { return row.find_first_of(letters) != row.npos; };
  std::vector<Shape> shapes;
  if (hasOneOf("MTpq")) {
    for (std::uint32_t columns = 2; columns <= 4; ++columns)
      for (std::uint32_t rowCount = 2; rowCount <= 4; ++rowCount)
        shapes.push_back({1, columns, rowCount});
  } else if (hasOneOf("S")) {
    for (std::uint32_t columns = 2; columns <= 4; ++columns)
      shapes.push_back({1, columns, columns});
  } else {
    const std::uint32_t first = hasOneOf("vwxy") ? 2 : 1;
    const std::uint32_t last = hasOneOf("vwxyFIUB") ? 4 : 1;
    for (std::uint32_t components = first; components <= last; ++components)
      shapes.push_back({components, 2, 2});
  }
  return shapes;
}

static bool sameParameters(const Signature &a, const Signature &b) {
  return std::equal(a.parameters.begin(), a.parameters.end(), b.parameters.begin(),
                    b.parameters.end(),
                    [](const Signature::Parameter &x, const Signature::Parameter &y) {
                      return x.type == y.type;
                    });
}

/// Any struct is a payload, so such a call is checked by code of its own.
static bool takesPayload(const Row &row) {
  return row.signature.find('P') != row.signature.npos;
}

const BuiltinOverloads *BuiltinTable::find(const std::string &name) {
  if (auto found = expanded.find(name); found != expanded.end())
    return found->second.signatures.empty() ? nullptr : &found->second;
  BuiltinOverloads overloads;
  for (const Row &row : allRows()) {
    if (name != typed::name(row.builtin) || takesPayload(row))
      continue;
    for (Shape shape : shapesOf(row.signature)) {
      Signature signature = expand(row.signature, shape, types);
      // `min(F, f)` equals `min(F, F)` if F is float.
      const bool known =
          std::any_of(overloads.signatures.begin(), overloads.signatures.end(),
                      [&](const Signature &other) { return sameParameters(signature, other); });
      if (known)
        continue;
      overloads.signatures.push_back(std::move(signature));
      overloads.builtins.push_back(row.builtin);
    }
  }
  const BuiltinOverloads &entry = expanded.emplace(name, std::move(overloads)).first->second;
  return entry.signatures.empty() ? nullptr : &entry;
}

const std::vector<std::string> &builtinNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const Row &row : allRows())
      if (std::find(all.begin(), all.end(), typed::name(row.builtin)) == all.end())
        all.emplace_back(typed::name(row.builtin));
    return all;
  }();
  return names;
}

std::vector<std::string> colorFunctionNames() {
  std::vector<std::string> names;
  for (const Row &row : allRows())
    if (const std::string name = typed::name(row.builtin);
        row.signature.find(" c") != row.signature.npos &&
        std::find(names.begin(), names.end(), name) == names.end())
      names.push_back(name);
  return names;
}

} // namespace rtsl
