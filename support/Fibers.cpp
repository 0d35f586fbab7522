#include "support/Fibers.h"

#include "support/WorkerThreads.h"

#include <algorithm>
#include <cstddef>
#include <sys/mman.h>
#include <unistd.h>
#include <utility>
#include <vector>

namespace rtsl {

namespace {

/// Memory for a stack, which takes as much as is used of it. The page below it cannot be accessed.
class FiberStack {
public:
  explicit FiberStack(std::uint64_t needed) {
    const auto page = std::uint64_t(::sysconf(_SC_PAGESIZE));
    bytes = (needed + page - 1) / page * page + page;
    memory = ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS | MAP_STACK | MAP_NORESERVE, -1, 0);
    if (memory != MAP_FAILED && ::mprotect(memory, page, PROT_NONE) != 0)
      release();
  }
  FiberStack(FiberStack &&other) noexcept : memory(other.memory), bytes(other.bytes) {
    other.memory = MAP_FAILED;
  }
  FiberStack &operator=(FiberStack &&) = delete;
  ~FiberStack() { release(); }

  bool isValid() const { return memory != MAP_FAILED; }
  void *lowest() const { return memory; }
  std::size_t size() const { return bytes; }

private:
  void release() {
    if (isValid())
      ::munmap(memory, bytes);
    memory = MAP_FAILED;
  }

  void *memory;
  std::size_t bytes;
};

} // namespace

void Fibers::run(unsigned count, std::uint64_t stackBytes,
                 const std::function<void(unsigned)> &work) {
  if (current)
    return work(0);
  std::vector<FiberStack> memory;
  Fibers fibers(work);
  for (unsigned number = 1; number < std::min(count, most); ++number) {
    FiberStack stack(stackBytes + stackMargin);
    if (!stack.isValid())
      break;
    memory.push_back(std::move(stack));
    fibers.add(memory.back().lowest(), memory.back().size());
  }
  if (memory.empty())
    return work(0);
  current = &fibers;
  fibers.runOne(0);
  while (fibers.next[0] != 0)
    fibers.pause();
  current = nullptr;
  if (fibers.failure)
    std::rethrow_exception(fibers.failure);
}

/// It begins when its turn comes: switchStacks takes the address from the stack. At the beginning
/// of a function there is a return address, here null, and then a multiple of 16 bytes.
void Fibers::add(void *stack, std::size_t bytes) {
  void **top = reinterpret_cast<void **>(static_cast<std::byte *>(stack) + bytes) - 2;
  *--top = nullptr;
  *--top = reinterpret_cast<void *>(&begin);
  announced[count] = {stack, bytes};
  next[count - 1] = count;
  stacks[count++] = top;
}

void Fibers::runOne(unsigned number) {
  try {
    work(number);
  } catch (...) {
    if (!failure)
      failure = std::current_exception();
  }
}

/// The bottom of a fiber's stack.
void Fibers::begin() {
  Fibers &fibers = *current;
  const unsigned number = fibers.running;
  fibers.announced[number].arrive();
  fibers.runOne(number);
  unsigned before = number;
  while (fibers.next[before] != number)
    before = fibers.next[before];
  fibers.next[before] = fibers.next[number];
  fibers.goOn(false);
  __builtin_unreachable();
}

} // namespace rtsl
