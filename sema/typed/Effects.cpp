#include "sema/typed/Effects.h"

#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <algorithm>
#include <string_view>

namespace rtsl::typed {

void Effects::add(const Effects &other) {
  reads.insert(other.reads.begin(), other.reads.end());
  writes.insert(other.writes.begin(), other.writes.end());
  random |= other.random;
  reportsHit |= other.reportsHit;
  usesRay |= other.usesRay;
  usesScratch |= other.usesScratch;
  writesScratch |= other.writesScratch;
  writesMembers |= other.writesMembers;
  hasOutput |= other.hasOutput;
  raises |= other.raises;
}

bool Effects::operator==(const Effects &other) const {
  return reads == other.reads && writes == other.writes && random == other.random &&
         reportsHit == other.reportsHit && usesRay == other.usesRay &&
         usesScratch == other.usesScratch && writesScratch == other.writesScratch &&
         writesMembers == other.writesMembers && hasOutput == other.hasOutput &&
         raises == other.raises;
}

static bool intersect(const std::set<const void *> &a, const std::set<const void *> &b) {
  return std::any_of(a.begin(), a.end(), [&](const void *place) { return b.count(place) != 0; });
}

/// Can it be observed whether a sample ends before or after this? Rays draw random numbers.
static bool showsEnd(const Effects &effects) {
  return effects.random || effects.hasOutput;
}

bool conflicts(const Effects &first, const Effects &second) {
  return intersect(first.writes, second.reads) || intersect(first.reads, second.writes) ||
         intersect(first.writes, second.writes) || (first.random && second.random) ||
         (first.reportsHit && second.reportsHit) || (first.hasOutput && second.hasOutput) ||
         (first.raises && showsEnd(second)) || (showsEnd(first) && second.raises);
}

const void *EffectsOf::place(StateVariable variable) {
  static const char places[256] = {};
  return places + static_cast<std::size_t>(variable);
}

bool EffectsOf::isSilent(const Expr &expr) const {
  auto *builtin = dynCast<BuiltinExpr>(&expr);
  return !prints && builtin && has(builtin->builtin, effect::Prints);
}

EffectsOf::EffectsOf(const Module &module, bool prints, bool raises)
    : module(module), prints(prints), raises(raises) {
  // Textures call one another, so their effects are found before those of any `lookup`.
  for (const auto &definition : module.classes)
    if (definition->root == "rt_Texture")
      for (const auto &method : definition->functions)
        if (method->body)
          forEachExpr(*method->body, [&](const Expr &expr) {
            if (auto *builtin = dynCast<BuiltinExpr>(&expr))
              texturesDraw |= has(builtin->builtin, effect::Random);
            if (auto *call = dynCast<CallExpr>(&expr))
              texturesDraw |= !call->function->owner && function(*call->function).random;
          });
}

bool isCalledByEngineAlone(const Function &function) {
  return function.isStateMethod && !function.isCalledOnSelf;
}

const Function &overridden(const Function &function) {
  const Function *top = &function;
  if (function.owner && !function.isConstructor && !isCalledByEngineAlone(function))
    for (const Class *base = function.owner->base; base; base = base->base)
      for (const auto &method : base->functions)
        if (method->name == function.name && sameParameters(*method, function))
          top = method.get();
  return *top;
}

// Methods of the name in all classes are treated as one: they have one signature, and a call may
// run any of them.
Effects EffectsOf::ofBodies(const Function &function) {
  Effects effects;
  std::set<const void *> locals;
  auto addBody = [&](const Function &definition) {
    if (definition.body)
      effects.add(statement(*definition.body));
    for (const auto &parameter : definition.parameters)
      locals.insert(parameter.get());
    for (const auto &local : definition.locals)
      locals.insert(local.get());
  };
  addBody(function);
  if (function.owner && !function.isConstructor)
    for (const auto &other : module.classes)
      if (other.get() != function.owner && other->derivesFrom(function.owner))
        for (const auto &method : other->functions)
          if (method->name == function.name && sameParameters(*method, function))
            addBody(*method);
  // Effects on local variables cannot be observed outside.
  for (const void *local : locals) {
    effects.reads.erase(local);
    effects.writes.erase(local);
  }
  return effects;
}

const Effects &EffectsOf::function(const Function &named) {
  const Function &function = overridden(named);
  if (auto found = known.find(&function); found != known.end()) {
    hasCycle |= open.count(&function) != 0;
    return found->second;
  }
  known[&function]; // a method through a reference may lead back here
  open.insert(&function);
  Effects effects = ofBodies(function);
  open.erase(&function);
  known[&function] = std::move(effects);
  // In a cycle of calls, each function has the effects of all of them.
  while (hasCycle && open.empty()) {
    hasCycle = false;
    for (auto &[other, effectsSoFar] : known)
      if (Effects now = ofBodies(*other); !(now == effectsSoFar)) {
        effectsSoFar = std::move(now);
        hasCycle = true;
      }
  }
  return known[&function];
}

template <typename Tree>
void EffectsOf::collectAll(const Tree &tree, Effects &effects) {
  std::set<const Expr *> onlyWritten; // outer expressions come first
  forEachEvaluated(tree, [&](const Expr &inner) {
    if (auto *assign = dynCast<AssignExpr>(&inner); assign && !assign->compound)
      onlyWritten.insert(&wholeOf(*assign->target));
    if (!onlyWritten.count(&inner))
      collect(inner, effects);
  });
}

Effects EffectsOf::expression(const Expr &expr) {
  Effects effects;
  collectAll(expr, effects);
  return effects;
}

/// The effects of the lights' methods where a point is lit.
void EffectsOf::collectLights(Effects &effects) {
  effects.usesRay = effects.random = true;
  for (StateVariable variable :
       {StateVariable::LightDirection, StateVariable::LightDistance, StateVariable::LightColor})
    effects.writes.insert(place(variable));
}

Effects EffectsOf::statement(const Stmt &stmt) {
  Effects effects;
  collectAll(stmt, effects);
  std::vector<const Stmt *> pending = {&stmt};
  while (!pending.empty()) {
    const Stmt *at = pending.back();
    pending.pop_back();
    auto push = [&](const StmtPtr &inner) {
      if (inner)
        pending.push_back(inner.get());
    };
    if (auto *compound = dynCast<CompoundStmt>(at))
      for (const auto &inner : compound->body)
        push(inner);
    else if (auto *branch = dynCast<IfStmt>(at))
      push(branch->thenStmt), push(branch->elseStmt);
    else if (auto *loop = dynCast<ForStmt>(at))
      push(loop->init), push(loop->body);
    else if (auto *loop = dynCast<WhileStmt>(at))
      push(loop->body);
    else if (auto *loop = dynCast<DoWhileStmt>(at))
      push(loop->body);
    else if (auto *choice = dynCast<SwitchStmt>(at))
      for (const auto &arm : choice->arms)
        for (const auto &inner : arm.body)
          push(inner);
    else if (auto *illuminance = dynCast<IlluminanceStmt>(at)) {
      collectLights(effects);
      push(illuminance->body);
    }
  }
  return effects;
}

void EffectsOf::collectWrite(const Expr &target, Effects &effects) {
  const Expr *root = &wholeOf(target);
  if (auto *variable = dynCast<VariableExpr>(root)) {
    effects.writes.insert(variable->variable);
  } else if (auto *member = dynCast<MemberExpr>(root)) {
    effects.writes.insert(member->member);
    if (member->member->type->is(TypeKind::Buffer))
      effects.usesRay = true; // has an exception ended the sample?
    else if (member->member->access == ast::Access::Scratch)
      effects.writesScratch = true;
    else
      effects.writesMembers = true;
    effects.usesScratch |= member->member->access == ast::Access::Scratch;
  } else if (auto *state = dynCast<StateExpr>(root)) {
    effects.writes.insert(place(state->variable));
    effects.usesRay = true;
  }
}

void EffectsOf::collectCall(const Function &callee, const std::vector<ExprPtr> &args,
                            Effects &effects) {
  for (std::size_t i = 0; i < args.size(); ++i)
    if (callee.parameters[i]->direction != ast::Direction::In)
      collectWrite(*args[i], effects);
  effects.add(function(callee));
}

/// Conversions between object space and world space read the matrices between them.
static bool convertsSpace(Builtin builtin) {
  switch (builtin) {
#define RTSL_BUILTIN(id, name, effects, cost, where, ...)                                          \
  case Builtin::id:                                                                                \
    return std::string_view(#where) == "Spaces";
#include "language/Builtins.def"
  }
  return false;
}

void EffectsOf::collectBuiltin(const BuiltinExpr &builtin, Effects &effects) {
  const auto hasEffect = [&](effect::Effect effect) { return has(builtin.builtin, effect); };
  for (std::size_t i = 0; i < builtin.args.size(); ++i)
    if (isOutArgument(builtin.builtin, i))
      collectWrite(*builtin.args[i], effects);
  effects.usesRay |= !isFoldable(builtin.builtin) && !hasEffect(effect::Outputs) &&
                     !hasEffect(effect::Atomic); // writing a buffer does, where there is one
  effects.random |= hasEffect(effect::Random) || hasEffect(effect::Traces);
  effects.hasOutput |=
      hasEffect(effect::EndsHit) || hasEffect(effect::Visits) || hasEffect(effect::Prints);
  if (hasEffect(effect::Hits)) {
    effects.reportsHit = true;
    effects.writes.insert(place(StateVariable::HitDistance));
  }
  if (hasEffect(effect::Lights))
    collectLights(effects);
  if (hasEffect(effect::Samples))
    effects.writes.insert(place(StateVariable::PDF));
  if (convertsSpace(builtin.builtin))
    effects.reads.insert(
        {place(StateVariable::ObjectToWorld), place(StateVariable::WorldToObject)});
}

void EffectsOf::collect(const Expr &expr, Effects &effects) {
  switch (expr.kind) {
  case ExprKind::Variable:
    effects.reads.insert(cast<VariableExpr>(expr).variable);
    break;
  case ExprKind::Member: {
    const Member &member = *cast<MemberExpr>(expr).member;
    if (member.isConst)
      break;
    effects.reads.insert(&member);
    effects.usesScratch |= member.access == ast::Access::Scratch;
    break;
  }
  case ExprKind::State:
    effects.reads.insert(place(cast<StateExpr>(expr).variable));
    effects.usesRay = true;
    break;
  case ExprKind::Index:
    effects.usesRay |= isInOutputBuffer(expr);
    if (raises && mayBeOutOfRange(cast<IndexExpr>(expr)))
      effects.usesRay = effects.raises = true;
    break;
  case ExprKind::IncDec:
    collectWrite(*cast<IncDecExpr>(expr).target, effects);
    break;
  case ExprKind::Assign:
    collectWrite(*cast<AssignExpr>(expr).target, effects);
    break;
  case ExprKind::Call: {
    const auto &call = cast<CallExpr>(expr);
    collectCall(*call.function, call.args, effects);
    break;
  }
  case ExprKind::MethodCall: {
    const auto &call = cast<MethodCallExpr>(expr);
    effects.usesRay = true;
    if (call.function) {
      collectCall(*call.function, call.args, effects);
    } else { // `lookup` reads the state, and does not change it
      effects.random |= texturesDraw;
      effects.writes.insert(place(StateVariable::TextureColor));
      effects.writes.insert(place(StateVariable::FloatTextureValue));
    }
    break;
  }
  case ExprKind::Builtin:
    collectBuiltin(cast<BuiltinExpr>(expr), effects);
    break;
  default:
    break;
  }
}

} // namespace rtsl::typed
