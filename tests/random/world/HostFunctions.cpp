//===- HostFunctions.cpp - what compiled programs need from the host ------===//
#include "HostFunctions.h"

#include "Numbers.h"

#include "runtime/device/traverse/AnyHit.h"
#include "runtime/device/traverse/Traverse.h"
#include "runtime/program/ProgramHost.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <map>

namespace rtsl::random {

static std::uint32_t hashOf(const runtime::PrintFormat &format) {
  std::uint32_t sum = 0;
  for (const runtime::PrintItem &item : format)
    sum = mix(mix(sum, hashOf(item.text)), 32 * static_cast<std::uint32_t>(item.kind) + item.words);
  return sum;
}

} // namespace rtsl::random

/// All that each sample printed, as one number, by the sample. Some paths run many at a time.
static std::map<std::array<std::uint32_t, 3>, std::uint32_t> printed;
// of the program that runs, each as a number that every path gives it
static std::vector<std::uint32_t> formats;
static std::uint32_t raysThatHit = 0;

static void note(const RtslState &state, std::uint32_t format, const std::uint32_t *words,
                 std::size_t count) {
  const RtslEvents events = state.events ? *state.events : RtslEvents{};
  std::uint32_t &sum = printed[{events.x, events.y, events.sample}];
  auto add = [&](std::uint32_t word) { sum = (sum ^ word) * 16777619u ^ sum >> 15; };
  add(format);
  for (std::size_t i = 0; i != count; ++i)
    add(words[i]);
}

extern "C" void rtsl_print(RtslState *state, std::uint32_t format, const std::uint32_t *words,
                           std::uint32_t count) {
  note(*state, formats.at(format), words, count);
}

namespace rtsl::runtime {
/// `print` of shaders in C++, which have no numbers for their formats.
void print(RtslState *state, const PrintFormat &format, const std::vector<std::uint32_t> &words) {
  note(*state, random::hashOf(format), words.data(), words.size());
}
} // namespace rtsl::runtime

extern "C" std::uint32_t rtsl_traverse(RtslState *state, std::uint32_t how) {
  const auto &slots = static_cast<const rtsl::runtime::ProgramHost *>(state->launch->host)->slots;
  const std::uint32_t answer =
      how & RTSL_INVOKE_ANY_HIT
          ? rtsl::device::traverseAsking(*state, how, rtsl::runtime::FilledSlots{slots})
          : rtsl::device::traverseDevice(*state, how & RTSL_FIRST_HIT,
                                         rtsl::runtime::FilledSlots{slots});
  raysThatHit += answer == RTSL_HIT;
  return answer;
}

static constexpr std::uint64_t guardBytes = 64;
static std::uint8_t *stackMemory = nullptr;
static std::uint64_t stackBytes = 0;

/// Of the requested size; the memory after it is checked.
extern "C" void *rtsl_machine_stack(std::uint64_t bytes) {
  std::free(stackMemory);
  bytes = (bytes + 15) / 16 * 16;
  stackMemory =
      static_cast<std::uint8_t *>(std::aligned_alloc(64, (bytes + guardBytes + 63) / 64 * 64));
  std::memset(stackMemory, 0xa5, bytes + guardBytes);
  stackBytes = bytes;
  return stackMemory;
}

void rtsl::random::checkStack() {
  for (std::uint64_t i = 0; stackMemory && i != guardBytes; ++i)
    if (stackMemory[stackBytes + i] != 0xa5) {
      std::fputs("a program wrote past the machine's stack\n", stderr);
      std::abort();
    }
}

namespace rtsl::random {

void beginRun(const std::vector<runtime::PrintFormat> &prints) {
  printed.clear();
  raysThatHit = 0;
  formats.clear();
  for (const runtime::PrintFormat &format : prints)
    formats.push_back(hashOf(format));
}

std::uint32_t hashOfPrinted() {
  std::uint32_t sum = 0;
  for (const auto &[sample, one] : printed)
    sum = mix(mix(sum, mix(sample[0], sample[1])), mix(sample[2], one));
  return sum;
}

bool hasRayThatHit() {
  return raysThatHit != 0;
}

} // namespace rtsl::random
