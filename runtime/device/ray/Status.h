//===- Status.h - what goes wrong or is counted while samples run ---------===//
#pragma once

#include <stdint.h>

// What may go wrong in a sample. The first exception ends it (docs/language.md, "Exceptions").
#define RTSL_EXCEPTION_NONE 0u
#define RTSL_EXCEPTION_STACK_OVERFLOW 1u // a ray deeper than the launch allows
#define RTSL_EXCEPTION_BAD_RAY 2u        // not finite, or without a direction
#define RTSL_EXCEPTION_INDEX 3u          // an index out of range
#define RTSL_EXCEPTIONS 4u

/// How many of the samples that are not finite a status records: the first in the order of the
/// image.
#define RTSL_FIRST_NOT_FINITE 8

/// The lines that `print` has written on a device since the host took them
/// (runtime/device/engines/PrintedLines.h).
typedef struct RtslPrintedLines {
  uint64_t capacity; // of `words`
  uint64_t reserved; // words for all lines, also for those that did not fit
  uint64_t lost;     // lines that did not fit
  uint32_t *words;
} RtslPrintedLines;

/// What searches of the trees visit, of programs that count their steps.
typedef struct RtslTreeVisits {
  uint64_t rays;         // searches from the root of the world
  uint64_t nodes, items; // of all of them, also in the trees of meshes
} RtslTreeVisits;

/// What all lanes of a job write, atomically. The host clears it before the job.
typedef struct RtslStatus {
  uint64_t nextSample;          // the first of the slice that no lane has taken
  uint64_t badRays;             // not finite, or without a direction: their color is 0
  uint64_t raysTooDeep;         // deeper than the launch allows: they were not sent
  uint64_t samplesNotFinite;    // left out of the means of their pixels
  uint64_t pixelsWithoutSample; // black, because none of their samples was finite
  uint64_t firstNotFinite[RTSL_FIRST_NOT_FINITE]; // ~(sample + pixel * 2^32), descending; 0: none
  uint64_t exceptions[RTSL_EXCEPTIONS];           // samples that ended with each exception
  RtslTreeVisits visits;
  uint32_t stop;    // set by the host or a lane: no lane takes samples any more
  uint32_t problem; // RTSL_PROBLEM_*
  uint32_t hasSums; // lanes have added the samples of the slice to the sums, and computed the means
  RtslPrintedLines
      *printed; // null: the program prints nothing, or the host takes each line at once
} RtslStatus;

#define RTSL_PROBLEM_NONE 0u
#define RTSL_PROBLEM_STACK 1u // laneBytes is less than rtsl_lane_bytes: no lane was started
