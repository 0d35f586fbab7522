//===- MachineMemory.h - how much memory there is -------------------------===//
#pragma once

#include <cstdint>
#include <filesystem>
#include <utility>

namespace rtsl {

/// Bytes that this process can still take: what the machine has free or can free, and what the
/// control groups of the process leave it. The largest number if the system does not say. `root` is
/// another folder in tests only.
std::uint64_t availableMemory(const std::filesystem::path &root = "/");

/// Counts an allocation whose pages are taken only when they are written. An allocation for which
/// there is not enough memory is refused at once: otherwise the system would kill the process in
/// the middle of a launch.
class MemoryReservation {
public:
  MemoryReservation() = default;
  /// Throws std::bad_alloc if all reservations are more than the process has and can still take.
  explicit MemoryReservation(std::uint64_t bytes);
  MemoryReservation(MemoryReservation &&other) noexcept : bytes(std::exchange(other.bytes, 0)) {}
  MemoryReservation &operator=(MemoryReservation &&other) noexcept {
    std::swap(bytes, other.bytes);
    return *this;
  }
  ~MemoryReservation();

  /// The bytes of all reservations.
  static std::uint64_t all();

private:
  std::uint64_t bytes = 0;
};

} // namespace rtsl
