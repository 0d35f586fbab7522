//===- RayPatterns.cpp - what rays do, to LLVM ----------------------------===//
#include "codegen/emit/Patterns.h"
#include "codegen/emit/RuntimeFunctions.h"
#include "codegen/ir/RtslOps.h"
#include "runtime/device/Abi.h"

#include "mlir/Conversion/LLVMCommon/Pattern.h"

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;
using mlir::ConversionPatternRewriter;
using mlir::ConvertOpToLLVMPattern;
using mlir::LogicalResult;
using mlir::Value;

namespace {

struct ConvertTrace : ConvertOpToLLVMPattern<ir::TraceOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::TraceOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Location location = op.getLoc();
    // Room for the largest color: what a launch's is, the program that it runs need not know.
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
    Value answer = callRuntime(rewriter, op.getLoc(), runtimeFunction(op),
                               {rayState(rewriter), adaptor.getT()});
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

struct ConvertAmbient : ConvertOpToLLVMPattern<ir::AmbientOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::AmbientOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Value address = launchAddress(rewriter, op.getLoc(), offsetof(RtslLaunch, ambient));
    rewriter.replaceOp(op, loadFrom(rewriter, op.getLoc(), op.getType(), address, true));
    return mlir::success();
  }
};

struct ConvertLightCount : ConvertOpToLLVMPattern<ir::LightCountOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::LightCountOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Value address = launchAddress(rewriter, op.getLoc(), offsetof(RtslLaunch, lightCount));
    rewriter.replaceOp(op, loadFrom(rewriter, op.getLoc(), op.getType(), address, true));
    return mlir::success();
  }
};

struct ConvertIlluminate : ConvertOpToLLVMPattern<ir::IlluminateOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::IlluminateOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Location location = op.getLoc();
    mlir::Type f32 = rewriter.getF32Type();
    llvm::SmallVector<Value> arguments = {rayState(rewriter), adaptor.getIndex()};
    llvm::append_range(arguments, componentsOf(rewriter, location, adaptor.getPoint()));
    if (adaptor.getNormal()) {
      llvm::append_range(arguments, componentsOf(rewriter, location, adaptor.getNormal()));
      arguments.push_back(adaptor.getCosAngle());
    } else {
      // -2 is no cosine: there is no cone (Abi.h).
      arguments.append(3, constantLike(rewriter, location, f32, 0));
      arguments.push_back(constantLike(rewriter, location, f32, -2));
    }
    Value answer = callRuntime(rewriter, location, runtimeFunction(op), arguments);
    rewriter.replaceOpWithNewOp<LLVM::ICmpOp>(
        op, LLVM::ICmpPredicate::ne, answer, constantLike(rewriter, location, answer.getType(), 0));
    return mlir::success();
  }
};

/// The two halves of a trace in a function that was split there.
struct ConvertSpawn : ConvertOpToLLVMPattern<ir::SpawnOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::SpawnOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    llvm::SmallVector<Value> arguments = {rayState(rewriter)};
    llvm::append_range(arguments, componentsOf(rewriter, op.getLoc(), adaptor.getOrigin()));
    llvm::append_range(arguments, componentsOf(rewriter, op.getLoc(), adaptor.getDirection()));
    callRuntime(rewriter, op.getLoc(), runtimeFunction(op), arguments);
    rewriter.eraseOp(op);
    return mlir::success();
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
               ConvertIlluminate, ConvertSpawn, ConvertTraceResult>(converter);
}

} // namespace rtsl::codegen
