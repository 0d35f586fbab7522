#include "codegen/cpp/states/Machine.h"

#include <algorithm>

namespace rtsl::cpp {

std::size_t Machine::argumentNumber(ir::CallArgumentOp argument) const {
  const auto at = std::find(called->offsets.begin(), called->offsets.end(),
                            static_cast<std::int32_t>(argument.getOffset()));
  return static_cast<std::size_t>(at - called->offsets.begin());
}

const Type *Machine::argumentType(std::size_t number) const {
  const typed::Variable *argument = called->arguments[number];
  return argument ? argument->type : method->returnType;
}

std::string Machine::addressName(const Context &context, std::size_t number) const {
  if (!called->arguments[number])
    return called->fields[number];
  const std::size_t before = called->arguments.size() - method->parameters.size();
  const std::string &name = context.names.of(method->parameters[number - before].get());
  return name.empty() ? called->fields[number] : name;
}

const FrameField *Machine::savedField(llvm::StringRef key) const {
  for (const FrameField &known : frame)
    if (!known.isObject && known.key == key)
      return &known;
  return nullptr;
}

unsigned lineOf(mlir::Location location, llvm::StringRef file) {
  if (auto place = llvm::dyn_cast<mlir::FileLineColLoc>(location))
    return place.getFilename() == file ? place.getLine() : 0;
  if (auto name = llvm::dyn_cast<mlir::NameLoc>(location))
    return lineOf(name.getChildLoc(), file);
  if (auto call = llvm::dyn_cast<mlir::CallSiteLoc>(location)) {
    const unsigned line = lineOf(call.getCallee(), file);
    return line != 0 ? line : lineOf(call.getCaller(), file);
  }
  if (auto fused = llvm::dyn_cast<mlir::FusedLoc>(location))
    for (mlir::Location part : fused.getLocations())
      if (unsigned line = lineOf(part, file))
        return line;
  return 0;
}

} // namespace rtsl::cpp
