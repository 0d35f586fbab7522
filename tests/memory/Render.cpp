// Renders the scene of a package with a program that MemorySanitizer watches (tests/memory/run).
// All that the program reads was read from the file or written by itself: uninitialized memory is
// poisoned by malloc. Prints the mean of each component of the color. Exit status: 0, or that of
// the sanitizer.
#include "runtime/device/organisations/Slice.h"
#include "runtime/device/ray/Divisor.h"
#include "runtime/package/FileLayout.h"

#include <sanitizer/msan_interface.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

using namespace rtsl;
using namespace rtsl::runtime::packageFile;

namespace {

[[noreturn]] void stop(const char *why) {
  std::fprintf(stderr, "%s\n", why);
  std::exit(2);
}

void *allocate(std::uint64_t bytes) {
  void *memory = std::aligned_alloc(alignment, (bytes + alignment - 1) / alignment * alignment);
  if (!memory)
    stop("too little memory");
  return memory;
}

void *readPart(std::FILE *file, std::uint64_t offset, std::uint64_t bytes) {
  void *part = allocate(bytes);
  if (std::fseek(file, long(offset), SEEK_SET) != 0 || std::fread(part, 1, bytes, file) != bytes)
    stop("the package is not whole");
  return part;
}

Section sectionOf(std::FILE *file, SectionKind kind) {
  const auto *header = static_cast<const Header *>(readPart(file, 0, sizeof(Header)));
  if (std::memcmp(header->magic, magic, sizeof magic) != 0 || header->version != formatVersion)
    stop("this is no package of this version");
  const auto *table = static_cast<const Section *>(
      readPart(file, sizeof(Header), header->sectionCount * sizeof(Section)));
  for (std::uint32_t i = 0; i < header->sectionCount; ++i)
    if (table[i].kind == std::uint32_t(kind))
      return table[i];
  stop("the package lacks a section");
}

void *readSection(std::FILE *file, SectionKind kind) {
  const Section section = sectionOf(file, kind);
  return readPart(file, section.offset, section.bytes);
}

RtslLaunch readLaunch(std::FILE *file, const Info &info) {
  auto *scene = static_cast<char *>(readSection(file, SectionKind::Scene));
  const auto *pointers =
      static_cast<const std::uint64_t *>(readSection(file, SectionKind::Pointers));
  const std::uint64_t count = sectionOf(file, SectionKind::Pointers).bytes / sizeof *pointers;
  for (std::uint64_t i = 0; i < count; ++i) {
    std::uint64_t pointer;
    std::memcpy(&pointer, scene + pointers[i], sizeof pointer);
    pointer += reinterpret_cast<std::uintptr_t>(scene);
    std::memcpy(scene + pointers[i], &pointer, sizeof pointer);
  }
  RtslLaunch launch;
  std::memcpy(&launch, scene, sizeof launch);
  device::setLaunchSize(launch, info.width, info.height / info.slices, info.slices);
  launch.maxDepth = info.maxDepth;
  launch.seed = info.seed;
  return launch;
}

} // namespace

int main(int argc, char **argv) {
  std::FILE *file = argc == 2 ? std::fopen(argv[1], "rb") : nullptr;
  if (!file)
    stop("usage: render PACKAGE");
  const Info &info = *static_cast<const Info *>(readSection(file, SectionKind::Info));
  RtslStatus status = {};
  RtslLaunch launch = readLaunch(file, info);
  launch.status = &status;

  RtslJob job = {};
  job.launch = &launch;
  job.status = &status;
  job.samplesPerPixel = info.samplesPerPixel;
  device::setWindowSize(job, info.width, info.height);
  device::setSampleCount(job, info.samplesPerPixel);
  job.laneBytes = (rtsl_lane_bytes(launch.maxDepth, launch.referenceChain) + alignment - 1) /
                  alignment * alignment;
  job.lanes = static_cast<std::uint8_t *>(allocate(job.laneBytes));
  const std::uint64_t samples = device::samplesOfSlice(job), channels = launch.colorComponents;
  job.samples = static_cast<float *>(allocate(samples * channels * sizeof *job.samples));
  rtsl_run_lane(&job, 0);
  __msan_check_mem_is_initialized(job.samples, samples * channels * sizeof *job.samples);

  for (std::uint64_t channel = 0; channel < channels; ++channel) {
    double sum = 0;
    for (std::uint64_t i = 0; i < samples; ++i)
      sum += double(job.samples[i * channels + channel]);
    std::printf("%s%.9g", channel ? " " : "", sum / double(samples));
  }
  std::printf("\n");
  return 0;
}
