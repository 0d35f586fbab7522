//===- RayPatterns.cpp - operations of rays to LLVM -----------------------===//
#include "codegen/emit/RuntimeFunctions.h"
#include "codegen/emit/patterns/Patterns.h"
#include "codegen/ir/dialect/RtslOps.h"
#include "runtime/device/ray/State.h"

#include "mlir/Conversion/LLVMCommon/Pattern.h"

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;
using mlir::ConversionPatternRewriter;
using mlir::ConvertOpToLLVMPattern;
using mlir::LogicalResult;
using mlir::Value;

namespace {

/// Replaces an operation without results by a call of its function of the runtime.
template <typename Op>
LogicalResult replaceByCall(ConversionPatternRewriter &rewriter, Op op,
                            llvm::ArrayRef<Value> arguments) {
  callRuntime(rewriter, op.getLoc(), runtimeFunction(op), arguments);
  rewriter.eraseOp(op);
  return mlir::success();
}

struct ConvertTrace : ConvertOpToLLVMPattern<ir::TraceOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::TraceOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Location location = op.getLoc();
    // Space for the largest color: the number of components of the launch is not known here.
    Value color = stackSlot(rewriter, location, sizeof(float) * RTSL_MAX_COLOR);
    llvm::SmallVector<Value> arguments = {rayState(rewriter)};
    llvm::append_range(arguments, componentsOf(rewriter, location, adaptor.getOrigin()));
    llvm::append_range(arguments, componentsOf(rewriter, location, adaptor.getDirection()));
    arguments.push_back(color);
    callRuntime(rewriter, location, runtimeFunction(op), arguments);
    rewriter.replaceOp(op, loadFrom(rewriter, location, op.getType(), color, false));
    return mlir::success();
  }
};

struct ConvertHit : ConvertOpToLLVMPattern<ir::HitOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::HitOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    llvm::SmallVector<Value, 3> arguments = {rayState(rewriter), adaptor.getT()};
    if (adaptor.getError())
      arguments.push_back(adaptor.getError());
    Value answer = callRuntime(rewriter, op.getLoc(), runtimeFunction(op), arguments);
    rewriter.replaceOpWithNewOp<LLVM::ICmpOp>(
        op, LLVM::ICmpPredicate::ne, answer,
        constantLike(rewriter, op.getLoc(), answer.getType(), 0));
    return mlir::success();
  }
};

struct ConvertRand : ConvertOpToLLVMPattern<ir::RandOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::RandOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOp(
        op, callRuntime(rewriter, op.getLoc(), runtimeFunction(op), {rayState(rewriter)}));
    return mlir::success();
  }
};

/// A fact of the launch at this offset.
template <typename Op, std::size_t offset>
struct ConvertLaunchFact : ConvertOpToLLVMPattern<Op> {
  using ConvertOpToLLVMPattern<Op>::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(Op op, typename Op::Adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Value address = launchAddress(rewriter, op.getLoc(), offset);
    rewriter.replaceOp(op, loadFrom(rewriter, op.getLoc(), op.getType(), address, true));
    return mlir::success();
  }
};
using ConvertAmbient = ConvertLaunchFact<ir::AmbientOp, offsetof(RtslLaunch, ambient)>;
using ConvertLightCount = ConvertLaunchFact<ir::LightCountOp, offsetof(RtslLaunch, lightCount)>;

struct ConvertIlluminate : ConvertOpToLLVMPattern<ir::IlluminateOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::IlluminateOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Location location = op.getLoc();
    mlir::Type f32 = rewriter.getF32Type();
    llvm::SmallVector<Value> arguments = {rayState(rewriter)};
    if (adaptor.getIndex())
      arguments.push_back(adaptor.getIndex());
    llvm::append_range(arguments, componentsOf(rewriter, location, adaptor.getPoint()));
    if (adaptor.getNormal())
      llvm::append_range(arguments, componentsOf(rewriter, location, adaptor.getNormal()));
    else
      arguments.append(3, constantLike(rewriter, location, f32, 0));
    if (adaptor.getCosAngle())
      arguments.push_back(adaptor.getCosAngle());
    else if (adaptor.getIndex()) // -2 is not a cosine: there is no cone (Abi.h)
      arguments.push_back(constantLike(rewriter, location, f32, -2));
    Value answer = callRuntime(rewriter, location, runtimeFunction(op), arguments);
    rewriter.replaceOpWithNewOp<LLVM::ICmpOp>(
        op, LLVM::ICmpPredicate::ne, answer, constantLike(rewriter, location, answer.getType(), 0));
    return mlir::success();
  }
};

//===----------------------------------------------------------------------===//
// Rays with a payload
//===----------------------------------------------------------------------===//

/// The address of a field of RtslState at this offset.
Value stateField(mlir::OpBuilder &builder, mlir::Location location, uint32_t bytes) {
  return offsetAddress(builder, location, rayState(builder), bytes);
}

Value loadStateField(mlir::OpBuilder &builder, mlir::Location location, mlir::Type type,
                     uint32_t bytes) {
  return loadFrom(builder, location, type, stateField(builder, location, bytes), false);
}

/// `rtsl.trace_payload`, or the first half of a split one.
template <typename Op>
struct ConvertPayloadRay : ConvertOpToLLVMPattern<Op> {
  using ConvertOpToLLVMPattern<Op>::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(Op op, typename Op::Adaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Location location = op.getLoc();
    mlir::Type i32 = rewriter.getI32Type(), f32 = rewriter.getF32Type();
    auto orOwn = [&](Value given, mlir::Type type, uint32_t field) {
      return given ? given : loadStateField(rewriter, location, type, field);
    };
    llvm::SmallVector<Value> arguments = {rayState(rewriter)};
    llvm::append_range(arguments, componentsOf(rewriter, location, adaptor.getOrigin()));
    llvm::append_range(arguments, componentsOf(rewriter, location, adaptor.getDirection()));
    arguments.push_back(adaptor.getTmin());
    arguments.push_back(adaptor.getTmax());
    arguments.push_back(adaptor.getPayload());
    arguments.push_back(orOwn(adaptor.getRoot(), i32, offsetof(RtslState, rayRoot)));
    arguments.push_back(orOwn(adaptor.getMask(), i32, offsetof(RtslState, rayMask)));
    arguments.push_back(orOwn(adaptor.getTime(), f32, offsetof(RtslState, Time)));
    arguments.push_back(constantLike(rewriter, location, i32, *op.getRayType()));
    arguments.push_back(constantLike(rewriter, location, i32, *op.getHow()));
    return replaceByCall(rewriter, op, arguments);
  }
};

struct ConvertPayload : ConvertOpToLLVMPattern<ir::PayloadOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::PayloadOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Type pointer = LLVM::LLVMPointerType::get(op.getContext());
    Value field = stateField(rewriter, op.getLoc(), offsetof(RtslState, payload));
    rewriter.replaceOpWithNewOp<LLVM::LoadOp>(op, pointer, field, alignof(void *));
    return mlir::success();
  }
};

struct ConvertRayType : ConvertOpToLLVMPattern<ir::RayTypeOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::RayTypeOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOp(
        op, loadStateField(rewriter, op.getLoc(), op.getType(), offsetof(RtslState, rayType)));
    return mlir::success();
  }
};

struct ConvertAnswerHit : ConvertOpToLLVMPattern<ir::AnswerHitOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::AnswerHitOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Value answer = constantLike(rewriter, op.getLoc(), rewriter.getI32Type(),
                                static_cast<int64_t>(op.getAnswer()));
    Value field = stateField(rewriter, op.getLoc(), offsetof(RtslState, hitAnswer));
    rewriter.replaceOpWithNewOp<LLVM::StoreOp>(op, answer, field, alignof(uint32_t));
    return mlir::success();
  }
};

struct ConvertHitAnswered : ConvertOpToLLVMPattern<ir::HitAnsweredOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::HitAnsweredOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Value answer = loadStateField(rewriter, op.getLoc(), rewriter.getI32Type(),
                                  offsetof(RtslState, hitAnswer));
    rewriter.replaceOpWithNewOp<LLVM::ICmpOp>(
        op, LLVM::ICmpPredicate::ne, answer,
        constantLike(rewriter, op.getLoc(), answer.getType(), RTSL_ACCEPT));
    return mlir::success();
  }
};

struct ConvertVisitChild : ConvertOpToLLVMPattern<ir::VisitChildOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::VisitChildOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    return replaceByCall(rewriter, op, {rayState(rewriter), adaptor.getChild()});
  }
};

//===----------------------------------------------------------------------===//
// Events
//===----------------------------------------------------------------------===//

struct ConvertRaise : ConvertOpToLLVMPattern<ir::RaiseOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::RaiseOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Value exception = constantLike(rewriter, op.getLoc(), rewriter.getI32Type(), op.getException());
    return replaceByCall(rewriter, op, {rayState(rewriter), exception});
  }
};

/// The words of the values are stored to memory.
struct ConvertPrint : ConvertOpToLLVMPattern<ir::PrintOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::PrintOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Location location = op.getLoc();
    mlir::Type i32 = rewriter.getI32Type();
    auto count = static_cast<uint32_t>(adaptor.getValues().size());
    Value words = stackSlot(rewriter, location, 4 * std::max(count, 1u));
    for (auto [index, value] : llvm::enumerate(adaptor.getValues())) {
      if (value.getType().isInteger(1))
        value = LLVM::ZExtOp::create(rewriter, location, i32, value);
      Value place = offsetAddress(rewriter, location, words, 4 * static_cast<uint32_t>(index));
      LLVM::StoreOp::create(rewriter, location, value, place, 4);
    }
    return replaceByCall(rewriter, op,
                         {rayState(rewriter),
                          constantLike(rewriter, location, i32, op.getFormat().value_or(0)), words,
                          constantLike(rewriter, location, i32, count)});
  }
};

//===----------------------------------------------------------------------===//
// Split traces
//===----------------------------------------------------------------------===//

/// The two halves of a split trace.
struct ConvertSpawn : ConvertOpToLLVMPattern<ir::SpawnOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::SpawnOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    llvm::SmallVector<Value> arguments = {rayState(rewriter)};
    llvm::append_range(arguments, componentsOf(rewriter, op.getLoc(), adaptor.getOrigin()));
    llvm::append_range(arguments, componentsOf(rewriter, op.getLoc(), adaptor.getDirection()));
    return replaceByCall(rewriter, op, arguments);
  }
};

struct ConvertMoveFrame : ConvertOpToLLVMPattern<ir::MoveFrameOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::MoveFrameOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    return replaceByCall(rewriter, op,
                         {rayState(rewriter), adaptor.getBytes(), adaptor.getObject()});
  }
};

struct ConvertTraceResult : ConvertOpToLLVMPattern<ir::TraceResultOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::TraceResultOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Value color = callRuntime(rewriter, op.getLoc(), runtimeFunction(op), {rayState(rewriter)});
    rewriter.replaceOp(op, loadFrom(rewriter, op.getLoc(), op.getType(), color, false));
    return mlir::success();
  }
};

} // namespace

void addRayPatterns(mlir::LLVMTypeConverter &converter, mlir::RewritePatternSet &patterns) {
  patterns.add<ConvertTrace, ConvertHit, ConvertRand, ConvertAmbient, ConvertLightCount,
               ConvertIlluminate, ConvertSpawn, ConvertTraceResult, ConvertMoveFrame,
               ConvertPayloadRay<ir::TracePayloadOp>, ConvertPayloadRay<ir::SpawnPayloadOp>,
               ConvertRaise, ConvertPrint, ConvertPayload, ConvertRayType, ConvertVisitChild,
               ConvertAnswerHit, ConvertHitAnswered>(converter);
}

} // namespace rtsl::codegen
