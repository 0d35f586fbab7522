//===- Configurations.h - every path that a program takes -----------------===//
#pragma once

#include "codegen/driver/Compiler.h"
#include "runtime/render/Renderer.h"

#include <ostream>
#include <string>
#include <vector>

namespace rtsl::test {

/// One way to compile and run a program. A new path is a new row of the table in
/// Configurations.cpp.
struct Configuration {
  std::string name;
  CompileOptions compile;
  runtime::Traversal traversal = runtime::Traversal::Embree;
  bool bindsScene = false; // the scene's objects are constants
};

/// The strict ones: all compute the same.
const std::vector<Configuration> &configurations();
/// The parts of the language that hold with --fp=fast, and with --fp=double.
const std::vector<Configuration> &fastConfigurations();
const std::vector<Configuration> &doubleConfigurations();

/// What GoogleTest shows of one.
inline void PrintTo(const Configuration &configuration, std::ostream *stream) {
  *stream << configuration.name;
}

} // namespace rtsl::test
