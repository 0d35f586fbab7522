//===- References.h - references to objects inside of values --------------===//
#pragma once

#include "runtime/program/Program.h"

#include <cstdint>
#include <functional>

namespace rtsl::runtime {

/// Whether a value of this type can hold a reference.
bool holdsReferences(const ValueType &type);

/// Calls `visit` with each reference in the value of this type at `bytes`, elements of buffers and
/// fields of structs included, in order. Empty references are skipped.
void forEachReference(const ValueType &type, const std::uint8_t *bytes,
                      const std::function<void(RtslRef)> &visit);

} // namespace rtsl::runtime
