//===- ConstantBuiltins.cpp - folding of built-in functions ---------------===//
//
// A call of constants folds by the formula that Builtins.def names. Colors do not: how many
// components they have is chosen later.
//
//===----------------------------------------------------------------------===//
#include "language/formulas/Call.h"
#include "sema/fold/ConstantFold.h"
#include "sema/fold/Number.h"

namespace rtsl {

using typed::Constant;

std::optional<Constant> evaluateBuiltin(const typed::BuiltinExpr &call,
                                        const std::vector<Constant> &args) {
  if (!typed::isFoldable(call.builtin) || args.empty())
    return std::nullopt;
  formulas::Call<fold::Number> formula;
  for (std::size_t i = 0; i != args.size(); ++i) {
    const Type &type = *call.args[i]->type;
    if (!type.scalar() || args[i].scalars.size() != type.componentCount())
      return std::nullopt;
    formula.arguments.push_back(fold::columnsOf(type, args[i]));
  }
  if (call.args.front()->type->scalar()->is(TypeKind::UInt))
    formula.sign = formulas::IntegerSign::Unsigned;
  if (!formulas::evaluate(call.builtin, formula))
    return std::nullopt;
  return fold::toConstant(formula.result);
}

} // namespace rtsl
