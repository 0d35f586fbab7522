#include "runtime/image/Jpeg2000Claim.h"

#include <algorithm>

namespace rtsl::runtime {

namespace {

/// Numbers are big-endian; 0 after the end of the file.
class Numbers {
public:
  explicit Numbers(const ReadBytes &read) : read(read) {}

  std::uint64_t at(std::uint64_t offset, std::size_t bytes) const {
    std::uint64_t number = 0;
    const std::vector<unsigned char> found = read(offset, bytes);
    for (const unsigned char byte : found)
      number = number << 8 | byte;
    return found.size() == bytes ? number : 0;
  }

private:
  const ReadBytes &read;
};

constexpr std::uint64_t box(const char (&name)[5]) {
  std::uint64_t number = 0;
  for (int i = 0; i < 4; ++i)
    number = number << 8 | static_cast<unsigned char>(name[i]);
  return number;
}

/// Where the code stream begins: at once, or in a box (ISO/IEC 15444-1, I.4).
std::optional<std::uint64_t> startOfCode(const Numbers &numbers) {
  constexpr std::uint64_t startAndSize = 0xff4fff51, signature = 0x0d0a870a;
  if (numbers.at(0, 4) == startAndSize)
    return 0;
  if (numbers.at(0, 4) != 12 || numbers.at(4, 4) != box("jP  ") || numbers.at(8, 4) != signature)
    return std::nullopt;
  constexpr int mostBoxes = 1000;
  std::uint64_t place = 0;
  for (int i = 0; i < mostBoxes; ++i) {
    std::uint64_t length = numbers.at(place, 4), header = 8;
    const std::uint64_t name = numbers.at(place + 4, 4);
    if (length == 1) {
      length = numbers.at(place + 8, 8);
      header = 16;
    }
    if (name == box("jp2c"))
      return numbers.at(place + header, 4) == startAndSize ? std::optional(place + header)
                                                           : std::nullopt;
    if (length < header || length > ~std::uint64_t(0) - place - header)
      return std::nullopt;
    place += length;
  }
  return std::nullopt;
}

} // namespace

std::optional<ImageClaim> jpeg2000Claim(const ReadBytes &read) {
  const Numbers numbers(read);
  const std::optional<std::uint64_t> start = startOfCode(numbers);
  if (!start)
    return std::nullopt;
  // The segment SIZ (A.5.1): the far corner of the image, and its near one.
  const std::uint64_t right = numbers.at(*start + 8, 4), bottom = numbers.at(*start + 12, 4);
  const std::uint64_t left = numbers.at(*start + 16, 4), top = numbers.at(*start + 20, 4);
  ImageClaim claim;
  claim.format = "jpeg2000";
  claim.width = right - std::min(right, left);
  claim.height = bottom - std::min(bottom, top);
  claim.channels = numbers.at(*start + 40, 2);
  claim.bitsPerSample = (numbers.at(*start + 42, 1) & 0x7f) + 1;
  claim.pixelBytes = 4 * claim.channels;
  return claim;
}

} // namespace rtsl::runtime
