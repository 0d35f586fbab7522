//===- LowerLvalues.cpp - lvalues: their addresses, loads and stores ------===//
#include "codegen/lower/Lowering.h"
#include "language/formulas/Common.h"
#include "sema/typed/Analysis.h"

#include "runtime/device/ray/Status.h"
#include "sema/fold/ConstantFold.h"
#include "sema/typed/Casting.h"

namespace rtsl::lowering {

using typed::ExprKind;

Value FunctionLowering::temporary(llvm::StringRef name, const Type *type) {
  return variableOf(name, type);
}

Parts FunctionLowering::loadFrom(Value address, const Type *type) {
  if (isAggregate(type))
    return {address};
  if (!type->isMatrix())
    return {emitter.load(address)};
  Parts columns;
  for (unsigned i = 0; i < type->columns(); ++i)
    columns.push_back(emitter.load(emitter.element(address, i)));
  return columns;
}

void FunctionLowering::storeTo(const Parts &parts, Value address, const Type *type) {
  if (isAggregate(type))
    emitter.copy(parts.front(), address);
  else if (!type->isMatrix())
    emitter.store(parts.front(), address);
  else
    for (unsigned i = 0; i < type->columns(); ++i)
      emitter.store(parts[i], emitter.element(address, i));
}

//===----------------------------------------------------------------------===//
// Addresses of lvalues
//===----------------------------------------------------------------------===//

Lvalue FunctionLowering::lowerLvalue(const typed::Expr &expr) {
  Lvalue result;
  result.type = expr.type;
  switch (expr.kind) {
  case ExprKind::Variable: {
    auto binding = variables.find(cast<typed::VariableExpr>(expr).variable);
    if (binding != variables.end() && binding->second.address) {
      result.address = binding->second.address;
      return result;
    }
    break; // a constant, or a parameter that is a value
  }
  case ExprKind::State: {
    const char *name = typed::name(cast<typed::StateExpr>(expr).variable);
    result.address = emitter.make<ir::StateOp>(name, module.type(expr.type));
    return result;
  }
  case ExprKind::Member: {
    const typed::Member &member = *cast<typed::MemberExpr>(expr).member;
    if (member.isConst)
      break;
    if (member.access != ast::Access::Scratch)
      result.address = emitter.make<ir::MemberOp>(module.pointer(member.type), self(), member.name);
    else if (auto variable = scratch.find(&member); variable != scratch.end())
      result.address = variable->second;
    else if (member.changeOf)
      result.address = emitter.make<ir::AttributeOp>(member.changeOf->name,
                                                     module.type(member.type), member.axis);
    else
      result.address = emitter.make<ir::AttributeOp>(member.name, module.type(member.type));
    return result;
  }
  case ExprKind::Field: {
    const auto &field = cast<typed::FieldExpr>(expr);
    Lvalue base = lowerLvalue(*field.base);
    result.guard = base.guard;
    result.address =
        emitter.field(base.address, field.base->type->structure->fields[field.field].name);
    return result;
  }
  case ExprKind::Swizzle: {
    const auto &swizzle = cast<typed::SwizzleExpr>(expr);
    Lvalue base = lowerLvalue(*swizzle.base);
    if (typed::isWholeVector(swizzle))
      return base;
    result.address = base.address;
    result.guard = base.guard;
    result.isPartOfVector = true;
    for (std::uint8_t component : swizzle.components)
      result.components.push_back(base.isPartOfVector ? base.components[component] : component);
    return result;
  }
  case ExprKind::Index:
    return indexLvalue(cast<typed::IndexExpr>(expr));
  default:
    break;
  }
  // Not an lvalue: store the value in a temporary.
  Parts parts = lower(expr);
  if (isAggregate(expr.type)) {
    result.address = parts.front();
  } else {
    result.address = temporary("value", expr.type);
    storeTo(parts, result.address, expr.type);
  }
  return result;
}

static std::optional<std::int64_t> constantIndex(const typed::Expr &index, std::uint32_t count) {
  std::optional<std::int64_t> value = evaluateInteger(index);
  return value && *value >= 0 && *value < count ? value : std::nullopt;
}

Lvalue FunctionLowering::indexLvalue(const typed::IndexExpr &expr) {
  const Type *type = expr.base->type;
  if (type->is(TypeKind::Buffer))
    return bufferLvalue(expr);
  Lvalue base = lowerLvalue(*expr.base);
  Lvalue result;
  result.type = expr.type;
  result.guard = base.guard;
  std::optional<std::int64_t> constant = constantIndex(*expr.index, type->count);
  if (!type->isVector()) {
    result.address = constant ? emitter.element(base.address, static_cast<unsigned>(*constant))
                              : emitter.element(base.address, clampedIndex(expr));
    return result;
  }
  result.address = base.address;
  result.isPartOfVector = true;
  if (constant) {
    auto component = static_cast<unsigned>(*constant);
    result.components = {base.isPartOfVector ? base.components[component] : component};
    return result;
  }
  result.component = clampedIndex(expr);
  if (base.isPartOfVector) {
    // `v.zx[i]`: the component that the swizzle names.
    Num index = num(result.component), component = index.like(base.components.back());
    for (unsigned i = static_cast<unsigned>(base.components.size()) - 1; i-- > 0;)
      component = select(equal(index, i), base.components[i], component);
    result.component = component;
  }
  return result;
}

// All indices of `buffer[i][j]`. An element of an empty buffer does not exist: it reads as zero,
// and stores to it do nothing.
Lvalue FunctionLowering::bufferLvalue(const typed::IndexExpr &expr) {
  const auto [base, indices] = typed::bufferAccess(expr);
  Lvalue buffer = lowerLvalue(*base);
  Lvalue result;
  result.type = expr.type;
  result.guard = buffer.guard;
  if (indices.size() != base->type->count) {
    // Rows cannot be used as values: `rows[i];` only has the side effects of `i`.
    for (const typed::Expr *index : indices)
      (void)value(*index);
    result.address = temporary("row", expr.type);
    return result;
  }
  llvm::SmallVector<Value, 3> values;
  for (unsigned i = 0; i < indices.size(); ++i) {
    if (!module.options.checkIndices) {
      values.push_back(value(*indices[i]));
      continue;
    }
    Num length = num(emitter.make<ir::BufferLengthOp>(emitter.getI32Type(), buffer.address, i));
    values.push_back(clampedIndex(*indices[i], length));
    Num exists = less(0.0, length);
    result.guard = result.guard ? num(result.guard) & exists : exists;
  }
  result.address = emitter.make<ir::BufferElementOp>(buffer.address, values);
  return result;
}

Value FunctionLowering::clampedIndex(const typed::IndexExpr &expr) {
  if (module.options.source && mayRaise(expr))
    return checkedIndex(expr);
  return clampedIndex(*expr.index, emitter.intConstant(expr.base->type->count));
}

// The count is never negative. If it is 0 the index is 0, or 2^32 - 1 unsigned, but guarded.
Value FunctionLowering::clampedIndex(const typed::Expr &index, Value count) {
  Num result = number(index);
  if (!module.options.checkIndices)
    return result;
  if (module.options.raisesExceptions)
    emitter.ifThen(num(emitter.fold<mlir::arith::CmpIOp>(mlir::arith::CmpIPredicate::uge,
                                                         Value(result), count)),
                   [&] { emitter.make<ir::RaiseOp>(RTSL_EXCEPTION_INDEX); });
  Num last = num(count) - 1.0;
  if (index.type->is(TypeKind::UInt))
    return formulas::minimum(result, last, formulas::IntegerSign::Unsigned);
  return formulas::maximum(formulas::minimum(result, last), result.like(0));
}

//===----------------------------------------------------------------------===//
// Reading and writing
//===----------------------------------------------------------------------===//

Parts FunctionLowering::load(const Lvalue &lvalue) {
  if (lvalue.guard) {
    // Reads zero if the element does not exist.
    Lvalue unguarded = lvalue;
    unguarded.guard = nullptr;
    Value result = temporary("element", lvalue.type);
    emitter.ifThen(lvalue.guard, [&] { storeTo(load(unguarded), result, lvalue.type); });
    return loadFrom(result, lvalue.type);
  }
  if (!lvalue.isPartOfVector)
    return loadFrom(lvalue.address, lvalue.type);
  Value vector = emitter.load(lvalue.address);
  if (lvalue.component)
    return {emitter.extract(vector, lvalue.component)};
  if (lvalue.components.size() == 1)
    return {emitter.extract(vector, lvalue.components.front())};
  llvm::SmallVector<std::int64_t, 4> components(lvalue.components.begin(), lvalue.components.end());
  return {emitter.shuffle(vector, components)};
}

void FunctionLowering::store(const Parts &parts, const Lvalue &lvalue) {
  if (lvalue.guard) {
    Lvalue unguarded = lvalue;
    unguarded.guard = nullptr;
    emitter.ifThen(lvalue.guard, [&] { store(parts, unguarded); });
    return;
  }
  if (!lvalue.isPartOfVector)
    return storeTo(parts, lvalue.address, lvalue.type);
  Value vector = emitter.load(lvalue.address);
  if (lvalue.component)
    vector = emitter.insert(vector, parts.front(), lvalue.component);
  else if (lvalue.components.size() == 1)
    vector = emitter.insert(vector, parts.front(), lvalue.components.front());
  else
    for (unsigned i = 0; i < lvalue.components.size(); ++i)
      vector = emitter.insert(vector, emitter.extract(parts.front(), i), lvalue.components[i]);
  emitter.store(vector, lvalue.address);
}

} // namespace rtsl::lowering
