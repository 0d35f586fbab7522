//===- WorkerThreads.cpp - threads with a stack of the required size ------===//
#include "support/WorkerThreads.h"

#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <exception>
#include <pthread.h>
#include <unistd.h>

namespace rtsl {

namespace {

/// The remaining stack of this thread.
std::uint64_t stackLeft() {
  pthread_attr_t attributes;
  if (::pthread_getattr_np(::pthread_self(), &attributes) != 0)
    return 0;
  void *lowest = nullptr;
  std::size_t size = 0;
  ::pthread_attr_getstack(&attributes, &lowest, &size);
  ::pthread_attr_destroy(&attributes);
  const char here = 0;
  return std::uint64_t(std::max<std::ptrdiff_t>(&here - static_cast<const char *>(lowest), 0));
}

std::uint64_t machineMemory() {
  return std::uint64_t(::sysconf(_SC_PHYS_PAGES)) * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

struct Worker {
  const std::function<void(unsigned)> *work;
  unsigned number;
  pthread_t thread{};
  std::exception_ptr failure = {};

  void run() {
    try {
      (*work)(number);
    } catch (...) {
      failure = std::current_exception();
    }
  }
};

void *runWorker(void *worker) {
  static_cast<Worker *>(worker)->run();
  return nullptr;
}

/// Starts the thread; returns whether that succeeded.
bool start(Worker &worker, std::uint64_t stackBytes) {
  pthread_attr_t attributes;
  ::pthread_attr_init(&attributes);
  std::size_t usual = 0; // if the default size is unknown
  ::pthread_attr_getstacksize(&attributes, &usual);
  const bool isStarted =
      ::pthread_attr_setstacksize(&attributes, std::max<std::size_t>(stackBytes, usual)) == 0 &&
      ::pthread_create(&worker.thread, &attributes, runWorker, &worker) == 0;
  ::pthread_attr_destroy(&attributes);
  return isStarted;
}

[[noreturn]] void refuse(std::uint64_t stackBytes) {
  throw Error(message::noMemoryForStack(double(stackBytes) / (1 << 20)));
}

} // namespace

void runOnThreads(unsigned count, std::uint64_t stackBytes,
                  const std::function<void(unsigned)> &work) {
  // Whole pages, as the system requires.
  const std::uint64_t page = std::uint64_t(::sysconf(_SC_PAGESIZE));
  const std::uint64_t needed = (stackBytes + stackMargin + page - 1) / page * page;
  const std::uint64_t memory = machineMemory();
  if (stackBytes > memory)
    refuse(stackBytes);
  // Stacks take memory only where they are used, but all of them may be used.
  count = unsigned(std::min<std::uint64_t>(count, std::max<std::uint64_t>(memory / needed, 1)));
  const bool takesPart = needed <= stackLeft();

  std::deque<Worker> workers; // which are never moved
  for (unsigned number = takesPart ? 1 : 0; number < count; ++number) {
    workers.push_back({&work, number});
    if (!start(workers.back(), needed)) {
      workers.pop_back();
      break;
    }
  }
  if (!takesPart && workers.empty())
    refuse(stackBytes);
  Worker here{&work, 0};
  if (takesPart)
    here.run();
  for (Worker &worker : workers)
    ::pthread_join(worker.thread, nullptr);
  workers.push_back(here);
  for (const Worker &worker : workers)
    if (worker.failure)
      std::rethrow_exception(worker.failure);
}

} // namespace rtsl
