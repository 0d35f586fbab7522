#include "codegen/emit/SceneTables.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/Layout.h"
#include "runtime/device/ray/Abi.h"

namespace rtsl::codegen {

namespace LLVM = mlir::LLVM;

namespace {

/// A GPU loads four words at once.
constexpr unsigned tableAlignment = 16;

constexpr llvm::StringLiteral recordsName = "rtsl.records", instancesName = "rtsl.instances",
                              emittersName = "rtsl.emitters",
                              meshAttributesName = "rtsl.mesh_attributes",
                              listedBoxesName = "rtsl.listed_boxes",
                              listedPairsName = "rtsl.listed_pairs";

void defineTable(mlir::OpBuilder &builder, mlir::Location location, llvm::StringRef name,
                 llvm::ArrayRef<std::int32_t> words) {
  const auto count = static_cast<int64_t>(words.size());
  auto values = mlir::DenseIntElementsAttr::get(
      mlir::RankedTensorType::get({count}, builder.getI32Type()), words);
  auto type = LLVM::LLVMArrayType::get(builder.getI32Type(), static_cast<unsigned>(count));
  LLVM::GlobalOp::create(builder, location, type, /*isConstant=*/true, LLVM::Linkage::Internal,
                         name, values, tableAlignment);
}

/// `type NAME(const RtslLaunch *)`, which returns what `result` makes. It replaces the weak
/// function of the device code, and each part of a large program has it.
void defineFunction(mlir::OpBuilder &builder, mlir::Location location, llvm::StringRef name,
                    mlir::Type type, llvm::function_ref<mlir::Value()> result) {
  auto pointer = LLVM::LLVMPointerType::get(builder.getContext());
  auto function = LLVM::LLVMFuncOp::create(builder, location, name,
                                           LLVM::LLVMFunctionType::get(type, {pointer}),
                                           LLVM::Linkage::WeakODR);
  mlir::OpBuilder::InsertionGuard guard(builder);
  builder.setInsertionPointToStart(function.addEntryBlock(builder));
  LLVM::ReturnOp::create(builder, location, result());
}

mlir::Value addressOf(mlir::OpBuilder &builder, mlir::Location location, llvm::StringRef name) {
  return LLVM::AddressOfOp::create(builder, location,
                                   LLVM::LLVMPointerType::get(builder.getContext()), name);
}

mlir::Value constant(mlir::OpBuilder &builder, mlir::Location location, std::int32_t value) {
  return LLVM::ConstantOp::create(builder, location, builder.getI32Type(),
                                  builder.getI32IntegerAttr(value));
}

/// A table of structs of a size, `TABLE(launch)`, and their number, `COUNT(launch)`. An empty one
/// is not defined, since nothing reads it.
void defineCounted(mlir::OpBuilder &builder, mlir::Location location, llvm::StringRef global,
                   llvm::ArrayRef<std::int32_t> words, std::size_t size, llvm::StringRef table,
                   llvm::StringRef count) {
  defineFunction(builder, location, count, builder.getI32Type(), [&] {
    return constant(builder, location, static_cast<std::int32_t>(words.size() * 4 / size));
  });
  if (words.empty())
    return;
  defineTable(builder, location, global, words);
  defineFunction(builder, location, table, LLVM::LLVMPointerType::get(builder.getContext()),
                 [&] { return addressOf(builder, location, global); });
}

} // namespace

void defineSceneTables(mlir::ModuleOp module) {
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockBegin(module.getBody());
  const mlir::Location location = module.getLoc();
  if (const auto records = ir::attr::records.of(module))
    defineTable(builder, location, recordsName, records);
  if (const auto instances = ir::attr::instances.of(module)) {
    defineTable(builder, location, instancesName, instances);
    defineFunction(builder, location, "rtsl_instances",
                   LLVM::LLVMPointerType::get(builder.getContext()),
                   [&] { return addressOf(builder, location, instancesName); });
  }
  if (const auto emitters = ir::attr::emitters.of(module))
    defineCounted(builder, location, emittersName, emitters, sizeof(RtslEmitter), "rtsl_emitters",
                  "rtsl_emitter_count");
  if (ir::attr::wholeEmitters.isOn(module))
    defineFunction(builder, location, "rtsl_emitters_have_parts", builder.getI32Type(),
                   [&] { return constant(builder, location, 0); });
  if (const auto attributes = ir::attr::meshAttributes.of(module))
    defineCounted(builder, location, meshAttributesName, attributes, sizeof(RtslMeshAttribute),
                  "rtsl_mesh_attributes", "rtsl_mesh_attribute_count");
  if (const auto boxes = ir::attr::listedBoxes.of(module))
    defineCounted(builder, location, listedBoxesName, boxes, sizeof(RtslListedBox),
                  "rtsl_listed_boxes", "rtsl_listed_instances");
  if (const auto pairs = ir::attr::listedPairs.of(module)) {
    defineTable(builder, location, listedPairsName, pairs);
    defineFunction(builder, location, "rtsl_listed_pairs",
                   LLVM::LLVMPointerType::get(builder.getContext()),
                   [&] { return addressOf(builder, location, listedPairsName); });
  }
}

bool hasConstantRecords(const llvm::Module &module) {
  return module.getNamedGlobal(recordsName) != nullptr;
}

mlir::Value sceneRecords(mlir::OpBuilder &builder, mlir::Location location) {
  auto module = builder.getInsertionBlock()->getParentOp()->getParentOfType<mlir::ModuleOp>();
  return ir::attr::records.of(module) ? addressOf(builder, location, recordsName) : mlir::Value();
}

} // namespace rtsl::codegen
