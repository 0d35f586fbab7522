//===- FunctionPart.h - a part of the printer of a function ---------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/tree/Statement.h"

namespace rtsl::cpp {

struct FunctionPrinter;

/// What all parts have: the function, with the other parts, and the module.
class FunctionPart {
public:
  FunctionPart(FunctionPrinter &printer, Context &context) : printer(printer), context(context) {}

protected:
  FunctionPrinter &printer;
  Context &context;
};

} // namespace rtsl::cpp
