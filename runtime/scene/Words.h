//===- Words.h - the memory of a buffer -----------------------------------===//
#pragma once

#include "support/MachineMemory.h"

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>
#include <vector>

namespace rtsl::runtime {

/// 32-bit words, which stay where they are and as many as they are.
class Words {
public:
  /// Zeros, which take memory only where they are written. Throws std::bad_alloc if that is more
  /// than there is.
  explicit Words(std::size_t count)
      : reservation(bytesOf(count)),
        zeros(static_cast<std::uint32_t *>(std::calloc(count ? count : 1, sizeof(std::uint32_t)))),
        first(zeros.get()), count(count) {
    if (!zeros)
      throw std::bad_alloc();
  }
  explicit Words(std::vector<std::uint32_t> words)
      : given(std::move(words)), first(given.data()), count(given.size()) {}
  Words(const Words &) = delete;
  Words &operator=(const Words &) = delete;

  std::uint32_t *data() const { return first; }
  std::size_t size() const { return count; }

private:
  struct Free {
    void operator()(std::uint32_t *memory) const { std::free(memory); }
  };

  static std::uint64_t bytesOf(std::size_t count) {
    if (count > std::size_t(-1) / sizeof(std::uint32_t))
      throw std::bad_alloc();
    return count * sizeof(std::uint32_t);
  }

  MemoryReservation reservation;
  std::unique_ptr<std::uint32_t, Free> zeros;
  std::vector<std::uint32_t> given;
  std::uint32_t *const first;
  const std::size_t count;
};

} // namespace rtsl::runtime
