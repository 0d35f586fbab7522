//===- Crc64.h - has a file changed? --------------------------------------===//
//
// CRC-64/XZ: the polynomial of ECMA-182, bits reflected, all ones before and inverted after. It
// finds every change of up to 64 bits in a row, and all others but one in 2^64.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace rtsl::runtime {

namespace detail {
constexpr std::array<std::uint64_t, 256> crc64Table() {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t remainder = byte;
    for (int bit = 0; bit < 8; ++bit)
      remainder = remainder >> 1 ^ (remainder & 1 ? 0xc96c5795d7870f42u : 0);
    table[byte] = remainder;
  }
  return table;
}
} // namespace detail

/// The checksum of `bytes`; `before` is that of what stands before them.
inline std::uint64_t crc64(std::string_view bytes, std::uint64_t before = 0) {
  static constexpr std::array<std::uint64_t, 256> table = detail::crc64Table();
  std::uint64_t remainder = ~before;
  for (char byte : bytes)
    remainder = table[(remainder ^ std::uint8_t(byte)) & 255] ^ remainder >> 8;
  return ~remainder;
}

} // namespace rtsl::runtime
