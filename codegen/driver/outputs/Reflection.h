//===- Reflection.h - the description of a module as JSON -----------------===//
#pragma once

#include "codegen/driver/Compilation.h"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>

namespace rtsl::driver {

/// The classes, structs and functions of a module as JSON: types, defaults, comments, the state
/// that methods read and write, the layouts of records, payloads and frames, and the names in
/// printed C++ that differ. docs/reflection-schema.json is its schema.
class Reflection {
public:
  /// Describes the module of a compilation that has reached level 1.
  explicit Reflection(const Compilation &compilation);
  ~Reflection();

  /// The states and frames of functions that trace.
  void addStates(const SplitReport &report);
  std::string text() const;

private:
  std::unique_ptr<nlohmann::ordered_json> json;
};

} // namespace rtsl::driver
