//===- HostPrint.cpp - `print` of shaders on the host ---------------------===//
//
// An object file of its own, so that a program that handles the output of shaders in another way
// can define these functions itself.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/engines/PrintedLines.h"
#include "runtime/program/PrintLog.h"

#include <utility>

namespace rtsl::runtime {

/// Takes a lock; it need not be fast.
static void add(const RtslState &state, PrintedLine line) {
  if (RtslEvents *events = state.events) {
    if (events->x == device::unheard)
      return;
    line.x = events->x;
    line.y = events->y;
    line.sample = events->sample;
    line.order = events->printed++;
  }
  addPrinted(std::move(line));
}

void print(RtslState *state, const PrintFormat &format, const std::vector<std::uint32_t> &words) {
  add(*state, {0, 0, PrintedLine::noSample, 0, 0, {}, itemsText(format, words.data())});
}

} // namespace rtsl::runtime

extern "C" void rtsl_print(RtslState *state, std::uint32_t format, const std::uint32_t *words,
                           std::uint32_t count) {
  using rtsl::runtime::PrintedLine;
  RtslStatus *const status = state->launch ? state->launch->status : nullptr;
  if (status && status->printed && state->events)
    return rtsl::device::printLine(*status, *state->events, format, words, count);
  rtsl::runtime::add(*state, {0, 0, PrintedLine::noSample, 0, format, {words, words + count}});
}
