//===- Elements.h - the elements of a stored value ------------------------===//
#pragma once

#include "runtime/program/Program.h"

#include <cstdint>
#include <cstring>

namespace rtsl::runtime {

/// A single value, the elements of an array, or those of a buffer.
struct Elements {
  const std::uint8_t *first;
  std::size_t count, stride; // bytes

  const std::uint8_t *operator[](std::size_t i) const { return first + i * stride; }
};

/// Those of a value that is stored from `bytes` on; a buffer's are where it is bound.
inline Elements elementsOf(const ValueType &type, const std::uint8_t *bytes) {
  std::size_t count = 1, size = type.size;
  if (type.bufferRank != 0) {
    RtslBuffer buffer;
    std::memcpy(&buffer, bytes, sizeof buffer);
    for (std::uint8_t i = 0; i < type.bufferRank; ++i)
      count *= buffer.size[i];
    const std::uint64_t address = std::uint64_t(buffer.addressHigh) << 32 | buffer.addressLow;
    bytes = reinterpret_cast<const std::uint8_t *>(address);
    size = count * type.elementSize;
  }
  for (const std::uint32_t length : type.arraySizes)
    count *= length;
  return {bytes, count, count ? size / count : 0};
}

} // namespace rtsl::runtime
