//===- BindTables.cpp - the tables of a small scene, in its program -------===//
//
// The records, the instances and the emitters of a small scene are constants of its program: what
// is loaded from them at a constant place folds. If the scene has only a few primitives, rays test
// them one after the other: no tree, and `intersect` of each has the members of its object as
// constants.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/BindTables.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/ClassTable.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/link/ListedPairs.h"
#include "runtime/device/ray/ListedBox.h"

#include "llvm/ADT/STLExtras.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

namespace rtsl {

namespace {

/// Larger tables would evict data that all shaders share from the caches of a GPU.
constexpr std::size_t mostRecordBytes = 4096;

/// With more, a tree is faster (docs/gpu.md).
constexpr std::size_t mostListed = 32;

std::vector<std::int32_t> wordsOf(const void *bytes, std::size_t size) {
  std::vector<std::int32_t> words(size / 4);
  if (!words.empty()) // `bytes` may be null
    std::memcpy(words.data(), bytes, words.size() * 4);
  return words;
}

/// Calls `visit(object, member, offset)` for each editable member of each object; bytes from the
/// start of its record.
template <typename Visit>
void forEachEditable(mlir::ModuleOp ir, const runtime::SceneFacts &scene, const Visit &visit) {
  const ir::ClassTable classes(ir);
  const mlir::SymbolTable symbols(ir);
  for (const runtime::SceneFacts::Object &object : scene.objects)
    for (auto at = symbols.lookup<ir::ClassOp>(object.className); at;
         at = at.getBase() ? symbols.lookup<ir::ClassOp>(*at.getBase()) : ir::ClassOp())
      for (auto member : at.getBody().getOps<ir::MemberDeclOp>())
        if (ir::attr::editable.isOn(member))
          visit(object, member, *classes.find(object.className, member.getSymName())->offset);
}

/// The records of all objects; members that are editable are zero.
std::vector<std::int32_t> recordsWithoutEditable(mlir::ModuleOp ir,
                                                 const runtime::SceneFacts &scene) {
  std::vector<std::int32_t> words = wordsOf(scene.records, scene.recordBytes);
  forEachEditable(ir, scene,
                  [&](const auto &object, ir::MemberDeclOp member, std::uint32_t offset) {
                    const auto begin = words.begin() + (object.record - scene.records + offset) / 4;
                    std::fill(begin, begin + ir::sizeInBytes(member.getType()) / 4, 0);
                  });
  return words;
}

/// Whether the boxes of primitives may change without new code.
bool hasEditablePrimitives(mlir::ModuleOp ir, const runtime::SceneFacts &scene) {
  bool found = false;
  forEachEditable(ir, scene, [&](const auto &object, ir::MemberDeclOp, std::uint32_t) {
    found |= llvm::any_of(scene.instances, [&](const RtslInstance &instance) {
      return object.record == scene.records + instance.primitive;
    });
  });
  return found;
}

bool isOnePrimitive(const RtslInstance &instance) {
  return instance.primitive != 0 && instance.boxCount == 0;
}

/// Is each instance one primitive, and are they few enough for a list?
bool isListed(const std::vector<RtslInstance> &instances) {
  return !instances.empty() && instances.size() <= mostListed &&
         llvm::all_of(instances, isOnePrimitive);
}

bool areEmittersWhole(const runtime::SceneFacts &scene) {
  return llvm::all_of(*scene.emitters, [&](const RtslEmitter &emitter) {
    return isOnePrimitive(scene.instances[emitter.instance]);
  });
}

/// The words of an RtslListedBox for each.
std::vector<std::int32_t> listedBoxes(const std::vector<RtslInstance> &instances) {
  std::vector<RtslListedBox> boxes;
  for (const RtslInstance &one : instances)
    boxes.push_back(device::listedBox(one.lower, one.upper));
  return wordsOf(boxes.data(), boxes.size() * sizeof(RtslListedBox));
}

std::string reasonForList(std::size_t primitives) {
  return primitives == 1 ? "one primitive, which every ray tests"
                         : fmt::format("{} primitives, tested one after the other", primitives);
}

std::string reasonForTree(std::size_t instances) {
  if (instances == 0)
    return "the scene has no instance; its tree is empty";
  return instances > mostListed ? fmt::format("there are more than {} instances", mostListed)
                                : "some instance is a mesh, or holds several primitives";
}

Finding describe(const runtime::SceneFacts &scene, bool isEditable) {
  const bool isList = isListed(scene.instances) && !isEditable;
  return {Item::Tree,
          "tree",
          !isList,
          isList       ? reasonForList(scene.instances.size())
          : isEditable ? "some primitive is editable: boxes are not in the code"
                       : reasonForTree(scene.instanceCount),
          {}};
}

} // namespace

void bindTables(mlir::ModuleOp ir, const runtime::SceneFacts &scene, const LinkRequest &request,
                Findings *findings) {
  const bool anyEditable = !request.editable.empty();
  const bool isEditable = anyEditable && hasEditablePrimitives(ir, scene);
  if (findings)
    findings->push_back(describe(scene, isEditable));
  if (request.keep.has(Item::Parameters))
    return;
  mlir::Builder builder(ir.getContext());
  if (scene.records && !scene.hasBuffers && scene.recordBytes <= mostRecordBytes)
    ir::attr::records.set(
        ir, builder.getDenseI32ArrayAttr(anyEditable ? recordsWithoutEditable(ir, scene)
                                                     : wordsOf(scene.records, scene.recordBytes)));
  if (scene.instances.empty() || isEditable)
    return;
  const std::size_t bytes = scene.instances.size() * sizeof(RtslInstance);
  ir::attr::instances.set(ir, builder.getDenseI32ArrayAttr(wordsOf(scene.instances.data(), bytes)));
  // The powers of emitters may depend on whatever is editable.
  if (scene.emitters && !anyEditable && !request.keep.has(Item::Lights)) {
    ir::attr::emitters.set(
        ir, builder.getDenseI32ArrayAttr(
                wordsOf(scene.emitters->data(), scene.emitters->size() * sizeof(RtslEmitter))));
    if (areEmittersWhole(scene))
      ir::attr::wholeEmitters.set(ir);
  }
  if (isListed(scene.instances) && !request.keep.has(Item::Tree)) {
    ir::attr::listedBoxes.set(ir, builder.getDenseI32ArrayAttr(listedBoxes(scene.instances)));
    if (const std::vector<std::int32_t> pairs = listedPairs(scene.instances); !pairs.empty())
      ir::attr::listedPairs.set(ir, builder.getDenseI32ArrayAttr(pairs));
  }
}

} // namespace rtsl
