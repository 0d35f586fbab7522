#include "codegen/passes/calls/PassParts.h"

#include "codegen/passes/calls/FunctionEffects.h"
#include "codegen/passes/calls/Parts.h"

namespace rtsl::codegen {

using mlir::func::CallOp;
using mlir::func::FuncOp;

/// An aggregate of more parts stays in memory.
constexpr std::size_t mostParts = 16;

static void pass(const std::vector<Part> &parts, unsigned number, FuncOp function,
                 llvm::ArrayRef<CallOp> callers) {
  for (CallOp call : callers) {
    mlir::OpBuilder builder(call);
    llvm::SmallVector<mlir::Value> values;
    for (const Part &part : parts)
      values.push_back(loadPart(builder, call.getLoc(), call.getOperand(number), part));
    call.getOperandsMutable().append(values);
    call->eraseOperand(number);
  }
  for (const Part &part : parts)
    replaceLoads(part, addArgument(function, part.type));
  eraseParts(function.getArgument(number));
  if (mlir::failed(function.eraseArgument(number)))
    llvm_unreachable("nothing uses it");
}

void passParts(FuncOp function, llvm::ArrayRef<CallOp> callers, const FunctionEffects &effects) {
  if (!effects.onlyReads() || effects.writesArguments) // which may be the same memory
    return;
  for (unsigned number = function.getNumArguments(); number-- > 0;)
    if (llvm::isa<ir::PtrType>(function.getArgument(number).getType()))
      if (const auto parts = partsRead(function.getArgument(number)))
        if (parts->size() <= mostParts)
          pass(*parts, number, function, callers);
}

} // namespace rtsl::codegen
