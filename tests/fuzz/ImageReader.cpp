//===- ImageReader.cpp - any bytes through the reader of images -----------===//
//
// As a file, for which OpenImageIO finds out the format, and as bytes of a model.
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include "runtime/image/Texels.h"

#include <sys/mman.h>
#include <unistd.h>

#include <string>

using namespace rtsl;
using fuzz::attempt;
using fuzz::require;

namespace {

void check(const runtime::Pixels &pixels) {
  require(pixels.width > 0 && pixels.height > 0 && pixels.channels >= 1 && pixels.channels <= 4,
          "an image has pixels");
  runtime::Texels texels = runtime::texelsOf({pixels});
  runtime::dropNotFinite(texels);
  runtime::addLevels(texels);
  require(!texels.levelStarts.empty(), "an image has levels");
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  const std::string bytes(reinterpret_cast<const char *>(data), size);
  attempt([&] { check(runtime::decodePixels(bytes, "image", runtime::ColorSpace::ByFile)); });
  const int file = memfd_create("image", 0);
  require(file >= 0 && write(file, data, size) == static_cast<ssize_t>(size), "a file is written");
  attempt([&] {
    check(
        runtime::readPixels("/proc/self/fd/" + std::to_string(file), runtime::ColorSpace::ByFile));
  });
  close(file);
  return 0;
}
