//===- ImageReader.h - reading image files, in a library of its own -------===//
//
// OpenImageIO depends on more than a hundred libraries, which take a third of a second to load. A
// program does so only when it reads an image for a sampler that is no PNG: then it opens
// `rtsl-images.so`.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>

namespace rtsl::runtime {

struct ImageFile {
  enum class Problem : std::uint8_t { None, Bad, TooLarge, NoMemory };

  std::uint32_t width, height, channels;
  std::uint32_t bytesPerChannel; // 1, 2 or 4
  bool isFloat;                  // half or float; otherwise unsigned
  bool isSecondAlpha;
  bool isSrgb; // the file's own statement, or that of its format
  // The rows from the top; `allocate` gives the memory.
  void *pixels;
  Problem problem;
  char message[512]; // of a bad file
};

/// Reads the first image of a file, unless it has more bytes than `mostBytes`, takes more memory
/// than `freeBytes`, or claims more than a file of this size can hold; if `bytes` is not null, of
/// these bytes, which are a file's. `allocate(context, bytes)` is called several times for a large
/// file, each time for more, and keeps what the memory before had; it returns null if there is no
/// memory.
using ReadImageFile = void (*)(const char *path, const void *bytes, std::uint64_t size,
                               std::uint64_t mostBytes, std::uint64_t freeBytes,
                               void *(*allocate)(void *context, std::uint64_t), void *context,
                               ImageFile *file);
constexpr const char *readImageFileSymbol = "rtslReadImageFile";

} // namespace rtsl::runtime
