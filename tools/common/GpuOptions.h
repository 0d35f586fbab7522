//===- GpuOptions.h - options of renderings on GPUs -----------------------===//
#pragma once

#include <CLI/CLI.hpp>

#include <cstddef>
#include <cstdint>

namespace rtsl::tool {

struct GpuOptions {
  std::size_t count = 1;          // devices; 0: all
  std::uint32_t maxRegisters = 0; // of a thread; 0: by the program (runtime::Package::registers)
};

/// Adds --gpus.
void addGpusOption(CLI::App &command, GpuOptions &options);
/// Adds --max-registers.
void addMaxRegistersOption(CLI::App &command, GpuOptions &options);
/// When all options are read, of a command that does not render on a GPU. Throws if one of these
/// options was given.
void rejectGpuOptions(const CLI::App &command);

} // namespace rtsl::tool
