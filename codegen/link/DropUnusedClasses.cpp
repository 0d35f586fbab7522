//===- DropUnusedClasses.cpp - keep what the scene has objects of ---------===//
//
// Methods are lowered once for each class, inherited ones too, so that the functions of a class without objects are
// never called. Its declaration stays: other classes may name it as their base.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/Steps.h"

#include <algorithm>

namespace rtsl::linking {

namespace {

bool isWanted(const LinkRequest &request, const std::string &name) {
  return request.classes.empty() ||
         std::find(request.classes.begin(), request.classes.end(), name) != request.classes.end();
}

} // namespace

void dropUnusedClasses(LinkContext &context) {
  mlir::SymbolTable symbols(context.ir);
  for (const auto &info : context.module.classes) {
    auto record = symbols.lookup<ir::ClassOp>(info->name);
    if (!isWanted(context.request, info->name) || !record)
      continue;
    LinkedClass linked;
    linked.info = info.get();
    linked.record = record;
    linked.id = static_cast<std::uint32_t>(context.classes.size()) + 1;
    context.classes.push_back(linked);
  }

  for (auto function : llvm::make_early_inc_range(context.ir.getOps<mlir::func::FuncOp>()))
    if (auto name = function->getAttrOfType<mlir::StringAttr>("rtsl.class"))
      if (!isWanted(context.request, name.str()))
        function.erase();
}

} // namespace rtsl::linking
