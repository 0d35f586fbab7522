//===- Analysis.cpp - what lowering asks about a typed tree ---------------===//
#include "codegen/lower/Analysis.h"

#include "sema/Casting.h"
#include "sema/TypeProperties.h"

#include <algorithm>

namespace rtsl::lowering {

using ast::StmtKind;
using typed::ExprKind;

//===----------------------------------------------------------------------===//
// Questions
//===----------------------------------------------------------------------===//

bool isPureBuiltin(typed::Builtin builtin) {
  return typed::isPure(builtin);
}

std::pair<std::size_t, std::size_t> outputsOf(typed::Builtin builtin) {
  constexpr std::size_t mostArguments = 4;
  if (typed::info(builtin).effect != typed::BuiltinEffect::Outputs)
    return {0, 0};
  std::size_t first = 0, count = 0;
  while (first < mostArguments && !isOutArgument(builtin, first))
    ++first;
  while (first + count < mostArguments && isOutArgument(builtin, first + count))
    ++count;
  return {first, count};
}

bool isLocal(const typed::Expr &expr) {
  auto *variable = dynCast<typed::VariableExpr>(&expr);
  return variable && variable->variable->kind != typed::Variable::Kind::Global;
}

const typed::Expr &rootOf(const typed::Expr &expr) {
  const typed::Expr *root = &expr;
  for (;;) {
    if (auto *field = dynCast<typed::FieldExpr>(root))
      root = field->base.get();
    else if (auto *index = dynCast<typed::IndexExpr>(root))
      root = index->base.get();
    else
      return *root;
  }
}

const typed::Expr &wholeOf(const typed::Expr &place) {
  const typed::Expr *root = &rootOf(place);
  while (auto *swizzle = dynCast<typed::SwizzleExpr>(root))
    root = &rootOf(*swizzle->base);
  return *root;
}

bool hasSideEffects(const typed::Expr &expr) {
  bool found = false;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    switch (inner.kind) {
    case ExprKind::IncDec:
    case ExprKind::Assign:
    case ExprKind::Call:
    case ExprKind::MethodCall:
      found = true;
      break;
    case ExprKind::Builtin:
      found = found || !isPureBuiltin(cast<typed::BuiltinExpr>(inner).builtin);
      break;
    default:
      break;
    }
  });
  return found;
}

bool isCheap(const typed::Expr &expr) {
  constexpr unsigned limit = 12;
  unsigned cost = 0;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    switch (inner.kind) {
    case ExprKind::Literal:
    case ExprKind::Variable:
    case ExprKind::State:
    case ExprKind::Member:
    case ExprKind::Swizzle:
    case ExprKind::Field:
    case ExprKind::Unary:
    case ExprKind::Convert:
      cost += 1;
      break;
    case ExprKind::Binary: {
      const auto &binary = cast<typed::BinaryExpr>(inner);
      bool isDivision = binary.op == ast::BinaryOp::Div || binary.op == ast::BinaryOp::Mod;
      bool isLarge = binary.left->type->isMatrix() || binary.right->type->isMatrix();
      cost += isDivision || isLarge ? limit + 1 : 2;
      break;
    }
    case ExprKind::Builtin:
      cost += typed::info(cast<typed::BuiltinExpr>(inner).builtin).cost;
      break;
    case ExprKind::Construct:
      cost += inner.type->isScalar() || inner.type->isVector() ? 1 : limit + 1;
      break;
    default:
      cost += limit + 1;
    }
    if (inner.type->isMatrix() || inner.type->is(TypeKind::Struct) ||
        inner.type->is(TypeKind::Array) || inner.type->is(TypeKind::Buffer))
      cost += limit + 1;
  });
  return cost <= limit;
}

bool isPlace(const typed::Expr &expr) {
  switch (expr.kind) {
  case ExprKind::Variable:
  case ExprKind::State:
    return true;
  case ExprKind::Member:
    return !cast<typed::MemberExpr>(expr).member->isConst;
  case ExprKind::Field:
    return isPlace(*cast<typed::FieldExpr>(expr).base);
  case ExprKind::Swizzle:
    return isPlace(*cast<typed::SwizzleExpr>(expr).base);
  case ExprKind::Index:
    return isPlace(*cast<typed::IndexExpr>(expr).base);
  default:
    return false;
  }
}

//===----------------------------------------------------------------------===//
// Functions
//===----------------------------------------------------------------------===//

bool sameParameters(const typed::Function &a, const typed::Function &b) {
  if (a.parameters.size() != b.parameters.size())
    return false;
  for (std::size_t i = 0; i < a.parameters.size(); ++i)
    if (a.parameters[i]->type != b.parameters[i]->type)
      return false;
  return true;
}

const typed::Function &resolve(const typed::Function &callee, const typed::Class *concrete) {
  if (!callee.owner)
    return callee;
  for (const typed::Class *type = concrete; type; type = type->base)
    for (const auto &function : type->functions)
      if (function->name == callee.name && sameParameters(*function, callee))
        return *function;
  return callee;
}

const typed::Function &resolve(const typed::CallExpr &call, const typed::Class *concrete) {
  return call.isOfBase ? *call.function : resolve(*call.function, concrete);
}

static bool takesPart(const typed::Function &function, const typed::Class *concrete,
                      std::set<const typed::Function *> &visited) {
  if (!function.body || !visited.insert(&function).second)
    return false;
  bool found = false;
  forEachExpr(*function.body, [&](const typed::Expr &expr) {
    if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr))
      found = found || builtin->builtin == typed::Builtin::Hit;
    else if (auto *member = dynCast<typed::MemberExpr>(&expr))
      found = found || member->member->access == ast::Access::Scratch;
    else if (auto *call = dynCast<typed::CallExpr>(&expr))
      found = found || takesPart(resolve(*call, concrete), concrete, visited);
  });
  return found;
}

bool takesPartInIntersection(const typed::Function &function, const typed::Class *concrete) {
  std::set<const typed::Function *> visited;
  return takesPart(function, concrete, visited);
}

bool takesPayload(const typed::Function &function) {
  return function.isStateMethod && !function.parameters.empty();
}

bool isHitAnswer(const typed::Expr &expr) {
  auto *builtin = dynCast<typed::BuiltinExpr>(&expr);
  return builtin && (builtin->builtin == typed::Builtin::IgnoreIntersection ||
                     builtin->builtin == typed::Builtin::TerminateRay);
}

/// Does some expression of a function of the module fulfil it? It takes both.
template <typename Condition>
static bool someExpression(const typed::Module &module, const Condition &condition) {
  bool found = false;
  const auto look = [&](const typed::Function &function) {
    if (function.body && !found)
      forEachExpr(*function.body, [&](const typed::Expr &expr) { found = found || condition(function, expr); });
  };
  for (const auto &function : module.functions)
    look(*function);
  for (const auto &definition : module.classes)
    for (const auto &function : definition->functions)
      look(*function);
  return found;
}

HitAnswers::HitAnswers(const typed::Module &module)
    : module(module), hasAnswers(someExpression(module, [](const typed::Function &, const typed::Expr &expr) {
        return isHitAnswer(expr);
      })) {}

bool lookupsNest(const typed::Module &module) {
  return someExpression(module, [](const typed::Function &function, const typed::Expr &expr) {
    auto *call = dynCast<typed::MethodCallExpr>(&expr);
    return function.mayRunInLookup && call && !call->function;
  });
}

bool HitAnswers::isFoundIn(const typed::Function &function, const typed::Class *concrete) {
  bool found = false;
  forEachExpr(*function.body, [&](const typed::Expr &expr) {
    if (found)
      return;
    found = isHitAnswer(expr);
    if (auto *call = dynCast<typed::CallExpr>(&expr))
      found = call->onSelf ? mayAnswer(resolve(*call, concrete), concrete)
                           : mayAnswer(*call->function, nullptr);
    else if (auto *method = dynCast<typed::MethodCallExpr>(&expr))
      found = method->function && mayAnswerOf(*method->function);
  });
  return found;
}

bool HitAnswers::mayAnswer(const typed::Function &function, const typed::Class *concrete) {
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
  if (open.empty()) { // within a cycle, nothing was known yet of what closes it
    if (comesRound)
      for (const Key &other : uncertain)
        known.erase(other);
    uncertain.clear();
    comesRound = false;
  }
  return found;
}

bool HitAnswers::mayAnswerOf(const typed::Function &function) {
  return hasAnswers && std::any_of(module.classes.begin(), module.classes.end(), [&](const auto &definition) {
           return definition->derivesFrom(function.owner) &&
                  mayAnswer(resolve(function, definition.get()), definition.get());
         });
}

// Brackets have no place in a symbol: `float[4]` becomes `float_4`.
std::string parameterWords(const typed::Function &function) {
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

std::string slotName(const typed::Module &module, const typed::Function &method) {
  if (takesPayload(method)) // beside others for other payloads, in this class or the next
    return method.name + parameterWords(method);
  for (const auto &definition : module.classes)
    for (const auto &other : definition->functions)
      if (other->name == method.name && !sameParameters(*other, method) && !method.isConstructor)
        return method.name + parameterWords(method);
  return method.name;
}

bool mayReferToNothing(const typed::Module &module) {
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

} // namespace rtsl::lowering
