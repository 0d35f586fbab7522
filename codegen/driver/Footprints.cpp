#include "codegen/driver/Footprints.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Rays.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/ir/Slots.h"
#include "codegen/link/Link.h"
#include "codegen/link/steps/Steps.h"

#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "llvm/ADT/SetVector.h"

#include <map>
#include <set>

namespace rtsl::driver {

using mlir::func::FuncOp;

/// Changes the finding that this subject is read: it is not.
static void noteNeverRead(Compilation &compilation, Item item, const std::string &subject) {
  if (!compilation.findings)
    return;
  for (Finding &finding : *compilation.findings)
    if (finding.item == item && finding.isNeeded && finding.subject == subject) {
      finding.isNeeded = false;
      finding.reason = "read only by code that never runs with the numbers of the scene";
    }
}

/// The offsets of the changes that some code reads.
static std::set<std::uint32_t> changesRead(mlir::ModuleOp ir) {
  std::set<std::uint32_t> read;
  ir.walk([&](ir::AttributeOp op) {
    if (op.getAxis() && op.getOffset() && linking::isRead(op))
      read.insert(*op.getOffset());
  });
  return read;
}

/// Changes of named attributes of meshes.
static void leaveOutChangesOfMeshes(Compilation &compilation, const std::set<std::uint32_t> &read) {
  const auto table = ir::attr::meshAttributes.of(*compilation.ir);
  if (compilation.input.scene->keep.has(Item::MeshAttributes) || !table)
    return;
  std::vector<std::int32_t> words;
  for (runtime::AttributeInfo &attribute : compilation.program->meshAttributes) {
    const std::int32_t size = table[words.size() + 1];
    words.push_back(static_cast<std::int32_t>(attribute.offset));
    words.push_back(size);
    for (std::uint32_t axis = 0; axis < 2; ++axis) {
      std::uint32_t &change = attribute.changes[axis];
      if (change != RTSL_NOT_READ && !read.count(change)) {
        change = RTSL_NOT_READ;
        noteNeverRead(compilation, Item::MeshAttributes, changeSubject(attribute.name, axis));
      }
      words.push_back(static_cast<std::int32_t>(change));
    }
  }
  ir::attr::meshAttributes.set(
      *compilation.ir, mlir::Builder(compilation.ir->getContext()).getDenseI32ArrayAttr(words));
}

/// Removes the code of a function of level 2, and the functions that only this code calls.
static void clear(FuncOp function, Compilation &compilation) {
  mlir::ModuleOp ir = *compilation.ir;
  llvm::SetVector<mlir::Operation *> called;
  const auto addCalled = [&](FuncOp caller) {
    caller.walk([&](mlir::func::CallOp call) {
      if (auto callee = ir.lookupSymbol<FuncOp>(call.getCallee()))
        called.insert(callee);
    });
  };
  addCalled(function);
  function.getBody().dropAllReferences();
  function.getBody().getBlocks().clear();
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(function.addEntryBlock());
  mlir::func::ReturnOp::create(builder, function.getLoc());
  while (!called.empty()) {
    auto callee = llvm::cast<FuncOp>(called.pop_back_val());
    if (!callee.isPrivate() || !mlir::SymbolTable::symbolKnownUseEmpty(callee, ir))
      continue;
    addCalled(callee);
    called.remove(callee);
    noteNeverRead(compilation, Item::Methods, linking::shownName(callee));
    callee.erase();
  }
}

/// Does the function compute changes of scratch members: the method, or the runtime's entry to it?
static bool computesChanges(FuncOp function) {
  const auto method = ir::attr::methodName.of(function), slot = ir::attr::slot.of(function);
  return !function.isExternal() &&
         ((method && method == typed::scratchChangesMethod) ||
          (slot && slot == ir::slotName("rt_Primitive", typed::scratchChangesMethod)));
}

/// Removes stores of changes that are not read. Are others left?
static bool storesChanges(FuncOp function, const std::set<std::uint32_t> &read,
                          Compilation &compilation) {
  bool isLeft = false;
  std::vector<ir::AttributeOp> unread;
  function.walk([&](ir::AttributeOp change) {
    if (change.getAxis() && change.getOffset() && read.count(*change.getOffset()))
      isLeft = true;
    else if (change.getAxis())
      unread.push_back(change);
  });
  for (ir::AttributeOp change : unread) {
    noteNeverRead(compilation, Item::Attributes,
                  changeSubject(change.getName().str(), *change.getAxis()));
    for (mlir::Operation *user : llvm::make_early_inc_range(change->getUsers()))
      user->erase();
    change->erase();
  }
  return isLeft;
}

/// Changes of scratch members of primitives.
static void leaveOutChangesOfPrimitives(Compilation &compilation,
                                        const std::set<std::uint32_t> &read) {
  if (compilation.input.scene->keep.has(Item::Attributes))
    return;
  std::vector<FuncOp> functions;
  for (auto function : compilation.ir->getOps<FuncOp>())
    if (computesChanges(function))
      functions.push_back(function);
  bool areLeft = false;
  for (FuncOp function : functions)
    areLeft |= storesChanges(function, read, compilation);
  if (areLeft)
    return;
  for (const auto &definition : compilation.input.module->classes) // may have been inlined
    noteNeverRead(compilation, Item::Methods, definition->name + "." + typed::scratchChangesMethod);
  // The methods are called from there.
  for (FuncOp function : functions)
    if (ir::attr::slot.isOn(function))
      return clear(function, compilation);
}

/// The changes that code of a material, or of one that it may refer to, reads.
static std::set<std::string> changesReadBy(mlir::ModuleOp ir, const std::string &material,
                                           const std::set<std::string> &onSurfaces) {
  std::set<std::string> names;
  for (auto function : ir.getOps<FuncOp>()) {
    const auto owner = ir::attr::className.of(function);
    if (owner && owner != material && onSurfaces.count(owner.str()))
      continue; // another material's
    function.walk([&](ir::AttributeOp op) {
      if (op.getAxis() && linking::isRead(op))
        names.insert(op.getName().str());
    });
  }
  return names;
}

/// Warns of changes that are read although `intersect` of the primitive cannot be followed.
static void warnOfUnknownChanges(const Compilation &compilation) {
  std::set<std::string> onSurfaces;
  for (const auto &[primitive, material] : compilation.input.scene->surfaces)
    onSurfaces.insert(material);
  std::set<const typed::Member *> reported;
  for (const auto &[primitive, material] : compilation.input.scene->surfaces) {
    const typed::Class *info = compilation.input.module->findClass(primitive);
    const typed::Function *method = info ? info->findMethod(typed::scratchChangesMethod) : nullptr;
    if (!method || !method->knowsNoChanges)
      continue;
    for (const std::string &name : changesReadBy(*compilation.ir, material, onSurfaces))
      if (const typed::Member *member = linking::findScratch(*info, name);
          member && reported.insert(member).second)
        compilation.diagnostics
            .report(Code::scratchChangeUnknown, member->range, name, primitive, material)
            .note(fmt::format("write `{}` in `intersect` itself, or give texture coordinates by "
                              "computeTextureCoordinates and computeDerivatives",
                              name));
  }
}

void leaveOutFootprints(Compilation &compilation) {
  const LinkRequest *scene = compilation.input.scene;
  if (!scene)
    return;
  const std::set<std::uint32_t> read = changesRead(*compilation.ir);
  leaveOutChangesOfMeshes(compilation, read);
  leaveOutChangesOfPrimitives(compilation, read);
  warnOfUnknownChanges(compilation);
  if (scene->keep.has(Item::Outputs) || ir::readsFootprints(*compilation.ir))
    return;
  compilation.program->needs &= ~(RTSL_NEEDS_FOOTPRINT | RTSL_NEEDS_NORMAL_CHANGES);
  noteNeverRead(compilation, Item::Outputs, footprintSubject);
}

} // namespace rtsl::driver
