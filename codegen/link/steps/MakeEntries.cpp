//===- MakeEntries.cpp - the entry points of a program --------------------===//
//
// The runtime calls a program through four kinds of entry points: a slot of Slots.def or
// SamplingSlots.def on an object, the `intersect` of a given class, the defaults of a class on a
// new record, and the constructor of a class on packed arguments:
//
//   func.func @Glass.construct(%self: !rtsl.ref<"Glass">,
//                              %arguments: !rtsl.ptr<!rtsl.struct<"Glass.arguments", {...}>>)
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Slots.h"
#include "codegen/link/Reflect.h"
#include "codegen/link/steps/Steps.h"
#include "codegen/passes/errors/DeriveHitErrors.h"

namespace rtsl::linking {

namespace {

void exportFunction(mlir::func::FuncOp function) {
  ir::attr::exported.set(function);
  function.setPublic();
}

void makeSlot(LinkContext &context, const Slot &slot) {
  std::vector<const LinkedClass *> classes;
  for (const LinkedClass &linked : context.classes)
    if (linked.isMet && linked.info->root == slot.base)
      classes.push_back(&linked);
  const std::string name = ir::slotName(slot.base, slot.method);
  const bool isNoted = llvm::any_of(
      context.findings, [&](const Finding &finding) { return finding.subject == name; });
  const auto hasMethod = [&](const LinkedClass *linked) {
    return findMethod(context, *linked, slot.method);
  };
  const bool isForBuilding = std::string_view(slot.method) == "computeBounds";
  const bool isDerived = // no author has defined it
      slot.method == hitErrorMethod || llvm::StringRef(slot.method) == typed::scratchChangesMethod;
  if (!isNoted && !isForBuilding && !isDerived && llvm::any_of(classes, hasMethod))
    context.findings.push_back(describeDispatch(name, classes, {}));

  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(context.ir.getBody());
  const mlir::Type object = ir::RefType::get(builder.getContext(), slot.base);
  auto function = mlir::func::FuncOp::create(builder, builder.getUnknownLoc(), ir::slotSymbol(name),
                                             builder.getFunctionType({object}, {}));
  ir::attr::slot.set(function, builder.getStringAttr(name));
  ir::insertForRuntime(context.symbols, function);
  buildDispatch(context, function, name, classes, slot.method);
  exportFunction(function);
}

/// Makes a constructor that takes its arguments from memory, so that the runtime can call it
/// without its signature.
void makeConstruct(LinkContext &context, LinkedClass &linked) {
  const typed::Function *constructor = findConstructor(*linked.info);
  mlir::func::FuncOp target = constructor ? findMethod(context, linked, "constructor") : nullptr;
  if (!target)
    return;

  mlir::MLIRContext *mlirContext = target.getContext();
  llvm::SmallVector<mlir::StringAttr> names;
  llvm::SmallVector<mlir::Type> types;
  for (std::size_t i = 0; i < constructor->parameters.size(); ++i) {
    const std::string &name = constructor->parameters[i]->name;
    names.push_back(
        mlir::StringAttr::get(mlirContext, name.empty() ? "unnamed" + std::to_string(i) : name));
    const mlir::Type type = target.getArgumentTypes()[i + 1];
    const auto address = mlir::dyn_cast<ir::PtrType>(type); // of an aggregate
    types.push_back(address ? address.getPointee() : type);
  }
  linked.parameters =
      ir::StructType::get(mlirContext, linked.info->name + ".arguments", names, types);

  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(context.ir.getBody());
  const mlir::Location location = target.getLoc();
  auto function = mlir::func::FuncOp::create(
      builder, location, constructSymbol(linked.info->name),
      builder.getFunctionType(
          {target.getArgumentTypes().front(), ir::PtrType::get(linked.parameters)}, {}));
  context.symbols.insert(function);
  ir::attr::constructor.set(function);

  mlir::Block *entry = function.addEntryBlock();
  builder.setInsertionPointToEnd(entry);
  llvm::SmallVector<mlir::Value> arguments = {entry->getArgument(0)};
  for (std::size_t i = 0; i < names.size(); ++i) {
    const mlir::Value address =
        ir::FieldOp::create(builder, location, entry->getArgument(1), names[i].getValue());
    const bool byAddress = mlir::isa<ir::PtrType>(target.getArgumentTypes()[i + 1]);
    arguments.push_back(byAddress ? address
                                  : ir::LoadOp::create(builder, location, address).getResult());
  }
  mlir::func::CallOp::create(builder, location, target, arguments);
  ir::ReturnOp::create(builder, location, mlir::ValueRange());
  exportFunction(function);
}

} // namespace

void makeEntries(LinkContext &context) {
  for (auto function : context.ir.getOps<mlir::func::FuncOp>()) {
    function.setPrivate();
    if (ir::attr::kept.isOn(function))
      exportFunction(function);
  }
  for (const Slot &slot : methodSlots)
    makeSlot(context, slot);
  if (context.request.isSampled)
    for (const Slot &slot : samplingSlots)
      makeSlot(context, slot);
  else if (findNeeds(context) & RTSL_NEEDS_EMITTERS)
    for (const Slot &slot : surfaceSlots)
      makeSlot(context, slot);
  if (!context.request.isSampled && lightPasses(context))
    for (const Slot &slot : passingSlots)
      if (context.methodsThatPassLight.count(slot.method))
        makeSlot(context, slot);
  makePayloadSlots(context);
  makeFeatures(context);
  for (LinkedClass &linked : context.classes) {
    makeConstruct(context, linked);
    if (linked.info->root == "rt_Primitive") // if the class is known, no dispatch is needed
      if (mlir::func::FuncOp intersect = findMethod(context, linked, "intersect"))
        exportFunction(intersect);
    if (auto initialize = context.function(initializeSymbol(linked.info->name)))
      exportFunction(initialize);
  }
}

} // namespace rtsl::linking
