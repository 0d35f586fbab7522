//===- Statements.cpp - control flow that ends ----------------------------===//
#include "Generator.h"

#include "sema/typed/TypeProperties.h"

#include <algorithm>

namespace rtsl::random {

NodePtr Generator::declare(const std::string &name, const Type *type, NodePtr value,
                           const char *qualifier) {
  std::string head = qualifier;
  // The outermost dimension may stand after the name.
  if (type->is(TypeKind::Array) && chance(50))
    head += toString(type->element) + " " + name + "[" + std::to_string(type->count) + "]";
  else
    head += toString(type) + " " + name;
  return makeNode(Role::Statement, head + " = $;", std::move(value));
}

/// Appends a statement (or none), after the declarations that were put off while it was made.
void Generator::add(Node &list, NodePtr statement) {
  for (NodePtr &before : pending)
    list.children.push_back(std::move(before));
  pending.clear();
  if (statement)
    list.children.push_back(std::move(statement));
}

/// Appends `count` statements, each after the declarations that it needs.
void Generator::statements(Node &list, unsigned count, unsigned depth) {
  std::vector<NodePtr> outer = std::move(pending);
  pending.clear();
  for (; count > 0; --count)
    add(list, statement(depth));
  pending = std::move(outer);
}

/// A list of statements with a scope of its own.
NodePtr Generator::block(unsigned count, unsigned depth) {
  const std::size_t variables = scope.size(), objects = references.size();
  NodePtr list = makeList();
  statements(*list, count, depth);
  scope.resize(variables);
  references.resize(objects);
  return list;
}

NodePtr Generator::statement(unsigned depth) {
  if (depth != 0 && work < workLimit) {
    switch (below(25)) {
    case 0:
    case 1:
    case 2:
      return ifStatement(depth);
    case 3:
    case 4:
      if (context.loops < 2)
        return loop(depth);
      break;
    case 5:
      return switchStatement(depth);
    case 6:
      return makeNode(Role::Statement, "{$}", block(1 + below(2), depth - 1));
    case 7:
    case 8:
      if (NodePtr made = jump())
        return made;
      break;
    case 9:
    case 10:
      if (context.illuminance && context.weight == 1)
        return illuminance(depth);
      break;
    case 11: // functions without a value
      if (NodePtr made = chance(50) ? builtinCall(types.voidType, 2) : userCall(types.voidType, 2))
        return makeNode(Role::Statement, "$;", std::move(made));
      break;
    case 12:
      if (NodePtr made = methodCall(types.voidType, 2))
        return makeNode(Role::Statement, "$;", std::move(made));
      break;
    case 13:
    case 14:
      if (!payloads.empty() && context.traces >= context.weight)
        return payloadRay();
      break;
    case 15:
      if (context.print && context.weight < 4)
        return print();
      break;
    case 16:
      if (context.answers)
        return answer();
      break;
    default:
      break;
    }
  }
  return chance(45) ? declaration(depth) : assignment(depth);
}

NodePtr Generator::declaration(unsigned depth) {
  if (!references.empty() && chance(10))
    if (NodePtr made = referenceDeclaration())
      return made;
  const Type *type = anyType();
  std::string name = fresh("v");
  if (chance(10)) {
    // Blocks and functions have constants of the same name.
    if (context.switches == 0 && chance(50) &&
        std::none_of(scope.begin(), scope.end(),
                     [](const Variable &one) { return one.name == "k"; }))
      name = "k";
    context.constantOnly = true;
    NodePtr value = expression(type, 2);
    context.constantOnly = false;
    scope.push_back({name, type, false, true});
    return declare(name, type, std::move(value), "const ");
  }
  if (chance(8)) { // zero unless something happens
    NodePtr test = condition(1);
    NodePtr value = converted(type, 2);
    scope.push_back({name, type});
    pending.push_back(makeNode(Role::Statement, toString(type) + " " + name + ";"));
    return makeNode(Role::Statement, "if ($) " + name + " = $;", std::move(test), std::move(value));
  }
  const bool hasParts = type->is(TypeKind::Struct) || type->is(TypeKind::Array) ||
                        type->isVector() || type->isMatrix();
  NodePtr value = hasParts && chance(10) ? braced(type, 2) : converted(type, 1 + below(3));
  scope.push_back({name, type});
  return declare(name, type, std::move(value));
}

/// Another name for an object, or an array of some of its class; null if it might be the object's
/// own class.
NodePtr Generator::referenceDeclaration() {
  const ClassPlan *plan = nullptr;
  NodePtr object = referenceTo(&plan, false);
  if (isOwn(plan))
    return nullptr;
  const std::string name = fresh("r");
  if (chance(60)) {
    references.push_back({name, plan, 0, false, true});
    return makeNode(Role::Statement, plan->name + " " + name + " = $;", std::move(object));
  }
  const unsigned count = 2 + below(2);
  const std::string type = plan->name + "[" + std::to_string(count) + "]";
  NodePtr made =
      makeNode(Role::Statement, type + " " + name + " = " + type + "($", std::move(object));
  for (unsigned i = 1; i != count; ++i) {
    made->text += ", $";
    made->children.push_back(objectOf(plan));
  }
  made->text += ");";
  references.push_back({name, plan, count, false, true});
  return made;
}

/// A local variable refers to another object from now on; null if there is none.
NodePtr Generator::referenceAssignment() {
  std::vector<Reference> candidates;
  for (const Reference &reference : references)
    if (reference.writable)
      candidates.push_back(reference);
  if (candidates.empty())
    return nullptr;
  const Reference reference = pick(candidates);
  NodePtr place = element(reference);
  return makeNode(Role::Statement, "$ = $;", std::move(place), objectOf(reference.target));
}

NodePtr Generator::assignment(unsigned depth) {
  if (chance(12))
    if (NodePtr made = referenceAssignment())
      return made;
  for (unsigned attempt = 0; attempt != 3; ++attempt) {
    const Type *type = anyType();
    NodePtr place = part(type, true);
    if (!place)
      continue;
    if (const char *op = chance(35) ? compoundOperator(type) : nullptr)
      return makeNode(Role::Statement, std::string("$ ") + op + " $;", std::move(place),
                      expression(type, 2));
    return makeNode(Role::Statement, "$ = $;", std::move(place), converted(type, 1 + below(3)));
  }
  return declaration(depth);
}

NodePtr Generator::ifStatement(unsigned depth) {
  NodePtr test = condition(2);
  NodePtr first = block(1 + below(2), depth - 1);
  if (chance(50))
    return makeNode(Role::Statement, "if ($) {$}", std::move(test), std::move(first));
  return makeNode(Role::Statement, "if ($) {$} else {$}", std::move(test), std::move(first),
                  block(1 + below(2), depth - 1));
}

/// A loop that a counter of its own ends, which nothing in it writes.
NodePtr Generator::loop(unsigned depth) {
  const unsigned trips = 1 + below(4);
  const std::string bound = std::to_string(trips), name = fresh("i");
  const Context outer = context;
  const unsigned form = below(4);
  const std::size_t variables = scope.size();
  ++context.loops;
  context.canContinue = true;
  context.weight *= trips + 1; // the condition is tested once more
  if (form != 0) {
    pending.push_back(makeNode(Role::Statement, "int " + name + " = 0;"));
    scope.push_back({name, types.intType, false});
  }
  NodePtr made;
  const std::string limit = " < " + bound;
  switch (form) {
  case 0: {
    // `i` is in sight of the whole loop.
    scope.push_back({name, types.intType, false});
    NodePtr extra = chance(25) ? condition(1) : nullptr;
    NodePtr body = block(1 + below(3), depth - 1);
    const std::string head = "for (int " + name + " = 0; " + name + limit;
    const std::string step = chance(50) ? "; ++" + name + ") {$}" : "; " + name + "++) {$}";
    made = extra
               ? makeNode(Role::Statement, head + " && $" + step, std::move(extra), std::move(body))
               : makeNode(Role::Statement, head + step, std::move(body));
    break;
  }
  case 1: {
    NodePtr extra = chance(40) ? condition(1) : nullptr;
    NodePtr body = block(1 + below(3), depth - 1);
    made = extra ? makeNode(Role::Statement, "while (" + name + "++" + limit + " && $) {$}",
                            std::move(extra), std::move(body))
                 : makeNode(Role::Statement, "while (" + name + "++" + limit + ") {$}",
                            std::move(body));
    break;
  }
  case 2: {
    NodePtr body = block(1 + below(3), depth - 1);
    NodePtr extra = chance(40) ? condition(1) : nullptr;
    made = extra ? makeNode(Role::Statement, "do {$} while (++" + name + limit + " && $);",
                            std::move(body), std::move(extra))
                 : makeNode(Role::Statement, "do {$} while (++" + name + limit + ");",
                            std::move(body));
    break;
  }
  default: {
    const char *head = chance(50) ? "for (;;)" : "while (true)";
    made = makeNode(Role::Statement,
                    std::string(head) + " { if (" + name + "++ >= " + bound + ") break; {$} }",
                    block(1 + below(3), depth - 1));
    break;
  }
  }
  if (form == 0)
    scope.resize(variables);
  const unsigned traces = context.traces;
  context = outer;
  context.traces = traces;
  return made;
}

NodePtr Generator::switchStatement(unsigned depth) {
  const Type *type = chance(60) ? types.intType : types.uintType;
  NodePtr value = expression(type, 2);
  NodePtr node =
      makeNode(Role::Statement, type == types.intType ? "switch ($ % 5) {" : "switch ($ % 5u) {",
               std::move(value));
  const unsigned arms = 1 + below(3);
  const unsigned defaultArm = below(arms + 2);
  ++context.switches;
  unsigned label = 0;
  for (unsigned arm = 0; arm != arms; ++arm) {
    node->text += " ";
    if (arm == defaultArm)
      node->text += "default: ";
    for (unsigned labels = (arm == defaultArm ? 0 : 1) + below(2); labels-- > 0; ++label)
      node->text += "case " + std::string(type == types.intType && chance(30) ? "-" : "") +
                    std::to_string(label + 1) + (type == types.uintType ? "u" : "") + ": ";
    const char *end = chance(60) ? " break;" : "";
    node->text += std::string(chance(70) ? "{$}" : "$") + end;
    node->children.push_back(block(1 + below(2), depth - 1));
  }
  node->text += " }";
  --context.switches;
  return node;
}

NodePtr Generator::jump() {
  const unsigned kind = below(3);
  if (kind == 0 && (context.loops != 0 || context.switches != 0))
    return makeNode(Role::Statement, "if ($) break;", condition(2));
  if (kind == 1 && context.canContinue)
    return makeNode(Role::Statement, "if ($) continue;", condition(2));
  if (!context.returns)
    return nullptr;
  NodePtr test = condition(2);
  if (context.result)
    return makeNode(Role::Statement, "if ($) return $;", std::move(test),
                    converted(context.result, 2));
  return makeNode(Role::Statement, "if ($) { " + context.onReturn + "return; }", std::move(test));
}

/// Ends `anyHit` for some hits, from a function that it calls too.
NodePtr Generator::answer() {
  return makeNode(Role::Statement,
                  chance(50) ? "if ($) ignoreIntersection();" : "if ($) terminateRay();",
                  condition(2));
}

NodePtr Generator::illuminance(unsigned depth) {
  const Type *vec3 = types.vector(types.floatType, 3);
  const Context outer = context;
  const bool isOfSurface = chance(40);          // that shines, or of the background
  const bool isOne = isOfSurface || chance(30); // of the lights
  NodePtr number = isOne && !isOfSurface ? expression(types.intType, 2) : nullptr;
  NodePtr point = chance(60) ? makeNode(Role::Fixed, "rt_HitPoint") : expression(vec3, 2);
  NodePtr axis = chance(50) ? expression(vec3, 2) : nullptr;
  NodePtr angle = axis ? expression(types.floatType, 1) : nullptr;
  context.illuminance = false; // not inside of another one
  context.weight *= 2;         // lights
  context.canContinue |= !isOne;
  context.loops += isOne ? 0 : 1;
  const std::size_t variables = scope.size();
  scope.push_back({"rt_LightDirection", vec3, false});
  scope.push_back({"rt_LightDistance", types.floatType, false});
  scope.push_back({"rt_LightColor", types.color, false});
  if (isOfSurface)
    scope.push_back({"rt_PDF", types.floatType, false});
  NodePtr body = block(1 + below(3), depth - 1);
  scope.resize(variables);
  const unsigned traces = context.traces;
  context = outer;
  context.traces = traces;
  if (isOfSurface && axis)
    return makeNode(Role::Statement, "if (illuminate($, $)) {$}", std::move(point), std::move(axis),
                    std::move(body));
  if (isOfSurface)
    return makeNode(Role::Statement, "if (illuminate($)) {$}", std::move(point), std::move(body));
  if (isOne && axis)
    return makeNode(Role::Statement,
                    chance(50) ? "if (illuminate($, $, $)) {$}"
                               : "if (illuminate($, $, ($).x > 0.0)) {$}",
                    std::move(number), std::move(point), std::move(axis), std::move(body));
  if (isOne)
    return makeNode(Role::Statement, "if (illuminate($, $)) {$}", std::move(number),
                    std::move(point), std::move(body));
  if (!axis)
    return makeNode(Role::Statement, "illuminance ($) {$}", std::move(point), std::move(body));
  return makeNode(Role::Statement, "illuminance ($, $, $) {$}", std::move(point), std::move(axis),
                  std::move(angle), std::move(body));
}

/// A ray's direction: of any length, and one in ten far longer or shorter than others.
NodePtr Generator::direction(unsigned depth) {
  static const char *const lengths[] = {"1e-43", "1e-39", "1e-33", "1e13", "1e34", "3e38"};
  const Type *vec3 = types.vector(types.floatType, 3);
  NodePtr made = converted(vec3, depth);
  if (!chance(10))
    return made;
  return make(vec3, "($ * $)", std::move(made), makeNode(Role::Fixed, lengths[below(6)]));
}

/// A ray that carries something. Most of them can meet something.
NodePtr Generator::payloadRay() {
  context.traces -= context.weight;
  const Type *vec3 = types.vector(types.floatType, 3);
  NodePtr origin = converted(vec3, 1), towards = direction(1);
  if (context.illuminance && chance(20)) { // straight on through the surface
    origin = makeNode(Role::Fixed, "rt_HitPoint");
    towards = makeNode(Role::Fixed, chance(70) ? "rt_RayDirection" : "(0.5 * rt_RayDirection)");
  }
  NodePtr tMin = chance(70) ? makeNode(Role::Fixed, "0.0") : converted(types.floatType, 1);
  NodePtr tMax = chance(70) ? makeNode(Role::Fixed, "64.0") : converted(types.floatType, 1);
  NodePtr payload = target(pick(payloads));
  std::string more;
  std::vector<NodePtr> values;
  if (chance(30)) {
    more += chance(90) ? ", 0" : ", 1";
    if (chance(70)) {
      more += ", $";
      values.push_back(expression(types.uintType, 1));
      if (chance(50)) {
        more += ", $";
        values.push_back(converted(types.floatType, 1));
      }
    }
  }
  NodePtr ray = makeNode(Role::Statement, "trace($, $, $, $, $" + more + ");", std::move(origin),
                         std::move(towards), std::move(tMin), std::move(tMax), std::move(payload));
  for (NodePtr &value : values)
    ray->children.push_back(std::move(value));
  return ray;
}

/// Numbers that have one spelling: no floats, for a NaN may have any sign.
NodePtr Generator::print() {
  const Type *scalar = vocabulary.scalars[1 + below(2)];
  return makeNode(Role::Statement, "print(\"" + fresh("t") + "\", $, $);",
                  expression(withScalar(types.vector(types.floatType, 2 + below(3)), scalar), 2),
                  expression(scalar, 1));
}

//===----------------------------------------------------------------------===//
// What a method has computed, as one number
//===----------------------------------------------------------------------===//

/// `h = hash_vec3(h, v);` for every part of the variable.
static void appendHash(std::string &text, const std::string &place, const Type *type) {
  if (type->is(TypeKind::Array)) {
    for (std::uint32_t i = 0; i != type->count; ++i)
      appendHash(text, place + "[" + std::to_string(i) + "]", type->element);
  } else if (type->is(TypeKind::Struct)) {
    for (const typed::Field &field : type->structure->fields)
      appendHash(text, place + "." + field.name, field.type);
  } else {
    text += "h = hash_" + toString(type) + "(h, " + place + "); ";
  }
}

NodePtr Generator::hashed(const Variable &variable) {
  std::string text;
  appendHash(text, variable.name, variable.type);
  return makeNode(Role::Statement, text);
}

/// Hashes the variables of the scope from number `from` on, the last ones first, as far as they are
/// not too many or too large.
void Generator::hashAll(Node &list, std::size_t from) {
  std::uint64_t room = large ? 60 : 10;
  for (std::size_t i = scope.size(); i-- > from;) {
    const std::uint64_t size = scalarCount(scope[i].type) + (hasColor(scope[i].type) ? 4 : 0);
    if (!scope[i].writable || size > room)
      continue;
    list.children.push_back(hashed(scope[i]));
    room -= size;
  }
}

} // namespace rtsl::random
