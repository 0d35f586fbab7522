//===- LowerCalls.cpp - calls of functions and methods --------------------===//
//
// Arguments are evaluated from left to right. An `in` argument is a value, or the address of a
// copy; for `out` and `inout` the lvalue is evaluated once, before the call, a temporary is passed
// to the function (with the lvalue's value, for `inout`), and after the call the temporaries are
// copied back, again from left to right. So arguments may overlap.
//
//===----------------------------------------------------------------------===//
#include "codegen/lower/Lowering.h"
#include "sema/typed/Analysis.h"

#include "sema/typed/Casting.h"

#include <algorithm>

namespace rtsl::lowering {

// Is the argument a variable of the caller that neither the callee nor a later argument changes? No
// other code can change it.
static bool canShare(const typed::Expr &arg, const std::vector<typed::ExprPtr> &args,
                     std::size_t index, const std::set<const typed::Variable *> &assigned,
                     const typed::Variable &parameter) {
  auto *variable = dynCast<typed::VariableExpr>(&arg);
  if (!variable || variable->variable->kind == typed::Variable::Kind::Global ||
      assigned.count(&parameter))
    return false;
  for (std::size_t later = index + 1; later < args.size(); ++later)
    if (hasSideEffects(*args[later]))
      return false;
  return true;
}

// For C++ output: a variable that stays whole is passed without a copy to a method that traces, if
// no other argument refers to it.
bool FunctionLowering::canHandOver(const typed::Function &callee,
                                   const std::vector<typed::ExprPtr> &args,
                                   std::size_t index) const {
  auto *variable = dynCast<typed::VariableExpr>(args[index].get());
  if (!module.options.source || !variable ||
      variable->variable->kind == typed::Variable::Kind::Global || !livesInMemory(variable->type) ||
      callee.parameters[index]->direction != ast::Direction::InOut)
    return false;
  for (std::size_t other = 0; other < args.size(); ++other) {
    if (other > index && hasSideEffects(*args[other]))
      return false;
    bool isAliased = false;
    if (other != index && callee.parameters[other]->direction != ast::Direction::In)
      forEachExpr(*args[other], [&](const typed::Expr &inner) {
        auto *same = dynCast<typed::VariableExpr>(&inner);
        isAliased |= same && same->variable == variable->variable;
      });
    if (isAliased)
      return false;
  }
  return true;
}

void FunctionLowering::passArguments(const typed::Function &callee,
                                     const std::vector<typed::ExprPtr> &args,
                                     llvm::SmallVectorImpl<Value> &values,
                                     std::vector<CopyOut> &outputs, bool isDispatched) {
  std::set<const typed::Variable *> assigned;
  bool hasMemory = std::any_of(args.begin(), args.end(),
                               [](const typed::ExprPtr &arg) { return livesInMemory(arg->type); });
  if (hasMemory && !isDispatched)
    assigned = assignedVariables(*callee.body);
  for (std::size_t i = 0; i < args.size(); ++i) {
    const typed::Variable &parameter = *callee.parameters[i];
    const Type *type = parameter.type;
    llvm::StringRef name = parameter.name.empty() ? "argument" : llvm::StringRef(parameter.name);
    emitter.setLoc(module.location(args[i]->range));
    if (parameter.direction == ast::Direction::In) {
      if (!livesInMemory(type)) {
        values.push_back(value(*args[i]));
        continue;
      }
      if (!isDispatched && canShare(*args[i], args, i, assigned, parameter)) {
        values.push_back(lowerLvalue(*args[i]).address);
        continue;
      }
      Value copy = temporary(name, type);
      lowerInto(*args[i], copy);
      values.push_back(copy);
      continue;
    }
    if (isDispatched && canHandOver(callee, args, i)) {
      values.push_back(lowerLvalue(*args[i]).address);
      continue;
    }
    Lvalue target = lowerLvalue(*args[i]);
    Value copy = temporary(name, type);
    if (parameter.direction == ast::Direction::InOut)
      storeTo(load(target), copy, type);
    values.push_back(copy);
    outputs.push_back({target, copy});
  }
}

void FunctionLowering::copyOut(const std::vector<CopyOut> &outputs) {
  for (const CopyOut &output : outputs)
    store(loadFrom(output.from, output.target.type), output.target);
}

/// Is the callee an overridden function, or one that begins a ray if the engine calls it?
bool FunctionLowering::isHidden(const typed::CallExpr &expr) const {
  const typed::Function &callee = *expr.function;
  if (expr.isOfBase)
    return callee.isStateMethod || callee.isConstructor ||
           &resolve(callee, key.concrete) != &callee;
  return callee.isStateMethod && (callee.name == "shade" || callee.name == "miss");
}

Parts FunctionLowering::lowerCall(const typed::CallExpr &expr, Value result) {
  const typed::Class *concrete = expr.onSelf ? key.concrete : nullptr;
  const typed::Function &callee = resolve(expr, concrete);
  bool forIntersect = accepted && takesPartInIntersection(callee, concrete);
  mlir::func::FuncOp target = module.function({&callee, concrete, forIntersect, isHidden(expr)});

  llvm::SmallVector<Value, 8> values;
  std::vector<CopyOut> outputs;
  if (concrete)
    values.push_back(self());
  const Type *type = callee.returnType;
  if (livesInMemory(type)) {
    if (!result)
      result = temporary(callee.name, type);
    values.push_back(result);
  }
  passArguments(callee, expr.args, values, outputs, /*isDispatched=*/false);
  if (forIntersect) {
    if (concrete)
      for (const typed::Member *member : module.scratchMembers(concrete))
        values.push_back(scratch[member]);
    values.push_back(accepted);
  }
  emitter.setLoc(module.location(expr.range));
  auto call = emitter.make<mlir::func::CallOp>(target, values);
  copyOut(outputs);
  if (mayEndAnyHit && module.hitAnswers.mayAnswer(callee, concrete))
    returnIfHitAnswered();
  if (livesInMemory(type))
    return loadFrom(result, type);
  return Parts(call.getResults().begin(), call.getResults().end());
}

// A texture stores its results in two state variables. They are cleared before the call, so that a
// result that it does not set is zero and not that of an earlier texture. A texture that calls
// another one preserves its own results:
//
//   %mine = rtsl.load TextureColor      only where the caller may itself be looked up
//   rtsl.store 0, TextureColor
//   rtsl.call_method "lookup" on %t
//   %found = rtsl.load TextureColor
//   rtsl.store %mine, TextureColor
Parts FunctionLowering::lowerLookup(const typed::MethodCallExpr &expr) {
  const Value object = value(*expr.receiver);
  emitter.setLoc(module.location(expr.range));
  const TypeContext &types = module.languageTypes();
  const Value color = emitter.make<ir::StateOp>("TextureColor", module.type(types.color));
  const Value number = emitter.make<ir::StateOp>("FloatTextureValue", module.type(types.floatType));
  Parts mine;
  for (const Value state : {color, number}) {
    if (key.function->mayRunInLookup)
      mine.push_back(emitter.load(state));
    emitter.store(emitter.zero(mlir::cast<ir::PtrType>(state.getType()).getPointee()), state);
  }
  emitter.make<ir::CallMethodOp>(mlir::TypeRange(), "lookup", object, mlir::ValueRange());
  const Value found = emitter.load(expr.method == "lookupFloat" ? number : color);
  if (!mine.empty()) {
    emitter.store(mine[0], color);
    emitter.store(mine[1], number);
  }
  return {found};
}

Parts FunctionLowering::lowerMethodCall(const typed::MethodCallExpr &expr) {
  if (!expr.function)
    return lowerLookup(expr);

  Value object = value(*expr.receiver);
  const typed::Function &callee = *expr.function;
  llvm::SmallVector<Value, 8> values;
  std::vector<CopyOut> outputs;
  const Type *type = callee.returnType;
  llvm::SmallVector<mlir::Type, 1> results;
  Value result;
  if (livesInMemory(type)) {
    result = temporary(callee.name, type);
    values.push_back(result);
  } else if (!type->is(TypeKind::Void)) {
    results.push_back(module.type(type));
  }
  passArguments(callee, expr.args, values, outputs, /*isDispatched=*/true);
  emitter.setLoc(module.location(expr.range));
  auto call = emitter.make<ir::CallMethodOp>(results, module.slotName(callee), object, values);
  copyOut(outputs);
  if (mayEndAnyHit && module.hitAnswers.mayAnswerOf(callee))
    returnIfHitAnswered();
  if (livesInMemory(type))
    return loadFrom(result, type);
  return Parts(call.getResults().begin(), call.getResults().end());
}

} // namespace rtsl::lowering
