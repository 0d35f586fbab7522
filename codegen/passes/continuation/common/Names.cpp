//===- Names.cpp - names of values in the source --------------------------===//
#include "codegen/passes/continuation/common/Names.h"

#include "codegen/ir/IncomingEdges.h"
#include "codegen/ir/NamedLocation.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/ir/SourcePlace.h"

#include "mlir/Dialect/Vector/IR/VectorOps.h"
#include "llvm/ADT/SmallPtrSet.h"

namespace rtsl::continuation {

static std::string nameOfAddress(mlir::Value address) {
  mlir::Operation *op = address.getDefiningOp();
  if (auto state = llvm::dyn_cast_or_null<ir::StateOp>(op))
    return state.getName().str();
  if (auto member = llvm::dyn_cast_or_null<ir::MemberOp>(op))
    return member.getMember().str();
  if (auto attribute = llvm::dyn_cast_or_null<ir::AttributeOp>(op))
    return attribute.getName().str();
  if (auto variable = llvm::dyn_cast_or_null<ir::VarOp>(op))
    return variable.getName().str();
  if (auto table = llvm::dyn_cast_or_null<ir::TableOp>(op))
    return table.getName().str();
  if (auto object = llvm::dyn_cast_or_null<ir::FrameObjectOp>(op))
    return object.getName().str();
  if (auto field = llvm::dyn_cast_or_null<ir::FieldOp>(op))
    return nameOfAddress(field.getBase()) + "." + field.getField().str();
  if (auto element = llvm::dyn_cast_or_null<ir::ElementOp>(op))
    return nameOfAddress(element.getBase()) + ".element";
  if (auto element = llvm::dyn_cast_or_null<ir::BufferElementOp>(op))
    return nameOfAddress(element.getBuffer()) + ".element";
  return "address";
}

/// The first name among the values that flow into a block argument.
static std::string nameOfArgument(mlir::BlockArgument argument,
                                  llvm::SmallPtrSetImpl<mlir::Block *> &seen) {
  mlir::Block *block = argument.getOwner();
  if (!seen.insert(block).second)
    return {};
  std::string name;
  ir::forEachEdgeInto(*block, [&](ir::Edge edge) {
    mlir::Value value = edge.passedTo(argument);
    if (!name.empty() || !value || value == argument)
      return;
    name = authorsName(value);
    if (auto outer = llvm::dyn_cast<mlir::BlockArgument>(value); outer && name.empty())
      name = nameOfArgument(outer, seen);
  });
  return name;
}

std::string sourceName(mlir::Value value) {
  std::string name = authorsName(value);
  if (!name.empty())
    return name;
  if (auto argument = llvm::dyn_cast<mlir::BlockArgument>(value)) {
    llvm::SmallPtrSet<mlir::Block *, 8> seen;
    name = nameOfArgument(argument, seen);
    if (!name.empty())
      return name;
    return argument.getOwner()->isEntryBlock() ? "argument" : "merged";
  }
  mlir::Operation *op = value.getDefiningOp();
  if (llvm::isa<ir::PtrType>(value.getType()))
    return nameOfAddress(value);
  if (auto load = llvm::dyn_cast<ir::LoadOp>(op))
    return nameOfAddress(load.getAddress());
  if (llvm::isa<ir::TraceResultOp>(op))
    return "traced";
  if (auto extract = llvm::dyn_cast<mlir::vector::ExtractOp>(op)) {
    std::string component = ".component";
    if (!extract.hasDynamicPosition() && extract.getStaticPosition().size() == 1 &&
        extract.getStaticPosition().front() < 4)
      component = std::string(".") + "xyzw"[extract.getStaticPosition().front()];
    return sourceName(extract.getSource()) + component;
  }
  return op->getName().stripDialect().str();
}

bool isNamedByCaller(mlir::Value value) {
  auto call = llvm::dyn_cast<mlir::CallSiteLoc>(value.getLoc());
  return call && ir::nameIn(call.getCallee()).isEmpty();
}

std::string authorsName(mlir::Value value) {
  return ir::nameIn(value.getLoc()).text;
}

std::string describeToAuthor(mlir::Value value) {
  std::string name = authorsName(value);
  if (auto argument = llvm::dyn_cast<mlir::BlockArgument>(value); argument && name.empty()) {
    llvm::SmallPtrSet<mlir::Block *, 8> seen;
    name = nameOfArgument(argument, seen);
  }
  if (auto load = value.getDefiningOp<ir::LoadOp>(); load && name.empty()) {
    name = nameOfAddress(load.getAddress());
    if (load.getAddress().getDefiningOp<ir::StateOp>())
      name = "rt_" + name;
  }
  if (!name.empty())
    return "`" + name + "`";
  const ir::SourcePlace place = ir::placeOf(value.getLoc());
  if (!place.isKnown())
    return "an intermediate value";
  const char *made = value.getDefiningOp<ir::TraceResultOp>() ? "returned" : "computed";
  return std::string("the value ") + made + " in line " + std::to_string(place.line);
}

std::string UniqueNames::unique(const std::string &name) {
  unsigned count = ++used[name];
  if (count == 1)
    return name;
  std::string numbered;
  do
    numbered = name + "." + std::to_string(count);
  while (used.count(numbered) && (count = ++used[name]));
  used[numbered] = 1;
  return numbered;
}

const std::string &UniqueNames::of(mlir::Value value) {
  auto [at, isNew] = names.try_emplace(value);
  if (isNew) {
    std::string name = unique(sourceName(value));
    at = names.find(value);
    at->second = name;
  }
  return at->second;
}

} // namespace rtsl::continuation
