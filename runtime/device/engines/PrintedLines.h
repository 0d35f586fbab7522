//===- PrintedLines.h - `print` into the memory of a device ---------------===//
//
// Lanes append their lines to words that they share, in any order; the host takes them after each
// launch and sorts them (runtime/program/PrintLog.h). From the line that fills half of the words
// on, lanes take no more samples: the other half is for the samples in flight. The host then
// launches the rest of the slice.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Events.h"
#include "runtime/device/ray/State.h"
#include "runtime/device/ray/Status.h"

namespace rtsl::device {

/// Precedes the words of the values of a line.
struct LineHeader {
  uint32_t words; // of the line, with this header; 0: no line follows
  uint32_t x, y, sample, order, format;
};

constexpr uint32_t headerWords = sizeof(LineHeader) / sizeof(uint32_t);

/// The next line of the sample. If there is no room for it, it is counted as lost.
inline void printLine(RtslStatus &status, RtslEvents &events, uint32_t format,
                      const uint32_t *values, uint32_t count) {
  if (events.x == unheard)
    return;
  RtslPrintedLines &printed = *status.printed;
  const uint32_t order = events.printed++;
  const uint32_t length = headerWords + count;
  const uint64_t first = __atomic_fetch_add(&printed.reserved, uint64_t(length), __ATOMIC_RELAXED);
  if (first + length > printed.capacity / 2)
    __atomic_store_n(&status.stop, 1u, __ATOMIC_RELAXED);
  if (first + length > printed.capacity) {
    if (first < printed.capacity)
      printed.words[first] = 0;
    __atomic_fetch_add(&printed.lost, uint64_t(1), __ATOMIC_RELAXED);
    return;
  }
  uint32_t *const words = printed.words + first;
  const uint32_t header[headerWords] = {length, events.x, events.y, events.sample, order, format};
  for (uint32_t i = 0; i < headerWords; ++i)
    words[i] = header[i];
  for (uint32_t i = 0; i < count; ++i)
    words[headerWords + i] = values[i];
}

} // namespace rtsl::device
