//===- RuntimeFunctions.cpp - runtime functions that compiled code calls --===//
#include "codegen/emit/RuntimeFunctions.h"

#include "codegen/emit/patterns/Patterns.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "llvm/ADT/TypeSwitch.h"

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;

std::string runtimeFunction(mlir::Operation *op) {
  return llvm::TypeSwitch<mlir::Operation *, std::string>(op)
      .Case([](ir::ElementaryOp elementary) {
        return "rtsl_" + ir::stringifyElementary(elementary.getFunction()).str();
      })
      .Case([](ir::RefractOp refract) {
        const auto vector = llvm::dyn_cast<mlir::VectorType>(refract.getType());
        const bool isDouble = ir::attr::inDouble.isOn(refract->getParentOfType<mlir::ModuleOp>());
        return (isDouble ? "rtsl_double_refract" : "rtsl_refract") +
               std::to_string(vector ? vector.getNumElements() : 1);
      })
      .Case([](ir::TraceOp) { return "rtsl_trace"; })
      .Case([](ir::TracePayloadOp) { return "rtsl_trace_payload"; })
      .Case([](ir::SpawnPayloadOp spawn) {
        return spawn.getLast() ? "rtsl_spawn_last_payload" : "rtsl_spawn_payload";
      })
      .Case([](ir::VisitChildOp) { return "rtsl_visit_child"; })
      .Case([](ir::RaiseOp) { return "rtsl_raise"; })
      .Case([](ir::PrintOp) { return "rtsl_print"; })
      .Case([](ir::HitOp hit) { return hit.getError() ? "rtsl_hit_within" : "rtsl_hit"; })
      .Case([](ir::RandOp rand) { return rand.getOpen() ? "rtsl_rand_open" : "rtsl_rand"; })
      .Case([](ir::IlluminateOp light) {
        return light.getIndex() ? "rtsl_illuminance" : "rtsl_illuminate_by_surface";
      })
      .Case([](ir::SpawnOp spawn) { return spawn.getLast() ? "rtsl_spawn_last" : "rtsl_spawn"; })
      .Case([](ir::TraceResultOp) { return "rtsl_trace_result"; })
      .Case([](ir::MoveFrameOp) { return "rtsl_move_frame"; })
      .Default([](mlir::Operation *) { return ""; });
}

/// The signatures are those of runtime/device/ray/Abi.h.
static LLVM::LLVMFunctionType signature(mlir::Operation *op) {
  mlir::MLIRContext *context = op->getContext();
  mlir::Type pointer = LLVM::LLVMPointerType::get(context);
  mlir::Type f32 = mlir::Float32Type::get(context);
  mlir::Type i32 = mlir::IntegerType::get(context, 32);
  mlir::Type nothing = LLVM::LLVMVoidType::get(context);
  auto function = [](mlir::Type result, llvm::ArrayRef<mlir::Type> arguments) {
    return LLVM::LLVMFunctionType::get(result, arguments);
  };
  return llvm::TypeSwitch<mlir::Operation *, LLVM::LLVMFunctionType>(op)
      .Case([&](ir::ElementaryOp elementary) {
        return function(f32, llvm::SmallVector<mlir::Type>(elementary.getOperands().size(), f32));
      })
      .Case([&](ir::RefractOp refract) {
        const bool isDouble = ir::attr::inDouble.isOn(refract->getParentOfType<mlir::ModuleOp>());
        return function(nothing,
                        {pointer, pointer,
                         isDouble ? mlir::Type(mlir::Float64Type::get(context)) : f32, pointer});
      })
      .Case([&](ir::TraceOp) {
        return function(nothing, {pointer, f32, f32, f32, f32, f32, f32, pointer});
      })
      .Case<ir::TracePayloadOp, ir::SpawnPayloadOp>([&](auto) {
        return function(nothing, {pointer, f32, f32, f32, f32, f32, f32, f32, f32, pointer, i32,
                                  i32, f32, i32, i32});
      })
      .Case<ir::RaiseOp, ir::VisitChildOp>([&](auto) { return function(nothing, {pointer, i32}); })
      .Case([&](ir::PrintOp) { return function(nothing, {pointer, i32, pointer, i32}); })
      .Case([&](ir::HitOp hit) {
        return hit.getError() ? function(i32, {pointer, f32, f32}) : function(i32, {pointer, f32});
      })
      .Case([&](ir::RandOp) { return function(f32, {pointer}); })
      .Case([&](ir::IlluminateOp light) {
        if (!light.getIndex())
          return function(i32, {pointer, f32, f32, f32, f32, f32, f32});
        return function(i32, {pointer, i32, f32, f32, f32, f32, f32, f32, f32});
      })
      .Case([&](ir::SpawnOp) { return function(nothing, {pointer, f32, f32, f32, f32, f32, f32}); })
      .Case([&](ir::MoveFrameOp) { return function(nothing, {pointer, i32, i32}); })
      .Case([&](ir::TraceResultOp) { return function(pointer, {pointer}); });
}

static bool writesOutputBuffers(mlir::ModuleOp module) {
  const mlir::WalkResult result = module.walk([](ir::BufferElementOp element) {
    return ir::isInOutputBuffer(element.getResult()) ? mlir::WalkResult::interrupt()
                                                     : mlir::WalkResult::advance();
  });
  return result.wasInterrupted();
}

void declareRuntimeFunctions(mlir::ModuleOp module) {
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(module.getBody());
  if (writesOutputBuffers(module)) {
    mlir::Type pointer = LLVM::LLVMPointerType::get(module.getContext());
    LLVM::LLVMFuncOp::create(builder, module.getLoc(), isAbandonedFunction,
                             LLVM::LLVMFunctionType::get(builder.getI32Type(), {pointer}))
        .setNoUnwind(true);
  }
  module.walk([&](mlir::Operation *op) {
    std::string name = runtimeFunction(op);
    if (name.empty() || module.lookupSymbol(name))
      return;
    auto function = LLVM::LLVMFuncOp::create(builder, module.getLoc(), name, signature(op));
    function.setNoUnwind(true);
    if (llvm::isa<ir::ElementaryOp, ir::RefractOp>(op)) {
      // Reads only its arguments and the memory that they point to.
      llvm::SmallVector<LLVM::ModRefInfo> effects(6, LLVM::ModRefInfo::NoModRef);
      if (llvm::isa<ir::RefractOp>(op))
        effects[1] = LLVM::ModRefInfo::ModRef; // the arguments' memory
      function.setMemoryEffectsAttr(
          LLVM::MemoryEffectsAttr::get(module.getContext(), llvm::ArrayRef(effects)));
      function.setWillReturn(true);
    }
  });
}

} // namespace rtsl::codegen
