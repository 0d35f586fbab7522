//===- Fibers.h - pieces of work that take turns on one thread ------------===//
//
// A load from memory takes longer than it takes to let another piece of work go on: each has a
// stack of its own, begins a load, and pauses until the others have paused in turn (Psaropoulos et
// al., "Interleaving with Coroutines: A Practical Approach for Robust Index Joins", VLDB 2017). A
// pause takes about as long as a call.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "support/AnnouncedStack.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>

namespace rtsl {

class Fibers {
public:
  static constexpr unsigned most = 8;

  /// Runs work(0) ... work(count - 1), at most `most`, in turns on this thread: one begins, and at
  /// each pause the next one goes on. work(0) runs on the thread's own stack, the others have
  /// `stackBytes` each, beside stackMargin (WorkerThreads.h). If memory for stacks is short, some
  /// are left out. Rethrows an exception of `work` when all have ended. Only work(0) runs within a
  /// fiber, as a part of it.
  static void run(unsigned count, std::uint64_t stackBytes,
                  const std::function<void(unsigned)> &work);

  /// Those that run on this thread; null unless there are several.
  static Fibers *ofThread() { return current; }

  /// Of those of this thread, if it has several: lets the others go on.
  static void pauseThread() {
    if (current)
      current->pause();
  }

  /// Of this thread's fiber that runs; 0 if there is one.
  static unsigned number() { return current ? current->running : 0; }

  /// Lets the others go on, until each of them has paused or ended.
  [[gnu::always_inline]] void pause() {
    if (next[running] != running)
      goOn(true);
  }

private:
  explicit Fibers(const std::function<void(unsigned)> &work) : work(work) {}

  void add(void *stack, std::size_t bytes);
  /// With the next one; `returns`: until it is this one's turn.
  [[gnu::always_inline]] void goOn(bool returns) {
    const unsigned from = running;
    running = next[from];
    announced[from].leaveFor(announced[running], returns);
    switchStacks(stacks[from], stacks[running]);
    announced[from].arrive();
  }
  void runOne(unsigned number);
  [[noreturn]] static void begin();

  /// Stores the state of this fiber, and goes on where another one has stored its own. The compiler
  /// saves the registers that are in use, all but two that it does not let go. The 128 bytes below
  /// the stack's end may be in use, too.
  [[gnu::always_inline]] static void switchStacks(void *&from, void *to) {
    void **stored = &from;
    asm volatile("leaq -128(%%rsp), %%rsp\n\t"
                 "pushq %%rbp\n\t"
                 "pushq %%rbx\n\t"
                 "leaq 1f(%%rip), %%rax\n\t"
                 "pushq %%rax\n\t"
                 "movq %%rsp, (%0)\n\t"
                 "movq %1, %%rsp\n\t"
                 "popq %%rax\n\t"
                 "jmpq *%%rax\n"
                 "1:\n\t"
                 "popq %%rbx\n\t"
                 "popq %%rbp\n\t"
                 "leaq 128(%%rsp), %%rsp"
                 : "+D"(stored), "+S"(to)
                 :
                 : "rax", "rcx", "rdx", "r8", "r9", "r10", "r11", "r12", "r13", "r14", "r15", "cc",
                   "memory", "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8",
                   "xmm9", "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15"
#ifdef __AVX512F__
                   ,
                   "xmm16", "xmm17", "xmm18", "xmm19", "xmm20", "xmm21", "xmm22", "xmm23", "xmm24",
                   "xmm25", "xmm26", "xmm27", "xmm28", "xmm29", "xmm30", "xmm31", "k1", "k2", "k3",
                   "k4", "k5", "k6", "k7"
#endif
    );
  }

  static inline thread_local Fibers *current = nullptr;

  const std::function<void(unsigned)> &work;
  unsigned count = 1, running = 0;
  std::array<unsigned, most> next{}; // a ring of those that have not ended
  std::array<void *, most> stacks{}; // where those that pause go on: the end of the stack
  std::array<AnnouncedStack, most> announced;
  std::exception_ptr failure = {}; // the first
};

} // namespace rtsl
