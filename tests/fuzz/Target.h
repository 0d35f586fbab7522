//===- Target.h - what a fuzzer runs --------------------------------------===//
//
// All targets, FrontEnd.cpp, SceneReader.cpp, MaterialReader.cpp, GltfReader.cpp and
// ImageReader.cpp, define LLVMFuzzerTestOneInput. libFuzzer calls it with inputs that it makes;
// Replay.cpp is a plain main that calls it with files. docs/testing.md describes how to run them.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstddef>
#include <cstdint>

/// Runs one input. What must not be ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size);

namespace rtsl::fuzz {

/// Ends the process unless `holds`; fuzzers take that as a crash.
void require(bool holds, const char *what);

} // namespace rtsl::fuzz
