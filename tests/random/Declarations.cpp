//===- Declarations.cpp - constants and functions at file level -----------===//
#include "Generator.h"

#include "sema/typed/TypeProperties.h"

namespace rtsl::random {

void Generator::makeConstant() {
  const Type *type = anyType();
  const std::string name = global("C");
  context = Context();
  context.constantOnly = true;
  scope = constants;
  NodePtr value = expression(type, 3);
  context.constantOnly = false;
  program.tree->children.push_back(declare(name, type, std::move(value), "const "));
  constants.push_back({name, type, false, true});
}

/// Parameters and body of `made`; `context` says what may be done. `head` is what stands before the
/// parameters.
NodePtr Generator::function(Function &made, const std::string &head,
                            const std::vector<Variable> &around) {
  const unsigned workBefore = work, tracesBefore = context.traces;
  work = 0;
  workLimit = large ? 150 : 30;
  scope = around;
  std::string parameters;
  NodePtr body = makeList();
  const std::size_t first = scope.size();
  for (Signature::Parameter &parameter : made.signature.parameters) {
    const std::string name = fresh("p");
    const bool isIn = parameter.direction == ast::Direction::In;
    const bool isConst = isIn && chance(10);
    parameters += parameters.empty() ? "" : ", ";
    parameters += isConst                                        ? "const "
                  : parameter.direction == ast::Direction::Out   ? "out "
                  : parameter.direction == ast::Direction::InOut ? "inout "
                  : chance(20)                                   ? "in "
                                                                 : "";
    parameters += toString(parameter.type) + " " + name;
    if (head == "constructor")
      parameters += someRange(parameter.type).text;
    if (parameter.direction == ast::Direction::Out)
      add(*body, makeNode(Role::Statement, name + " = $;", literal(parameter.type)));
    scope.push_back({name, parameter.type, !isConst});
  }
  context.result = made.signature.result == types.voidType ? nullptr : made.signature.result;
  statements(*body, some(2 + below(4)), nesting());
  NodePtr node;
  const std::string result = toString(made.signature.result) + " " + head + "(" + parameters + ") ";
  if (context.result) {
    NodePtr value = expression(made.signature.result, nesting());
    add(*body, nullptr);
    node = makeNode(Role::Fixed, result + "{$  return $; }", std::move(body), std::move(value));
  } else {
    node = makeNode(Role::Fixed, result + "{$}", std::move(body));
  }
  scope.resize(first);
  made.work = work;
  made.traces = tracesBefore - context.traces;
  work = workBefore;
  return node;
}

void Generator::makeFreeFunction() {
  Function made;
  made.signature.result = chance(12) ? types.voidType : anyType();
  for (unsigned n = below(4); n-- > 0;) {
    static const ast::Direction directions[] = {ast::Direction::In, ast::Direction::In,
                                                ast::Direction::Out, ast::Direction::InOut};
    const Type *type = anyType();
    made.signature.parameters.push_back({type, directions[below(4)]});
  }
  // Overloads of one name, as far as their parameters differ.
  made.name = !functions.empty() && chance(40) ? pick(functions).name : global("f");
  for (const Function &other : functions) {
    if (other.name != made.name ||
        other.signature.parameters.size() != made.signature.parameters.size())
      continue;
    bool same = true;
    for (std::size_t i = 0; i != made.signature.parameters.size(); ++i)
      same &= other.signature.parameters[i].type == made.signature.parameters[i].type;
    if (same)
      made.name = global("f");
  }
  context = Context();
  context.reads = made.reads = someReads("");
  context.rand = made.draws = chance(30);
  context.raises = made.raises = program.raises && chance(60);
  context.changes = true; // 0 unless a material or a texture calls it
  references.clear();
  std::vector<Variable> around = constants;
  for (const Variable &variable : stateOf(made.reads, {}))
    around.push_back(variable);
  program.tree->children.push_back(function(made, made.name, around));
  functions.push_back(std::move(made));
}

} // namespace rtsl::random
