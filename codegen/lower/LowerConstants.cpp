//===- LowerConstants.cpp - constants, and tables of their words ----------===//
#include "codegen/formulas/Color.h"
#include "codegen/lower/Lowering.h"

#include "sema/fold/ConstantFold.h"
#include "sema/typed/Casting.h"
#include "sema/typed/TypeProperties.h"
#include "sema/typed/Walk.h"

#include "mlir/IR/Matchers.h"

namespace rtsl::lowering {

using typed::ExprKind;

/// The words of a constant of this type; `next` is the first scalar of it.
static void wordsOf(const Type *type, const typed::Constant::Scalar *&next,
                    llvm::SmallVectorImpl<std::int32_t> &words) {
  if (type->is(TypeKind::Struct))
    for (const typed::Field &field : type->structure->fields)
      wordsOf(field.type, next, words);
  else if (type->is(TypeKind::Array))
    for (unsigned i = 0; i < type->count; ++i)
      wordsOf(type->element, next, words);
  else
    for (unsigned i = 0; i < type->componentCount(); ++i, ++next)
      words.push_back(type->scalar()->is(TypeKind::Bool) ? next->b : next->i);
}

Parts FunctionLowering::lowerLiteral(const Type *type, const typed::Constant &constant,
                                     llvm::StringRef name) {
  auto scalar = [&](const Type *scalarType, typed::Constant::Scalar value) -> Value {
    switch (scalarType->kind) {
    case TypeKind::Float:
      return emitter.floatConstant(value.f);
    case TypeKind::Bool:
      return emitter.boolConstant(value.b);
    default:
      return emitter.intConstant(value.i);
    }
  };
  if (type->is(TypeKind::Color)) {
    auto part = [&](std::size_t i) { return num(emitter.floatConstant(constant.scalars[i].f)); };
    return {constant.scalars.size() == 1
                ? colorOfGrey(part(0), colorComponents())
                : colorOfRgb(part(0), part(1), part(2), colorComponents())};
  }
  if (type->isScalar())
    return {scalar(type, constant.scalars.front())};
  if (type->isVector()) {
    llvm::SmallVector<Value, 4> components;
    for (typed::Constant::Scalar value : constant.scalars)
      components.push_back(scalar(type->element, value));
    return {emitter.vector(components)};
  }
  if (type->isMatrix()) {
    Parts columns;
    for (unsigned i = 0; i < type->columns(); ++i) {
      typed::Constant column;
      const auto first = constant.scalars.begin() + i * type->rows();
      column.scalars.assign(first, first + type->rows());
      columns.append(lowerLiteral(type->element, column));
    }
    return columns;
  }
  llvm::SmallVector<std::int32_t> words;
  const typed::Constant::Scalar *next = constant.scalars.data();
  wordsOf(type, next, words);
  return {table(name, type, words)};
}

// Inserted after what was made there before, which it may use. `make` may insert further values,
// which then come before it, because it is recorded only when it is complete.
Value FunctionLowering::atStart(llvm::function_ref<Value()> make) {
  mlir::OpBuilder::InsertionGuard guard(emitter);
  if (lastAtStart)
    emitter.setInsertionPointAfter(lastAtStart);
  else
    emitter.setInsertionPointToStart(&function.getBody().front());
  Value made = make();
  lastAtStart = &*std::prev(emitter.getInsertionPoint());
  return made;
}

// Made once, at the start of the function.
Value FunctionLowering::table(llvm::StringRef name, const Type *type,
                              llvm::ArrayRef<std::int32_t> words) {
  const mlir::Type pointer = module.pointer(type);
  Value &known = tables[{pointer, emitter.getDenseI32ArrayAttr(words)}];
  return known ? known
               : known = atStart([&] { return emitter.make<ir::TableOp>(pointer, name, words); });
}

/// The bits of a constant, one word for each scalar; false if `value` is not a constant.
static bool wordsOf(Value value, llvm::SmallVectorImpl<std::int32_t> &words) {
  auto append = [&](mlir::Attribute scalar) {
    const auto number = llvm::dyn_cast<mlir::FloatAttr>(scalar);
    const llvm::APInt bits = number ? number.getValue().bitcastToAPInt()
                                    : llvm::cast<mlir::IntegerAttr>(scalar).getValue();
    words.push_back(static_cast<std::int32_t>(bits.getZExtValue()));
  };
  mlir::Attribute constant;
  if (!mlir::matchPattern(value, mlir::m_Constant(&constant)))
    return false;
  if (auto elements = llvm::dyn_cast<mlir::DenseElementsAttr>(constant))
    llvm::for_each(elements.getValues<mlir::Attribute>(), append);
  else if (llvm::isa<mlir::FloatAttr, mlir::IntegerAttr>(constant))
    append(constant);
  else
    return false;
  return true;
}

bool FunctionLowering::appendWords(const typed::Expr &expr,
                                   llvm::SmallVectorImpl<std::int32_t> &words) {
  // For C++ output, a matrix that turns out not to be constant must leave no operations behind.
  const bool isPrinted = module.options.source && expr.type->isMatrix();
  if (!isAggregate(expr.type) && !isPrinted)
    return llvm::all_of(lower(expr), [&](Value part) { return wordsOf(part, words); });
  if (auto *construct = dynCast<typed::ConstructExpr>(&expr); construct && !isPrinted)
    return llvm::all_of(construct->args,
                        [&](const typed::ExprPtr &arg) { return appendWords(*arg, words); });
  if (isComputedWhenRun(expr))
    return false;
  const std::optional<typed::Constant> constant = evaluate(expr);
  if (!constant)
    return false;
  const typed::Constant::Scalar *next = constant->scalars.data();
  wordsOf(expr.type, next, words);
  return true;
}

bool FunctionLowering::isComputedWhenRun(const typed::Expr &constant) {
  if (!module.options.hidesConstants)
    return false;
  if (auto *literal = dynCast<typed::LiteralExpr>(&constant)) {
    const typed::Expr *init = literal->variable ? literal->variable->init.get()
                              : literal->member ? literal->member->init.get()
                                                : nullptr;
    return init && isComputedWhenRun(*init);
  }
  auto [known, isNew] = computedWhenRun.try_emplace(&constant, false);
  if (!isNew)
    return known->second;
  bool isComputed = false;
  forEachExpr(constant, [&](const typed::Expr &expr) {
    if (expr.kind == ExprKind::Literal)
      isComputed = isComputed || isComputedWhenRun(expr);
    else
      isComputed = isComputed || contains(expr.type, TypeKind::Float) ||
                   contains(expr.type, TypeKind::Color);
  });
  return computedWhenRun[&constant] = isComputed;
}

Parts FunctionLowering::computedOnce(const void *constant, const typed::Expr &value) {
  if (auto known = computedConstants.find(constant); known != computedConstants.end())
    return known->second;
  Parts parts;
  atStart([&] {
    parts = lower(value);
    return parts.front();
  });
  return computedConstants[constant] = parts;
}

Value FunctionLowering::tableOf(const typed::Expr &expr, llvm::StringRef name) {
  llvm::SmallVector<std::int32_t> words;
  const typed::Expr *obstacle = nullptr;
  if (!isAggregate(expr.type) || !isConstantExpression(expr, &obstacle) ||
      !appendWords(expr, words))
    return nullptr;
  return table(name, expr.type, words);
}

} // namespace rtsl::lowering
