//===- SplitStates.cpp - a function for each resume point -----------------===//
//
//   func @f {                       func @f.state0 {              func @f.state1 {
//     %i = 0                          %i = 0                        %c = rtsl.trace_result
//     br ^loop(%i)                    br ^loop(%i)                  %i = rtsl.frame_load
//   ^loop(%i):                      ^loop(%i):                      cond_br ..., ^loop, ^exit
//     rtsl.frame_store %i             rtsl.frame_store %i         ^loop(%i):
//     rtsl.suspend ..., ^r    ==>     rtsl.spawn ...                rtsl.frame_store %i
//   ^r:                               %n = rtsl.next trace @f.state1  rtsl.spawn ...
//     %c = rtsl.trace_result          rtsl.end %n                   %n = rtsl.next trace @f.state1
//     %i = rtsl.frame_load          }                               rtsl.end %n
//     cond_br ..., ^loop, ^exit                                   ^exit:
//   ^exit:                                                          %n = rtsl.next done
//     return                                                        rtsl.end %n
//   }                                                             }
//
// Each state gets a copy of the blocks that its beginning reaches before the next trace: code on
// several paths, such as `^loop` here, is duplicated.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Slots.h"
#include "codegen/passes/continuation/states/Steps.h"
#include "codegen/passes/continuation/suspend/CutJoins.h"

#include "mlir/IR/IRMapping.h"
#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::continuation {

namespace {

/// A call that is a jump to the first state of the callee; nothing follows it.
bool isJump(mlir::Operation &op) {
  return ir::attr::tail.isOn(&op);
}

class Splitter {
public:
  explicit Splitter(FuncOp function) : function(function), suspends(suspendsOf(function)) {
    for (auto [number, suspend] : llvm::enumerate(suspends))
      numbers[suspend] = number;
  }
  llvm::SmallVector<FuncOp> run();

private:
  std::string stateName(unsigned index) {
    return (function.getSymName() + ".state" + llvm::Twine(index)).str();
  }
  llvm::SmallVector<mlir::Block *> reachableFrom(mlir::Block *start);
  FuncOp makeState(unsigned index, mlir::Block *start);
  void cloneBlock(mlir::Block *from, mlir::IRMapping &mapping);
  void endState(mlir::OpBuilder &builder, mlir::Location location, ir::Transition transition,
                llvm::StringRef state = {});

  FuncOp function;
  llvm::SmallVector<ir::SuspendOp> suspends;
  llvm::DenseMap<mlir::Operation *, unsigned> numbers;
};

/// Blocks up to the next trace, in reverse postorder: definitions come before uses.
llvm::SmallVector<mlir::Block *> Splitter::reachableFrom(mlir::Block *start) {
  llvm::SmallVector<mlir::Block *> postorder;
  llvm::SmallPtrSet<mlir::Block *, 16> seen;
  llvm::SmallVector<std::pair<mlir::Block *, unsigned>> stack;
  auto successors = [](mlir::Block *block) -> unsigned {
    if (llvm::isa<ir::SuspendOp>(block->back()) || llvm::any_of(*block, isJump))
      return 0;
    return block->getNumSuccessors();
  };
  seen.insert(start);
  stack.push_back({start, 0});
  while (!stack.empty()) {
    auto &[block, next] = stack.back();
    if (next == successors(block)) {
      postorder.push_back(block);
      stack.pop_back();
      continue;
    }
    // Last successor first, so that the first one is first in the reversed order.
    mlir::Block *successor = block->getSuccessor(successors(block) - 1 - next++);
    if (seen.insert(successor).second)
      stack.push_back({successor, 0});
  }
  return {postorder.rbegin(), postorder.rend()};
}

void Splitter::endState(mlir::OpBuilder &builder, mlir::Location location,
                        ir::Transition transition, llvm::StringRef state) {
  mlir::FlatSymbolRefAttr symbol;
  if (!state.empty())
    symbol = mlir::FlatSymbolRefAttr::get(builder.getContext(), state);
  auto next = ir::NextOp::create(builder, location, builder.getI32Type(), transition, symbol);
  ir::EndOp::create(builder, location, next);
}

void Splitter::cloneBlock(mlir::Block *from, mlir::IRMapping &mapping) {
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(mapping.lookup(from));
  ir::EnterOp call; // the last one is that of the suspend
  for (mlir::Operation &op : *from) {
    if (isJump(op)) {
      std::string callee = llvm::cast<mlir::func::CallOp>(op).getCallee().str();
      endState(builder, op.getLoc(), ir::Transition::Jump, callee + ".state0");
      return;
    }
    if (auto suspend = llvm::dyn_cast<ir::SuspendOp>(op)) {
      if (suspend.getOrigin())
        ir::SpawnOp::create(builder, op.getLoc(), mapping.lookup(suspend.getOrigin()),
                            mapping.lookup(suspend.getDirection()), /*last=*/false);
      const unsigned index = numbers.lookup(suspend);
      if (llvm::isa<ir::CallReturnedOp>(suspend.getResume()->front())) {
        call.setResume(stateName(index + 1));
        endState(builder, op.getLoc(), ir::Transition::Jump, call.getCallee().str() + ".state0");
      } else if (ir::attr::join.isOn(suspend)) {
        endState(builder, op.getLoc(), ir::Transition::Jump, stateName(index + 1));
      } else {
        endState(builder, op.getLoc(), ir::Transition::Trace, stateName(index + 1));
      }
    } else if (llvm::isa<mlir::func::ReturnOp>(op)) {
      if (isFramed(function))
        ir::LeaveOp::create(builder, op.getLoc());
      endState(builder, op.getLoc(),
               isFramed(function)         ? ir::Transition::Return
               : ir::attr::last.isOn(&op) ? ir::Transition::Last
                                          : ir::Transition::Done);
    } else if (auto copy = llvm::dyn_cast<ir::EnterOp>(builder.clone(op, mapping))) {
      call = copy;
    }
  }
}

FuncOp Splitter::makeState(unsigned index, mlir::Block *start) {
  mlir::OpBuilder builder(function);
  mlir::Value object = objectOf(function);
  llvm::SmallVector<mlir::Type> inputs;
  if (index == 0)
    inputs.assign(function.getArgumentTypes().begin(), function.getArgumentTypes().end());
  else if (object)
    inputs.push_back(object.getType());
  auto state = FuncOp::create(builder, function.getLoc(), stateName(index),
                              builder.getFunctionType(inputs, {builder.getI32Type()}));
  state.setPrivate();
  for (llvm::StringRef name :
       {ir::attr::className.name, ir::attr::methodName.name, ir::attr::slot.name,
        ir::attr::dispatch.name, ir::attr::frameSize.name, ir::attr::framed.name})
    if (mlir::Attribute value = function->getAttr(name))
      state->setAttr(name, value);
  ir::attr::state.set(state, builder.getI32IntegerAttr(index));
  if (index == 0 && ir::attr::exported.isOn(function))
    ir::attr::entry.set(state, builder.getStringAttr(ir::finalSymbol(function)));

  mlir::IRMapping mapping;
  llvm::SmallVector<mlir::Block *> blocks = reachableFrom(start);
  for (mlir::Block *block : blocks) {
    mlir::Block *copy = new mlir::Block;
    state.getBody().push_back(copy);
    mapping.map(block, copy);
    if (block == start && index != 0)
      continue;
    for (mlir::BlockArgument argument : block->getArguments())
      mapping.map(argument, copy->addArgument(argument.getType(), argument.getLoc()));
  }
  if (index != 0 && object)
    mapping.map(object, state.getBody().front().addArgument(object.getType(), object.getLoc()));
  for (mlir::Block *block : blocks)
    cloneBlock(block, mapping);
  forwardArguments(state);
  return state;
}

llvm::SmallVector<FuncOp> Splitter::run() {
  llvm::SmallVector<FuncOp> states = {makeState(0, &function.getBody().front())};
  for (auto [index, suspend] : llvm::enumerate(suspends))
    states.push_back(makeState(index + 1, suspend.getResume()));
  function.erase();
  return states;
}

} // namespace

mlir::FailureOr<llvm::SmallVector<FuncOp>> splitStates(FuncOp function) {
  if (function.getNumResults() != 0)
    return function.emitError()
           << "`" << function.getSymName()
           << "` traces and returns a value, so it cannot be split into states";
  for (ir::SuspendOp suspend : suspendsOf(function))
    if (!suspend.getSaved().empty())
      return suspend.emitError() << "saves values that have no slot in the frame yet";
  return Splitter(function).run();
}

} // namespace rtsl::continuation
