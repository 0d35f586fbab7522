//===- Calls.cpp - calls of built-in functions, functions and methods -----===//
#include "Generator.h"

namespace rtsl::random {

/// `callee(arguments)` so that overload number `index` is meant.
NodePtr Generator::call(const std::string &callee, const Signature &signature,
                        const std::vector<Signature> &overloads, std::size_t index, unsigned depth,
                        NodePtr receiver) {
  NodePtr node = makeNode(Role::Fixed, "");
  if (receiver) {
    node->text = "$.";
    node->children.push_back(std::move(receiver));
  }
  node->text += callee + "(";
  std::vector<const Type *> given;
  for (const Signature::Parameter &parameter : signature.parameters)
    given.push_back(parameter.type);
  for (std::size_t i = 0; i != signature.parameters.size(); ++i) {
    const Signature::Parameter &parameter = signature.parameters[i];
    NodePtr argument;
    if (parameter.direction != ast::Direction::In) {
      argument = target(parameter.type);
    } else {
      const Type *made = nullptr;
      NodePtr value = converted(parameter.type, depth, &made);
      given[i] = made;
      const Resolution resolution = resolveOverload(overloads, given);
      if (resolution.chosen == static_cast<int>(index)) {
        argument = std::move(value);
      } else { // the conversion would choose another one
        given[i] = parameter.type;
        argument = expression(parameter.type, depth);
      }
    }
    node->text += i ? ", $" : "$";
    node->children.push_back(std::move(argument));
  }
  node->text += ")";
  if (signature.result != types.voidType) {
    node->role = Role::Expression;
    node->type = toString(signature.result);
    node->simplest = simplestValue(signature.result);
  }
  work += context.weight;
  return node;
}

NodePtr Generator::builtinCall(const Type *result, unsigned depth) {
  auto found = vocabulary.byResult.find(result);
  if (found == vocabulary.byResult.end())
    return nullptr;
  const BuiltinChoice &choice = pick(pick(found->second));
  if (context.constantOnly)
    for (const Signature::Parameter &parameter : choice.signature->parameters)
      if (parameter.direction != ast::Direction::In)
        return nullptr;
  return call(choice.name, *choice.signature, choice.overloads->signatures, choice.index,
              depth - 1);
}

bool Generator::mayCall(const Function &function) const {
  return function.traces * context.weight <= context.traces &&
         work + function.work * context.weight <= workLimit &&
         isIn(function.reads, context.reads) && (context.rand || !function.draws) &&
         (context.lookup || !function.looksUp) && (context.answers || !function.answers) &&
         (context.raises || !function.raises) && (context.changes || !function.changes) &&
         (context.converts || !function.converts) && (context.illuminance || !function.lights);
}

void Generator::account(const Function &function) {
  context.traces -= function.traces * context.weight;
  work += function.work * context.weight;
}

/// A function at file level, or one of the class.
NodePtr Generator::userCall(const Type *result, unsigned depth) {
  if (context.constantOnly)
    return nullptr;
  const bool ofClass = context.self && chance(50);
  const std::vector<Function> &all = ofClass ? context.self->functions : functions;
  std::vector<std::size_t> candidates;
  for (std::size_t i = 0; i != all.size(); ++i)
    if (all[i].signature.result == result && mayCall(all[i]))
      candidates.push_back(i);
  if (candidates.empty())
    return nullptr;
  const Function function = all[pick(candidates)];
  account(function);
  std::vector<Signature> overloads;
  std::size_t index = 0;
  for (const Function &other : all)
    if (other.name == function.name) {
      if (other.signature.parameters.size() == function.signature.parameters.size()) {
        bool same = true;
        for (std::size_t i = 0; i != other.signature.parameters.size(); ++i)
          same &= other.signature.parameters[i].type == function.signature.parameters[i].type;
        if (same)
          index = overloads.size();
      }
      overloads.push_back(other.signature);
    }
  std::string callee = function.name;
  if (ofClass && context.self->base &&
      chance(40)) // the base's own, which calls none but earlier ones
    for (const Function &inherited : context.self->base->functions)
      if (inherited.name == function.name)
        callee = context.self->base->name + "::" + function.name;
  return call(callee, function.signature, overloads, index, depth - 1);
}

/// A function of another object, or a texture lookup.
NodePtr Generator::methodCall(const Type *result, unsigned depth) {
  if (context.constantOnly)
    return nullptr;
  const ClassPlan *plan = nullptr;
  if (context.lookup && chance(50) && (result == types.color || result == types.floatType))
    if (NodePtr texture = referenceTo(&plan, true)) {
      work += 50 * context.weight;
      return make(result, result == types.color ? "$.lookup()" : "$.lookupFloat()",
                  std::move(texture));
    }
  NodePtr receiver = referenceTo(&plan, false);
  if (!receiver)
    return nullptr;
  std::vector<const Function *> candidates;
  for (const Function &function : plan->functions)
    if (function.remote && function.signature.result == result && mayCall(function))
      candidates.push_back(&function);
  if (candidates.empty())
    return nullptr;
  const Function function = *pick(candidates);
  account(function);
  return call(function.name, function.signature, {function.signature}, 0, depth - 1,
              std::move(receiver));
}

} // namespace rtsl::random
