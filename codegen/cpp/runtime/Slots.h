//===- Slots.h - the functions that the runtime calls ---------------------===//
#pragma once

#include "codegen/cpp/Context.h"
#include "codegen/cpp/states/StateMachines.h"
#include "codegen/cpp/tree/Declaration.h"

namespace rtsl::cpp {

/// A slot that some class fills: `program.slots().base_method`.
struct FilledSlot {
  std::string base, method;
};

/// The namespace `slots`. `withHitErrors`: classes with a function `boundHitError`.
Declarations slots(Context &context, const StateEntries &entries,
                   const std::set<const typed::Class *> &withHitErrors,
                   std::vector<FilledSlot> &filled);

/// `program.slots().name = &slots::function;`
Statement setSlot(const std::string &name, const std::string &function);

} // namespace rtsl::cpp
