//===- BindScene.cpp - what the objects of a scene say of a program -------===//
//
// A program that renders is made after the constructors of its scene have run. By then members no longer change, and
// where all objects of a class agree on one it is a constant: what is computed from it folds. Objects that a reference
// of a class may lead to are those of the class and of all classes below it.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/BindScene.h"

#include "codegen/ir/Layout.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/passes/BindMembers.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"

#include "llvm/ADT/STLExtras.h"

#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace rtsl {

namespace {

constexpr llvm::StringLiteral exported = "rtsl.export";
constexpr llvm::StringLiteral boundsEntry = "rtsl_rt_Primitive_computeBounds";

/// Whether the runtime calls the function while a scene is built, and never again.
bool isForBuilding(mlir::func::FuncOp function) {
  const llvm::StringRef name = function.getSymName();
  return function->hasAttr("rtsl.constructor") || name == boundsEntry ||
         (function->hasAttr(exported) && name.ends_with(".initialize"));
}

/// Makes an entry what nobody calls from outside.
void hide(mlir::func::FuncOp function) {
  function->removeAttr(exported);
  function.setPrivate();
}

using Objects = std::vector<const runtime::SceneFacts::Object *>;

/// The objects of each class and of the classes below it.
std::map<mlir::Operation *, Objects> objectsByClass(const mlir::SymbolTable &symbols, const runtime::SceneFacts &scene) {
  std::map<mlir::Operation *, Objects> byClass;
  for (const runtime::SceneFacts::Object &object : scene.objects) {
    auto at = symbols.lookup<ir::ClassOp>(object.className);
    while (at) {
      byClass[at].push_back(&object);
      at = at.getBase() ? symbols.lookup<ir::ClassOp>(*at.getBase()) : ir::ClassOp();
    }
  }
  return byClass;
}

/// The words of a member if they are the same in all objects; or else nothing.
std::vector<std::int32_t> commonWords(const mlir::SymbolTable &symbols, ir::MemberDeclOp member, const Objects &objects) {
  std::vector<std::int32_t> common;
  for (const runtime::SceneFacts::Object *object : objects) {
    const auto own = symbols.lookup<ir::ClassOp>(object->className);
    std::vector<std::int32_t> words(ir::sizeInBytes(member.getType()) / 4);
    std::memcpy(words.data(), object->record + *ir::memberOffset(own, member.getSymName()), words.size() * 4);
    if (!common.empty() && common != words)
      return {};
    common = std::move(words);
  }
  return common;
}

} // namespace

void keepConstructors(mlir::ModuleOp ir) {
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (function->hasAttr(exported) && !isForBuilding(function) && function.getSymName() != "rtsl_features")
      hide(function);
}

void bindScene(mlir::ModuleOp ir, const runtime::SceneFacts &scene) {
  for (auto function : llvm::make_early_inc_range(ir.getOps<mlir::func::FuncOp>()))
    if (isForBuilding(function))
      function.erase(); // nobody calls them but the runtime

  mlir::Builder builder(ir.getContext());
  const mlir::SymbolTable symbols(ir);
  for (const auto &[record, objects] : objectsByClass(symbols, scene))
    for (auto member : mlir::cast<ir::ClassOp>(record).getBody().getOps<ir::MemberDeclOp>())
      if (!member.isScratch())
        if (const std::vector<std::int32_t> words = commonWords(symbols, member, objects); !words.empty())
          member->setAttr(codegen::boundWords, builder.getDenseI32ArrayAttr(words));
  ir->setAttr(codegen::boundLightCount, builder.getI32IntegerAttr(static_cast<std::int32_t>(scene.lightCount)));
  ir->setAttr(codegen::boundAmbient, builder.getDenseF32ArrayAttr(scene.ambient));
}

} // namespace rtsl
