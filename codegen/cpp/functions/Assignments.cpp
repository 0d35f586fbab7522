#include "codegen/cpp/functions/FunctionPrinter.h"

#include "sema/typed/Casting.h"

#include <algorithm>

namespace rtsl::cpp {

void Assignments::assignComponents(const Code &target, const std::vector<std::uint8_t> &parts,
                                   const Code &from, Statements &out) {
  for (std::size_t i = 0; i < parts.size(); ++i)
    out.push_back(statement(cpp::assign(component(target, parts[i]), component(from, i))));
}

Code Assignments::incDec(const typed::IncDecExpr &expr, bool resultIsUsed) {
  const typed::Expr *vector = nullptr;
  const Type *scalar = expr.target->type->scalar();
  if (const std::vector<std::uint8_t> parts = printer.lvalues.components(*expr.target, vector);
      parts.size() > 1) { // `v.xy++`
    const Code old =
        printer.hoist(expr.target->type, "value", printer.expressions.argument(*expr.target));
    const Code changed =
        printer.hoist(expr.target->type, "value", stepped(old, scalar, expr.increment));
    assignComponents(printer.lvalues.of(*vector), parts, changed, *printer.before);
    return expr.prefix ? changed : old;
  }
  const Code target = printer.lvalues.of(*expr.target);
  // Compilers warn of `x = x++ + 1`, but not of a function.
  bool isSafe = !scalar->is(TypeKind::Int) && !resultIsUsed;
  if (auto *variable = dynCast<typed::VariableExpr>(expr.target))
    isSafe |= printer.counters.count(variable->variable) != 0;
  if (!isSafe) {
    const char *name = expr.increment ? "rtsl::increment" : "rtsl::decrement";
    if (!expr.prefix && resultIsUsed)
      name = expr.increment ? "rtsl::postIncrement" : "rtsl::postDecrement";
    return cpp::call(name, {target});
  }
  const UnaryOperator op = expr.increment ? UnaryOperator::Increment : UnaryOperator::Decrement;
  return expr.prefix ? cpp::unary(op, target) : postfix(op, target);
}

Code Assignments::stepped(const Code &value, const Type *scalar, bool increment) {
  if (scalar->is(TypeKind::Int)) // may overflow
    return cpp::call(increment ? "rtsl::add" : "rtsl::subtract", {value, integer(1)});
  return cpp::binary(increment ? Operator::Add : Operator::Subtract, value,
                     cpp::literal(scalar->is(TypeKind::Float) ? "1.0f" : "1u"));
}

Code Assignments::assign(const typed::AssignExpr &expr, bool resultIsUsed) {
  const typed::Effects value = context.effects.expression(*expr.value);
  const typed::Expr *vector = nullptr;
  const std::vector<std::uint8_t> parts = printer.lvalues.components(*expr.target, vector);
  const typed::Effects indices = printer.lvalues.indexEffects(*expr.target);
  const bool storeIndices = conflicts(indices, value) || (parts.size() > 1 && !indices.isPure());

  // Indices with side effects are evaluated once. The old value is saved if evaluating the new one
  // may change it.
  Code stored, old;
  const bool changesOld =
      expr.compound && conflicts(context.effects.expression(*expr.target), value);
  if (expr.compound && (changesOld || !indices.isPure())) {
    stored = printer.lvalues.of(parts.size() > 1 ? *vector : *expr.target, true);
    std::vector<Code> codes;
    for (std::uint8_t part : parts)
      codes.push_back(component(stored, part));
    old = printer.hoist(
        expr.target->type, "value",
        parts.size() > 1 ? cpp::construct(context.types.of(expr.target->type), codes) : stored);
  }

  const std::optional<Operator> plain =
      expr.compound ? printer.operators.plainOperator(expr.op, *expr.target, *expr.value)
                    : std::nullopt;
  auto combined = [&]() -> Code {
    if (!expr.compound) {
      // `a = b = c` stays as it is; an assignment anywhere else becomes a statement of its own.
      auto *inner = dynCast<typed::AssignExpr>(expr.value);
      if (inner && !printer.replaced.count(inner) &&
          !conflicts(context.effects.expression(*expr.target), context.effects.expression(*inner)))
        return assign(*inner, true);
      return printer.expressions.argument(*expr.value);
    }
    const Code left = old ? old : printer.expressions.argument(*expr.target);
    if (plain)
      return cpp::binary(*plain, left, printer.expressions.operand(*expr.value, bindingOf(*plain)));
    return cpp::call(printer.operators.functionFor(expr.op, *expr.target, *expr.value),
                     {left, printer.expressions.argument(*expr.value)});
  };

  if (parts.size() > 1) { // `v.zx = ...`: component by component
    const Code target = stored ? stored : printer.lvalues.of(*vector, storeIndices);
    const bool isFree = !expr.compound && printer.lvalues.isSimple(*expr.value) &&
                        !conflicts(context.effects.expression(*vector), value);
    Code from = combined();
    // A simple value that is no part of the target can be named more than once.
    std::set<const void *> written = context.effects.expression(expr).writes;
    const bool overlaps = std::any_of(written.begin(), written.end(),
                                      [&](const void *at) { return value.reads.count(at) != 0; });
    if (!isFree || overlaps)
      from = printer.hoist(expr.target->type, "value", from);
    assignComponents(target, parts, from, *printer.before);
    return resultIsUsed ? from : Code();
  }

  if (expr.compound && plain && !old) {
    const Code target = printer.lvalues.of(*expr.target, storeIndices);
    return cpp::assign(*plain, target, printer.expressions.argument(*expr.value));
  }
  const Code target = stored ? stored : printer.lvalues.of(*expr.target, storeIndices);
  return cpp::assign(target, combined());
}

} // namespace rtsl::cpp
