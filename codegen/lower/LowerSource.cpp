//===- LowerSource.cpp - expressions that are kept whole ------------------===//
//
// For C++ output (SourceTable.h). An expression becomes one operation. Its operands are the parts
// whose values may change: variables, the ray's state, and subexpressions that have effects, which
// are lowered first, from left to right. Members and constants are not operands.
//
//===----------------------------------------------------------------------===//
#include "codegen/lower/Lowering.h"
#include "language/Costs.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Casting.h"

#include <algorithm>

namespace rtsl::lowering {

using typed::ExprKind;

static bool hasNoOutputs(const typed::Function &function) {
  return std::all_of(function.parameters.begin(), function.parameters.end(),
                     [](const auto &p) { return p->direction == ast::Direction::In; });
}

/// Does the operation itself end the sample where an index is out of range?
bool FunctionLowering::mayRaise(const typed::Expr &expr) const {
  auto *index = dynCast<typed::IndexExpr>(&expr);
  return index && module.options.raisesExceptions && typed::mayBeOutOfRange(*index);
}

/// May the operation itself, regardless of its operands, be kept in a whole expression?
bool FunctionLowering::isKept(const typed::Expr &expr) const {
  switch (expr.kind) {
  case ExprKind::Assign:
  case ExprKind::IncDec:
  case ExprKind::MethodCall:
  case ExprKind::Comma:
  case ExprKind::String:
    return false;
  case ExprKind::Field:
  case ExprKind::Swizzle:
    return !isInOutputBuffer(expr); // whose elements change
  case ExprKind::Index:
    return !isInOutputBuffer(expr) && !mayRaise(expr);
  case ExprKind::Builtin:
    return typed::isPure(cast<typed::BuiltinExpr>(expr).builtin);
  case ExprKind::Call: {
    const typed::Function &callee = *cast<typed::CallExpr>(expr).function;
    return hasNoOutputs(callee) && module.options.source->isPure(callee);
  }
  case ExprKind::Conditional:
  case ExprKind::Binary: {
    // Conditional subexpressions cannot be lowered before.
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

/// Estimated number of instructions of the expression.
static unsigned costOf(const typed::Expr &expr, const std::vector<const typed::Expr *> &leaves) {
  unsigned total = 0;
  forEachExpr(expr, [&](const typed::Expr &inner) {
    if (std::find(leaves.begin(), leaves.end(), &inner) != leaves.end())
      return;
    const unsigned width =
        livesInMemory(inner.type) || inner.type->is(TypeKind::Void) ||
                inner.type->is(TypeKind::Class)
            ? 1u
            : std::max(1u, inner.type->is(TypeKind::Color) ? 3u : inner.type->componentCount());
    switch (inner.kind) {
    case ExprKind::Member:
      total += cost::memberLoad * width;
      break;
    case ExprKind::Unary:
    case ExprKind::Binary:
    case ExprKind::Conditional:
    case ExprKind::Convert:
      total += cost::arithmetic * width;
      break;
    case ExprKind::Index:
      total += cost::elementAddress + cost::load;
      break;
    case ExprKind::Builtin:
      total += info(cast<typed::BuiltinExpr>(inner).builtin).cost * width;
      break;
    case ExprKind::Call:
      total += cost::functionCall;
      break;
    default:
      break;
    }
  });
  return total;
}

Value FunctionLowering::wholeExpression(SourceTable::Kind kind, const typed::Expr &expr,
                                        std::vector<const typed::Expr *> leaves,
                                        llvm::ArrayRef<Value> operands, mlir::Type type) {
  SourceTable &table = *module.options.source;
  const auto number = static_cast<std::uint32_t>(table.entries.size());
  const unsigned cost = kind == SourceTable::Kind::Value         ? costOf(expr, leaves)
                        : kind == SourceTable::Kind::AngleCosine ? cost::functionCall
                                                                 : cost::sizeQuery;
  table.entries.push_back({kind, &expr, std::move(leaves)});
  return emitter.make<ir::ExpressionOp>(type, number, cost, operands);
}

//===----------------------------------------------------------------------===//
// Choice of lowering
//===----------------------------------------------------------------------===//

std::optional<Parts> FunctionLowering::lowerWhole(const typed::Expr &expr) {
  const bool isCall = expr.kind == ExprKind::Call || expr.kind == ExprKind::MethodCall;
  if (livesInMemory(expr.type) || expr.kind == ExprKind::String)
    return std::nullopt;
  auto *builtin = dynCast<typed::BuiltinExpr>(&expr);
  if (builtin && has(builtin->builtin, typed::effect::Prints) && !module.options.prints)
    return Parts();
  if ((isCall && !isKept(expr)) || isInOutputBuffer(expr) || mayRaise(expr) ||
      (builtin && (outputsOf(builtin->builtin).second != 0 || typed::isAtomic(builtin->builtin) ||
                   has(builtin->builtin, typed::effect::Prints))))
    return lowerEvaluation(expr);
  if (expr.type->is(TypeKind::Void) ||
      (expr.kind == ExprKind::Literal && expr.type->is(TypeKind::Bool)))
    return std::nullopt;
  std::vector<const typed::Expr *> leaves;
  const bool isOfNumbers = collectLeaves(expr, leaves);
  const bool isLeaf = leaves.size() == 1 && leaves.front() == &expr;
  if (!isOfNumbers || isLeaf) {
    if (!isKept(expr) || expr.kind == ExprKind::Variable || (isLeaf && !mentionsMemory(expr)))
      return std::nullopt;
    std::optional<Parts> read = lowerEvaluation(expr);
    return read ? read : lowerOneByOne(expr);
  }
  if (std::any_of(leaves.begin(), leaves.end(), [&](const auto *leaf) {
        return (leaf->kind == ExprKind::Field || leaf->kind == ExprKind::Index) &&
               mentionsMemory(*leaf);
      })) {
    std::optional<Parts> read = lowerEvaluation(expr);
    return read ? read : lowerOneByOne(expr);
  }
  llvm::SmallVector<Value, 8> operands;
  for (const typed::Expr *leaf : leaves)
    operands.push_back(value(*leaf));
  emitter.setLoc(module.location(expr.range));
  return Parts{
      wholeExpression(SourceTable::Kind::Value, expr, leaves, operands, module.type(expr.type))};
}

} // namespace rtsl::lowering
