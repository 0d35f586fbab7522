//===- LowerPlaces.cpp - places in memory: what can be read and assigned --===//
#include "codegen/lower/Lowering.h"
#include "language/formulas/Common.h"
#include "sema/typed/Analysis.h"

#include "runtime/device/ray/Abi.h"
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
// Finding places
//===----------------------------------------------------------------------===//

Place FunctionLowering::place(const typed::Expr &expr) {
  Place result;
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
    else
      result.address = emitter.make<ir::AttributeOp>(member.name, module.type(member.type));
    return result;
  }
  case ExprKind::Field: {
    const auto &field = cast<typed::FieldExpr>(expr);
    Place base = place(*field.base);
    result.guard = base.guard;
    result.address =
        emitter.field(base.address, field.base->type->structure->fields[field.field].name);
    return result;
  }
  case ExprKind::Swizzle: {
    const auto &swizzle = cast<typed::SwizzleExpr>(expr);
    Place base = place(*swizzle.base);
    result.address = base.address;
    result.guard = base.guard;
    result.isPartOfVector = true;
    for (std::uint8_t component : swizzle.components)
      result.components.push_back(base.isPartOfVector ? base.components[component] : component);
    return result;
  }
  case ExprKind::Index:
    return indexPlace(cast<typed::IndexExpr>(expr));
  default:
    break;
  }
  // A value: give it a place of its own.
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

Place FunctionLowering::indexPlace(const typed::IndexExpr &expr) {
  const Type *type = expr.base->type;
  if (type->is(TypeKind::Buffer))
    return bufferPlace(expr);
  Place base = place(*expr.base);
  Place result;
  result.type = expr.type;
  result.guard = base.guard;
  std::optional<std::int64_t> constant = constantIndex(*expr.index, type->count);
  if (!type->isVector()) {
    result.address = constant
                         ? emitter.element(base.address, static_cast<unsigned>(*constant))
                         : emitter.element(base.address, clampedIndex(*expr.index, type->count));
    return result;
  }
  result.address = base.address;
  result.isPartOfVector = true;
  if (constant) {
    auto component = static_cast<unsigned>(*constant);
    result.components = {base.isPartOfVector ? base.components[component] : component};
    return result;
  }
  result.component = clampedIndex(*expr.index, type->count);
  if (base.isPartOfVector) {
    // `v.zx[i]`: the component that the swizzle names.
    Num index = num(result.component), component = index.like(base.components.back());
    for (unsigned i = static_cast<unsigned>(base.components.size()) - 1; i-- > 0;)
      component = select(equal(index, i), base.components[i], component);
    result.component = component;
  }
  return result;
}

// All indices of `buffer[i][j]`. An element of an empty buffer does not exist: it reads as zero and
// takes no store.
Place FunctionLowering::bufferPlace(const typed::IndexExpr &expr) {
  llvm::SmallVector<const typed::Expr *, 3> indices;
  const typed::Expr *base = &expr;
  while (auto *index = dynCast<typed::IndexExpr>(base)) {
    if (!index->base->type->is(TypeKind::Buffer))
      break;
    indices.insert(indices.begin(), index->index.get());
    base = index->base.get();
  }
  Place buffer = place(*base);
  Place result;
  result.type = expr.type;
  result.guard = buffer.guard;
  if (indices.size() != base->type->count) {
    // Rows have no values that anything could be done with: `rows[i];` does what `i` does.
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

Value FunctionLowering::clampedIndex(const typed::Expr &index, std::uint32_t count) {
  return clampedIndex(index, emitter.intConstant(count));
}

// A negative count cannot be; of 0 the index is 0, or 2^32 - 1 unsigned, behind a guard.
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

Parts FunctionLowering::load(const Place &place) {
  if (place.guard) {
    // Reads zero where there is nothing.
    Place unguarded = place;
    unguarded.guard = nullptr;
    Value result = temporary("element", place.type);
    emitter.ifThen(place.guard, [&] { storeTo(load(unguarded), result, place.type); });
    return loadFrom(result, place.type);
  }
  if (!place.isPartOfVector)
    return loadFrom(place.address, place.type);
  Value vector = emitter.load(place.address);
  if (place.component)
    return {emitter.extract(vector, place.component)};
  if (place.components.size() == 1)
    return {emitter.extract(vector, place.components.front())};
  llvm::SmallVector<std::int64_t, 4> components(place.components.begin(), place.components.end());
  return {emitter.shuffle(vector, components)};
}

void FunctionLowering::store(const Parts &parts, const Place &place) {
  if (place.guard) {
    Place unguarded = place;
    unguarded.guard = nullptr;
    emitter.ifThen(place.guard, [&] { store(parts, unguarded); });
    return;
  }
  if (!place.isPartOfVector)
    return storeTo(parts, place.address, place.type);
  Value vector = emitter.load(place.address);
  if (place.component)
    vector = emitter.insert(vector, parts.front(), place.component);
  else if (place.components.size() == 1)
    vector = emitter.insert(vector, parts.front(), place.components.front());
  else
    for (unsigned i = 0; i < place.components.size(); ++i)
      vector = emitter.insert(vector, emitter.extract(parts.front(), i), place.components[i]);
  emitter.store(vector, place.address);
}

} // namespace rtsl::lowering
