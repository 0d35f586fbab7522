//===- Analysis.cpp - queries on typed trees ------------------------------===//
#include "sema/typed/Analysis.h"

#include "language/Costs.h"
#include "sema/typed/Casting.h"
#include "sema/typed/TypeProperties.h"

#include <algorithm>

namespace rtsl::typed {

using ast::StmtKind;

//===----------------------------------------------------------------------===//
// Queries
//===----------------------------------------------------------------------===//

bool isWholeVector(const SwizzleExpr &expr) {
  const Type *type = expr.base->type;
  if (!type->isVector() || expr.components.size() != type->componentCount())
    return false;
  for (std::size_t i = 0; i < expr.components.size(); ++i)
    if (expr.components[i] != i)
      return false;
  return true;
}

bool isInOutputBuffer(const Expr &place) {
  if (place.type->is(TypeKind::Buffer)) // the whole one, or a row
    return false;
  const Type *type = wholeOf(place).type;
  return type->is(TypeKind::Buffer) && type->mode != BufferMode::Read;
}

bool isLocal(const Expr &expr) {
  auto *variable = dynCast<VariableExpr>(&expr);
  return variable && variable->variable->kind != Variable::Kind::Global;
}

const Expr &rootOf(const Expr &expr) {
  const Expr *root = &expr;
  for (;;) {
    if (auto *field = dynCast<FieldExpr>(root))
      root = field->base.get();
    else if (auto *index = dynCast<IndexExpr>(root))
      root = index->base.get();
    else
      return *root;
  }
}

const Expr &wholeOf(const Expr &place) {
  const Expr *root = &rootOf(place);
  while (auto *swizzle = dynCast<SwizzleExpr>(root))
    root = &rootOf(*swizzle->base);
  return *root;
}

bool hasSideEffects(const Expr &expr) {
  bool found = false;
  forEachExpr(expr, [&](const Expr &inner) {
    switch (inner.kind) {
    case ExprKind::IncDec:
    case ExprKind::Assign:
    case ExprKind::Call:
    case ExprKind::MethodCall:
      found = true;
      break;
    case ExprKind::Builtin:
      found = found || !isPure(cast<BuiltinExpr>(inner).builtin);
      break;
    default:
      break;
    }
  });
  return found;
}

bool isCheap(const Expr &expr) {
  constexpr unsigned tooMuch = cost::withoutBranch + 1;
  unsigned cost = 0;
  forEachExpr(expr, [&](const Expr &inner) {
    switch (inner.kind) {
    case ExprKind::Literal:
    case ExprKind::Variable:
    case ExprKind::State:
    case ExprKind::Member:
    case ExprKind::Swizzle:
    case ExprKind::Field:
    case ExprKind::Unary:
    case ExprKind::Convert:
      cost += cost::arithmetic;
      break;
    case ExprKind::Binary: {
      const auto &binary = cast<BinaryExpr>(inner);
      bool isDivision = binary.op == ast::BinaryOp::Div || binary.op == ast::BinaryOp::Mod;
      bool isLarge = binary.left->type->isMatrix() || binary.right->type->isMatrix();
      cost += isDivision || isLarge ? tooMuch : 2 * cost::arithmetic;
      break;
    }
    case ExprKind::Builtin: {
      const unsigned ofBuiltin = info(cast<BuiltinExpr>(inner).builtin).cost;
      cost += ofBuiltin >= cost::squareRoot ? tooMuch : ofBuiltin;
      break;
    }
    case ExprKind::Construct:
      cost += inner.type->isScalar() || inner.type->isVector() ? cost::arithmetic : tooMuch;
      break;
    default:
      cost += tooMuch;
    }
    if (inner.type->isMatrix() || inner.type->is(TypeKind::Struct) ||
        inner.type->is(TypeKind::Array) || inner.type->is(TypeKind::Buffer))
      cost += tooMuch;
  });
  return cost <= cost::withoutBranch;
}

BufferAccess bufferAccess(const IndexExpr &expr) {
  BufferAccess access{&expr, {}};
  while (auto *index = dynCast<IndexExpr>(access.buffer)) {
    if (!index->base->type->is(TypeKind::Buffer))
      break;
    access.indices.insert(access.indices.begin(), index->index.get());
    access.buffer = index->base.get();
  }
  return access;
}

bool mayBeOutOfRange(const IndexExpr &expr) {
  if (expr.base->type->is(TypeKind::Buffer))
    return !expr.type->is(TypeKind::Buffer);
  return expr.index->kind != ExprKind::Literal;
}

bool isLvalue(const Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Variable:
  case ExprKind::State:
    return true;
  case ExprKind::Member:
    return !cast<MemberExpr>(expr).member->isConst;
  case ExprKind::Field:
    return isLvalue(*cast<FieldExpr>(expr).base);
  case ExprKind::Swizzle:
    return isLvalue(*cast<SwizzleExpr>(expr).base);
  case ExprKind::Index:
    return isLvalue(*cast<IndexExpr>(expr).base);
  default:
    return false;
  }
}

//===----------------------------------------------------------------------===//
// Functions
//===----------------------------------------------------------------------===//

bool sameParameters(const Function &a, const Function &b) {
  if (a.parameters.size() != b.parameters.size())
    return false;
  for (std::size_t i = 0; i < a.parameters.size(); ++i)
    if (a.parameters[i]->type != b.parameters[i]->type)
      return false;
  return true;
}

const Function &resolve(const Function &callee, const Class *concrete) {
  if (!callee.owner)
    return callee;
  for (const Class *type = concrete; type; type = type->base)
    for (const auto &function : type->functions)
      if (function->name == callee.name && sameParameters(*function, callee))
        return *function;
  return callee;
}

const Function &resolve(const CallExpr &call, const Class *concrete) {
  return call.isOfBase ? *call.function : resolve(*call.function, concrete);
}

SentRays raysOf(const Expr &expr, const Class *concrete) {
  if (auto *builtin = dynCast<BuiltinExpr>(&expr))
    return {has(builtin->builtin, effect::Traces), has(builtin->builtin, effect::Lights)};
  if (auto *call = dynCast<CallExpr>(&expr)) {
    if (call->onSelf && concrete)
      return resolve(*call, concrete).sends;
    return call->isOfBase ? call->function->sends : call->function->callSends;
  }
  auto *method = dynCast<MethodCallExpr>(&expr);
  return method && method->function ? method->function->callSends : SentRays();
}

bool mayTrace(const Expr &expr, const Class *concrete) {
  return raysOf(expr, concrete).traced;
}

const Expr *payloadOf(const BuiltinExpr &call) {
  if (has(call.builtin, effect::Traces))
    for (std::size_t i = 0; i < call.args.size(); ++i)
      if (isOutArgument(call.builtin, i))
        return call.args[i].get();
  return nullptr;
}

static bool takesPart(const Function &function, const Class *concrete,
                      std::set<const Function *> &visited) {
  if (!function.body || !visited.insert(&function).second)
    return false;
  bool found = false;
  forEachExpr(*function.body, [&](const Expr &expr) {
    if (auto *builtin = dynCast<BuiltinExpr>(&expr))
      found = found || has(builtin->builtin, effect::Hits);
    else if (auto *member = dynCast<MemberExpr>(&expr))
      found = found || member->member->access == ast::Access::Scratch;
    else if (auto *call = dynCast<CallExpr>(&expr))
      found = found || takesPart(resolve(*call, concrete), concrete, visited);
  });
  return found;
}

bool takesPartInIntersection(const Function &function, const Class *concrete) {
  std::set<const Function *> visited;
  return takesPart(function, concrete, visited);
}

bool takesPayload(const Function &function) {
  return function.isStateMethod && !function.parameters.empty();
}

bool isHitAnswer(const Expr &expr) {
  auto *builtin = dynCast<BuiltinExpr>(&expr);
  return builtin && has(builtin->builtin, effect::EndsHit);
}

/// Does any expression of a function of the module satisfy `condition`?
template <typename Condition>
static bool someExpression(const Module &module, const Condition &condition) {
  bool found = false;
  const auto look = [&](const Function &function) {
    if (function.body && !found)
      forEachExpr(*function.body,
                  [&](const Expr &expr) { found = found || condition(function, expr); });
  };
  for (const auto &function : module.functions)
    look(*function);
  for (const auto &definition : module.classes)
    for (const auto &function : definition->functions)
      look(*function);
  return found;
}

HitAnswers::HitAnswers(const Module &module)
    : module(module), hasAnswers(someExpression(module, [](const Function &, const Expr &expr) {
        return isHitAnswer(expr);
      })) {}

bool lookupsNest(const Module &module) {
  return someExpression(module, [](const Function &function, const Expr &expr) {
    auto *call = dynCast<MethodCallExpr>(&expr);
    return function.mayRunInLookup && call && !call->function;
  });
}

bool HitAnswers::isFoundIn(const Function &function, const Class *concrete) {
  bool found = false;
  forEachExpr(*function.body, [&](const Expr &expr) {
    if (found)
      return;
    found = isHitAnswer(expr);
    if (auto *call = dynCast<CallExpr>(&expr))
      found = call->onSelf ? mayAnswer(resolve(*call, concrete), concrete)
                           : mayAnswer(*call->function, nullptr);
    else if (auto *method = dynCast<MethodCallExpr>(&expr))
      found = method->function && mayAnswerOf(*method->function);
  });
  return found;
}

bool HitAnswers::mayAnswer(const Function &function, const Class *concrete) {
  if (!hasAnswers || !function.body)
    return false;
  const Key key = {&function, concrete};
  const auto [entry, isNew] = known.try_emplace(key, false);
  if (!isNew) {
    comesRound |= open.count(key) != 0;
    return entry->second;
  }
  open.insert(key);
  const bool found = isFoundIn(function, concrete);
  open.erase(key);
  known[key] = found;
  if (!found && !open.empty())
    uncertain.push_back(key);
  if (open.empty()) { // within a cycle, negative results were preliminary
    if (comesRound)
      for (const Key &other : uncertain)
        known.erase(other);
    uncertain.clear();
    comesRound = false;
  }
  return found;
}

bool HitAnswers::mayAnswerOf(const Function &function) {
  return hasAnswers &&
         std::any_of(module.classes.begin(), module.classes.end(), [&](const auto &definition) {
           return definition->derivesFrom(function.owner) &&
                  mayAnswer(resolve(function, definition.get()), definition.get());
         });
}

// Brackets are not allowed in a symbol: `float[4]` becomes `float_4`.
std::string parameterWords(const Function &function) {
  std::string words;
  for (const auto &parameter : function.parameters) {
    words += '.';
    for (char c : toString(parameter->type))
      if (c == '[')
        words += '_';
      else if (c != ']' && c != ' ')
        words += c;
  }
  return words;
}

std::string slotName(const Module &module, const Function &method) {
  if (takesPayload(method)) // there may be others for other payloads, in this class or another
    return method.name + parameterWords(method);
  for (const auto &definition : module.classes)
    for (const auto &other : definition->functions)
      if (other->name == method.name && !sameParameters(*other, method) && !method.isConstructor)
        return method.name + parameterWords(method);
  return method.name;
}

bool mayReferToNothing(const Module &module) {
  const auto refers = [](const Type *type) { return contains(type, TypeKind::Class); };
  const auto inFunction = [&](const auto &function) {
    return std::any_of(function->locals.begin(), function->locals.end(),
                       [&](const auto &local) { return !local->init && refers(local->type); }) ||
           std::any_of(function->parameters.begin(), function->parameters.end(),
                       [&](const auto &parameter) {
                         return parameter->direction == ast::Direction::Out &&
                                refers(parameter->type);
                       });
  };
  const auto inMember = [&](const auto &member) {
    const bool isSet = member->access == ast::Access::Public && !member->isOptional &&
                       !member->type->is(TypeKind::Buffer);
    return !isSet && refers(member->type);
  };
  return std::any_of(module.functions.begin(), module.functions.end(), inFunction) ||
         std::any_of(module.classes.begin(), module.classes.end(), [&](const auto &definition) {
           return std::any_of(definition->members.begin(), definition->members.end(), inMember) ||
                  std::any_of(definition->functions.begin(), definition->functions.end(),
                              inFunction);
         });
}

} // namespace rtsl::typed
