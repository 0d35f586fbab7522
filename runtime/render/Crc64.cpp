#include "runtime/render/Crc64.h"

#include <lzma.h>

namespace rtsl::runtime {

std::uint64_t crc64(std::string_view bytes, std::uint64_t before) {
  return lzma_crc64(reinterpret_cast<const std::uint8_t *>(bytes.data()), bytes.size(), before);
}

} // namespace rtsl::runtime
