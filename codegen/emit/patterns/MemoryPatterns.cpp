//===- MemoryPatterns.cpp - memory and references to LLVM -----------------===//
#include "codegen/emit/SceneTables.h"
#include "codegen/emit/patterns/Patterns.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/BaseAddress.h"
#include "codegen/ir/ClassTable.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/dialect/RtslOps.h"
#include "runtime/device/ray/State.h"

#include "mlir/Conversion/LLVMCommon/Pattern.h"
#include "mlir/Interfaces/FunctionInterfaces.h"

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;
using mlir::ConversionPatternRewriter;
using mlir::ConvertOpToLLVMPattern;
using mlir::Location;
using mlir::LogicalResult;
using mlir::Value;

namespace {

bool isBool(mlir::Type type) {
  return mlir::getElementTypeOrSelf(type).isInteger(1);
}

/// The type of a value in memory: bools are i32.
mlir::Type memoryType(const mlir::TypeConverter &converter, mlir::Type type) {
  return isBool(type) ? ir::intLike(type) : converter.convertType(type);
}

/// Whether the memory at `address` does not change while the program runs: it is part of a
/// constant, a member or a buffer that is no output, and the code does not belong to a constructor.
bool isInvariant(Value address) {
  if (ir::isInOutputBuffer(address))
    return false;
  mlir::Operation *variable = ir::variableOperation(address);
  if (!llvm::isa_and_nonnull<ir::MemberOp>(variable))
    return llvm::isa_and_nonnull<ir::TableOp>(variable);
  auto function = variable->getParentOfType<mlir::FunctionOpInterface>();
  return function && !ir::attr::writesMembers.isOn(function);
}

/// `base[index]` for an index in range and elements of `size` bytes.
Value indexedAddress(mlir::OpBuilder &builder, Location location, Value base, Value index,
                     uint32_t size) {
  mlir::Type element = LLVM::LLVMArrayType::get(builder.getI8Type(), size);
  return LLVM::GEPOp::create(builder, location, base.getType(), element, base,
                             llvm::ArrayRef<LLVM::GEPArg>{index}, LLVM::GEPNoWrapFlags::inbounds);
}

Value widen(mlir::OpBuilder &builder, Location location, Value index) {
  return LLVM::ZExtOp::create(builder, location, builder.getI64Type(), index);
}

void fillWithZeros(mlir::OpBuilder &builder, Location location, Value address, uint32_t size) {
  Value zero = LLVM::ConstantOp::create(builder, location, builder.getI8IntegerAttr(0));
  Value length = LLVM::ConstantOp::create(builder, location, builder.getI64IntegerAttr(size));
  LLVM::MemsetOp::create(builder, location, address, zero, length, /*isVolatile=*/false);
}

//===----------------------------------------------------------------------===//
// Variables, loads, stores
//===----------------------------------------------------------------------===//

/// A variable that was not promoted is a stack slot, and is zero each time that control reaches it.
struct ConvertVar : ConvertOpToLLVMPattern<ir::VarOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::VarOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    uint32_t size = ir::sizeInBytes(ir::pointee(op.getResult()));
    Value slot = stackSlot(rewriter, op.getLoc(), size);
    fillWithZeros(rewriter, op.getLoc(), slot, size);
    rewriter.replaceOp(op, slot);
    return mlir::success();
  }
};

struct ConvertClear : ConvertOpToLLVMPattern<ir::ClearOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::ClearOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    fillWithZeros(rewriter, op.getLoc(), adaptor.getAddress(),
                  ir::sizeInBytes(ir::pointee(op.getAddress())));
    rewriter.eraseOp(op);
    return mlir::success();
  }
};

struct ConvertLoad : ConvertOpToLLVMPattern<ir::LoadOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::LoadOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Type type = memoryType(*getTypeConverter(), op.getType());
    Value value =
        loadFrom(rewriter, op.getLoc(), type, adaptor.getAddress(), isInvariant(op.getAddress()));
    if (isBool(op.getType()))
      value = LLVM::ICmpOp::create(rewriter, op.getLoc(), LLVM::ICmpPredicate::ne, value,
                                   constantLike(rewriter, op.getLoc(), type, 0));
    rewriter.replaceOp(op, value);
    return mlir::success();
  }
};

/// `address`, or `slot` instead in a sample that an exception has ended.
Value slotIfAbandoned(mlir::OpBuilder &builder, Location location, Value slot, Value address) {
  Value over = callRuntime(builder, location, isAbandonedFunction, {rayState(builder)});
  Value isOver = LLVM::ICmpOp::create(builder, location, LLVM::ICmpPredicate::ne, over,
                                      constantLike(builder, location, over.getType(), 0));
  return LLVM::SelectOp::create(builder, location, isOver, slot, address);
}

/// Where a store to `address` goes, with elements of `size` bytes: a sample that an exception has
/// ended no longer writes to output buffers.
Value whereToStore(mlir::OpBuilder &builder, Location location, Value source, Value address,
                   uint32_t size) {
  if (!ir::isInOutputBuffer(source))
    return address;
  return slotIfAbandoned(builder, location, stackSlot(builder, location, size), address);
}

struct ConvertStore : ConvertOpToLLVMPattern<ir::StoreOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::StoreOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Value value = adaptor.getValue();
    if (isBool(value.getType()))
      value = LLVM::ZExtOp::create(rewriter, op.getLoc(), ir::intLike(value.getType()), value);
    Value address = whereToStore(rewriter, op.getLoc(), op.getAddress(), adaptor.getAddress(),
                                 ir::sizeInBytes(ir::pointee(op.getAddress())));
    rewriter.replaceOpWithNewOp<LLVM::StoreOp>(op, value, address, ir::memoryAlignment);
    return mlir::success();
  }
};

struct ConvertCopy : ConvertOpToLLVMPattern<ir::CopyOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::CopyOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    uint32_t size = ir::sizeInBytes(ir::pointee(op.getSource()));
    Value length =
        LLVM::ConstantOp::create(rewriter, op.getLoc(), rewriter.getI64IntegerAttr(size));
    Value target = whereToStore(rewriter, op.getLoc(), op.getTarget(), adaptor.getTarget(), size);
    rewriter.replaceOpWithNewOp<LLVM::MemcpyOp>(op, target, adaptor.getSource(), length,
                                                /*isVolatile=*/false);
    return mlir::success();
  }
};

LLVM::AtomicBinOp binaryOf(ir::AtomicKind kind) {
  switch (kind) {
  case ir::AtomicKind::Add:
    return LLVM::AtomicBinOp::add;
  case ir::AtomicKind::MinSigned:
    return LLVM::AtomicBinOp::min;
  case ir::AtomicKind::MaxSigned:
    return LLVM::AtomicBinOp::max;
  case ir::AtomicKind::MinUnsigned:
    return LLVM::AtomicBinOp::umin;
  case ir::AtomicKind::MaxUnsigned:
    return LLVM::AtomicBinOp::umax;
  case ir::AtomicKind::And:
    return LLVM::AtomicBinOp::_and;
  case ir::AtomicKind::Or:
    return LLVM::AtomicBinOp::_or;
  case ir::AtomicKind::Xor:
    return LLVM::AtomicBinOp::_xor;
  case ir::AtomicKind::Exchange:
  case ir::AtomicKind::CompareExchange:
    return LLVM::AtomicBinOp::xchg;
  }
  llvm_unreachable("all kinds have been handled");
}

/// The order of other memory accesses does not matter: launch indices share nothing else. A sample
/// that an exception has ended changes a copy of the element, so that the result is its value.
struct ConvertAtomic : ConvertOpToLLVMPattern<ir::AtomicOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::AtomicOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    constexpr auto order = LLVM::AtomicOrdering::monotonic;
    Location location = op.getLoc();
    Value copy = stackSlot(rewriter, location, sizeof(uint32_t));
    Value element = LLVM::LoadOp::create(
        rewriter, location, op.getType(), adaptor.getAddress(), ir::memoryAlignment,
        /*isVolatile=*/false, /*isNonTemporal=*/false, /*isInvariant=*/false,
        /*isInvariantGroup=*/false, LLVM::AtomicOrdering::unordered);
    LLVM::StoreOp::create(rewriter, location, element, copy, ir::memoryAlignment);
    Value address = slotIfAbandoned(rewriter, location, copy, adaptor.getAddress());
    if (Value expected = adaptor.getExpected()) {
      Value exchange =
          LLVM::AtomicCmpXchgOp::create(rewriter, location, address, expected, adaptor.getValue(),
                                        order, order, {}, ir::memoryAlignment);
      rewriter.replaceOpWithNewOp<LLVM::ExtractValueOp>(op, exchange, 0);
      return mlir::success();
    }
    rewriter.replaceOpWithNewOp<LLVM::AtomicRMWOp>(op, binaryOf(op.getKind()), address,
                                                   adaptor.getValue(), order, llvm::StringRef(),
                                                   ir::memoryAlignment);
    return mlir::success();
  }
};

//===----------------------------------------------------------------------===//
// Addresses
//===----------------------------------------------------------------------===//

struct ConvertField : ConvertOpToLLVMPattern<ir::FieldOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::FieldOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    auto type = llvm::cast<ir::StructType>(ir::pointee(op.getBase()));
    uint32_t offset = ir::fieldOffset(type, *type.fieldIndex(op.getField()));
    rewriter.replaceOp(op, offsetAddress(rewriter, op.getLoc(), adaptor.getBase(), offset));
    return mlir::success();
  }
};

struct ConvertElement : ConvertOpToLLVMPattern<ir::ElementOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::ElementOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    uint32_t size = ir::sizeInBytes(ir::pointee(op.getResult()));
    Value index = widen(rewriter, op.getLoc(), adaptor.getIndex());
    rewriter.replaceOp(op, indexedAddress(rewriter, op.getLoc(), adaptor.getBase(), index, size));
    return mlir::success();
  }
};

/// The address of the records that the launch has.
Value launchRecords(mlir::OpBuilder &builder, Location location) {
  Value field = launchAddress(builder, location, offsetof(RtslLaunch, records));
  return LLVM::LoadOp::create(builder, location, field.getType(), field, alignof(void *), false,
                              false, /*isInvariant=*/true);
}

/// The address of the scene's records: of its table of constants, if the program has one.
Value recordsAddress(mlir::OpBuilder &builder, Location location) {
  Value table = sceneRecords(builder, location);
  return table ? table : launchRecords(builder, location);
}

struct ConvertMember : ConvertOpToLLVMPattern<ir::MemberOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::MemberOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    const int64_t offset = ir::attr::offset.of(op).getInt();
    Location location = op.getLoc();
    Value records = ir::attr::editable.isOn(op) ? launchRecords(rewriter, location)
                                                : recordsAddress(rewriter, location);
    Value record = indexedAddress(rewriter, location, records,
                                  widen(rewriter, location, adaptor.getObject()), 1);
    rewriter.replaceOp(op,
                       offsetAddress(rewriter, location, record, static_cast<uint32_t>(offset)));
    return mlir::success();
  }
};

/// Bytes from the start of RtslState to a state variable.
uint32_t stateOffset(llvm::StringRef name) {
#define RTSL_STATE_VARIABLE(variable, type, ...)                                                   \
  if (name == #variable)                                                                           \
    return offsetof(RtslState, variable);
#include "language/StateVariables.def"
  if (name == "hitError")
    return offsetof(RtslState, hitError);
  llvm_unreachable("the verifier checks the names");
}

struct ConvertTable : ConvertOpToLLVMPattern<ir::TableOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::TableOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    auto symbol = ir::attr::symbol.of(op);
    rewriter.replaceOpWithNewOp<LLVM::AddressOfOp>(op, LLVM::LLVMPointerType::get(op.getContext()),
                                                   symbol.getValue());
    return mlir::success();
  }
};

struct ConvertState : ConvertOpToLLVMPattern<ir::StateOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::StateOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOp(
        op, offsetAddress(rewriter, op.getLoc(), rayState(rewriter), stateOffset(op.getName())));
    return mlir::success();
  }
};

struct ConvertKeepAddress : ConvertOpToLLVMPattern<ir::KeepAddressOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::KeepAddressOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOpWithNewOp<LLVM::StoreOp>(op, adaptor.getValue(), adaptor.getSlot(),
                                               alignof(void *));
    return mlir::success();
  }
};

struct ConvertKeptAddress : ConvertOpToLLVMPattern<ir::KeptAddressOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::KeptAddressOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    mlir::Type pointer = LLVM::LLVMPointerType::get(op.getContext());
    rewriter.replaceOpWithNewOp<LLVM::LoadOp>(op, pointer, adaptor.getSlot(), alignof(void *));
    return mlir::success();
  }
};

struct ConvertFrameSlot : ConvertOpToLLVMPattern<ir::FrameSlotOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::FrameSlotOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOp(op,
                       offsetAddress(rewriter, op.getLoc(), adaptor.getFrame(), op.getOffset()));
    return mlir::success();
  }
};

struct ConvertAttribute : ConvertOpToLLVMPattern<ir::AttributeOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::AttributeOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    uint32_t offset = offsetof(RtslState, attributes) + *op.getOffset() * sizeof(uint32_t);
    rewriter.replaceOp(op, offsetAddress(rewriter, op.getLoc(), rayState(rewriter), offset));
    return mlir::success();
  }
};

//===----------------------------------------------------------------------===//
// Buffers
//===----------------------------------------------------------------------===//

Value bufferSize(mlir::OpBuilder &builder, Location location, Value buffer, unsigned dimension,
                 bool invariant) {
  Value address = offsetAddress(builder, location, buffer,
                                offsetof(RtslBuffer, size) + dimension * sizeof(uint32_t));
  return loadFrom(builder, location, builder.getI32Type(), address, invariant);
}

struct ConvertBufferElement : ConvertOpToLLVMPattern<ir::BufferElementOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::BufferElementOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Location location = op.getLoc();
    bool invariant = isInvariant(op.getBuffer());
    Value buffer = adaptor.getBuffer();

    // The two halves of the address are adjacent, so one load reads both.
    static_assert(offsetof(RtslBuffer, addressHigh) == offsetof(RtslBuffer, addressLow) + 4);
    Value base = loadFrom(
        rewriter, location, buffer.getType(),
        offsetAddress(rewriter, location, buffer, offsetof(RtslBuffer, addressLow)), invariant);

    // The first index is the slowest: ((i * size[1]) + j) * size[2] + k.
    Value index = widen(rewriter, location, adaptor.getIndices().front());
    for (auto [dimension, next] : llvm::enumerate(adaptor.getIndices().drop_front())) {
      Value size = bufferSize(rewriter, location, buffer, dimension + 1, invariant);
      index = LLVM::MulOp::create(rewriter, location, index, widen(rewriter, location, size));
      index = LLVM::AddOp::create(rewriter, location, index, widen(rewriter, location, next));
    }
    rewriter.replaceOp(op, indexedAddress(rewriter, location, base, index,
                                          ir::sizeInBytes(ir::pointee(op.getResult()))));
    return mlir::success();
  }
};

struct ConvertBufferLength : ConvertOpToLLVMPattern<ir::BufferLengthOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::BufferLengthOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOp(op, bufferSize(rewriter, op.getLoc(), adaptor.getBuffer(), op.getDim(),
                                      isInvariant(op.getBuffer())));
    return mlir::success();
  }
};

//===----------------------------------------------------------------------===//
// References
//===----------------------------------------------------------------------===//

struct ConvertNullRef : ConvertOpToLLVMPattern<ir::NullRefOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::NullRefOp op, OpAdaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOp(op, constantLike(rewriter, op.getLoc(), rewriter.getI32Type(), 0));
    return mlir::success();
  }
};

struct ConvertCastRef : ConvertOpToLLVMPattern<ir::CastRefOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::CastRefOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOp(op, adaptor.getObject());
    return mlir::success();
  }
};

struct ConvertEqualRef : ConvertOpToLLVMPattern<ir::EqualRefOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::EqualRefOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    rewriter.replaceOpWithNewOp<LLVM::ICmpOp>(op, LLVM::ICmpPredicate::eq, adaptor.getLhs(),
                                              adaptor.getRhs());
    return mlir::success();
  }
};

/// The first word of the record. The null reference has a record of its own, where it is 0: no
/// branch is needed.
struct ConvertClassId : ConvertOpToLLVMPattern<ir::ClassIdOp> {
  using ConvertOpToLLVMPattern::ConvertOpToLLVMPattern;
  LogicalResult matchAndRewrite(ir::ClassIdOp op, OpAdaptor adaptor,
                                ConversionPatternRewriter &rewriter) const override {
    Location location = op.getLoc();
    mlir::Type i32 = rewriter.getI32Type();
    Value records = recordsAddress(rewriter, location);
    // Not `inbounds`: if the reference is null there may be no records at all.
    Value record = LLVM::GEPOp::create(
        rewriter, location, records.getType(), rewriter.getI8Type(), records,
        llvm::ArrayRef<LLVM::GEPArg>{widen(rewriter, location, adaptor.getObject())});
    Value none = LLVM::AddressOfOp::create(rewriter, location, records.getType(), nullRecord);
    Value isNull =
        LLVM::ICmpOp::create(rewriter, location, LLVM::ICmpPredicate::eq, adaptor.getObject(),
                             constantLike(rewriter, location, i32, 0));
    Value address = LLVM::SelectOp::create(rewriter, location, isNull, none, record);
    rewriter.replaceOp(op, loadFrom(rewriter, location, i32, address, /*isInvariant=*/true));
    return mlir::success();
  }
};

} // namespace

void addMemoryPatterns(mlir::LLVMTypeConverter &converter, mlir::RewritePatternSet &patterns) {
  patterns.add<ConvertVar, ConvertClear, ConvertLoad, ConvertStore, ConvertCopy, ConvertAtomic,
               ConvertField, ConvertElement, ConvertMember, ConvertTable, ConvertState,
               ConvertFrameSlot, ConvertKeepAddress, ConvertKeptAddress, ConvertAttribute,
               ConvertBufferElement, ConvertBufferLength, ConvertNullRef, ConvertCastRef,
               ConvertEqualRef, ConvertClassId>(converter);
}

} // namespace rtsl::codegen
