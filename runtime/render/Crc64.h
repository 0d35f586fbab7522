//===- Crc64.h - the checksum of our files --------------------------------===//
#pragma once

#include <cstdint>
#include <string_view>

namespace rtsl::runtime {

/// CRC-64/XZ of `bytes`, which follow bytes with the CRC `before`.
std::uint64_t crc64(std::string_view bytes, std::uint64_t before = 0);

} // namespace rtsl::runtime
