//===- FileLayout.h - what is where in the file of a package --------------===//
//
// docs/packages.md describes it. Every section begins at a multiple of 64 bytes.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/organisations/Job.h"
#include "runtime/device/ray/Launch.h"
#include "runtime/device/ray/State.h"
#include "runtime/device/ray/Status.h"

#include <cstddef>
#include <cstdint>

namespace rtsl::runtime::packageFile {

inline constexpr char magic[8] = {'R', 'T', 'S', 'L', 'P', 'K', 'G', '\n'};
/// Counts up with every change that older programs would misread.
constexpr std::uint32_t formatVersion = 14;
constexpr std::uint64_t alignment = 64;

struct Header {
  char magic[8];
  std::uint32_t version;
  std::uint32_t sectionCount;
  std::uint64_t fileBytes;
  std::uint64_t checksum; // CRC-64 of the whole file, with 0 here
  char compiler[32];      // ends in zeros
};
static_assert(sizeof(Header) == 64);

enum class SectionKind : std::uint32_t {
  Info = 1,
  Ptx,
  HostCode,
  Scene,
  Pointers,
  LaneBytes,
  Buffers
};
constexpr SectionKind allKinds[] = {
    SectionKind::Info,     SectionKind::Ptx,       SectionKind::HostCode, SectionKind::Scene,
    SectionKind::Pointers, SectionKind::LaneBytes, SectionKind::Buffers};

struct Section {
  std::uint32_t kind;
  std::uint32_t reserved; // 0
  std::uint64_t offset;   // from the start of the file, a multiple of 64
  std::uint64_t bytes;
};
static_assert(sizeof(Section) == 24);

/// Sizes and offsets that the program that renders a package and the code in it must have in
/// common.
struct Layouts {
  std::uint32_t launch = sizeof(RtslLaunch), state = sizeof(RtslState), status = sizeof(RtslStatus),
                job = sizeof(RtslJob), node = sizeof(RtslBvhNode), item = sizeof(RtslTreeItem),
                instance = sizeof(RtslInstance), mesh = sizeof(RtslMesh),
                statusOffset = offsetof(RtslLaunch, status);
};

struct Info {
  Layouts layouts;
  std::uint32_t width, height, slices, samplesPerPixel, maxDepth, seed;
  std::uint32_t stateCount, frameBytes, hostStackBytes, registers;
  std::uint32_t waveStates, waveGroups, waveHasStacks, waveIsPersistent; // WaveFacts
  std::uint32_t hasSamples;
  std::uint64_t hostLaneBytes, hostRunLane; // distances from the start of the host's code
};
static_assert(sizeof(Info) == 112);

} // namespace rtsl::runtime::packageFile
