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

#ifdef __SANITIZE_ADDRESS__
constexpr bool mayInterleave = false;
#elif defined(__has_feature)
constexpr bool mayInterleave = !__has_feature(address_sanitizer);
#else
constexpr bool mayInterleave = true;
#endif

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
  void *end() const { return static_cast<std::byte *>(memory) + bytes; }

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
  for (unsigned number = 1; mayInterleave && number < std::min(count, most); ++number) {
    FiberStack stack(stackBytes + stackMargin);
    if (!stack.isValid())
      break;
    memory.push_back(std::move(stack));
    fibers.add(memory.back().end());
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
void Fibers::add(void *stackEnd) {
  void **top = static_cast<void **>(stackEnd) - 2;
  *--top = nullptr;
  *--top = reinterpret_cast<void *>(&begin);
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
  fibers.runOne(number);
  unsigned before = number;
  while (fibers.next[before] != number)
    before = fibers.next[before];
  fibers.next[before] = fibers.next[number];
  fibers.pause(); // for good: no one goes on with it
  __builtin_unreachable();
}

} // namespace rtsl
