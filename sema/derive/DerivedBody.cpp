//===- DerivedBody.cpp - the derivation of one function -------------------===//
#include "sema/derive/DerivedBody.h"

#include "sema/model/Conversion.h"
#include "sema/typed/Walk.h"

#include <algorithm>
#include <iterator>

namespace rtsl::derive {

using namespace typed;

DerivedBody::DerivedBody(Derivation &derivation, const Function &from, Function &to, bool isAtHit)
    : types(derivation.types()), to(to), derivation(derivation), from(from),
      changes(derivation, from, isAtHit) {}

std::unique_ptr<Variable> variableLike(const Variable &from) {
  auto made = std::make_unique<Variable>();
  made->kind = from.kind;
  made->name = from.name;
  made->type = from.type;
  made->isConst = from.isConst;
  made->direction = from.direction;
  if (from.constant)
    made->constant = std::make_unique<Constant>(*from.constant);
  made->range = from.range;
  made->comment = from.comment;
  return made;
}

std::string freeName(const Function &function, std::string name) {
  const auto isTaken = [&](const auto &variables) {
    return std::any_of(variables.begin(), variables.end(),
                       [&](const auto &variable) { return variable->name == name; });
  };
  while (isTaken(function.parameters) || isTaken(function.locals))
    name += "_";
  return name;
}

/// `uv_dx`.
static std::string companionName(const Function &function, const std::string &of, Axis axis) {
  return freeName(function, of + (axis == Axis::X ? "_dx" : "_dy"));
}

Variable &DerivedBody::addLocal(std::string name, const Type *type, SourceRange range) {
  auto made = std::make_unique<Variable>();
  made->kind = Variable::Kind::Local;
  made->name = std::move(name);
  made->type = type;
  made->range = range;
  to.locals.push_back(std::move(made));
  return *to.locals.back();
}

const Variable &DerivedBody::addKept(const Type *type, SourceRange range) {
  const std::string name = freeName(from, "kept" + std::to_string(++keptCount));
  const Variable &made = addLocal(name, type, range);
  keptDeclarations.push_back(declaration(made));
  return made;
}

void DerivedBody::declareKept(std::vector<StmtPtr> &out) {
  std::move(keptDeclarations.begin(), keptDeclarations.end(), std::back_inserter(out));
  keptDeclarations.clear();
}

void DerivedBody::addCompanions(const Variable &of, std::vector<StmtPtr> &out,
                                const Term (&values)[2]) {
  Companions &made = companions[&of];
  for (Axis axis : axes) {
    if (!changes.usedAxes().contains(axis))
      continue;
    Variable &companion = addLocal(companionName(from, of.name, axis), of.type, of.range);
    Term value = values[static_cast<int>(axis)];
    companion.init = value.isZero() ? zero(of.type, of.range) : value.take();
    made.along[static_cast<int>(axis)] = &companion;
    out.push_back(declaration(companion));
  }
}

const DerivedBody::Companions *DerivedBody::companionsOf(const Expr &place) const {
  const Variable *variable = rootVariable(place);
  const auto found = companions.find(variable);
  return variable && found != companions.end() ? &found->second : nullptr;
}

StmtPtr DerivedBody::declaration(const Variable &variable) const {
  auto made = std::make_unique<DeclarationStmt>();
  made->range = variable.range;
  made->variables = {&variable};
  return made;
}

StmtPtr DerivedBody::assignment(const Variable &variable, ExprPtr value) {
  auto target = makeExpr<VariableExpr>(variable.type, variable.range);
  target->variable = &variable;
  auto assign = makeExpr<AssignExpr>(variable.type, variable.range);
  assign->target = std::move(target);
  assign->value = std::move(value);
  auto made = std::make_unique<ExpressionStmt>();
  made->range = variable.range;
  made->expr = std::move(assign);
  return made;
}

void DerivedBody::replace() {
  changes.find({});
  run();
}

void DerivedBody::vary(Result wanted) {
  result = wanted;
  const AxisSet given = derivation.axesOf(from, wanted);
  changes.addParameters(given);
  for (const auto &parameter : from.parameters) {
    to.parameters.push_back(variableLike(*parameter));
    variables[parameter.get()] = to.parameters.back().get();
  }
  for (const auto &parameter : from.parameters) {
    if (!isDifferentiable(parameter->type))
      continue;
    Companions &made = companions[parameter.get()];
    for (Axis axis : axes) {
      if (!given.contains(axis))
        continue;
      auto companion = variableLike(*parameter);
      companion->name = companionName(from, parameter->name, axis);
      companion->comment.clear();
      made.along[static_cast<int>(axis)] = companion.get();
      to.parameters.push_back(std::move(companion));
    }
  }
  if (!from.body)
    return;
  changes.find(wanted == Result::Value    ? AxisSet{}
               : wanted == Result::AlongX ? AxisSet::only(Axis::X)
                                          : AxisSet::only(Axis::Y));
  run();
}

void DerivedBody::run() {
  auto body = std::make_unique<CompoundStmt>();
  body->range = from.body->range;
  for (const auto &parameter : from.parameters) {
    const auto known = companions.find(parameter.get());
    if (known == companions.end() && changes.hasCompanions(parameter.get()))
      addCompanions(*parameter, body->body, {Term(), Term()});
    else if (known != companions.end() && parameter->direction == ast::Direction::Out)
      for (const Variable *companion : known->second.along) // where nothing is written
        if (companion)
          body->body.push_back(assignment(*companion, zero(companion->type, from.range)));
  }
  std::vector<StmtPtr> statements;
  statement(*from.body, statements);
  for (StmtPtr &inner : static_cast<CompoundStmt &>(*statements.back()).body)
    body->body.push_back(std::move(inner));
  to.body = std::move(body);
}

} // namespace rtsl::derive
