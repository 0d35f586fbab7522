//===- ReferredClasses.cpp - what a call through a member may reach -------===//
//
//   %p = rtsl.load (rtsl.member %self "pattern")
//   %c = rtsl.call_method "colorAt" on %p
//
// If all objects of the class refer to a Checker there, the call is a Checker's, whatever patterns
// other members refer to. A method is lowered for each class that has it, so members of other
// classes, including derived ones, are treated separately.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/WithoutCasts.h"
#include "codegen/link/Members.h"
#include "codegen/link/steps/Steps.h"

#include "llvm/ADT/StringSet.h"

namespace rtsl::linking {

namespace {

/// The members that some constructor writes, by name.
llvm::StringSet<> membersWritten(mlir::ModuleOp ir) {
  llvm::StringSet<> written;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (ir::attr::constructor.isOn(function))
      function.walk([&](ir::MemberOp member) {
        if (llvm::any_of(member->getUsers(),
                         [](mlir::Operation *user) { return !llvm::isa<ir::LoadOp>(user); }))
          written.insert(member.getMember());
      });
  return written;
}

/// The member that a reference is loaded from; null if it comes from elsewhere, an element of an
/// array included: which object that is may depend on the ray.
ir::MemberOp memberOf(mlir::Value reference) {
  auto load = ir::withoutCasts(reference).getDefiningOp<ir::LoadOp>();
  return load ? load.getAddress().getDefiningOp<ir::MemberOp>() : nullptr;
}

/// The typed member of an object's class; null if the object may be of a derived class.
const typed::Member *findMember(const LinkContext &context, ir::MemberOp member) {
  const llvm::StringRef name = llvm::cast<ir::RefType>(member.getObject().getType()).getClassName();
  const typed::Member *found = nullptr;
  for (const LinkedClass &linked : context.classes) {
    if (!derivesFrom(*linked.info, name))
      continue;
    if (linked.info->name != name)
      return nullptr;
    for (const typed::Member *each : allMembers(*linked.info))
      if (each->name == member.getMember())
        found = each;
  }
  return found;
}

Referred referredBy(ir::CallMethodOp call, const LinkContext &context,
                    const llvm::StringSet<> &written) {
  ir::MemberOp member = memberOf(call.getObject());
  const typed::Member *info = member ? findMember(context, member) : nullptr;
  if (!info || written.contains(member.getMember()))
    return {};
  const std::string owner =
      llvm::cast<ir::RefType>(member.getObject().getType()).getClassName().str();
  const auto classes = context.request.referredClasses.find({owner, info->name});
  if (classes == context.request.referredClasses.end())
    return {};
  return {owner + "." + info->name, classes->second, info->isOptional};
}

} // namespace

llvm::DenseMap<mlir::Operation *, Referred> referredClasses(const LinkContext &context) {
  const llvm::StringSet<> written = membersWritten(context.ir);
  llvm::DenseMap<mlir::Operation *, Referred> referred;
  mlir::ModuleOp(context.ir).walk([&](ir::CallMethodOp call) {
    referred[call] = referredBy(call, context, written);
  });
  return referred;
}

} // namespace rtsl::linking
