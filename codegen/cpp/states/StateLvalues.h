//===- StateLvalues.h - lvalues for addresses of the IR -------------------===//
#pragma once

#include "codegen/cpp/states/StatePart.h"

#include "llvm/ADT/DenseMap.h"

namespace rtsl::cpp {

class StateLvalues : StatePart {
public:
  using StatePart::StatePart;

  Code of(mlir::Value address);
  /// `frame.field`
  Code frameField(const std::string &field) const;
  /// An address of an element has this index.
  void setIndex(ir::ElementOp element, Code index);
  bool indicesMention(const std::string &name) const;
  /// The variable counts lights, and is read as the number in the loop over them.
  void countLights(mlir::Operation *variable, Code number);

private:
  llvm::DenseMap<mlir::Operation *, Code> indices, lightNumbers;
};

} // namespace rtsl::cpp
