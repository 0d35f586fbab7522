//===- Parts.cpp - large programs in parts that are compiled in parallel --===//
#include "codegen/emit/Parts.h"

#include "codegen/emit/RuntimeFunctions.h"
#include "codegen/emit/patterns/ConvertToLlvm.h"
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Separate.h"
#include "codegen/ir/dialect/RtslDialect.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/SetVector.h"
#include "llvm/IR/InstrTypes.h"
#include "llvm/IR/Module.h"

namespace rtsl::codegen {

using mlir::func::FuncOp;

namespace {

/// Operations of level 2 in a part: many, because each part has a copy of the device code.
constexpr std::size_t operationsOfPart = 10000;

/// Instructions. LLVM inlines larger functions only if a constant eliminates most of them.
constexpr unsigned largestInlined = 100;

std::size_t operationCount(FuncOp function) {
  std::size_t count = 0;
  function.walk([&](mlir::Operation *) { ++count; });
  return count;
}

/// Moves a function and leaves a declaration.
void move(FuncOp function, mlir::ModuleOp part) {
  mlir::OpBuilder builder(function);
  auto declaration = llvm::cast<FuncOp>(builder.insert(function->cloneWithoutRegions()));
  declaration.setPrivate();
  function->moveBefore(part.getBody(), part.getBody()->end());
}

/// Declares the functions that the part calls but does not contain.
void declareCallees(mlir::ModuleOp part, const mlir::SymbolTable &program) {
  llvm::SetVector<mlir::StringAttr> called;
  part.walk([&](mlir::func::CallOp call) { called.insert(call.getCalleeAttr().getAttr()); });
  llvm::DenseSet<mlir::StringAttr> there;
  for (FuncOp function : part.getOps<FuncOp>())
    there.insert(function.getSymNameAttr());
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(part.getBody());
  for (mlir::StringAttr name : called)
    if (auto function = program.lookup<FuncOp>(name); function && !there.contains(name))
      llvm::cast<FuncOp>(builder.insert(function->cloneWithoutRegions())).setPrivate();
}

} // namespace

std::vector<mlir::OwningOpRef<mlir::ModuleOp>> takeParts(mlir::ModuleOp program) {
  std::vector<std::pair<FuncOp, std::size_t>> separate;
  std::size_t operations = 0;
  for (FuncOp function : program.getOps<FuncOp>())
    if (ir::attr::separate.isOn(function) && !function.isExternal()) {
      separate.push_back({function, operationCount(function)});
      operations += separate.back().second;
    }
  std::vector<mlir::OwningOpRef<mlir::ModuleOp>> parts;
  if (operations < 2 * operationsOfPart)
    return parts;
  noteWholeProgram(program);
  const std::size_t count = operations / operationsOfPart; // parts of about equal size
  std::size_t before = 0, last = count;
  for (const auto &[function, size] : separate) {
    const std::size_t index = before * count / operations;
    if (index != last) {
      parts.push_back(mlir::ModuleOp::create(program.getLoc(), program.getName()));
      parts.back()->getOperation()->setDiscardableAttrs(program->getDiscardableAttrDictionary());
      last = index;
    }
    before += size;
    move(function, *parts.back());
  }
  const mlir::SymbolTable symbols(program);
  for (mlir::OwningOpRef<mlir::ModuleOp> &part : parts)
    declareCallees(*part, symbols);
  return parts;
}

std::vector<std::string> visibleFunctions(const llvm::Module &module) {
  std::vector<std::string> names;
  for (const llvm::Function &function : module)
    if (!function.isDeclaration() && !function.hasLocalLinkage() && !function.isWeakForLinker())
      names.push_back(function.getName().str());
  return names;
}

/// Instructions of the function and of the functions that it is linked with, whose names are local
/// to a module. The count stops when it is large enough.
static unsigned instructionCount(const llvm::Function &function) {
  unsigned count = 0;
  llvm::SetVector<const llvm::Function *> pending;
  pending.insert(&function);
  for (std::size_t at = 0; at != pending.size() && count <= largestInlined; ++at)
    for (const llvm::BasicBlock &block : *pending[at])
      for (const llvm::Instruction &instruction : block) {
        ++count;
        if (auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction))
          if (auto *callee = call->getCalledFunction(); callee && callee->hasLocalLinkage())
            pending.insert(callee);
      }
  return count;
}

std::vector<std::string> shareLargeFunctions(llvm::Module &part) {
  std::vector<llvm::Function *> large;
  for (llvm::Function &function : part)
    if (function.hasLocalLinkage() &&
        isRuntimeFunction(function.getName()) && // others have no external name
        !function.hasFnAttribute(llvm::Attribute::AlwaysInline) &&
        instructionCount(function) > largestInlined)
      large.push_back(&function);
  for (llvm::Function *function : large) {
    function->deleteBody(); // its linkage is external after that
    function->setDSOLocal(false);
  }
  for (bool changed = true; changed;) { // functions that only erased ones called
    changed = false;
    for (llvm::Function &function : llvm::make_early_inc_range(part))
      if (function.use_empty() && (function.hasLocalLinkage() || function.isDeclaration())) {
        function.eraseFromParent();
        changed = true;
      }
  }
  std::vector<std::string> missing;
  for (const llvm::Function &function : part)
    if (function.isDeclaration() && !function.isIntrinsic())
      missing.push_back(function.getName().str());
  return missing;
}

} // namespace rtsl::codegen
