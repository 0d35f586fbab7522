//===- EmptyReferences.cpp - optional members that the scene does not set -===//
//
//   %bump = rtsl.load (rtsl.member %self "bump")      %bump = rtsl.null_ref
//   rtsl.if (%bump is an object) { A } else { B }     rtsl.if false { } else { B }
//   %c = rtsl.call_method "lookup" on %bump           %c = 0
//
// If an optional member is empty in all objects of a class, it is never loaded or called, and code
// that runs only if it is set is removed before the methods and the outputs that the program uses
// are determined. A method is lowered for each class that has it, so members of other classes,
// including derived ones, are treated separately.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/WithoutCasts.h"
#include "codegen/link/Reflect.h"
#include "codegen/link/steps/Steps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "mlir/IR/Matchers.h"

#include <set>

namespace rtsl::linking {

namespace {

using mlir::Value;
using mlir::func::FuncOp;

using Members = std::set<MemberKey>;

Members emptyMembers(const LinkContext &context) {
  Members empty;
  for (const LinkedClass &linked : context.classes)
    for (const typed::Member *member : allMembers(*linked.info))
      if (const auto given = context.request.givenMembers.find(linked.info->name);
          member->isOptional && given != context.request.givenMembers.end() &&
          !given->second.count(member->name))
        empty.insert({linked.info->name, member->name});
  return empty;
}

/// A member that a constructor writes may be set.
void removeWritten(mlir::ModuleOp ir, Members &empty) {
  for (auto function : ir.getOps<FuncOp>())
    if (ir::attr::constructor.isOn(function))
      function.walk([&](ir::MemberOp member) {
        if (llvm::any_of(member->getUsers(),
                         [](mlir::Operation *user) { return !llvm::isa<ir::LoadOp>(user); }))
          empty.erase(keyOf(member));
      });
}

/// Replaces loads from an address or a part of its pointee.
bool emptyLoads(Value address) {
  bool found = false;
  for (mlir::Operation *user : llvm::make_early_inc_range(address.getUsers())) {
    if (auto load = llvm::dyn_cast<ir::LoadOp>(user);
        load && llvm::isa<ir::RefType>(load.getType())) {
      mlir::OpBuilder builder(load);
      load.replaceAllUsesWith(
          ir::NullRefOp::create(builder, load.getLoc(), load.getType()).getResult());
      load.erase();
      found = true;
    } else if (auto element = llvm::dyn_cast<ir::ElementOp>(user)) {
      found |= emptyLoads(element);
    }
  }
  return found;
}

bool isNull(Value reference) {
  return ir::withoutCasts(reference).getDefiningOp<ir::NullRefOp>() != nullptr;
}

/// The value of a condition, as far as it follows from empty references.
std::optional<bool> known(Value condition) {
  llvm::APInt constant;
  if (mlir::matchPattern(condition, mlir::m_ConstantInt(&constant)))
    return !constant.isZero();
  mlir::Operation *op = condition.getDefiningOp();
  if (auto equal = llvm::dyn_cast_or_null<ir::EqualRefOp>(op))
    return isNull(equal->getOperand(0)) && isNull(equal->getOperand(1)) ? std::optional(true)
                                                                        : std::nullopt;
  if (!llvm::isa_and_nonnull<mlir::arith::XOrIOp, mlir::arith::AndIOp, mlir::arith::OrIOp>(op))
    return std::nullopt;
  const std::optional<bool> left = known(op->getOperand(0)), right = known(op->getOperand(1));
  if (llvm::isa<mlir::arith::XOrIOp>(op))
    return left && right ? std::optional(*left != *right) : std::nullopt;
  const bool decides = llvm::isa<mlir::arith::OrIOp>(op); // regardless of the other operand
  if (left == decides || right == decides)
    return decides;
  return left && right ? std::optional(!decides) : std::nullopt;
}

/// Erases the contents of a region that control does not enter.
void emptyRegion(mlir::Region &region) {
  if (region.empty())
    return;
  mlir::Block &block = region.front();
  while (!block.empty())
    block.back().erase();
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(&block);
  ir::YieldOp::create(builder, region.getLoc());
}

/// A call through a null reference does nothing, and its result is zero.
void dropCalls(FuncOp function) {
  function.walk([](ir::CallMethodOp call) {
    if (!isNull(call.getObject()))
      return;
    mlir::OpBuilder builder(call);
    for (Value result : call.getResults())
      result.replaceAllUsesWith(ir::createZero(builder, call.getLoc(), result.getType()));
    call.erase();
  });
}

} // namespace

void dropBranches(FuncOp function) {
  function.walk<mlir::WalkOrder::PreOrder>([](ir::IfOp choice) {
    if (const std::optional<bool> condition = known(choice.getCondition()))
      emptyRegion(*condition ? choice.getElseRegion() : choice.getThenRegion());
  });
}

MemberKey keyOf(ir::MemberOp member) {
  return {llvm::cast<ir::RefType>(member.getObject().getType()).getClassName().str(),
          member.getMember().str()};
}

void emptyReferences(LinkContext &context) {
  if (context.request.keep.has(Item::Parameters))
    return;
  Members empty = emptyMembers(context);
  removeWritten(context.ir, empty);
  if (empty.empty())
    return;
  for (auto function : context.ir.getOps<FuncOp>()) {
    llvm::SmallVector<ir::MemberOp>
        members; // collected first: erasing loads would invalidate the walk
    function.walk([&](ir::MemberOp member) {
      if (empty.count(keyOf(member)))
        members.push_back(member);
    });
    bool found = false;
    for (ir::MemberOp member : members) {
      found |= emptyLoads(member);
      if (member->use_empty()) // its value is never read
        member.erase();
    }
    if (!found)
      continue;
    dropBranches(function);
    dropCalls(function);
  }
}

} // namespace rtsl::linking
