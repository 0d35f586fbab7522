//===- PassFrame.cpp - the frame as a parameter of a state ----------------===//
#include "codegen/passes/continuation/states/PassFrame.h"
#include "codegen/ir/Attributes.h"
#include "runtime/device/ray/Abi.h"

#include "mlir/Dialect/Arith/IR/Arith.h"

namespace rtsl::continuation {

namespace arith = mlir::arith;

namespace {

class FrameExpander {
public:
  FrameExpander(FuncOp state, const StateNumbers &numbers)
      : state(state), numbers(numbers), builder(state.getContext()) {}
  mlir::LogicalResult run();

private:
  void expand(ir::FrameLoadOp load);
  void expand(ir::FrameStoreOp store);
  mlir::LogicalResult expand(ir::EnterOp call);
  void expand(ir::CallReturnedOp returned);
  void expand(ir::LeaveOp leave);

  mlir::Value address(mlir::Location location, std::uint32_t offset, mlir::Type type);
  void keep(mlir::Value value, std::uint32_t offset);
  mlir::Value loadFrom(mlir::Location location, std::uint32_t offset, mlir::Type type);

  mlir::Value constant(mlir::Location location, std::int32_t value) {
    return arith::ConstantOp::create(builder, location, builder.getI32IntegerAttr(value));
  }

  FuncOp state;
  const StateNumbers &numbers;
  mlir::OpBuilder builder;
  mlir::Value frame;
  std::uint32_t frameSize = 0; // as its callees use it: addresses take eight bytes
};

mlir::Value FrameExpander::address(mlir::Location location, std::uint32_t offset, mlir::Type type) {
  return ir::FrameSlotOp::create(builder, location, ir::PtrType::get(type), frame, offset);
}

/// A bool is bit `bit` of its word.
void FrameExpander::expand(ir::FrameLoadOp load) {
  builder.setInsertionPoint(load);
  mlir::Location location = load.getLoc();
  mlir::Type type = load.getResult().getType();
  bool isBit = load.getBit().has_value();
  mlir::Value slot = address(location, load.getOffset(), isBit ? builder.getI32Type() : type);
  mlir::Value value = ir::LoadOp::create(builder, location, slot);
  if (isBit) {
    mlir::Value mask = constant(location, static_cast<std::int32_t>(1u << *load.getBit()));
    mlir::Value masked = arith::AndIOp::create(builder, location, value, mask);
    value = arith::CmpIOp::create(builder, location, arith::CmpIPredicate::ne, masked,
                                  constant(location, 0));
  }
  load.getResult().replaceAllUsesWith(value);
  load.erase();
}

void FrameExpander::expand(ir::FrameStoreOp store) {
  builder.setInsertionPoint(store);
  mlir::Location location = store.getLoc();
  mlir::Value value = store.getValue();
  bool isBit = store.getBit().has_value();
  mlir::Value slot =
      address(location, store.getOffset(), isBit ? builder.getI32Type() : value.getType());
  if (isBit) {
    std::int32_t mask = static_cast<std::int32_t>(1u << *store.getBit());
    mlir::Value word = ir::LoadOp::create(builder, location, slot);
    mlir::Value set = arith::OrIOp::create(builder, location, word, constant(location, mask));
    mlir::Value cleared = arith::AndIOp::create(builder, location, word, constant(location, ~mask));
    value = arith::SelectOp::create(builder, location, value, set, cleared);
  }
  ir::StoreOp::create(builder, location, value, slot);
  store.erase();
}

//===----------------------------------------------------------------------===//
// Calls with a frame of their own
//===----------------------------------------------------------------------===//

void FrameExpander::keep(mlir::Value value, std::uint32_t offset) {
  mlir::Location location = value.getLoc();
  if (llvm::isa<ir::PtrType>(value.getType()))
    ir::KeepAddressOp::create(builder, location, value,
                              address(location, offset, builder.getI32Type()));
  else
    ir::StoreOp::create(builder, location, value, address(location, offset, value.getType()));
}

mlir::Value FrameExpander::loadFrom(mlir::Location location, std::uint32_t offset,
                                    mlir::Type type) {
  if (llvm::isa<ir::PtrType>(type))
    return ir::KeptAddressOp::create(builder, location, type,
                                     address(location, offset, builder.getI32Type()));
  return ir::LoadOp::create(builder, location, address(location, offset, type));
}

/// The callee's frame begins at the end of this one.
mlir::LogicalResult FrameExpander::expand(ir::EnterOp call) {
  builder.setInsertionPoint(call);
  mlir::Location location = call.getLoc();
  const std::int32_t resume = numbers.lookup(call.getResume().value_or(""));
  if (resume == 0)
    return call.emitOpError() << "resumes in `" << call.getResume().value_or("")
                              << "`, which is no state";
  mlir::Value own = objectOf(state);
  if (!own)
    own =
        ir::NullRefOp::create(builder, location, ir::RefType::get(builder.getContext(), "object"));
  keep(constant(location, resume), frameSize + RTSL_CALL_RESUME);
  keep(own, frameSize + RTSL_CALL_OBJECT);
  keep(constant(location, static_cast<std::int32_t>(frameSize)), frameSize + RTSL_CALL_BELOW);
  mlir::OperandRange arguments = call.getOperands();
  mlir::Value object = own;
  if (arguments.size() > call.getOffsets().size()) {
    object = arguments.front();
    arguments = arguments.drop_front();
  }
  for (auto [value, offset] : llvm::zip(arguments, call.getOffsets()))
    keep(value, frameSize + static_cast<std::uint32_t>(offset));
  ir::MoveFrameOp::create(builder, location,
                          constant(location, static_cast<std::int32_t>(frameSize)), object);
  call.erase();
  return mlir::success();
}

void FrameExpander::expand(ir::CallReturnedOp returned) {
  builder.setInsertionPoint(returned);
  for (auto [result, offset] : llvm::zip(returned.getResults(), returned.getOffsets()))
    result.replaceAllUsesWith(loadFrom(
        returned.getLoc(), frameSize + static_cast<std::uint32_t>(offset), result.getType()));
  returned.erase();
}

void FrameExpander::expand(ir::LeaveOp leave) {
  builder.setInsertionPoint(leave);
  mlir::Location location = leave.getLoc();
  mlir::Value below = loadFrom(location, RTSL_CALL_BELOW, builder.getI32Type());
  mlir::Value down = arith::SubIOp::create(builder, location, constant(location, 0), below);
  mlir::Value object =
      loadFrom(location, RTSL_CALL_OBJECT, ir::RefType::get(builder.getContext(), "object"));
  ir::MoveFrameOp::create(builder, location, down, object);
  leave.erase();
}

//===----------------------------------------------------------------------===//
// All operations of a state
//===----------------------------------------------------------------------===//

mlir::LogicalResult FrameExpander::run() {
  mlir::Type frameType = ir::PtrType::get(builder.getI32Type());
  (void)state.insertArgument(state.getNumArguments(), frameType, {}, state.getLoc());
  frame = state.getArgument(state.getNumArguments() - 1);
  if (auto size = ir::attr::frameSize.of(state))
    frameSize = (static_cast<std::uint32_t>(size.getInt()) + 7) / 8 * 8;
  bool isFine = true;
  state.walk([&](mlir::Operation *op) {
    if (auto call = llvm::dyn_cast<ir::EnterOp>(op)) {
      isFine &= mlir::succeeded(expand(call));
    } else if (auto returned = llvm::dyn_cast<ir::CallReturnedOp>(op)) {
      expand(returned);
    } else if (auto leave = llvm::dyn_cast<ir::LeaveOp>(op)) {
      expand(leave);
    } else if (auto argument = llvm::dyn_cast<ir::CallArgumentOp>(op)) {
      builder.setInsertionPoint(argument);
      argument.replaceAllUsesWith(
          loadFrom(argument.getLoc(), argument.getOffset(), argument.getType()));
      argument.erase();
    } else if (auto result = llvm::dyn_cast<ir::CallResultOp>(op)) {
      builder.setInsertionPoint(result);
      keep(result.getValue(), result.getOffset());
      result.erase();
    } else if (auto load = llvm::dyn_cast<ir::FrameLoadOp>(op)) {
      expand(load);
    } else if (auto store = llvm::dyn_cast<ir::FrameStoreOp>(op)) {
      expand(store);
    } else if (auto object = llvm::dyn_cast<ir::FrameObjectOp>(op)) {
      builder.setInsertionPoint(object);
      mlir::Type type = llvm::cast<ir::PtrType>(object.getType()).getPointee();
      object.replaceAllUsesWith(address(object.getLoc(), object.getOffset(), type));
      object.erase();
    } else if (llvm::isa<ir::TraceReturnedOp>(op)) {
      op->erase();
    } else if (auto end = llvm::dyn_cast<ir::EndOp>(op)) {
      builder.setInsertionPoint(end);
      mlir::func::ReturnOp::create(builder, end.getLoc(), end.getNext());
      end.erase();
    }
  });
  return mlir::success(isFine);
}

} // namespace

mlir::LogicalResult passFrame(FuncOp state, const StateNumbers &numbers) {
  return FrameExpander(state, numbers).run();
}

} // namespace rtsl::continuation
