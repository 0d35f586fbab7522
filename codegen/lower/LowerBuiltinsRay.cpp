//===- LowerBuiltinsRay.cpp - trace, hit, rand and ambient ----------------===//
#include "codegen/lower/Lowering.h"

namespace rtsl::lowering {

using typed::Builtin;

std::optional<Parts> FunctionLowering::lowerRayBuiltin(const typed::BuiltinExpr &expr) {
  mlir::Location location = module.location(expr.range);
  switch (expr.builtin) {
  case Builtin::Trace: {
    Value origin = value(*expr.args[0]);
    Value direction = value(*expr.args[1]);
    emitter.setLoc(location);
    return Parts{emitter.make<ir::TraceOp>(module.type(expr.type), origin, direction)};
  }
  case Builtin::Hit: {
    Value t = value(*expr.args[0]);
    emitter.setLoc(location);
    Value nearest = emitter.make<ir::HitOp>(emitter.getI1Type(), t);
    if (accepted)
      emitter.store(num(emitter.load(accepted)) | num(nearest), accepted);
    return Parts{nearest};
  }
  case Builtin::Rand:
    emitter.setLoc(location);
    return Parts{emitter.make<ir::RandOp>(emitter.getF32Type())};
  case Builtin::Ambient:
    emitter.setLoc(location);
    return Parts{emitter.make<ir::AmbientOp>(module.type(expr.type))};
  case Builtin::TracePayload:
    unsupported(expr.range, "`trace` with a payload");
    return zeroOf(expr.type);
  default:
    return std::nullopt;
  }
}

} // namespace rtsl::lowering
