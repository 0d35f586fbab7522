//===- Reflection.h - the description of a module as JSON -----------------===//
#pragma once

#include "codegen/driver/Compiler.h"

#include <optional>
#include <string>

namespace rtsl {

/// The classes, structs and functions of a module as JSON: types, defaults, comments, the state
/// that methods read and write, the layouts of records, payloads and frames, and the names in
/// printed C++ that differ. docs/reflection-schema.json is its schema. Nothing if there were
/// errors.
std::optional<std::string> emitReflection(const typed::Module &module,
                                          const CompileOptions &options, Diagnostics &diagnostics);

} // namespace rtsl
