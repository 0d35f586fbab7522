//===- LowerBuiltinsRay.cpp - trace, hit, rand and ambient ----------------===//
#include "codegen/lower/Lowering.h"
#include "language/formulas/Spaces.h"
#include "sema/typed/Analysis.h"

#include "runtime/device/ray/Abi.h"
#include "sema/typed/Casting.h"

namespace rtsl::lowering {

using typed::Builtin;

std::optional<Parts> FunctionLowering::lowerRayBuiltin(const typed::BuiltinExpr &expr) {
  switch (expr.builtin) {
#define RTSL_BUILTIN(...)
#define RTSL_RAY_BUILTIN(id, name, effects, cost, where, lowering, ...)                            \
  case Builtin::id:                                                                                \
    return lowering(expr);
#include "language/Builtins.def"
  default:
    return std::nullopt;
  }
}

Parts FunctionLowering::lowerTrace(const typed::BuiltinExpr &expr) {
  Value origin = value(*expr.args[0]);
  Value direction = value(*expr.args[1]);
  emitter.setLoc(module.location(expr.range));
  return {emitter.make<ir::TraceOp>(module.type(expr.type), origin, direction)};
}

Parts FunctionLowering::lowerHit(const typed::BuiltinExpr &expr) {
  Value t = value(*expr.args[0]);
  Value error = expr.args.size() > 1 ? value(*expr.args[1]) : Value();
  emitter.setLoc(module.location(expr.range));
  Value nearest = emitter.make<ir::HitOp>(emitter.getI1Type(), t, error);
  if (accepted)
    emitter.store(num(emitter.load(accepted)) | num(nearest), accepted);
  return {nearest};
}

Parts FunctionLowering::lowerRand(const typed::BuiltinExpr &expr) {
  emitter.setLoc(module.location(expr.range));
  return {emitter.make<ir::RandOp>(emitter.getF32Type(), expr.builtin == Builtin::RandOpen)};
}

Parts FunctionLowering::lowerAmbient(const typed::BuiltinExpr &expr) {
  emitter.setLoc(module.location(expr.range));
  return {emitter.make<ir::AmbientOp>(module.type(expr.type))};
}

Parts FunctionLowering::lowerLightCount(const typed::BuiltinExpr &expr) {
  emitter.setLoc(module.location(expr.range));
  return {emitter.make<ir::LightCountOp>(emitter.getI32Type())};
}

Parts FunctionLowering::lowerLightMayPass(const typed::BuiltinExpr &expr) {
  emitter.setLoc(module.location(expr.range));
  return {emitter.make<ir::LightMayPassOp>(emitter.getI1Type())};
}

/// sema/derive has replaced all calls.
Parts FunctionLowering::lowerDerivative(const typed::BuiltinExpr &) {
  llvm_unreachable("a derivative is an expression");
}

/// The matrices are those of the state at this point.
Parts FunctionLowering::lowerSpaceChange(const typed::BuiltinExpr &expr) {
  const Num given = num(value(*expr.args[0]));
  emitter.setLoc(module.location(expr.range));
  const auto load = [&](const char *state) {
    const mlir::Type column = mlir::VectorType::get(4, emitter.getF32Type());
    const Value matrix = emitter.make<ir::StateOp>(state, ir::ArrayType::get(4, column));
    Columns columns;
    for (unsigned i = 0; i < 4; ++i)
      columns.push_back(num(emitter.load(emitter.element(matrix, i))));
    return columns;
  };
  const auto toWorld = [&] { return load("ObjectToWorld"); };
  const auto toObject = [&] { return load("WorldToObject"); };
  const auto changed = [&] {
    switch (expr.builtin) {
    case Builtin::PointToWorld:
      return formulas::pointToWorld(toWorld(), given);
    case Builtin::PointToObject:
      return formulas::pointToObject(toWorld(), toObject(), given);
    case Builtin::VectorToWorld:
      return formulas::transformVector(toWorld(), given);
    case Builtin::VectorToObject:
      return formulas::transformVector(toObject(), given);
    case Builtin::NormalToWorld:
      return formulas::transformNormal(toObject(), given);
    default:
      return formulas::transformNormal(toWorld(), given);
    }
  };
  return {changed()};
}

Parts FunctionLowering::lowerVisitChild(const typed::BuiltinExpr &expr) {
  Value child = value(*expr.args[0]);
  emitter.setLoc(module.location(expr.range));
  emitter.make<ir::VisitChildOp>(child);
  return {};
}

Parts FunctionLowering::lowerIlluminateBySurface(const typed::BuiltinExpr &expr) {
  Value point = value(*expr.args[0]);
  Value side = expr.args.size() > 1 ? value(*expr.args[1]) : Value();
  emitter.setLoc(module.location(expr.range));
  return {emitter.make<ir::IlluminateOp>(emitter.getI1Type(), Value(), point, side, Value())};
}

// A side is the cone of all directions within a right angle of the given one. The argument that
// turns shadows on or off is mostly a constant. RTSL_NO_SHADOWS, which is no possible cosine, turns
// them off (Abi.h).
Parts FunctionLowering::lowerIlluminate(const typed::BuiltinExpr &expr) {
  Value light = value(*expr.args[0]), point = value(*expr.args[1]);
  if (expr.args.size() > 2 && !expr.args[2]->type->is(TypeKind::Bool)) {
    Value side = value(*expr.args[2]);
    emitter.setLoc(module.location(expr.range));
    return {emitter.make<ir::IlluminateOp>(emitter.getI1Type(), light, point, side,
                                           emitter.constant(emitter.getF32Type(), 0))};
  }
  Value shadows = expr.args.size() > 2 ? value(*expr.args[2]) : emitter.boolConstant(true);
  emitter.setLoc(module.location(expr.range));
  Value lit = emitter.variable("lit", emitter.getI1Type());
  auto illuminate = [&](bool withShadows) {
    Value normal = withShadows ? Value() : point;
    Value cosine = withShadows ? Value() : emitter.constant(emitter.getF32Type(), RTSL_NO_SHADOWS);
    emitter.store(emitter.make<ir::IlluminateOp>(emitter.getI1Type(), light, point, normal, cosine),
                  lit);
  };
  emitter.ifThen(shadows, [&] { illuminate(true); }, [&] { illuminate(false); });
  return {emitter.load(lit)};
}

// The payload is an `inout` argument: a temporary is passed with the ray, and copied back.
Parts FunctionLowering::lowerTracePayload(const typed::BuiltinExpr &expr) {
  constexpr unsigned payload = 4, first = 5; // the optional arguments come last
  llvm::SmallVector<Value, 8> arguments;
  Lvalue target;
  for (unsigned i = 0; i < expr.args.size(); ++i) {
    if (i != payload) {
      arguments.push_back(value(*expr.args[i]));
      continue;
    }
    target = lowerLvalue(*expr.args[i]);
    const bool isWholeVariable =
        llvm::isa_and_nonnull<ir::VarOp, ir::PayloadOp>(target.address.getDefiningOp());
    const bool isUnchanged = std::none_of(expr.args.begin() + first, expr.args.end(),
                                          [](const auto &arg) { return hasSideEffects(*arg); });
    if (module.options.source && isWholeVariable && isUnchanged) { // no temporary is needed
      arguments.push_back(target.address);
      continue;
    }
    arguments.push_back(temporary("payload", target.type));
    storeTo(load(target), arguments.back(), target.type);
  }
  arguments.resize(first + 3);
  emitter.setLoc(module.location(expr.range));
  emitter.make<ir::TracePayloadOp>(arguments[0], arguments[1], arguments[2], arguments[3],
                                   arguments[payload], arguments[first], arguments[first + 1],
                                   arguments[first + 2], mlir::IntegerAttr(), mlir::IntegerAttr());
  if (arguments[payload] != target.address)
    copyOut({{target, arguments[payload]}});
  return {};
}

Parts FunctionLowering::lowerPrint(const typed::BuiltinExpr &expr) {
  if (!module.options.prints)
    return {};
  llvm::SmallVector<llvm::StringRef> items;
  std::vector<std::string> names; // of types; references are not printed
  names.reserve(expr.args.size());
  llvm::SmallVector<std::int32_t> words;
  llvm::SmallVector<Value> values;
  for (const typed::ExprPtr &arg : expr.args) {
    std::size_t before = values.size();
    if (auto *text = dynCast<typed::StringExpr>(arg.get())) {
      items.push_back(text->value);
    } else {
      appendScalars(lower(*arg), arg->type, values);
      names.push_back(toString(arg->type));
      items.push_back(names.back());
    }
    words.push_back(static_cast<std::int32_t>(values.size() - before));
  }
  emitter.setLoc(module.location(expr.range));
  emitter.make<ir::PrintOp>(emitter.getStrArrayAttr(items), emitter.getDenseI32ArrayAttr(words),
                            values, mlir::IntegerAttr());
  return {};
}

static ir::AtomicKind kindOf(Builtin atomic, bool isSigned) {
  switch (atomic) {
#define RTSL_BUILTIN(...)
#define RTSL_ATOMIC(id, name, kind, kindOfUint, ...)                                               \
  case Builtin::id:                                                                                \
    return isSigned ? ir::AtomicKind::kind : ir::AtomicKind::kindOfUint;
#include "language/Builtins.def"
  default:
    llvm_unreachable("not an atomic function");
  }
}

// On an element of an empty buffer it does nothing, and yields zero.
Parts FunctionLowering::lowerAtomic(const typed::BuiltinExpr &expr) {
  const Lvalue place = lowerLvalue(*expr.args[0]);
  const Value given = value(*expr.args[1]);
  const Value third = expr.args.size() > 2 ? value(*expr.args[2]) : Value();
  emitter.setLoc(module.location(expr.range));
  const ir::AtomicKind kind = kindOf(expr.builtin, expr.type->is(TypeKind::Int));
  auto change = [&] { // GLSL's order: the expected value, and then the new one
    return emitter.make<ir::AtomicOp>(emitter.getI32Type(), kind, place.address,
                                      third ? third : given, third ? given : Value());
  };
  if (!place.guard)
    return {change()};
  const Value old = temporary("old", expr.type);
  emitter.ifThen(place.guard, [&] { emitter.store(change(), old); });
  return {emitter.load(old)};
}

Parts FunctionLowering::lowerHitAnswer(const typed::BuiltinExpr &expr) {
  emitter.setLoc(module.location(expr.range));
  // In the middle of an expression unreachable code may follow.
  emitter.ifThen(emitter.boolConstant(true), [&] { answerHit(expr.builtin); });
  return {};
}

void FunctionLowering::answerHit(Builtin builtin) {
  emitter.make<ir::AnswerHitOp>(builtin == Builtin::IgnoreIntersection ? ir::HitAnswer::Ignore
                                                                       : ir::HitAnswer::Terminate);
  emitReturnOfZero();
}

/// Returns if the function that was just called has ended `anyHit`.
void FunctionLowering::returnIfHitAnswered() {
  Value ended = emitter.make<ir::HitAnsweredOp>(emitter.getI1Type());
  emitter.ifThen(ended, [&] { emitReturnOfZero(); });
}

} // namespace rtsl::lowering
