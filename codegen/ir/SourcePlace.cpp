#include "codegen/ir/SourcePlace.h"

#include "mlir/IR/Location.h"
#include "llvm/Support/Path.h"

namespace rtsl::ir {

std::string SourcePlace::text() const {
  if (file.empty())
    return {};
  return (llvm::sys::path::filename(file) + ":" + llvm::Twine(line) + ":" + llvm::Twine(column))
      .str();
}

SourcePlace placeOf(mlir::Location location) {
  if (auto file = llvm::dyn_cast<mlir::FileLineColLoc>(location))
    return {file.getFilename().str(), file.getLine(), file.getColumn()};
  if (auto name = llvm::dyn_cast<mlir::NameLoc>(location))
    return placeOf(name.getChildLoc());
  if (auto call = llvm::dyn_cast<mlir::CallSiteLoc>(location)) {
    SourcePlace place = placeOf(call.getCallee());
    return place.isKnown() ? place : placeOf(call.getCaller());
  }
  if (auto fused = llvm::dyn_cast<mlir::FusedLoc>(location))
    for (mlir::Location part : fused.getLocations())
      if (SourcePlace place = placeOf(part); place.isKnown())
        return place;
  return {};
}

} // namespace rtsl::ir
