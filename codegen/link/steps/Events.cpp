//===- Events.cpp - exceptions and prints ---------------------------------===//
//
// Exceptions and prints are enabled by options: the constant @rtsl_features passes them to
// runtime/device. Every `print` has a number, and the runtime is given its format.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Slots.h"
#include "codegen/link/steps/Steps.h"

#include "mlir/Dialect/Arith/IR/Arith.h"
#include "llvm/ADT/StringSwitch.h"

namespace rtsl::linking {

namespace {

runtime::ValueType::Kind kindOf(llvm::StringRef type) {
  using Kind = runtime::ValueType::Kind;
  return llvm::StringSwitch<Kind>(type)
      .StartsWith("int", Kind::Int)
      .StartsWith("ivec", Kind::Int)
      .StartsWith("uint", Kind::UInt)
      .StartsWith("uvec", Kind::UInt)
      .StartsWith("bool", Kind::Bool)
      .StartsWith("bvec", Kind::Bool)
      .Default(Kind::Float);
}

} // namespace

void makeFeatures(LinkContext &context) {
  mlir::OpBuilder builder = mlir::OpBuilder::atBlockEnd(context.ir.getBody());
  const mlir::Location location = builder.getUnknownLoc();
  auto function = mlir::func::FuncOp::create(builder, location, ir::slotSymbol(ir::slot::features),
                                             builder.getFunctionType({}, {builder.getI32Type()}));
  ir::insertForRuntime(context.symbols, function);
  builder.setInsertionPointToEnd(function.addEntryBlock());
  const mlir::Value features = mlir::arith::ConstantOp::create(
      builder, location,
      builder.getI32IntegerAttr(static_cast<std::int32_t>(context.request.features)));
  ir::ReturnOp::create(builder, location, features);
  ir::attr::slot.set(function, builder.getStringAttr(ir::slot::features));
  ir::attr::exported.set(function);
}

std::vector<runtime::PrintFormat> numberPrints(mlir::ModuleOp ir) {
  std::vector<runtime::PrintFormat> formats;
  ir.walk([&](ir::PrintOp print) {
    print.setFormat(static_cast<std::uint32_t>(formats.size()));
    runtime::PrintFormat format;
    for (auto [item, words] :
         llvm::zip(print.getItems().getAsRange<mlir::StringAttr>(), print.getWords()))
      format.push_back({item.str(), kindOf(item.getValue()), static_cast<std::uint32_t>(words)});
    formats.push_back(std::move(format));
  });
  return formats;
}

} // namespace rtsl::linking
