//===- LowerConstruct.cpp - vec3(...), mat4(...), Ray(...), color(...) ----===//
#include "codegen/formulas/Color.h"
#include "codegen/lower/Lowering.h"

namespace rtsl::lowering {

void FunctionLowering::appendScalars(const Parts &parts, const Type *type,
                                     llvm::SmallVectorImpl<Value> &scalars) {
  if (isAggregate(type)) {
    auto append = [&](Value address, const Type *part) {
      appendScalars(loadFrom(address, part), part, scalars);
    };
    if (type->is(TypeKind::Struct))
      for (const typed::Field &field : type->structure->fields)
        append(emitter.field(parts.front(), field.name), field.type);
    else if (type->is(TypeKind::Array))
      for (unsigned i = 0; i < type->count; ++i)
        append(emitter.element(parts.front(), i), type->element);
    return;
  }
  for (Value part : parts) {
    Num number = num(part);
    for (unsigned i = 0; i < number.count(); ++i)
      scalars.push_back(number[i]);
  }
}

Parts FunctionLowering::lowerConstruct(const typed::ConstructExpr &expr) {
  const Type *type = expr.type;
  if (isAggregate(type)) {
    Value address = temporary("value", type);
    constructInto(expr, address);
    return {address};
  }
  if (type->isMatrix())
    return constructMatrix(expr);
  if (type->is(TypeKind::Class))
    return lower(*expr.args.front());

  llvm::SmallVector<Parts, 4> args;
  for (const typed::ExprPtr &arg : expr.args)
    args.push_back(lower(*arg));
  emitter.setLoc(module.location(expr.range));
  if (type->is(TypeKind::Color)) {
    if (expr.args.front()->type->is(TypeKind::Color))
      return args.front();
    if (args.size() == 1)
      return {colorOfGrey(num(args[0].front()), colorComponents())};
    return {colorOfRgb(num(args[0].front()), num(args[1].front()), num(args[2].front()),
                       colorComponents())};
  }

  const Type *first = expr.args.front()->type;
  if (type->isVector() && args.size() == 1 && first->isScalar())
    return {emitter.splat(args.front().front(), type->count)};
  if (type->isVector() && args.size() == 1 && first->isVector()) {
    Value vector = args.front().front();
    if (first->count == type->count)
      return {vector};
    llvm::SmallVector<std::int64_t, 4> components;
    for (unsigned i = 0; i < type->count; ++i)
      components.push_back(i);
    return {emitter.shuffle(vector, components)};
  }
  // Excess components are dropped before the vector is split.
  unsigned needed = type->isVector() ? type->count : 1;
  llvm::SmallVector<Value, 16> scalars;
  for (std::size_t i = 0; i < args.size() && scalars.size() < needed; ++i)
    for (Value part : args[i]) {
      Num number = num(part);
      for (unsigned j = 0; j < number.count() && scalars.size() < needed; ++j)
        scalars.push_back(number[j]);
    }
  if (!type->isVector())
    return {scalars.front()};
  return {emitter.vector(scalars)};
}

// Fields or elements in order, each evaluated into its own memory.
void FunctionLowering::constructInto(const typed::ConstructExpr &expr, Value address) {
  const Type *type = expr.type;
  for (std::size_t i = 0; i < expr.args.size(); ++i) {
    emitter.setLoc(module.location(expr.args[i]->range));
    Value part = type->is(TypeKind::Struct)
                     ? emitter.field(address, type->structure->fields[i].name)
                     : emitter.element(address, static_cast<unsigned>(i));
    lowerInto(*expr.args[i], part);
  }
}

Parts FunctionLowering::constructMatrix(const typed::ConstructExpr &expr) {
  const Type *type = expr.type;
  const unsigned columnCount = type->columns(), rowCount = type->rows();
  const Type *first = expr.args.front()->type;
  Parts result;

  if (expr.args.size() == 1 && (first->isScalar() || first->isMatrix())) {
    Parts source = lower(*expr.args.front());
    emitter.setLoc(module.location(expr.range));
    Value zero = emitter.floatConstant(0), one = emitter.floatConstant(1);
    for (unsigned column = 0; column < columnCount; ++column) {
      llvm::SmallVector<Value, 4> components;
      for (unsigned row = 0; row < rowCount; ++row) {
        if (first->isScalar())
          components.push_back(row == column ? source.front() : zero);
        else if (column < first->columns() && row < first->rows())
          components.push_back(emitter.extract(source[column], row));
        else
          components.push_back(row == column ? one : zero);
      }
      result.push_back(emitter.vector(components));
    }
    return result;
  }

  llvm::SmallVector<Parts, 4> args;
  bool areColumns = expr.args.size() == columnCount;
  for (const typed::ExprPtr &arg : expr.args) {
    areColumns = areColumns && arg->type == type->element;
    args.push_back(lower(*arg));
  }
  emitter.setLoc(module.location(expr.range));
  if (areColumns) {
    for (const Parts &column : args)
      result.push_back(column.front());
    return result;
  }
  llvm::SmallVector<Value, 16> scalars;
  for (std::size_t i = 0; i < args.size(); ++i)
    appendScalars(args[i], expr.args[i]->type, scalars);
  for (unsigned column = 0; column < columnCount; ++column)
    result.push_back(
        emitter.vector(llvm::ArrayRef<Value>(scalars).slice(column * rowCount, rowCount)));
  return result;
}

} // namespace rtsl::lowering
