//===- LowerSource.cpp - expressions that are kept whole ------------------===//
//
// For C++ (SourceTable.h). An expression becomes one operation whose operands are what in it may
// change: variables, the ray's state, and parts that have effects, which are lowered first, from left
// to right. Members and constants stay inside.
//
//===----------------------------------------------------------------------===//
#include "codegen/lower/Analysis.h"
#include "codegen/lower/Lowering.h"

#include "sema/Casting.h"

#include <algorithm>

namespace rtsl::lowering {

using typed::ExprKind;

/// The place that a field, an element or components are part of.
static const typed::Expr &rootOf(const typed::Expr &expr) {
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

/// The same, through components too.
static const typed::Expr &wholeOf(const typed::Expr &place) {
  const typed::Expr *root = &rootOf(place);
  while (auto *swizzle = dynCast<typed::SwizzleExpr>(root))
    root = &rootOf(*swizzle->base);
  return *root;
}

static bool isLocal(const typed::Expr &expr) {
  auto *variable = dynCast<typed::VariableExpr>(&expr);
  return variable && variable->variable->kind != typed::Variable::Kind::Global;
}

static bool hasNoOutputs(const typed::Function &function) {
  return std::all_of(function.parameters.begin(), function.parameters.end(),
                     [](const auto &p) { return p->direction == ast::Direction::In; });
}

/// The arguments that a built-in function writes: the first of them, and how many; none: 0, 0.
static std::pair<std::size_t, std::size_t> outputsOf(typed::Builtin builtin) {
  switch (builtin) {
  case typed::Builtin::Modf:
  case typed::Builtin::Frexp:
    return {1, 1};
  case typed::Builtin::UaddCarry:
  case typed::Builtin::UsubBorrow:
    return {2, 1};
  case typed::Builtin::UmulExtended:
  case typed::Builtin::ImulExtended:
    return {2, 2};
  default:
    return {0, 0};
  }
}

/// Is the operation itself, whatever its operands are, one that may stand in a whole expression?
bool FunctionLowering::isKept(const typed::Expr &expr) const {
  switch (expr.kind) {
  case ExprKind::Assign:
  case ExprKind::IncDec:
  case ExprKind::MethodCall:
  case ExprKind::Comma:
  case ExprKind::String:
    return false;
  case ExprKind::Builtin:
    return isPureBuiltin(cast<typed::BuiltinExpr>(expr).builtin);
  case ExprKind::Call: {
    const typed::Function &callee = *cast<typed::CallExpr>(expr).function;
    return hasNoOutputs(callee) && module.options.source->isPure(callee);
  }
  case ExprKind::Conditional:
  case ExprKind::Binary: {
    // Parts that run only if they are needed cannot run before.
    auto *binary = dynCast<typed::BinaryExpr>(&expr);
    if (binary && binary->op != ast::BinaryOp::LogicalAnd && binary->op != ast::BinaryOp::LogicalOr)
      return true;
    bool isKeptWithin = true;
    forEachExpr(expr, [&](const typed::Expr &inner) {
      auto *innerBinary = dynCast<typed::BinaryExpr>(&inner);
      const bool isChoice = inner.kind == ExprKind::Conditional || innerBinary;
      isKeptWithin = isKeptWithin && (isChoice || isKept(inner));
    });
    return isKeptWithin;
  }
  default:
    return true;
  }
}

bool FunctionLowering::collectLeaves(const typed::Expr &expr,
                                     std::vector<const typed::Expr *> &leaves) const {
  auto leaf = [&] {
    leaves.push_back(&expr);
    return !livesInMemory(expr.type);
  };
  auto all = [&](const std::vector<typed::ExprPtr> &parts) {
    return std::all_of(parts.begin(), parts.end(),
                       [&](const auto &part) { return collectLeaves(*part, leaves); });
  };
  if (!isKept(expr))
    return leaf();
  switch (expr.kind) {
  case ExprKind::Variable:
    return !isLocal(expr) || leaf();
  case ExprKind::State:
    return livesInMemory(expr.type) || leaf(); // matrices of the instance do not change
  case ExprKind::Field:
    if (isLocal(rootOf(expr)))
      return leaf();
    return collectLeaves(*cast<typed::FieldExpr>(expr).base, leaves);
  case ExprKind::Index: {
    const auto &index = cast<typed::IndexExpr>(expr);
    if (!index.base->type->isVector() && isLocal(rootOf(expr)))
      return leaf();
    return collectLeaves(*index.base, leaves) && collectLeaves(*index.index, leaves);
  }
  case ExprKind::Swizzle:
    return collectLeaves(*cast<typed::SwizzleExpr>(expr).base, leaves);
  case ExprKind::Length:
    return collectLeaves(*cast<typed::LengthExpr>(expr).base, leaves);
  case ExprKind::Unary:
    return collectLeaves(*cast<typed::UnaryExpr>(expr).operand, leaves);
  case ExprKind::Convert:
    return collectLeaves(*cast<typed::ConvertExpr>(expr).operand, leaves);
  case ExprKind::Binary:
    return collectLeaves(*cast<typed::BinaryExpr>(expr).left, leaves) &&
           collectLeaves(*cast<typed::BinaryExpr>(expr).right, leaves);
  case ExprKind::Conditional: {
    const auto &choice = cast<typed::ConditionalExpr>(expr);
    return collectLeaves(*choice.condition, leaves) && collectLeaves(*choice.whenTrue, leaves) &&
           collectLeaves(*choice.whenFalse, leaves);
  }
  case ExprKind::Construct:
    return all(cast<typed::ConstructExpr>(expr).args);
  case ExprKind::Builtin:
    return all(cast<typed::BuiltinExpr>(expr).args);
  case ExprKind::Call:
    return all(cast<typed::CallExpr>(expr).args);
  default:
    return true; // literals and members
  }
}

/// About how many instructions the expression takes.
static std::int32_t costOf(const typed::Expr &expr, const std::vector<const typed::Expr *> &leaves) {
  std::int32_t cost = 0;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (std::find(leaves.begin(), leaves.end(), &inner) != leaves.end())
      return;
    const auto width = static_cast<std::int32_t>(
        livesInMemory(inner.type) || inner.type->is(TypeKind::Void) || inner.type->is(TypeKind::Class)
            ? 1u
            : std::max(1u, inner.type->is(TypeKind::Color) ? 3u : inner.type->componentCount()));
    switch (inner.kind) {
    case ExprKind::Member:
      cost += 2 * width;
      break;
    case ExprKind::Unary:
    case ExprKind::Binary:
    case ExprKind::Conditional:
    case ExprKind::Convert:
      cost += width;
      break;
    case ExprKind::Index:
      cost += 8;
      break;
    case ExprKind::Builtin:
      cost += 12 * width;
      break;
    case ExprKind::Call:
      cost += 50;
      break;
    default:
      break;
    }
  });
  return cost;
}

Value FunctionLowering::wholeExpression(SourceTable::Kind kind, const typed::Expr &expr,
                                        std::vector<const typed::Expr *> leaves,
                                        llvm::ArrayRef<Value> operands, mlir::Type type) {
  SourceTable &table = *module.options.source;
  const auto number = static_cast<std::uint32_t>(table.entries.size());
  const std::int32_t cost = kind == SourceTable::Kind::Value         ? costOf(expr, leaves)
                            : kind == SourceTable::Kind::AngleCosine ? 50
                                                                     : 2;
  table.entries.push_back({kind, &expr, std::move(leaves)});
  return emitter.make<ir::ExpressionOp>(type, number, static_cast<std::uint32_t>(cost), operands);
}

//===----------------------------------------------------------------------===//
// Evaluations: on variables where they lie
//===----------------------------------------------------------------------===//

// Structs, arrays and matrices stay whole, and so does what a call writes through its parameters: the operation has their
// addresses. A number or a vector that is written so is a variable of its own for the time, under the same name.

Value FunctionLowering::variableOf(llvm::StringRef name, const Type *type) {
  Value variable = emitter.variable(name, module.type(type));
  if (SourceTable *table = module.options.source) {
    variable.getDefiningOp()->setAttr(
        "rtsl.declared", emitter.getI32IntegerAttr(static_cast<std::int32_t>(table->types.size())));
    table->types.push_back(type);
  }
  return variable;
}

bool FunctionLowering::mentionsMemory(const typed::Expr &expr) {
  bool found = false;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    found = found || (isLocal(inner) && livesInMemory(inner.type)) ||
            (inner.kind == ExprKind::Call && livesInMemory(inner.type));
  });
  return found;
}

/// Is the target part of a variable that stays whole, or a component that is found at run time?
bool FunctionLowering::staysWhole(const typed::Expr &target) {
  const typed::Expr &whole = wholeOf(target);
  if (isLocal(whole) && livesInMemory(whole.type))
    return true;
  auto *index = dynCast<typed::IndexExpr>(&target);
  return index && index->base->type->isVector() && index->index->kind != ExprKind::Literal;
}

/// Finds what the expression itself, not a part of it, writes.
bool FunctionLowering::openPlaces(const typed::Expr &expr, Evaluation &evaluation) {
  std::vector<const typed::Expr *> parts, written;
  bool readsOld = true;
  auto outputs = [&](const typed::Function *callee, const std::vector<typed::ExprPtr> &args) {
    for (std::size_t i = 0; i < args.size(); ++i) {
      parts.push_back(args[i].get());
      if (callee && callee->parameters[i]->direction != ast::Direction::In)
        written.push_back(args[i].get());
    }
  };
  if (auto *assign = dynCast<typed::AssignExpr>(&expr)) {
    parts = {assign->target.get(), assign->value.get()};
    written = {assign->target.get()};
  } else if (auto *step = dynCast<typed::IncDecExpr>(&expr)) {
    parts = written = {step->target.get()};
  } else if (auto *call = dynCast<typed::CallExpr>(&expr)) {
    outputs(call->function, call->args);
  } else if (auto *method = dynCast<typed::MethodCallExpr>(&expr)) {
    parts = {method->receiver.get()};
    outputs(method->function, method->args);
  } else if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr)) {
    outputs(nullptr, builtin->args);
    const auto [first, count] = outputsOf(builtin->builtin);
    for (std::size_t i = first; i < first + count; ++i)
      written.push_back(builtin->args[i].get());
    readsOld = false;
  } else {
    parts = {&expr};
  }

  // Parts with effects run before: they must not change what is looked at in its place.
  std::set<const typed::Variable *> changedBefore;
  for (const typed::Expr *part : parts)
    for (const typed::Variable *variable : assignedVariables(*part))
      changedBefore.insert(variable);
  std::set<const typed::Variable *> looked;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (isLocal(inner) && livesInMemory(inner.type))
      looked.insert(cast<typed::VariableExpr>(inner).variable);
  });
  for (const typed::Expr *place : written) {
    const typed::Expr &whole = wholeOf(*place);
    if (isLocal(whole))
      looked.insert(cast<typed::VariableExpr>(whole).variable);
  }
  if (std::any_of(looked.begin(), looked.end(),
                  [&](const auto *variable) { return changedBefore.count(variable) != 0; }))
    return false;

  for (const typed::Expr *target : written) {
    const typed::Expr &whole = wholeOf(*target);
    if (auto *state = dynCast<typed::StateExpr>(&whole)) {
      evaluation.states.insert(state->variable);
      continue;
    }
    if (!isLocal(whole))
      return false;
    const typed::Variable *variable = cast<typed::VariableExpr>(whole).variable;
    if (evaluation.places.count(variable))
      continue;
    const Place where = place(whole);
    if (livesInMemory(whole.type)) {
      evaluation.places[variable] = where.address;
      continue;
    }
    const Value copy = variableOf(variable->name, whole.type);
    if (readsOld || &whole != target)
      storeTo(load(where), copy, whole.type);
    evaluation.places[variable] = copy;
    evaluation.outputs.push_back({where, copy});
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
  if (!isTop && expr.kind != ExprKind::String && !isKept(expr)) {
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
    if (auto place = evaluation.places.find(variable); place != evaluation.places.end())
      return leaf(place->second, true);
    if (!livesInMemory(expr.type))
      return leaf(value(expr));
    const Value address = place(expr).address;
    if (!address.getDefiningOp() || !llvm::isa<ir::TableOp>(address.getDefiningOp()))
      leaf(address);
    return;
  }
  case ExprKind::State:
    if (!livesInMemory(expr.type) && !evaluation.states.count(cast<typed::StateExpr>(expr).variable))
      leaf(value(expr));
    return;
  default:
    forEachChild(expr, [&](const typed::Expr &part) { gather(part, evaluation, false); });
  }
}

/// One that traces, or whose parts run only sometimes, is taken apart.
static bool isOneStep(const typed::Expr &expr, const SourceTable &table) {
  const typed::Function *callee = nullptr;
  if (auto *call = dynCast<typed::CallExpr>(&expr))
    callee = call->function;
  if (auto *method = dynCast<typed::MethodCallExpr>(&expr))
    callee = method->function;
  if (callee && table.mayTrace(*callee))
    return false;
  if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr))
    return isPureBuiltin(builtin->builtin) || builtin->builtin == typed::Builtin::Print ||
           outputsOf(builtin->builtin).second != 0;
  return expr.kind != ExprKind::Comma && expr.kind != ExprKind::String;
}

std::optional<Parts> FunctionLowering::lowerEvaluation(const typed::Expr &expr, Value into) {
  const bool isWrite = expr.kind == ExprKind::Assign || expr.kind == ExprKind::IncDec;
  if (!isOneStep(expr, *module.options.source) || (into && isWrite))
    return std::nullopt;
  const bool isChoice = expr.kind == ExprKind::Conditional || expr.kind == ExprKind::Binary;
  if (isChoice && !isKept(expr))
    return std::nullopt;
  if (!into && livesInMemory(expr.type) && !isWrite)
    return std::nullopt;
  Evaluation evaluation;
  if (into) {
    evaluation.leaves.push_back(nullptr);
    evaluation.operands.push_back(into);
    evaluation.changed.push_back(0);
  }
  if (!openPlaces(expr, evaluation))
    return std::nullopt;
  gather(expr, evaluation, true);

  emitter.setLoc(module.location(expr.range));
  SourceTable &table = *module.options.source;
  const auto number = static_cast<std::uint32_t>(table.entries.size());
  table.entries.push_back({into ? SourceTable::Kind::Into : SourceTable::Kind::Value, &expr, evaluation.leaves});
  const bool isCall = expr.kind == ExprKind::Call || expr.kind == ExprKind::MethodCall;
  mlir::ArrayAttr writes;
  std::vector<std::string> names;
  bool isKnown = true;
  if (isCall && !isKept(expr)) {
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
  if (!into && !isWrite && !expr.type->is(TypeKind::Void))
    types.push_back(module.type(expr.type));
  auto op = emitter.make<ir::EvaluateOp>(types, number, evaluation.operands, writes);
  if (into) // all of it
    op->setAttr("rtsl.into", emitter.getUnitAttr());
  if (!evaluation.changed.empty())
    op->setAttr("rtsl.changes", emitter.getDenseI32ArrayAttr(evaluation.changed));
  const bool isPrint = expr.kind == ExprKind::Builtin && cast<typed::BuiltinExpr>(expr).builtin == typed::Builtin::Print;
  if (!isPrint && (!isCall || isKept(expr))) // nothing but these variables is touched
    op->setAttr("rtsl.plain", emitter.getUnitAttr());
  for (const auto &[where, copy] : evaluation.outputs)
    store(loadFrom(copy, where.type), where);
  return Parts(op.getResults().begin(), op.getResults().end());
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
  }
  lower(expr);
}

/// Some part changes what another reads: each part is evaluated in its turn.
std::optional<Parts> FunctionLowering::lowerOneByOne(const typed::Expr &expr) {
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
  else if (auto *builtin = dynCast<typed::BuiltinExpr>(&expr))
    all(builtin->args);
  else if (auto *call = dynCast<typed::CallExpr>(&expr))
    all(call->args);
  if (parts.empty() || std::any_of(parts.begin(), parts.end(), [](const auto *part) { return livesInMemory(part->type); }))
    return std::nullopt;
  llvm::SmallVector<Value, 8> operands;
  for (const typed::Expr *part : parts)
    operands.push_back(value(*part));
  emitter.setLoc(module.location(expr.range));
  return Parts{wholeExpression(SourceTable::Kind::Value, expr, parts, operands, module.type(expr.type))};
}

std::optional<Parts> FunctionLowering::lowerWhole(const typed::Expr &expr) {
  const bool isCall = expr.kind == ExprKind::Call || expr.kind == ExprKind::MethodCall;
  if (livesInMemory(expr.type) || expr.kind == ExprKind::String)
    return std::nullopt;
  auto *builtin = dynCast<typed::BuiltinExpr>(&expr);
  if (builtin && builtin->builtin == typed::Builtin::Print && !module.options.prints)
    return Parts();
  if ((isCall && !isKept(expr)) ||
      (builtin && (outputsOf(builtin->builtin).second != 0 || builtin->builtin == typed::Builtin::Print)))
    return lowerEvaluation(expr);
  if (expr.type->is(TypeKind::Void) ||
      (expr.kind == ExprKind::Literal && expr.type->is(TypeKind::Bool)))
    return std::nullopt;
  std::vector<const typed::Expr *> leaves;
  if (!collectLeaves(expr, leaves) || (leaves.size() == 1 && leaves.front() == &expr)) {
    if (!isKept(expr) || expr.kind == ExprKind::Variable || !mentionsMemory(expr))
      return std::nullopt;
    std::optional<Parts> read = lowerEvaluation(expr);
    return read ? read : lowerOneByOne(expr);
  }
  if (std::any_of(leaves.begin(), leaves.end(), [&](const auto *leaf) {
        return (leaf->kind == ExprKind::Field || leaf->kind == ExprKind::Index) && mentionsMemory(*leaf);
      })) {
    std::optional<Parts> read = lowerEvaluation(expr);
    return read ? read : lowerOneByOne(expr);
  }
  llvm::SmallVector<Value, 8> operands;
  for (const typed::Expr *leaf : leaves)
    operands.push_back(value(*leaf));
  emitter.setLoc(module.location(expr.range));
  return Parts{wholeExpression(SourceTable::Kind::Value, expr, leaves, operands,
                               module.type(expr.type))};
}

} // namespace rtsl::lowering
