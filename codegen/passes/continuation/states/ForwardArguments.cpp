//===- ForwardArguments.cpp - block arguments with one incoming value -----===//
//
//   cond_br ..., ^a(%v), ^b(%v)                 cond_br ..., ^a, ^b
//   ^a(%x): br ^b(%x)                   ==>     ^a: br ^b
//   ^b(%y): cond_br ..., ^a(%y), ^c             ^b: cond_br ..., ^a, ^c        and %v for %x and %y
//
// A state has fewer edges than the function it was split from, so a block argument may get only one
// value. Arguments that pass each other on in a loop are a strongly connected component of the
// graph from arguments to their incoming values. A component with a single incoming value is
// replaced by it; in one with several, those arguments are examined separately that get values only
// from the component (Braun et al., "Simple and Efficient Construction of Static Single Assignment
// Form", 2013, algorithm 5).
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/IncomingEdges.h"
#include "codegen/passes/Components.h"
#include "codegen/passes/continuation/states/Steps.h"

#include "llvm/ADT/MapVector.h"

namespace rtsl::continuation {

namespace {

using mlir::Value;
using Arguments = Components<Value>::Part;

class Forwarder {
public:
  explicit Forwarder(FuncOp function) : function(function) {}
  void run();

private:
  void collect(mlir::Block &block);
  Value resolve(Value value) const;
  void forward(const Arguments &part);
  void forwardComponent(const Arguments &component);
  void erase(mlir::Block &block);

  FuncOp function;
  llvm::MapVector<Value, llvm::SmallVector<Value>> incoming; // of each argument
  llvm::DenseMap<Value, Value> forwarded;                    // its replacement
};

void Forwarder::collect(mlir::Block &block) {
  for (mlir::BlockArgument argument : block.getArguments()) {
    llvm::SmallVector<Value> passed;
    ir::forEachEdgeInto(block, [&](ir::Edge edge) { passed.push_back(edge.passedTo(argument)); });
    if (!llvm::is_contained(passed, Value())) // no terminator produces the value itself
      incoming.insert({argument, std::move(passed)});
  }
}

Value Forwarder::resolve(Value value) const {
  for (auto known = forwarded.find(value); known != forwarded.end(); known = forwarded.find(value))
    value = known->second;
  return value;
}

void Forwarder::forwardComponent(const Arguments &component) {
  Value only;
  bool several = false;
  Arguments inner;
  for (Value argument : component) {
    bool isInner = true;
    for (Value operand : incoming.find(argument)->second) {
      const Value value = resolve(operand);
      if (component.contains(value))
        continue;
      isInner = false;
      several |= only && only != value;
      only = value;
    }
    if (isInner)
      inner.insert(argument);
  }
  if (!several && only)
    for (Value argument : component)
      forwarded[argument] = only;
  else if (inner.size() < component.size())
    forward(inner);
}

void Forwarder::forward(const Arguments &part) {
  const auto operands = [&](Value argument, llvm::function_ref<void(Value)> visit) {
    llvm::for_each(incoming.find(argument)->second, visit);
  };
  for (const Arguments &component : Components<Value>::of(part, operands))
    forwardComponent(component);
}

void Forwarder::erase(mlir::Block &block) {
  for (unsigned i = block.getNumArguments(); i-- > 0;) {
    if (!forwarded.count(block.getArgument(i)))
      continue;
    ir::forEachEdgeInto(block, [&](ir::Edge edge) { edge.operands().erase(i); });
    block.eraseArgument(i);
  }
}

void Forwarder::run() {
  for (mlir::Block &block : llvm::drop_begin(function.getBody()))
    if (block.getNumArguments() != 0)
      collect(block);
  Arguments all;
  for (const auto &entry : incoming)
    all.insert(entry.first);
  forward(all);
  for (Value argument : all)
    if (forwarded.count(argument))
      argument.replaceAllUsesWith(resolve(argument));
  for (mlir::Block &block : llvm::drop_begin(function.getBody()))
    erase(block);
}

} // namespace

void forwardArguments(FuncOp function) {
  Forwarder(function).run();
}

} // namespace rtsl::continuation
