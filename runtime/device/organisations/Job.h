//===- Job.h - a slice of a rendering for the megakernel ------------------===//
//
// Plain C layouts, as in runtime/device/ray/Launch.h, and the functions of a program that has its
// own traversal and no external references.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/device/ray/Status.h"

#include <stdint.h>

/// The sums of the samples of each pixel, row by row, to which slices are added. The samples of an
/// adaptive rendering (runtime/render/passes/Adaptive.h) are in two halves: there each pixel has
/// two of everything but `taken` and `closed`, for its first half and for its second. Otherwise the
/// last three are null.
typedef struct RtslPixelSums {
  double *colors;     // colorComponents per pixel
  double *squares;    // of the values of samples, the means of their components; null: not wanted
  uint32_t *counted;  // finite samples in `colors`
  uint32_t *taken;    // all samples
  double *values;     // of the samples in `squares`
  uint32_t *deciding; // their number
  uint32_t *closed;   // bit h: half h is complete. Its colors take no sample any more, and the
                      // squares and values of the other half, which decided that, take none either
} RtslPixelSums;

/// How often warps took a step, and how many of their lanes took part.
typedef struct RtslStepCount {
  uint64_t steps, lanes;
} RtslStepCount;

/// A slice of a rendering for the megakernel (runtime/device/organisations/Megakernel.h): some
/// samples of each pixel in a window of the launch. They are numbered pixel by pixel, in the order
/// of runtime/device/organisations/Slice.h; there are less than 2^31. Lanes take them in order.
typedef struct RtslJob {
  const RtslLaunch *launch; // code for jobs asks launchOf (JobLaunch.h) for it
  RtslStatus *status;
  uint8_t *lanes;     // memory for the rays of each lane, aligned to 16 bytes
  uint64_t laneBytes; // a multiple of 16; of a wavefront on a GPU, of the stack of a slot
  // Of a wavefront on a GPU (runtime/device/organisations/WaveMemory.h), or of a persistent block.
  uint32_t slots;
  uint32_t left, top, width, height;
  uint32_t samplesPerPixel;          // of all slices
  uint32_t firstSample, sampleCount; // of each pixel in this slice
  // Of a launch that has a thread for each sample or pixel (WholeSamples.h): its samples.
  uint32_t firstOfLaunch, endOfLaunch;
  // by sampleCount, and by the pixels of a band (runtime/device/organisations/Slice.h)
  RtslDivisor bySampleCount, byBand;
  float *samples;         // colorComponents for each sample of the slice; null: not wanted
  uint32_t mayTakePixels; // whether lanes may render whole pixels: see LanePixel.h
  RtslPixelSums sums;     // of the samples before this slice; all null: there are none
  // the places of the pixels that take samples, ascending, and their number; null: all pixels
  const uint32_t *places;
  uint32_t placeCount;
  const uint32_t *taken; // sums.taken, if some pixels have samples of the slice already; or null
  float *pixels;         // the means, colorComponents per pixel, row by row; null: not wanted
  // By step (runtime/device/organisations/StepCounts.h), if they are counted.
  RtslStepCount *stepCounts;
} RtslJob;

#ifdef __cplusplus
extern "C" {
#endif

/// Bytes that a lane needs for rays up to this depth, a multiple of 16, in scenes with reference
/// chains of this length. Exact: no shader can need more.
uint64_t rtsl_lane_bytes(uint32_t maxDepth, uint32_t referenceChain);

/// Renders samples of the job until none is left, in the lane's own memory. Lanes with different
/// numbers may run at the same time.
void rtsl_run_lane(const RtslJob *job, uint32_t lane);

#ifdef __cplusplus
}
#endif
