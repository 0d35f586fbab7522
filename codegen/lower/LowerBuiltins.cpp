//===- LowerBuiltins.cpp - built-in functions -----------------------------===//
//
// Built-in functions that depend on the ray or the scene are in LowerBuiltinsRay.cpp; all others
// are lowered by their formulas (language/formulas), which Builtins.def names.
//
//===----------------------------------------------------------------------===//
#include "codegen/lower/Lowering.h"
#include "language/formulas/Call.h"

namespace rtsl::lowering {

static formulas::IntegerSign signOf(const typed::Expr &expr) {
  const Type *scalar = expr.type->scalar();
  return scalar && scalar->is(TypeKind::UInt) ? formulas::IntegerSign::Unsigned
                                              : formulas::IntegerSign::Signed;
}

Parts FunctionLowering::lowerBuiltin(const typed::BuiltinExpr &expr) {
  if (auto result = lowerRayBuiltin(expr))
    return *result;
  formulas::Call<Num> call;
  llvm::SmallVector<Lvalue, 2> targets; // `out` arguments
  const auto [firstOutput, outputCount] = typed::outputsOf(expr.builtin);
  for (std::size_t i = 0; i < expr.args.size(); ++i)
    if (i >= firstOutput && i < firstOutput + outputCount)
      targets.push_back(lowerLvalue(*expr.args[i]));
    else
      call.arguments.push_back(columns(lower(*expr.args[i])));
  emitter.setLoc(module.location(expr.range));
  if (!expr.args.empty())
    call.sign = signOf(*expr.args.front());
  if (!formulas::evaluate(expr.builtin, call)) {
    unsupported(expr.range, std::string("`") + typed::name(expr.builtin) + "`");
    return zeroOf(expr.type);
  }
  for (std::size_t i = 0; i < targets.size(); ++i)
    store({call.outputs[i]}, targets[i]);
  return parts(call.result);
}

} // namespace rtsl::lowering
