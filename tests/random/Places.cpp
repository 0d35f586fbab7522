//===- Places.cpp - variables and their parts -----------------------------===//
#include "Generator.h"

namespace rtsl::random {

static constexpr unsigned maxSteps = 3;

/// Whether a part of `from`, or all of it, has the type `wanted`.
bool Generator::canReach(const Type *from, const Type *wanted, unsigned steps, bool writing) const {
  if (from == wanted)
    return true;
  if (steps == 0)
    return false;
  switch (from->kind) {
  case TypeKind::Vector:
    return wanted->scalar() == from->element &&
           (wanted->isScalar() ||
            (wanted->isVector() && (!writing || wanted->count <= from->count)));
  case TypeKind::Matrix:
  case TypeKind::Array:
    return canReach(from->element, wanted, steps - 1, writing);
  case TypeKind::Buffer:
    return canReach(from->count == 1 ? from->element : types.buffer(from->element, from->count - 1),
                    wanted, steps - 1, writing);
  case TypeKind::Struct:
    for (const typed::Field &field : from->structure->fields)
      if (canReach(field.type, wanted, steps - 1, writing))
        return true;
    return false;
  default:
    return false;
  }
}

/// An index below `count` (an expression: "4", or "b.length()"), or any index if the program is not
/// in range and an exception would show nothing that is undefined, such as which primitives a ray
/// tests. Indices inside of indices are plain: they would grow without end.
NodePtr Generator::index(const std::string &count) {
  const bool isNumber = count.find('(') == std::string::npos;
  if (!isNumber && (indexDepth != 0 || context.constantOnly)) // no buffer is without an element
    return makeNode(Role::Fixed, "0");
  struct Deeper {
    unsigned &depth;
    explicit Deeper(unsigned &depth) : depth(depth) { ++depth; }
    ~Deeper() { --depth; }
  };
  if (isNumber && indexDepth != 0)
    return makeNode(Role::Fixed, std::to_string(below(static_cast<unsigned>(std::stoul(count)))));
  const Deeper deeper(indexDepth);
  if (isNumber && (context.constantOnly || chance(40)))
    return makeNode(Role::Fixed, std::to_string(below(static_cast<unsigned>(std::stoul(count)))));
  if (!program.inRange && (context.raises || !program.raises) && chance(50)) {
    // Not constant, or it would be an error.
    std::vector<const Variable *> variables;
    for (const Variable &variable : scope)
      if (variable.writable && (variable.type == types.intType || variable.type == types.uintType))
        variables.push_back(&variable);
    if (!variables.empty()) {
      const Variable &variable = *pick(variables);
      return makeNode(Role::Fixed, "$ + " + variable.name, expression(variable.type, 1));
    }
  }
  if (chance(50))
    return makeNode(Role::Fixed, "uint($) % " + (isNumber ? count + "u" : "uint(" + count + ")"),
                    expression(types.intType, 1));
  return makeNode(Role::Fixed, "int($ % " + (isNumber ? count + "u" : "uint(" + count + ")") + ")",
                  expression(types.uintType, 1));
}

/// Goes from a place of type `from` to a part of type `wanted`, which there is.
NodePtr Generator::descend(NodePtr base, const Type *from, const Type *wanted, bool writing) {
  static const char *const sets[] = {"xyzw", "rgba", "stpq"};
  for (unsigned steps = maxSteps;; --steps) {
    if (from == wanted && (steps == 0 || !from->isVector() || chance(80)))
      return base;
    switch (from->kind) {
    case TypeKind::Vector: {
      if (wanted->isScalar() && chance(40))
        return makeNode(Role::Fixed, "$[$]", std::move(base), index(std::to_string(from->count)));
      const unsigned count = wanted->isVector() ? wanted->count : 1;
      const char *letters = sets[below(3)];
      std::string swizzle;
      while (swizzle.size() != count) {
        const char letter = letters[below(from->count)];
        if (!writing || swizzle.find(letter) == std::string::npos)
          swizzle += letter;
      }
      return makeNode(Role::Fixed, "$." + swizzle, std::move(base));
    }
    case TypeKind::Matrix:
    case TypeKind::Array:
      base = makeNode(Role::Fixed, "$[$]", std::move(base), index(std::to_string(from->count)));
      from = from->element;
      break;
    case TypeKind::Buffer: {
      const std::string length = toText(*base) + ".length()";
      base = makeNode(Role::Fixed, "$[$]", std::move(base), index(length));
      from = from->count == 1 ? from->element : types.buffer(from->element, from->count - 1);
      break;
    }
    case TypeKind::Struct: {
      std::vector<const typed::Field *> fields;
      for (const typed::Field &field : from->structure->fields)
        if (canReach(field.type, wanted, steps - 1, writing))
          fields.push_back(&field);
      const typed::Field &field = *pick(fields);
      base = makeNode(Role::Fixed, "$." + field.name, std::move(base));
      from = field.type;
      break;
    }
    default:
      return base;
    }
  }
}

/// A variable in scope or a part of one; null if there is none.
NodePtr Generator::part(const Type *wanted, bool writing) {
  std::vector<const Variable *> candidates;
  for (const Variable &variable : scope)
    if ((!writing || variable.writable) && (!context.constantOnly || variable.isConstant) &&
        (!context.constantOnly || !variable.type->is(TypeKind::Buffer)) &&
        canReach(variable.type, wanted, maxSteps, writing))
      candidates.push_back(&variable);
  if (candidates.empty())
    return nullptr;
  const Variable variable = *pick(candidates);
  NodePtr place = descend(makeNode(Role::Fixed, variable.name), variable.type, wanted, writing);
  if (writing)
    return place;
  return make(wanted, "$", std::move(place));
}

NodePtr Generator::target(const Type *type) {
  if (!chance(15))
    if (NodePtr place = part(type, true))
      return place;
  const std::string name = fresh("v");
  pending.push_back(declare(name, type, literal(type)));
  scope.push_back({name, type});
  return makeNode(Role::Fixed, name);
}

/// An object; with `texture`, one that can be looked up. Null if there is none in reach.
NodePtr Generator::referenceTo(const ClassPlan **plan, bool texture) {
  std::vector<const Reference *> candidates;
  for (const Reference &reference : references)
    if (!texture || reference.target->root == "rt_Texture")
      candidates.push_back(&reference);
  if (candidates.empty())
    return nullptr;
  *plan = pick(candidates)->target;
  return objectOf(*plan);
}

/// Is it the class in the making, or a base of it? Then only calls through members end.
bool Generator::isOwn(const ClassPlan *plan) const {
  for (const ClassPlan *at = context.self; at; at = at->base)
    if (at == plan)
      return true;
  return false;
}

/// An object of this class, to which there is a reference; with `choosing`, perhaps one of two.
NodePtr Generator::objectOf(const ClassPlan *plan, bool choosing) {
  if (choosing && indexDepth == 0 && !isOwn(plan) && chance(12)) {
    NodePtr test = condition(1), first = objectOf(plan, false);
    return makeNode(Role::Fixed, "($ ? $ : $)", std::move(test), std::move(first),
                    objectOf(plan, false));
  }
  std::vector<Reference> candidates;
  for (const Reference &reference : references)
    if (reference.target == plan)
      candidates.push_back(reference);
  return element(pick(candidates));
}

/// What it refers to; of an array or buffer, an element of it.
NodePtr Generator::element(const Reference &reference) {
  if (reference.count == 0 && !reference.isBuffer)
    return makeNode(Role::Fixed, reference.text);
  return makeNode(
      Role::Fixed, reference.text + "[$]",
      index(reference.isBuffer ? reference.text + ".length()" : std::to_string(reference.count)));
}

} // namespace rtsl::random
