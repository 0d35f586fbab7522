//===- LowerEvaluations.cpp - expressions with effects, for C++ -----------------===//
//
// For C++ output (SourceTable.h): expressions that LowerSource.cpp cannot lower.
//
// Structs, arrays and matrices stay whole: the operation takes their addresses. So do the arguments
// that a call writes. A number or a vector that is written becomes a variable of the same name
// during the operation.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/lower/Lowering.h"
#include "sema/typed/Analysis.h"

#include "sema/typed/Casting.h"

#include <algorithm>

namespace rtsl::lowering {

using typed::ExprKind;

FunctionLowering::Evaluation::Evaluation(Value into) {
  if (!into)
    return;
  leaves.push_back(nullptr);
  operands.push_back(into);
  changed.push_back(0);
}

Value FunctionLowering::variableOf(llvm::StringRef name, const Type *type) {
  Value variable = emitter.variable(name, module.type(type));
  if (SourceTable *table = module.options.source) {
    ir::attr::declared.set(
        variable.getDefiningOp(),
        emitter.getI32IntegerAttr(static_cast<std::int32_t>(table->types.size())));
    table->types.push_back(type);
  }
  return variable;
}

bool FunctionLowering::isNamedMatrix(const typed::Variable &variable) {
  return variable.isConst && variable.constant && variable.type->isMatrix();
}

bool FunctionLowering::mentionsMemory(const typed::Expr &expr) {
  bool found = false;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    found = found || (isLocal(inner) && livesInMemory(inner.type)) ||
            (inner.kind == ExprKind::Call && livesInMemory(inner.type));
  });
  return found;
}

/// Is the target part of a variable that stays whole, or a vector component with a computed index?
bool FunctionLowering::staysWhole(const typed::Expr &target) {
  const typed::Expr &whole = wholeOf(target);
  if ((isLocal(whole) && livesInMemory(whole.type)) || isInOutputBuffer(target))
    return true;
  auto *index = dynCast<typed::IndexExpr>(&target);
  return index && index->base->type->isVector() && index->index->kind != ExprKind::Literal;
}

/// The element of an output buffer that the expression itself reads or writes; null: none.
static const typed::Expr *outputOf(const typed::Expr &expr) {
  const typed::Expr *place = &expr;
  if (auto *assign = dynCast<typed::AssignExpr>(&expr))
    place = assign->target.get();
  else if (auto *step = dynCast<typed::IncDecExpr>(&expr))
    place = step->target.get();
  else if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr);
           builtin && typed::isAtomic(builtin->builtin))
    place = builtin->args.front().get();
  return isInOutputBuffer(*place) ? place : nullptr;
}

/// The expression that this one is a part of: a field's struct, an element's array and so on; null
/// if it is no part.
static const typed::Expr *outerPlace(const typed::Expr &part) {
  if (auto *field = dynCast<typed::FieldExpr>(&part))
    return field->base.get();
  if (auto *index = dynCast<typed::IndexExpr>(&part))
    return index->base.get();
  auto *swizzle = dynCast<typed::SwizzleExpr>(&part);
  return swizzle ? swizzle->base.get() : nullptr;
}

namespace {

/// What an expression itself, not a subexpression, writes.
struct Writes {
  std::vector<const typed::Expr *> parts; // subexpressions
  std::vector<const typed::Expr *> lvalues;
  bool readsOld = true; // the values before
};

} // namespace

static Writes writesOf(const typed::Expr &expr) {
  Writes writes;
  auto outputs = [&](const typed::Function *callee, const std::vector<typed::ExprPtr> &args) {
    for (std::size_t i = 0; i < args.size(); ++i) {
      writes.parts.push_back(args[i].get());
      if (callee && callee->parameters[i]->direction != ast::Direction::In)
        writes.lvalues.push_back(args[i].get());
    }
  };
  if (auto *assign = dynCast<typed::AssignExpr>(&expr)) {
    writes.parts = {assign->target.get(), assign->value.get()};
    writes.lvalues = {assign->target.get()};
  } else if (auto *step = dynCast<typed::IncDecExpr>(&expr)) {
    writes.parts = writes.lvalues = {step->target.get()};
  } else if (auto *call = dynCast<typed::CallExpr>(&expr)) {
    outputs(call->function, call->args);
  } else if (auto *method = dynCast<typed::MethodCallExpr>(&expr)) {
    writes.parts = {method->receiver.get()};
    outputs(method->function, method->args);
  } else if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr)) {
    outputs(nullptr, builtin->args);
    const auto [first, count] = outputsOf(builtin->builtin);
    for (std::size_t i = first; i < first + count; ++i)
      writes.lvalues.push_back(builtin->args[i].get());
    writes.readsOld = false;
  } else {
    writes.parts = {&expr};
  }
  return writes;
}

/// Subexpressions with effects run before the expression: do they change a variable that it uses in
/// place?
static bool partsChangeUsed(const typed::Expr &expr, const Writes &writes) {
  std::set<const typed::Variable *> changed;
  for (const typed::Expr *part : writes.parts)
    for (const typed::Variable *variable : assignedVariables(*part))
      changed.insert(variable);
  bool isUsed = false;
  auto use = [&](const typed::Expr &variable) {
    isUsed |= changed.count(cast<typed::VariableExpr>(variable).variable) != 0;
  };
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (isLocal(inner) && livesInMemory(inner.type))
      use(inner);
  });
  for (const typed::Expr *target : writes.lvalues)
    if (const typed::Expr &whole = wholeOf(*target); isLocal(whole))
      use(whole);
  return isUsed;
}

/// The same for state variables and output buffers, of which it uses those that it writes. The
/// value that it had before the effects counts: `v[i] *= --v.y`.
static bool partsChangeWritten(const typed::Expr &expr, const Writes &writes,
                               const SourceTable &source) {
  std::set<std::string> states;
  for (const typed::Expr *target : writes.lvalues)
    if (auto *state = dynCast<typed::StateExpr>(&wholeOf(*target)))
      states.insert(typed::name(state->variable));
  auto *assign = dynCast<typed::AssignExpr>(&expr);
  const bool readsBuffer = outputOf(expr) && !(assign && !assign->compound);
  bool isChanged = false;
  for (const typed::Expr *part : writes.parts)
    forEachExpr(*part, [&](const typed::Expr &inner) {
      if (&inner == &expr)
        return;
      for (const typed::Expr *target : writesOf(inner).lvalues) {
        if (auto *state = dynCast<typed::StateExpr>(&wholeOf(*target)))
          isChanged |= states.count(typed::name(state->variable)) != 0;
        isChanged |= readsBuffer && isInOutputBuffer(*target);
      }
      auto *builtin = dynCast<typed::BuiltinExpr>(&inner);
      isChanged |= readsBuffer && builtin && typed::isAtomic(builtin->builtin);
      const bool isCall = inner.kind == ExprKind::Call || inner.kind == ExprKind::MethodCall;
      if (!isCall || states.empty())
        return;
      const std::optional<std::vector<std::string>> ofCall = source.writes(inner);
      isChanged |= !ofCall || std::any_of(ofCall->begin(), ofCall->end(), [&](const auto &name) {
        return states.count(name) != 0;
      });
    });
  return isChanged;
}

/// Collects the variables that the expression itself, not a subexpression, writes.
bool FunctionLowering::collectWritten(const typed::Expr &expr, Evaluation &evaluation) {
  const Writes writes = writesOf(expr);
  if (partsChangeUsed(expr, writes) || partsChangeWritten(expr, writes, *module.options.source))
    return false;
  for (const typed::Expr *target : writes.lvalues) {
    if (isInOutputBuffer(*target))
      continue;
    const typed::Expr &whole = wholeOf(*target);
    if (auto *state = dynCast<typed::StateExpr>(&whole)) {
      evaluation.states.insert(state->variable);
      continue;
    }
    if (!isLocal(whole))
      return false;
    const typed::Variable *variable = cast<typed::VariableExpr>(whole).variable;
    if (evaluation.addresses.count(variable))
      continue;
    const Lvalue lvalue = lowerLvalue(whole);
    if (livesInMemory(whole.type)) {
      evaluation.addresses[variable] = lvalue.address;
      continue;
    }
    const Value copy = variableOf(variable->name, whole.type);
    unsigned mentions = 0; // more than one: it is an input too
    forEachExpr(expr, [&](const typed::Expr &inner) {
      auto *named = dynCast<typed::VariableExpr>(&inner);
      mentions += named && named->variable == variable;
    });
    if (writes.readsOld || &whole != target || mentions > 1)
      storeTo(load(lvalue), copy, whole.type);
    evaluation.addresses[variable] = copy;
    evaluation.outputs.push_back({lvalue, copy});
  }
  return true;
}

void FunctionLowering::gather(const typed::Expr &expr, Evaluation &evaluation, bool isTop) {
  auto leaf = [&](Value operand, bool changes = false) {
    if (changes)
      evaluation.changed.push_back(static_cast<std::int32_t>(evaluation.operands.size()));
    evaluation.leaves.push_back(&expr);
    evaluation.operands.push_back(operand);
  };
  if (llvm::is_contained(evaluation.leaves, &expr))
    return; // an index that was checked before
  const bool isOnPath = evaluation.path.count(&expr) != 0;
  if (!isTop && !isOnPath && !evaluation.isNested && expr.kind != ExprKind::String &&
      !isKept(expr)) {
    if (!livesInMemory(expr.type))
      return leaf(value(expr));
    const auto *call = dynCast<typed::CallExpr>(&expr);
    const Value address = temporary(call ? call->function->name : "value", expr.type);
    lowerInto(expr, address);
    return leaf(address);
  }
  switch (expr.kind) {
  case ExprKind::Variable: {
    if (!isLocal(expr))
      return;
    const typed::Variable *variable = cast<typed::VariableExpr>(expr).variable;
    if (auto known = evaluation.addresses.find(variable); known != evaluation.addresses.end())
      return leaf(known->second, true);
    if (isNamedMatrix(*variable))
      return;
    if (!livesInMemory(expr.type))
      return leaf(value(expr));
    const Value address = lowerLvalue(expr).address;
    if (!address.getDefiningOp() || !llvm::isa<ir::TableOp>(address.getDefiningOp()))
      leaf(address);
    return;
  }
  case ExprKind::State:
    if (!evaluation.isNested && !livesInMemory(expr.type) &&
        !evaluation.states.count(cast<typed::StateExpr>(expr).variable))
      leaf(value(expr));
    return;
  default:
    forEachChild(expr, [&](const typed::Expr &part) { gather(part, evaluation, false); });
  }
}

/// An expression that traces, or with subexpressions that run conditionally, is lowered piece by
/// piece.
static bool isOneStep(const typed::Expr &expr, const typed::Class *concrete) {
  if (typed::mayTrace(expr, concrete))
    return false;
  if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr))
    return typed::isPure(builtin->builtin) || has(builtin->builtin, typed::effect::Prints) ||
           outputsOf(builtin->builtin).second != 0 || typed::isAtomic(builtin->builtin);
  return expr.kind != ExprKind::Comma && expr.kind != ExprKind::String;
}

/// The evaluation checks the indices of the places that it reads or writes itself; those of an
/// assignment are checked before its value sends rays.
void FunctionLowering::addIndexedPlaces(const typed::Expr &expr, Evaluation &evaluation) {
  std::vector<const typed::Expr *> places = writesOf(expr).lvalues;
  if (mayRaise(expr))
    places.push_back(&expr);
  bool comeFirst = false;
  if (auto *assign = dynCast<typed::AssignExpr>(&expr))
    forEachExpr(*assign->value,
                [&](const typed::Expr &inner) { comeFirst |= typed::raysOf(inner).any(); });
  for (const typed::Expr *place : places) {
    std::vector<const typed::IndexExpr *> elements; // the last index first
    for (const typed::Expr *at = place; at; at = outerPlace(*at)) {
      evaluation.path.insert(at);
      auto *index = dynCast<typed::IndexExpr>(at);
      if (comeFirst && index && (mayRaise(*index) || index->type->is(TypeKind::Buffer)))
        elements.push_back(index);
    }
    for (auto element = elements.rbegin(); element != elements.rend(); ++element) {
      evaluation.leaves.push_back((*element)->index.get());
      evaluation.operands.push_back(checkedIndex(**element));
    }
  }
}

Value FunctionLowering::checkedIndex(const typed::IndexExpr &expr) {
  const typed::Expr &index = *expr.index;
  const Value unchecked = value(index);
  SourceTable &table = *module.options.source;
  const auto number = static_cast<std::uint32_t>(table.entries.size());
  table.entries.push_back({SourceTable::Kind::Index, &expr, {&index}});
  emitter.setLoc(module.location(index.range));
  auto check = emitter.make<ir::EvaluateOp>(module.type(index.type), number, unchecked,
                                            emitter.getStrArrayAttr({}));
  return check.getResult(0);
}

std::optional<Parts> FunctionLowering::lowerEvaluation(const typed::Expr &expr, Value into) {
  const bool isWrite = expr.kind == ExprKind::Assign || expr.kind == ExprKind::IncDec;
  if (into && isWrite)
    return lowerNested(expr, /*hasResult=*/true, into);
  // The parts of an index are never conditional.
  if (!isOneStep(expr, key.concrete) && !mayRaise(expr))
    return std::nullopt;
  const bool isChoice = expr.kind == ExprKind::Conditional || expr.kind == ExprKind::Binary;
  if (isChoice && !isKept(expr))
    return std::nullopt;
  if (!into && livesInMemory(expr.type) && !isWrite)
    return std::nullopt;
  Evaluation evaluation(into);
  evaluation.hasResult = !isWrite;
  for (const typed::Expr *at = outputOf(expr); at; at = outerPlace(*at))
    evaluation.path.insert(at);
  if (module.options.raisesExceptions)
    addIndexedPlaces(expr, evaluation);
  if (!collectWritten(expr, evaluation))
    return lowerNested(expr, evaluation.hasResult, into);
  gather(expr, evaluation, true);
  return makeEvaluation(expr, evaluation, into);
}

Parts FunctionLowering::makeEvaluation(const typed::Expr &expr, const Evaluation &evaluation,
                                       Value into) {
  emitter.setLoc(module.location(expr.range));
  SourceTable &table = *module.options.source;
  const auto number = static_cast<std::uint32_t>(table.entries.size());
  table.entries.push_back(
      {into ? SourceTable::Kind::Into : SourceTable::Kind::Value, &expr, evaluation.leaves});
  const bool isCall = expr.kind == ExprKind::Call || expr.kind == ExprKind::MethodCall;
  mlir::ArrayAttr writes;
  std::vector<std::string> names;
  bool isKnown = !evaluation.isNested;
  if (isCall && isKnown && !isKept(expr)) {
    std::optional<std::vector<std::string>> found = table.writes(expr);
    isKnown = found.has_value();
    if (found)
      names = std::move(*found);
  }
  for (typed::StateVariable variable : evaluation.states)
    names.emplace_back(typed::name(variable));
  if (isKnown)
    writes = emitter.getStrArrayAttr(std::vector<llvm::StringRef>(names.begin(), names.end()));
  llvm::SmallVector<mlir::Type, 1> types;
  if (!into && evaluation.hasResult && !expr.type->is(TypeKind::Void))
    types.push_back(module.type(expr.type));
  auto op = emitter.make<ir::EvaluateOp>(types, number, evaluation.operands, writes);
  if (into) // `into` is written as a whole
    ir::attr::into.set(op);
  if (!evaluation.changed.empty())
    ir::attr::changes.set(op, emitter.getDenseI32ArrayAttr(evaluation.changed));
  const bool isPrint = expr.kind == ExprKind::Builtin &&
                       has(cast<typed::BuiltinExpr>(expr).builtin, typed::effect::Prints);
  bool raises = false;
  forEachExpr(expr, [&](const typed::Expr &inner) { raises |= mayRaise(inner); });
  if (evaluation.isNested)
    ir::attr::nested.set(op);
  else if (!isPrint && !raises && !outputOf(expr) &&
           (!isCall || isKept(expr))) // it accesses nothing but these variables
    ir::attr::plain.set(op);
  for (const auto &[lvalue, copy] : evaluation.outputs)
    store(loadFrom(copy, lvalue.type), lvalue);
  return Parts(op.getResults().begin(), op.getResults().end());
}

//===----------------------------------------------------------------------===//
// Nested effects
//===----------------------------------------------------------------------===//

/// Does the expression run without a trace in it?
static bool isBetweenRays(const typed::Expr &expr, const typed::Class *concrete) {
  bool found = true;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (auto *builtin = dynCast<typed::BuiltinExpr>(&inner))
      found = found &&
              (typed::isPure(builtin->builtin) || outputsOf(builtin->builtin).second != 0 ||
               has(builtin->builtin, typed::effect::Prints) ||
               has(builtin->builtin, typed::effect::Random) || typed::isAtomic(builtin->builtin));
    else
      found = found && !typed::mayTrace(inner, concrete);
  });
  return found;
}

/// One subexpression changes what another one uses: the expression is kept as it is, with its
/// nested effects, and the C++ printer orders them. Numbers and vectors that it writes become
/// variables during the operation.
std::optional<Parts> FunctionLowering::lowerNested(const typed::Expr &expr, bool hasResult,
                                                   Value into) {
  if (!module.options.source || !isBetweenRays(expr, key.concrete))
    return std::nullopt;
  if (hasResult && !into && livesInMemory(expr.type)) {
    const Value address = temporary("value", expr.type);
    lowerNested(expr, hasResult, address);
    return loadFrom(address, expr.type);
  }
  Evaluation evaluation(into);
  evaluation.isNested = true;
  evaluation.hasResult = hasResult;
  const std::set<const typed::Variable *> assigned = assignedVariables(expr);
  forEachExpr(expr, [&](const typed::Expr &inner) {
    auto *named = dynCast<typed::VariableExpr>(&inner);
    if (!named || !isLocal(inner) || !assigned.count(named->variable) ||
        evaluation.addresses.count(named->variable))
      return;
    const Lvalue lvalue = lowerLvalue(inner);
    evaluation.addresses[named->variable] = lvalue.address;
    if (livesInMemory(inner.type))
      return;
    const Value copy = variableOf(named->variable->name, inner.type);
    storeTo(load(lvalue), copy, inner.type);
    evaluation.addresses[named->variable] = copy;
    evaluation.outputs.push_back({lvalue, copy});
  });
  gather(expr, evaluation, true);
  return makeEvaluation(expr, evaluation, into);
}

void FunctionLowering::lowerDiscarded(const typed::Expr &expr) {
  if (module.options.source) {
    if (auto *comma = dynCast<typed::CommaExpr>(&expr)) {
      lowerDiscarded(*comma->left);
      return lowerDiscarded(*comma->right);
    }
    auto *assign = dynCast<typed::AssignExpr>(&expr);
    auto *step = dynCast<typed::IncDecExpr>(&expr);
    const typed::Expr *target = assign ? assign->target.get() : step ? step->target.get() : nullptr;
    if (target && staysWhole(*target) && lowerEvaluation(expr))
      return;
    if (livesInMemory(expr.type) && !target)
      return lowerInto(expr, temporary("value", expr.type));
  }
  lower(expr);
}

/// Some subexpression traces, or is not to be kept whole: each is evaluated in its turn.
std::optional<Parts> FunctionLowering::lowerOneByOne(const typed::Expr &expr, Value into) {
  std::vector<const typed::Expr *> parts;
  auto all = [&](const std::vector<typed::ExprPtr> &args) {
    for (const typed::ExprPtr &arg : args)
      parts.push_back(arg.get());
  };
  if (auto *binary = dynCast<typed::BinaryExpr>(&expr))
    parts = {binary->left.get(), binary->right.get()};
  else if (auto *unary = dynCast<typed::UnaryExpr>(&expr))
    parts = {unary->operand.get()};
  else if (auto *convert = dynCast<typed::ConvertExpr>(&expr))
    parts = {convert->operand.get()};
  else if (auto *construct = dynCast<typed::ConstructExpr>(&expr))
    all(construct->args);
  else if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr);
           builtin && typed::isPure(builtin->builtin))
    all(builtin->args);
  else if (auto *call = dynCast<typed::CallExpr>(&expr); call && isKept(expr))
    all(call->args);
  if (parts.empty())
    return std::nullopt;
  Evaluation evaluation(into);
  bool staysInMemory = into != nullptr;
  for (const typed::Expr *part : parts) {
    evaluation.leaves.push_back(part);
    if (!livesInMemory(part->type)) {
      evaluation.operands.push_back(value(*part));
      continue;
    }
    staysInMemory = true;
    evaluation.operands.push_back(temporary("value", part->type));
    lowerInto(*part, evaluation.operands.back());
  }
  if (staysInMemory)
    return makeEvaluation(expr, evaluation, into);
  emitter.setLoc(module.location(expr.range));
  return Parts{wholeExpression(SourceTable::Kind::Value, expr, parts, evaluation.operands,
                               module.type(expr.type))};
}

} // namespace rtsl::lowering
