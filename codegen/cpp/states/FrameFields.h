//===- FrameFields.h - the fields of a method's frame ---------------------===//
#pragma once

#include "codegen/cpp/states/Machine.h"
#include "codegen/cpp/states/MethodPrinter.h"

namespace rtsl::cpp {

/// Fills machine.frame in the order in which the fields are saved first, bools last. No field has
/// the name of one of `types`.
void collectFrame(Machine &machine, MethodPrinter &method, const std::set<std::string> &types);

} // namespace rtsl::cpp
