//===- LowerExprs.cpp - expressions ---------------------------------------===//
//
// Operands are evaluated from left to right, and so is an assignment: the lvalue first, then the
// value, then the store.
//
//===----------------------------------------------------------------------===//
#include "codegen/formulas/Color.h"
#include "codegen/ir/Attributes.h"
#include "codegen/lower/Lowering.h"
#include "sema/typed/Analysis.h"

#include "sema/typed/Casting.h"
#include "sema/typed/TypeProperties.h"

namespace rtsl::lowering {

using typed::ExprKind;

Columns FunctionLowering::columns(const Parts &parts) {
  Columns result;
  for (Value part : parts)
    result.push_back(num(part));
  return result;
}

Parts FunctionLowering::parts(const Columns &columns) {
  return Parts(columns.begin(), columns.end());
}

Parts FunctionLowering::zeroOf(const Type *type) {
  if (type->is(TypeKind::Void))
    return {};
  if (isAggregate(type))
    return {temporary("zero", type)};
  if (type->isMatrix())
    return Parts(type->columns(), emitter.zero(module.type(type->element)));
  return {emitter.zero(module.type(type))};
}

Parts FunctionLowering::lower(const typed::Expr &expr) {
  if (module.options.source)
    if (std::optional<Parts> whole = lowerWhole(expr))
      return *whole;
  emitter.setLoc(module.location(expr.range));
  switch (expr.kind) {
  case ExprKind::Literal: {
    const auto &literal = cast<typed::LiteralExpr>(expr);
    if (isComputedWhenRun(expr))
      return literal.variable ? lowerVariable(*literal.variable) : lowerConstant(*literal.member);
    return lowerLiteral(expr.type, literal.value);
  }
  case ExprKind::Variable:
    return lowerVariable(*cast<typed::VariableExpr>(expr).variable);
  case ExprKind::State:
    return load(lowerLvalue(expr));
  case ExprKind::Member: {
    const typed::Member &member = *cast<typed::MemberExpr>(expr).member;
    return member.isConst ? lowerConstant(member) : load(lowerLvalue(expr));
  }
  case ExprKind::Field:
    return load(lowerLvalue(expr));
  case ExprKind::Swizzle: {
    const auto &swizzle = cast<typed::SwizzleExpr>(expr);
    Value vector = value(*swizzle.base);
    if (swizzle.components.size() == 1)
      return {emitter.extract(vector, static_cast<unsigned>(swizzle.components.front()))};
    llvm::SmallVector<std::int64_t, 4> components(swizzle.components.begin(),
                                                  swizzle.components.end());
    return {emitter.shuffle(vector, components)};
  }
  case ExprKind::Index:
    return lowerIndex(cast<typed::IndexExpr>(expr));
  case ExprKind::Length:
    return lowerLength(cast<typed::LengthExpr>(expr));
  case ExprKind::Unary:
    return lowerUnary(cast<typed::UnaryExpr>(expr));
  case ExprKind::IncDec:
    return lowerIncDec(cast<typed::IncDecExpr>(expr));
  case ExprKind::Binary: {
    const auto &op = cast<typed::BinaryExpr>(expr);
    if (op.op == ast::BinaryOp::LogicalAnd || op.op == ast::BinaryOp::LogicalOr)
      return lowerShortCircuit(op);
    Parts left = lower(*op.left);
    if (hasSideEffects(*op.right))
      left = snapshot(left, op.left->type);
    Parts right = lower(*op.right);
    emitter.setLoc(module.location(expr.range));
    return binary(op.op, left, op.left->type, right, op.right->type);
  }
  case ExprKind::Assign:
    return lowerAssign(cast<typed::AssignExpr>(expr));
  case ExprKind::Conditional:
    return lowerConditional(cast<typed::ConditionalExpr>(expr));
  case ExprKind::Comma:
    lowerDiscarded(*cast<typed::CommaExpr>(expr).left);
    return lower(*cast<typed::CommaExpr>(expr).right);
  case ExprKind::Convert: {
    const typed::Expr &operand = *cast<typed::ConvertExpr>(expr).operand;
    return convert(lower(operand), operand.type, expr.type);
  }
  case ExprKind::Construct:
    return lowerConstruct(cast<typed::ConstructExpr>(expr));
  case ExprKind::Builtin:
    return lowerBuiltin(cast<typed::BuiltinExpr>(expr));
  case ExprKind::Call:
    return lowerCall(cast<typed::CallExpr>(expr));
  case ExprKind::MethodCall:
    return lowerMethodCall(cast<typed::MethodCallExpr>(expr));
  case ExprKind::String:
    break; // `print` uses its text itself
  }
  llvm_unreachable("unlisted kind of expression");
}

/// A constant array with more leaves is copied as a whole.
constexpr unsigned mostStores = 64;

void FunctionLowering::lowerInto(const typed::Expr &expr, Value address) {
  emitter.setLoc(module.location(expr.range));
  if (auto *choice = dynCast<typed::ConditionalExpr>(&expr); choice && module.options.source) {
    if (std::optional<Parts> whole = lowerWhole(expr))
      return storeTo(*whole, address, expr.type);
    // Named after the variable that is initialized, not after a temporary.
    Value condition = value(*choice->condition);
    return emitter.ifThen(
        condition, [&] { lowerInto(*choice->whenTrue, address); },
        [&] { lowerInto(*choice->whenFalse, address); });
  }
  if (livesInMemory(expr.type)) {
    if (auto *comma = dynCast<typed::CommaExpr>(&expr)) {
      lowerDiscarded(*comma->left);
      return lowerInto(*comma->right, address);
    }
    if (module.options.source && (lowerEvaluation(expr, address) || lowerOneByOne(expr, address)))
      return;
    if (auto *construct = dynCast<typed::ConstructExpr>(&expr);
        construct && isAggregate(expr.type)) {
      if (ir::leafCount(module.type(expr.type)) > mostStores)
        if (Value constant = tableOf(expr, "constant"))
          return emitter.copy(constant, address);
      return constructInto(*construct, address);
    }
    if (auto *call = dynCast<typed::CallExpr>(&expr)) {
      lowerCall(*call, address);
      return;
    }
  }
  storeTo(lower(expr), address, expr.type);
}

Parts FunctionLowering::snapshot(Parts parts, const Type *type) {
  if (!isAggregate(type) || type->is(TypeKind::Buffer))
    return parts;
  Value copy = temporary("copy", type);
  emitter.copy(parts.front(), copy);
  return {copy};
}

//===----------------------------------------------------------------------===//
// Reading
//===----------------------------------------------------------------------===//

Parts FunctionLowering::lowerConstant(const typed::Member &member) {
  const bool isComputed = isComputedWhenRun(*member.init);
  if (member.constant && !isComputed)
    return lowerLiteral(member.type, *member.constant, member.name);
  if (!isAggregate(member.type) && isComputed)
    return computedOnce(&member, *member.init);
  if (Value constant = tableOf(*member.init, member.name))
    return {constant};
  return lower(*member.init);
}

Parts FunctionLowering::lowerVariable(const typed::Variable &variable) {
  auto known = variables.find(&variable);
  if (known != variables.end())
    return known->second.address ? loadFrom(known->second.address, variable.type)
                                 : known->second.value;
  const bool isComputed = isComputedWhenRun(*variable.init);
  if (variable.constant && !isComputed)
    return lowerLiteral(variable.type, *variable.constant, variable.name);
  if (!isAggregate(variable.type) && isComputed)
    return computedOnce(&variable, *variable.init);
  // A constant of the file whose value depends on the target, such as one with colors.
  if (!isAggregate(variable.type))
    return lower(*variable.init);
  if (auto global = globalAggregates.find(&variable); global != globalAggregates.end())
    return {global->second};
  Value address = tableOf(*variable.init, variable.name);
  if (!address)
    address = atStart([&] {
      Value address = temporary(variable.name, variable.type);
      lowerInto(*variable.init, address);
      return address;
    });
  globalAggregates[&variable] = address;
  return {address};
}

Parts FunctionLowering::lowerIndex(const typed::IndexExpr &expr) {
  const Type *type = expr.base->type;
  if (isLvalue(expr) && !type->isVector())
    return load(lowerLvalue(expr));
  if (type->isVector()) {
    Value vector = value(*expr.base);
    if (auto *literal = dynCast<typed::LiteralExpr>(expr.index);
        literal && literal->value.scalars.front().u < type->count)
      return {emitter.extract(vector, static_cast<unsigned>(literal->value.scalars.front().u))};
    return {emitter.extract(vector, clampedIndex(expr))};
  }
  return load(lowerLvalue(expr));
}

Parts FunctionLowering::lowerLength(const typed::LengthExpr &expr) {
  // `buffer[i].length()` is the length of the second dimension; the value of i does not matter, but
  // its side effects happen.
  unsigned dimension = 0;
  const typed::Expr *base = expr.base.get();
  while (auto *index = dynCast<typed::IndexExpr>(base)) {
    if (!index->base->type->is(TypeKind::Buffer))
      break;
    if (hasSideEffects(*index->index))
      lower(*index->index);
    base = index->base.get();
    ++dimension;
  }
  if (!base->type->is(TypeKind::Buffer)) // an array: its length is its type
    return {emitter.intConstant(base->type->count)};
  Lvalue buffer = lowerLvalue(*base);
  return {emitter.make<ir::BufferLengthOp>(emitter.getI32Type(), buffer.address, dimension)};
}

//===----------------------------------------------------------------------===//
// Writing
//===----------------------------------------------------------------------===//

Parts FunctionLowering::lowerIncDec(const typed::IncDecExpr &expr) {
  if (hasSideEffects(*expr.target)) // only once
    if (std::optional<Parts> whole = lowerNested(expr, /*hasResult=*/true))
      return *whole;
  if (module.options.source && staysWhole(*expr.target)) {
    const Parts before = expr.prefix ? Parts() : lower(*expr.target);
    if (lowerEvaluation(expr))
      return expr.prefix ? lower(*expr.target) : before;
  }
  Lvalue target = lowerLvalue(*expr.target);
  Parts before = load(target), after;
  for (Value part : before) {
    Num old = num(part);
    after.push_back(expr.increment ? old + 1.0 : old - 1.0);
  }
  emitter.setLoc(module.location(expr.range));
  if (module.options.source && before.size() == 1)
    after = {wholeExpression(SourceTable::Kind::Step, expr, {expr.target.get()}, before,
                             before.front().getType())};
  store(after, target);
  return expr.prefix ? after : before;
}

Parts FunctionLowering::lowerAssign(const typed::AssignExpr &expr) {
  if (hasSideEffects(*expr.target)) // only once
    if (std::optional<Parts> whole = lowerNested(expr, /*hasResult=*/true))
      return *whole;
  if (module.options.source && staysWhole(*expr.target) && lowerEvaluation(expr))
    return lower(*expr.target);
  Lvalue target = lowerLvalue(*expr.target);
  Parts result;
  if (expr.compound) {
    Parts old = load(target);
    Parts operand = lower(*expr.value);
    emitter.setLoc(module.location(expr.range));
    if (module.options.source && old.size() == 1 && operand.size() == 1)
      result = {wholeExpression(SourceTable::Kind::Compound, expr,
                                {expr.target.get(), expr.value.get()},
                                {old.front(), operand.front()}, old.front().getType())};
    else
      result = binary(expr.op, old, expr.target->type, operand, expr.value->type);
  } else {
    result = lower(*expr.value);
    emitter.setLoc(module.location(expr.range));
  }
  store(result, target);
  if (isAggregate(expr.type) && !target.guard)
    return {target.address};
  return result;
}

//===----------------------------------------------------------------------===//
// Choosing
//===----------------------------------------------------------------------===//

Parts FunctionLowering::lowerConditional(const typed::ConditionalExpr &expr) {
  Value condition = value(*expr.condition);
  if (!livesInMemory(expr.type) && !expr.type->is(TypeKind::Void) && isCheap(*expr.whenTrue) &&
      isCheap(*expr.whenFalse)) {
    Num whenTrue = number(*expr.whenTrue), whenFalse = number(*expr.whenFalse);
    emitter.setLoc(module.location(expr.range));
    return {emitter.fold<mlir::arith::SelectOp>(condition, static_cast<Value>(whenTrue),
                                                static_cast<Value>(whenFalse))};
  }
  if (expr.type->is(TypeKind::Void)) {
    emitter.ifThen(condition, [&] { lower(*expr.whenTrue); }, [&] { lower(*expr.whenFalse); });
    return {};
  }
  emitter.setLoc(module.location(expr.range));
  Value result = temporary("choice", expr.type);
  emitter.ifThen(
      condition, [&] { lowerInto(*expr.whenTrue, result); },
      [&] { lowerInto(*expr.whenFalse, result); });
  return loadFrom(result, expr.type);
}

Parts FunctionLowering::lowerShortCircuit(const typed::BinaryExpr &expr) {
  bool isAnd = expr.op == ast::BinaryOp::LogicalAnd;
  Num left = number(*expr.left);
  if (isCheap(*expr.right)) {
    Num right = number(*expr.right);
    emitter.setLoc(module.location(expr.range));
    return {isAnd ? left & right : left | right};
  }
  emitter.setLoc(module.location(expr.range));
  const bool isRead = module.options.source != nullptr; // then `and` must not be given a name
  Value result = temporary(isRead ? isAnd ? "both" : "either" : isAnd ? "and" : "or", expr.type);
  if (isRead)
    ir::attr::shortCircuit.set(result.getDefiningOp());
  emitter.store(left, result);
  emitter.ifThen(isAnd ? left : !left, [&] { emitter.store(value(*expr.right), result); });
  return {emitter.load(result)};
}

} // namespace rtsl::lowering
