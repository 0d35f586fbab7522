#include "codegen/cpp/states/MethodPrinter.h"

#include <fmt/format.h>

namespace rtsl::cpp {

MethodPrinter::MethodPrinter(Context &context, const SourceTable &source, const Machine &machine)
    : context(context), source(source), machine(machine), functions(context, machine.method),
      types(context, source, machine) {
  functions.isNested = false;
}

void MethodPrinter::unsupported(mlir::Operation &op) {
  if (hasRefused) // one message a method is enough
    return;
  hasRefused = true;
  std::string what = op.getName().stripDialect().str();
  if (llvm::isa<ir::VarOp, ir::TableOp>(op))
    what = "an array or a struct";
  else if (llvm::isa<mlir::func::CallOp, ir::EnterOp, ir::ReturnOp>(op))
    what = "a call of a large function that traces,";
  const unsigned line = lineOf(op.getLoc(), machine.file);
  context.unsupported(
      machine.method->range,
      fmt::format("{} in states in C++{}", what, line ? fmt::format(" (line {})", line) : ""));
}

} // namespace rtsl::cpp
