//===- AnnouncedStack.h - stacks that AddressSanitizer is told about ------===//
//
// AddressSanitizer keeps the bounds of a thread's stack, and frames of its own beside it. It has to
// be told when a thread goes on with another stack; without it, nothing here does anything.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstddef>

#if defined(__SANITIZE_ADDRESS__)
#define RTSL_HAS_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#define RTSL_HAS_ADDRESS_SANITIZER __has_feature(address_sanitizer)
#else
#define RTSL_HAS_ADDRESS_SANITIZER 0
#endif

#if RTSL_HAS_ADDRESS_SANITIZER
#include <sanitizer/common_interface_defs.h>
#endif

namespace rtsl {

#if RTSL_HAS_ADDRESS_SANITIZER

class AnnouncedStack {
public:
  AnnouncedStack() = default; // that of the thread: known once the thread has left it
  AnnouncedStack(const void *lowest, std::size_t bytes) : lowest(lowest), bytes(bytes) {}

  /// To be called before the thread leaves this stack for another one; `returns`: it will be back.
  void leaveFor(const AnnouncedStack &other, bool returns) {
    left = this;
    __sanitizer_start_switch_fiber(returns ? &frames : nullptr, other.lowest, other.bytes);
  }
  /// To be called on this stack, once the thread has left another one for it.
  void arrive() { __sanitizer_finish_switch_fiber(frames, &left->lowest, &left->bytes); }

private:
  static inline thread_local AnnouncedStack *left = nullptr; // the last one

  void *frames = nullptr; // of AddressSanitizer
  const void *lowest = nullptr;
  std::size_t bytes = 0;
};

#else

class AnnouncedStack {
public:
  AnnouncedStack() = default;
  AnnouncedStack(const void *, std::size_t) {}
  void leaveFor(const AnnouncedStack &, bool) {}
  void arrive() {}
};

#endif

} // namespace rtsl
