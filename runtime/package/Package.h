//===- Package.h - a scene and its compiled code in one file --------------===//
//
// What `rtslc pack` writes and `rtsl-run` renders: PTX for GPUs, machine code for CPUs, and the
// flat scene. docs/packages.md describes the file.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/FlatScene.h"
#include "runtime/package/Buffers.h"
#include "runtime/program/Program.h"
#include "runtime/render/RenderOptions.h"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl::runtime {

/// Machine code that runs wherever it lies: it refers to itself alone, and by distances.
struct NativeImage {
  std::vector<std::uint8_t> bytes;
  std::uint64_t laneBytes = 0, runLane = 0; // where these functions begin (MegakernelCode)
  std::uint32_t stackBytes = 0;             // that runLane takes of its thread
};

struct Package {
  std::string compiler;                         // "rtslc 0.1.0", at most 31 bytes
  RenderOptions options;                        // the scene's own size, samples, depth and seed
  bool hasSamples = false;                      // the scene gives the samples
  std::uint32_t stateCount = 0, frameBytes = 0; // of the largest frame
  /// The results of rtsl_lane_bytes of its code, for each depth limit from 0.
  std::array<std::uint32_t, maxRayDepth + 1> laneBytes{};

  std::string ptx;
  std::uint32_t registers = 0; // GpuCode::maxRegisters
  WaveFacts wave;
  std::vector<std::string> stateNames; // Program::stateNames; not in the file
  NativeImage host;
  FlatScene scene; // not relocated
  std::vector<PackageBuffer> buffers;
};

/// The same package gives the same bytes.
std::string serialize(const Package &package);

/// `name` is for messages. Throws BadPackage: no package, one of another version, truncated, or
/// damaged. A change of any one byte is found.
Package parsePackage(std::string_view bytes, const std::string &name);

/// Throws FileNotFound, FileUnreadable, BadPackage.
Package readPackage(const std::string &path);

} // namespace rtsl::runtime
