//===- MethodPrinter.h - what the printers of a method's states share -----===//
#pragma once

#include "codegen/cpp/functions/FunctionPrinter.h"
#include "codegen/cpp/states/values/ValueTypes.h"

namespace rtsl::cpp {

struct MethodPrinter {
  MethodPrinter(Context &context, const SourceTable &source, const Machine &machine);
  MethodPrinter(const MethodPrinter &) = delete;

  /// Reports an operation that cannot be printed; one message a method is enough.
  void unsupported(mlir::Operation &op);

  Context &context;
  const SourceTable &source;
  const Machine &machine;
  FunctionPrinter functions; // of the author's expressions
  ValueTypes types;
  bool hasRefused = false;
};

} // namespace rtsl::cpp
