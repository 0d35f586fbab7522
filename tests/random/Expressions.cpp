//===- Expressions.cpp - a value of a type --------------------------------===//
#include "Generator.h"

#include <algorithm>

namespace rtsl::random {

NodePtr Generator::expression(const Type *type, unsigned depth) {
  if (depth != 0 && work < workLimit)
    for (unsigned attempt = 0; attempt != 4; ++attempt)
      if (NodePtr made = compound(type, depth))
        return made;
  return atom(type);
}

/// An expression that converts to `type`.
NodePtr Generator::converted(const Type *type, unsigned depth, const Type **made) {
  const Type *actual = type;
  const Type *scalar = type->scalar();
  if (scalar && !type->isMatrix() && chance(12)) {
    if (scalar == types.floatType)
      actual = withScalar(type, chance(50) ? types.intType : types.uintType);
    else if (scalar == types.uintType)
      actual = withScalar(type, types.intType);
  }
  if (made)
    *made = actual;
  NodePtr value = expression(actual, depth);
  // A part in its place has to have its type.
  return value;
}

NodePtr Generator::atom(const Type *type) {
  if (!chance(20))
    if (NodePtr read = part(type, false))
      return read;
  if (!context.constantOnly && chance(60))
    if (NodePtr made = adapted(type))
      return made;
  return literal(type);
}

NodePtr Generator::adapted(const Type *type) {
  const Type *scalar = type->scalar();
  if (type == types.color) {
    NodePtr value = part(types.floatType, false);
    return value ? make(type, "color($)", std::move(value)) : nullptr;
  }
  if (!scalar || type->isMatrix())
    return nullptr;
  if (type->isVector() && chance(50)) {
    NodePtr value = part(scalar, false);
    return value ? make(type, toString(type) + "($)", std::move(value)) : nullptr;
  }
  const Type *other = withScalar(type, pick(vocabulary.scalars));
  NodePtr value = part(other, false);
  if (!value)
    return nullptr;
  if (type == types.boolType && other != type) // seldom zero
    return make(type, "($ > " + literal(other)->text + ")", std::move(value));
  return make(type, toString(type) + "($)", std::move(value));
}

std::string Generator::number(const Type *scalar) {
  static const std::vector<std::string> floats = {"0.0",   "1.0",     "0.5",    "2.0",
                                                  "3.25",  "(-0.75)", "(-1.0)", "1e-3",
                                                  "100.0", "0.1",     "7.0",    "(-2.5)"};
  static const std::vector<std::string> extremeFloats = {
      "1e30",         "3.4028235e38",   "(-1e38)",         "1e-40",
      "1.4e-45",      "1.17549435e-38", "(-0.0)",          "(1.0 / 0.0)",
      "(-1.0 / 0.0)", "(0.0 / 0.0)",    "8388609.0",       "2147483648.0",
      "4294967296.0", "0.49999997",     "(-2147483904.0)", "16777217.0",
      "0.99999994",   "88.8",           "(-104.0)",        "1.5707964",
      "1e10"};
  static const std::vector<std::string> ints = {"0", "1", "2",    "3",  "(-1)",
                                                "5", "7", "(-8)", "16", "100"};
  static const std::vector<std::string> extremeInts = {
      "(-2147483648)", "2147483647", "31",         "32",         "33",        "65536",
      "(-65)",         "0x80000001", "0x7f800000", "1065353216", "0xffffffff"};
  static const std::vector<std::string> uints = {"0u", "1u", "2u", "3u", "5u", "8u", "17u", "255u"};
  static const std::vector<std::string> extremeUints = {
      "4294967295u", "0x80000000u", "31u", "32u", "40u", "65535u", "0x7fffffffu", "0x7fc00001u"};
  const bool extreme = chance(10);
  if (scalar == types.floatType) {
    if (extreme)
      return pick(extremeFloats);
    if (chance(50))
      return pick(floats);
    std::string text = std::to_string(below(64)) + ".";
    return text += std::to_string(below(1000));
  }
  if (scalar == types.intType)
    return extreme ? pick(extremeInts) : pick(ints);
  if (scalar == types.uintType)
    return extreme ? pick(extremeUints) : pick(uints);
  return chance(50) ? "true" : "false";
}

std::string Generator::numbers(const Type *scalar, unsigned count) {
  std::string text;
  for (unsigned i = 0; i != count; ++i)
    text += (i ? ", " : "") + number(scalar);
  return text;
}

NodePtr Generator::literal(const Type *type) {
  const std::string name = toString(type);
  switch (type->kind) {
  case TypeKind::Vector:
  case TypeKind::Matrix:
    return make(type, name + "(" +
                          numbers(type->scalar(), chance(25) ? 1 : type->componentCount()) + ")");
  case TypeKind::Color:
    return make(type, "color(" + numbers(types.floatType, chance(50) ? 1 : 3) + ")");
  case TypeKind::Struct:
  case TypeKind::Array: {
    NodePtr node = make(type, name + "(");
    const std::size_t count =
        type->is(TypeKind::Array) ? type->count : type->structure->fields.size();
    for (std::size_t i = 0; i != count; ++i) {
      node->text += i ? ", $" : "$";
      node->children.push_back(
          atom(type->is(TypeKind::Array) ? type->element : type->structure->fields[i].type));
    }
    node->text += ")";
    return node;
  }
  default:
    return make(type, number(type));
  }
}

NodePtr Generator::compound(const Type *type, unsigned depth) {
  switch (below(16)) {
  case 0:
  case 1:
  case 2:
  case 3:
    return operation(type, depth);
  case 4:
  case 5:
  case 6:
    return builtinCall(type, depth);
  case 7:
    return userCall(type, depth);
  case 8:
  case 9:
    return constructor(type, depth);
  case 10: {
    NodePtr test = condition(depth - 1);
    NodePtr a = expression(type, depth - 1);
    return make(type, "($ ? $ : $)", std::move(test), std::move(a), expression(type, depth - 1));
  }
  case 11:
    return partOfExpression(type, depth);
  case 12:
    return effect(type, depth);
  case 13:
  case 14:
    return ofObject(type, depth);
  default:
    return atom(type);
  }
}

NodePtr Generator::constructor(const Type *type, unsigned depth) {
  const std::string name = toString(type);
  if (type->isScalar()) { // a conversion, or the first component of something
    const Type *from = chance(80) ? pick(vocabulary.scalars) : pick(vocabulary.vectors);
    return make(type, name + "($)", expression(from, depth - 1));
  }
  if (type->is(TypeKind::Color)) {
    if (chance(40))
      return make(type, "color($)", converted(types.floatType, depth - 1));
    NodePtr r = converted(types.floatType, depth - 1), g = converted(types.floatType, depth - 1);
    return make(type, "color($, $, $)", std::move(r), std::move(g),
                converted(types.floatType, depth - 1));
  }
  if (type->is(TypeKind::Struct) || type->is(TypeKind::Array)) {
    NodePtr node = make(type, name + "(");
    const bool isArray = type->is(TypeKind::Array);
    const std::size_t count = isArray ? type->count : type->structure->fields.size();
    for (std::size_t i = 0; i != count; ++i) {
      node->text += i ? ", $" : "$";
      node->children.push_back(
          converted(isArray ? type->element : type->structure->fields[i].type, depth - 1));
    }
    node->text += ")";
    return node;
  }
  // Vectors and matrices: from one number, from another matrix, or from pieces.
  if (chance(15))
    return make(type, name + "($)", expression(pick(vocabulary.scalars), depth - 1));
  if (type->isMatrix() && chance(30))
    return make(type, name + "($)", expression(pick(vocabulary.matrices), depth - 1));
  if (type->isVector() && chance(20)) { // a conversion by component, or the beginning of a vector
    const unsigned count = type->count + below(5 - type->count);
    return make(type, name + "($)",
                expression(types.vector(pick(vocabulary.scalars), count), depth - 1));
  }
  NodePtr node = make(type, name + "(");
  unsigned filled = 0;
  const unsigned needed = type->componentCount();
  while (filled != needed) {
    unsigned size = 1 + below(4);
    if (size > needed - filled)
      size = needed - filled;
    const Type *scalar = chance(60) ? type->scalar() : pick(vocabulary.scalars);
    node->text += filled ? ", $" : "$";
    node->children.push_back(
        expression(size == 1 ? scalar : types.vector(scalar, size), depth - 1));
    filled += size;
  }
  node->text += ")";
  return node;
}

/// A component, element or field of something that has no name.
NodePtr Generator::partOfExpression(const Type *type, unsigned depth) {
  static const char *const sets[] = {"xyzw", "rgba", "stpq"};
  if (type->isScalar() || type->isVector()) {
    const unsigned from = 2 + below(3);
    const unsigned count = type->isVector() ? type->count : 1;
    const char *letters = sets[below(3)];
    std::string swizzle;
    for (unsigned i = 0; i != count; ++i)
      swizzle += letters[below(from)];
    if (type->isVector() && chance(15))
      return make(type, "($)." + std::string(count, 'x'), expression(type->element, depth - 1));
    if (type->isVector() && type->element == types.floatType && chance(20)) {
      const Type *matrix = types.matrix(2 + below(3), type->count);
      NodePtr base = expression(matrix, depth - 1);
      return make(type, "($)[$]", std::move(base), index(std::to_string(matrix->count)));
    }
    return make(type, "($)." + swizzle, expression(types.vector(type->scalar(), from), depth - 1));
  }
  if (chance(50)) {
    for (const Type *structure : structs)
      for (const typed::Field &field : structure->structure->fields)
        if (field.type == type)
          return make(type, "($)." + field.name, expression(structure, depth - 1));
    return nullptr;
  }
  if (type->is(TypeKind::Array) || type->is(TypeKind::Struct))
    return nullptr;
  const Type *array = types.array(type, 1 + below(3));
  NodePtr base = expression(array, depth - 1);
  return make(type, "($)[$]", std::move(base), index(std::to_string(array->count)));
}

/// An expression that writes something.
NodePtr Generator::effect(const Type *type, unsigned depth) {
  if (context.constantOnly)
    return nullptr;
  if (chance(25)) {
    NodePtr first = expression(smallType(), depth - 1);
    return make(type, "($, $)", std::move(first), expression(type, depth - 1));
  }
  NodePtr place = part(type, true);
  if (!place)
    return nullptr;
  const bool countable = type->scalar() && type->scalar() != types.boolType;
  if (countable && chance(40)) {
    static const char *const forms[] = {"(++$)", "(--$)", "($++)", "($--)"};
    return make(type, forms[below(4)], std::move(place));
  }
  if (const char *op = chance(40) ? compoundOperator(type) : nullptr)
    return make(type, std::string("($ ") + op + " $)", std::move(place),
                expression(type, depth - 1));
  return make(type, "($ = $)", std::move(place), converted(type, depth - 1));
}

/// `{...}`: a value whose parts are values of the parts' types.
NodePtr Generator::braced(const Type *type, unsigned depth) {
  NodePtr node = make(type, "{");
  const auto add = [&](const Type *part) {
    node->text += node->children.empty() ? "$" : ", $";
    node->children.push_back(expression(part, depth - 1));
  };
  if (type->is(TypeKind::Struct))
    for (const typed::Field &field : type->structure->fields)
      add(field.type);
  else
    for (std::uint32_t i = 0; i != type->count; ++i)
      add(type->element);
  node->text += "}";
  return node;
}

/// `dFdx(e)` or `dFdy(e)`. It may copy parts of e, so e is not deep.
NodePtr Generator::change(const Type *type, unsigned depth) {
  if (context.constantOnly || !context.changes || type->scalar() != types.floatType ||
      type->isMatrix())
    return nullptr;
  work += 20 * context.weight;
  return make(type, chance(50) ? "dFdx($)" : "dFdy($)", expression(type, std::min(depth, 2u)));
}

/// An integer operation on an element of an output buffer, in one step: its value before.
NodePtr Generator::atomic(const Type *type, unsigned depth) {
  static const char *const names[] = {"atomicAdd", "atomicMin", "atomicMax",     "atomicAnd",
                                      "atomicOr",  "atomicXor", "atomicExchange"};
  std::vector<const Variable *> buffers;
  for (const Variable &output : context.self->outputs)
    if (output.type->element == type)
      buffers.push_back(&output);
  if (buffers.empty())
    return nullptr;
  const Variable &buffer = *pick(buffers);
  NodePtr place = descend(makeNode(Role::Fixed, buffer.name), buffer.type, type, true);
  NodePtr value = expression(type, depth - 1);
  if (chance(12))
    return make(type, "atomicCompSwap($, $, $)", std::move(place), std::move(value),
                expression(type, depth - 1));
  return make(type, std::string(names[below(7)]) + "($, $)", std::move(place), std::move(value));
}

/// What an image has to say: a lookup, filtered by the footprint of the ray or not, or its size.
NodePtr Generator::ofImage(const Type *type, unsigned depth) {
  const Type *vec2 = types.vector(types.floatType, 2), *ivec2 = types.vector(types.intType, 2);
  NodePtr call = make(type, context.self->image);
  if (context.self->images != 0) {
    call->text += "[$]";
    call->children.push_back(index(std::to_string(context.self->images)));
  }
  const auto say = [&](const char *function, const std::vector<const Type *> &parameters) {
    call->text += std::string(".") + function + "(";
    for (std::size_t i = 0; i != parameters.size(); ++i) {
      call->text += i ? ", $" : "$";
      call->children.push_back(converted(parameters[i], depth - 1));
    }
    call->text += ")";
  };
  work += 20 * context.weight;
  if (type == types.intType)
    say("levels", {});
  else if (type == ivec2)
    chance(50) ? say("size", {}) : say("size", {types.intType});
  else if (chance(50))
    say("sample", {vec2});
  else if (chance(30))
    chance(50) ? say("load", {ivec2}) : say("load", {ivec2, types.intType});
  else if (chance(40))
    say("sample", {vec2, types.floatType});
  else
    chance(40) ? say("finest", {vec2}) : say("sampleGrad", {vec2, vec2, vec2});
  return call;
}

/// What the ray or an object has to say.
NodePtr Generator::ofObject(const Type *type, unsigned depth) {
  if (context.constantOnly)
    return nullptr;
  if ((type->isScalar() || type->isVector()) && chance(20))
    if (NodePtr changed = change(type, depth))
      return changed;
  const bool hasImage = context.self && !context.self->image.empty();
  if (hasImage && depth > 0 &&
      ((type == types.vector(types.floatType, 4) && chance(70)) ||
       (type == types.vector(types.intType, 2) && chance(30)) ||
       (type == types.intType && chance(10))))
    return ofImage(type, depth);
  if (type == types.vector(types.floatType, 3) && context.converts && chance(20)) {
    static const char *const forms[] = {"pointToWorld($)",   "vectorToWorld($)",
                                        "normalToWorld($)",  "pointToObject($)",
                                        "vectorToObject($)", "normalToObject($)"};
    const char *form = forms[below(6)];
    return make(type, form, converted(type, depth - 1));
  }
  if ((type == types.intType || type == types.uintType) && context.self && chance(60))
    if (NodePtr made = atomic(type, depth))
      return made;
  if (type == types.floatType && context.rand && chance(30))
    return make(type, chance(70) ? "rand()" : "randOpen()");
  if (type == types.color && context.traces >= context.weight && chance(60)) {
    context.traces -= context.weight;
    const Type *vec3 = types.vector(types.floatType, 3);
    if (context.illuminance && chance(20))
      return make(type, "trace(rt_HitPoint, rt_RayDirection)");
    NodePtr origin = converted(vec3, chance(50) ? 0 : depth - 1);
    return make(type, "trace($, $)", std::move(origin), direction(depth - 1));
  }
  if (type == types.color && context.illuminance && chance(20))
    return make(type, "ambient()");
  if (type == types.intType && context.illuminance && chance(30))
    return make(type, "lightCount()");
  if (type == types.boolType && chance(30)) {
    const ClassPlan *plan = nullptr;
    NodePtr a = referenceTo(&plan, false);
    if (!a)
      return nullptr;
    if (chance(40))
      return make(type, chance(50) ? "bool($)" : "(!$)", std::move(a));
    const char *form = chance(50) ? "($ == $)" : "($ != $)";
    return make(type, form, std::move(a), objectOf(plan));
  }
  return methodCall(type, depth);
}

} // namespace rtsl::random
