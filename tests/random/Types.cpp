//===- Types.cpp - which type the next thing has --------------------------===//
#include "Generator.h"

#include "sema/model/Conversion.h"
#include "sema/typed/TypeProperties.h"

namespace rtsl::random {

const Type *Generator::numericScalar() {
  return vocabulary.scalars[below(3)];
}

const Type *Generator::withScalar(const Type *shape, const Type *scalar) {
  return rtsl::withScalar(shape, scalar, types);
}

const Type *Generator::smallType() {
  switch (below(10)) {
  case 0:
  case 1:
    return types.floatType;
  case 2:
    return types.intType;
  case 3:
    return vocabulary.scalars[below(4)];
  case 4:
  case 5:
    return types.vector(types.floatType, 2 + below(3));
  case 6:
  case 7:
    return pick(vocabulary.vectors);
  case 8:
    return pick(vocabulary.matrices);
  default:
    return types.color;
  }
}

const Type *Generator::anyType() {
  const Type *type = smallType();
  if (!structs.empty() && chance(20))
    type = pick(structs);
  for (unsigned dimensions = chance(20) ? 1 + below(2) : 0; dimensions-- > 0;)
    if (scalarCount(type) + (hasColor(type) ? 4 : 0) <= 16)
      type = types.array(type, 1 + below(4));
  return type;
}

bool Generator::hasColor(const Type *type) const {
  return contains(type, TypeKind::Color);
}

const Type *Generator::structure(std::vector<typed::Field> fields, unsigned more) {
  while (more-- > 0) {
    typed::Field field;
    field.name = fresh("m");
    field.type = anyType();
    fields.push_back(std::move(field));
  }
  NodePtr list = makeList();
  for (const typed::Field &field : fields)
    list->children.push_back(makeNode(Role::Fixed, toString(field.type) + " " + field.name + ";"));
  const std::string name = global("S");
  const Type *type = vocabulary.structure(name, std::move(fields));
  // Constructors give every field, so a field cannot simply be deleted.
  list->role = Role::List;
  program.tree->children.push_back(
      makeNode(Role::Fixed, "struct " + name + " {$};", std::move(list)));
  return type;
}

void Generator::makeStruct() {
  const Type *type = structure({}, 1 + below(4));
  if (scalarCount(type) + (hasColor(type) ? 8 : 0) <= 40)
    structs.push_back(type);
}

/// What rays carry: a number, and some more.
void Generator::makePayload() {
  typed::Field hash;
  hash.name = "h";
  hash.type = types.uintType;
  payloads.push_back(structure({hash}, below(3)));
}

/// The runtime checks ranges, and shaders do not: a range changes no result, but the values that
/// World gives.
Generator::RangeText Generator::someRange(const Type *type) {
  const Type *number = type;
  while (number->is(TypeKind::Array))
    number = number->element;
  const Type *scalar = number->isVector() ? number->element : number;
  const bool isFloat = scalar->is(TypeKind::Float) || scalar->is(TypeKind::Color);
  if (!isFloat && !scalar->is(TypeKind::Int) && !scalar->is(TypeKind::UInt))
    return {};
  if (chance(60))
    return {};
  const int low = scalar->is(TypeKind::UInt) ? int(below(4)) : int(below(9)) - 4,
            width = 2 + int(below(5));
  const std::string unit = isFloat && chance(50) ? " * 0.25" : "", sum = std::to_string(low);
  std::string first = "[" + sum + unit,
              last = "(" + sum + " + " + std::to_string(width) + ")" + unit + "]";
  if (chance(30))
    first[0] = '(';
  if (chance(30))
    last.back() = ')';
  if (chance(20))
    first = "(-inf";
  if (chance(20))
    last = "inf)";
  const std::string inside = "(" + sum + " + 1)" + unit;
  return {" in " + first + ", " + last,
          type == number ? toString(type) + "(" + inside + ")" : std::string()};
}

} // namespace rtsl::random
