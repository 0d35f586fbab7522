//===- Description.h - how a program is described to the runtime ------------===//
//
//   static RtslShaders describe() {
//     rtsl::Program<3> program;
//     program.add<Glass>(static_cast<std::uint32_t>(Id::Glass), "Glass", ...).member(...);
//     program.slots().rt_Material_shade = &slots::shade;
//     ...
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/cpp/runtime/Slots.h"

namespace rtsl::cpp {

/// The function `describe`, and those for the structs that a scene sets.
Declarations description(Context &context, const StateEntries &entries,
                         const std::vector<FilledSlot> &filled);

} // namespace rtsl::cpp
