//===- NumberPatterns.cpp - arithmetic of the dialect to LLVM -------------===//
#include "codegen/emit/RuntimeFunctions.h"
#include "codegen/emit/patterns/Patterns.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/dialect/RtslOps.h"

#include "mlir/Conversion/LLVMCommon/Pattern.h"

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;
using mlir::ConversionPatternRewriter;
using mlir::ConvertOpToLLVMPattern;
using mlir::Location;
using mlir::LogicalResult;
using mlir::Value;

namespace {

/// One call for each component.
struct ConvertElementary : ConvertOpToLLVMPattern<ir::ElementaryOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::ElementaryOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Location location = op.getLoc();
    std::string function = runtimeFunction(op);
    auto type = llvm::dyn_cast<mlir::VectorType>(op.getType());
    if (!type) {
      rewriter.replaceOp(op, callRuntime(rewriter, location, function,
                                         llvm::SmallVector<Value>(adaptor.getOperands())));
      return mlir::success();
    }
    llvm::SmallVector<llvm::SmallVector<Value>> operands;
    for (Value operand : adaptor.getOperands())
      operands.push_back(componentsOf(rewriter, location, operand));
    Value result = LLVM::PoisonOp::create(rewriter, location, type);
    for (int64_t index = 0; index < type.getNumElements(); ++index) {
      llvm::SmallVector<Value, 2> arguments;
      for (const auto &components : operands)
        arguments.push_back(components[index]);
      Value value = callRuntime(rewriter, location, function, arguments);
      Value position =
          LLVM::ConstantOp::create(rewriter, location, rewriter.getI64IntegerAttr(index));
      result = LLVM::InsertElementOp::create(rewriter, location, result, value, position);
    }
    rewriter.replaceOp(op, result);
    return mlir::success();
  }
};

/// Vectors are passed in memory. The function is in single precision or, if arithmetic is widened,
/// in double: then its operands are converted here, and widening makes the conversions identities.
struct ConvertRefract : ConvertOpToLLVMPattern<ir::RefractOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::RefractOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    const Location location = op.getLoc();
    const bool isDouble = ir::attr::inDouble.isOn(op->getParentOfType<mlir::ModuleOp>());
    const mlir::Type number =
        isDouble ? mlir::Type(rewriter.getF64Type()) : mlir::Type(rewriter.getF32Type());
    auto vector = llvm::dyn_cast<mlir::VectorType>(op.getType());
    const mlir::Type type = vector ? mlir::Type(vector.clone(number)) : number;
    const uint32_t bytes = isDouble ? 8 : 4,
                   count = vector ? static_cast<uint32_t>(vector.getNumElements()) : 1;
    auto widened = [&](Value value, mlir::Type wide) -> Value {
      return isDouble ? Value(LLVM::FPExtOp::create(rewriter, location, wide, value)) : value;
    };
    auto inMemory = [&](Value value) {
      Value slot = stackSlot(rewriter, location, count * bytes, bytes);
      LLVM::StoreOp::create(rewriter, location, widened(value, type), slot, bytes);
      return slot;
    };
    Value incident = inMemory(adaptor.getIncident()), normal = inMemory(adaptor.getNormal());
    Value result = stackSlot(rewriter, location, count * bytes, bytes);
    callRuntime(rewriter, location, runtimeFunction(op),
                {incident, normal, widened(adaptor.getEta(), number), result});
    Value refracted = LLVM::LoadOp::create(rewriter, location, type, result, bytes);
    rewriter.replaceOp(
        op, isDouble ? Value(LLVM::FPTruncOp::create(rewriter, location, op.getType(), refracted))
                     : refracted);
    return mlir::success();
  }
};

/// A hidden value stays hidden until arithmetic has been widened, or checked.
struct ConvertHide : ConvertOpToLLVMPattern<ir::HideOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::HideOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOpWithNewOp<LLVM::FreezeOp>(op, adaptor.getValue());
    return mlir::success();
  }
};

/// LLVM's saturating conversions give 0 for NaN, like the ops.
template <typename Op>
struct ConvertToInt : ConvertOpToLLVMPattern<Op> {
  using ConvertOpToLLVMPattern<Op>::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(Op op, typename Op::Adaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    constexpr bool isSigned = std::is_same_v<Op, ir::ToSintOp>;
    rewriter.replaceOpWithNewOp<LLVM::CallIntrinsicOp>(
        op, op.getType(), rewriter.getStringAttr(isSigned ? "llvm.fptosi.sat" : "llvm.fptoui.sat"),
        mlir::ValueRange(adaptor.getInput()));
    return mlir::success();
  }
};

//     safe  = b == 0 (|| signed && b == -1 && a == smallest) ? 1 : b
//     a / b = b == 0 ? 0 : a / safe      a % b = a % safe, which is 0 where it matters
template <typename Op, typename LlvmOp, bool isSigned, bool isQuotient>
struct ConvertDivision : ConvertOpToLLVMPattern<Op> {
  using ConvertOpToLLVMPattern<Op>::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(Op op, typename Op::Adaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Location location = op.getLoc();
    mlir::Type type = op.getType();
    Value a = adaptor.getLhs(), b = adaptor.getRhs();
    auto constant = [&](int64_t value) { return constantLike(rewriter, location, type, value); };
    auto equal = [&](Value x, int64_t value) -> Value {
      return LLVM::ICmpOp::create(rewriter, location, LLVM::ICmpPredicate::eq, x, constant(value));
    };
    Value isZero = equal(b, 0);
    Value isUnsafe = isZero;
    if (isSigned) {
      Value isSmallest = equal(a, std::numeric_limits<int32_t>::min());
      Value isMinusOne = equal(b, -1);
      Value overflows = LLVM::AndOp::create(rewriter, location, isMinusOne, isSmallest);
      isUnsafe = LLVM::OrOp::create(rewriter, location, isZero, overflows);
    }
    Value safe = LLVM::SelectOp::create(rewriter, location, isUnsafe, constant(1), b);
    Value result = LlvmOp::create(rewriter, location, a, safe);
    if (isQuotient)
      result = LLVM::SelectOp::create(rewriter, location, isZero, constant(0), result);
    rewriter.replaceOp(op, result);
    return mlir::success();
  }
};

} // namespace

void addNumberPatterns(mlir::LLVMTypeConverter &converter, mlir::RewritePatternSet &patterns) {
  patterns.add<ConvertElementary, ConvertRefract, ConvertHide, ConvertToInt<ir::ToSintOp>,
               ConvertToInt<ir::ToUintOp>, ConvertDivision<ir::SDivOp, LLVM::SDivOp, true, true>,
               ConvertDivision<ir::UDivOp, LLVM::UDivOp, false, true>,
               ConvertDivision<ir::SRemOp, LLVM::SRemOp, true, false>,
               ConvertDivision<ir::URemOp, LLVM::URemOp, false, false>>(converter);
}

} // namespace rtsl::codegen
