//===- StatePart.h - a part of the printer of a state ---------------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/tree/Statement.h"
#include "codegen/ir/Rtsl.h"

namespace rtsl::cpp {

struct StatePrinter;

/// What all parts have: the state, with the other parts, and the module.
class StatePart {
public:
  StatePart(StatePrinter &state, Context &context) : state(state), context(context) {}

protected:
  StatePrinter &state;
  Context &context;
};

} // namespace rtsl::cpp
