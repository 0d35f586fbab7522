// Renders the scene of a package with a program that MemorySanitizer watches (tests/memory/run).
// All that the program reads was read from the file or written by itself: uninitialized memory is
// poisoned by malloc. Exit status: 0, or that of the sanitizer.
#include "runtime/device/organisations/Job.h"

#include <sanitizer/msan_interface.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// A part of a package (docs/packages.md).
typedef struct {
  uint32_t kind, reserved;
  uint64_t offset, bytes;
} Section;

enum { infoSection = 1, sceneSection = 4, pointerSection = 5 };
enum { sectionCountAt = 12, tableAt = 64, widthAt = 32 }; // in bytes

static void *readPart(FILE *file, uint64_t offset, uint64_t bytes) {
  void *part = aligned_alloc(64, (bytes + 63) / 64 * 64);
  if (!part || fseek(file, (long)offset, SEEK_SET) != 0 || fread(part, 1, bytes, file) != bytes) {
    fputs("the package is not whole\n", stderr);
    exit(2);
  }
  return part;
}

static Section sectionOf(FILE *file, uint32_t kind) {
  const uint32_t *count = readPart(file, sectionCountAt, sizeof *count);
  const Section *table = readPart(file, tableAt, *count * sizeof *table);
  for (uint32_t i = 0; i < *count; ++i)
    if (table[i].kind == kind)
      return table[i];
  fprintf(stderr, "the package has no section of kind %u\n", kind);
  exit(2);
}

static void *readSection(FILE *file, uint32_t kind) {
  const Section section = sectionOf(file, kind);
  return readPart(file, section.offset, section.bytes);
}

int main(int argc, char **argv) {
  FILE *file = argc == 2 ? fopen(argv[1], "rb") : NULL;
  if (!file) {
    fputs("usage: render PACKAGE\n", stderr);
    return 2;
  }
  const char *info = (const char *)readSection(file, infoSection);
  const uint32_t *options = (const uint32_t *)(info + widthAt);
  char *scene = readSection(file, sceneSection);
  const uint64_t *pointers = readSection(file, pointerSection);
  for (uint64_t i = 0; i < sectionOf(file, pointerSection).bytes / sizeof *pointers; ++i) {
    uint64_t pointer;
    memcpy(&pointer, scene + pointers[i], sizeof pointer);
    pointer += (uint64_t)(uintptr_t)scene;
    memcpy(scene + pointers[i], &pointer, sizeof pointer);
  }

  RtslStatus status = {0};
  RtslLaunch launch;
  memcpy(&launch, scene, sizeof launch);
  launch.width = options[0];
  launch.height = options[1];
  launch.slices = 1;
  launch.maxDepth = options[3];
  launch.seed = options[4];
  launch.status = &status;
  RtslJob job = {0};
  job.launch = &launch;
  job.status = &status;
  job.width = launch.width;
  job.height = launch.height;
  job.samplesPerPixel = job.sampleCount = options[2];
  job.laneBytes = (rtsl_lane_bytes(launch.maxDepth, launch.referenceChain) + 63) / 64 * 64;
  job.lanes = aligned_alloc(64, job.laneBytes);
  const uint64_t floats =
      (uint64_t)launch.width * launch.height * job.sampleCount * launch.colorComponents;
  job.samples = malloc(floats * sizeof *job.samples);
  rtsl_run_lane(&job, 0);
  __msan_check_mem_is_initialized(job.samples, floats * sizeof *job.samples);

  double sum = 0;
  for (uint64_t i = 0; i < floats; ++i)
    sum += job.samples[i];
  printf("mean %.9g\n", sum / (double)floats);
  return 0;
}
