#include "runtime/image/Image.h"

#include "language/ColorBasis.h"
#include "runtime/image/ImageFormats.h"
#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"
#include "support/MachineMemory.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <new>

namespace rtsl::runtime {

namespace {

/// Png or Exr.
PictureFormat formatOf(const std::string &path, PictureFormat requested) {
  if (requested != PictureFormat::ByName)
    return requested;
  if (path == "-")
    return PictureFormat::Png;
  std::size_t dot = path.find_last_of("./");
  std::string extension = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (extension == "png")
    return PictureFormat::Png;
  if (extension == "exr")
    return PictureFormat::Exr;
  throw Error(message::pictureFormatUnknown(path), Place{path});
}

} // namespace

Image newImage(std::uint32_t width, std::uint32_t height, std::uint32_t channels) {
  const std::uint64_t bytes = std::uint64_t(width) * height * channels * sizeof(float);
  try {
    const MemoryReservation check(bytes);
    return Image(width, height, channels);
  } catch (const std::bad_alloc &) {
    throw Error(message::noMemoryForPicture(bytes));
  }
}

Image toRgb(const Image &image) {
  if (image.channels == 3)
    return image;
  Image rgb(image.width, image.height, 3);
  const ColorBasis basis = makeColorBasis(image.channels);
  std::size_t count = std::size_t(image.width) * image.height;
  for (std::size_t i = 0; i < count; ++i) {
    const float *from = image.pixels.data() + i * image.channels;
    for (std::uint32_t c = 0; c < 3; ++c) {
      double sum = 0;
      for (std::uint32_t k = 0; k < image.channels; ++k)
        sum += basis.toRgb[c][k] * double(from[k]);
      rgb.pixels[i * 3 + c] = float(sum);
    }
  }
  return rgb;
}

void checkWritable(const std::string &path, PictureFormat format) {
  formatOf(path, format);
  checkFileWritable(path);
}

void writeImage(const std::string &path, const Image &image, PictureFormat format) {
  format = formatOf(path, format);
  if (image.width == 0 || image.height == 0 || image.channels == 0 ||
      image.pixels.size() != std::size_t(image.width) * image.height * image.channels)
    throw Error(message::emptyPictureWritten(path), Place{path});
  writeFileAtomically(path, format == PictureFormat::Png ? encodePng(image, path)
                                                         : encodeExr(image, {}, path));
}

bool isExr(const std::string &path, PictureFormat format) {
  return formatOf(path, format) == PictureFormat::Exr;
}

void writeLayers(const std::string &path, const Image &image, const std::vector<Layer> &layers) {
  writeFileAtomically(path, encodeExr(image, layers, path));
}

Image readImage(const std::string &path) {
  if (path != "-") { // the name is checked first: it is the most frequent error
    const PictureFormat format = formatOf(path, PictureFormat::ByName);
    const std::string bytes = readFile(path);
    return format == PictureFormat::Png ? decodePng(bytes, path) : decodeExr(bytes, path);
  }
  const std::string bytes = readFile(path);
  const bool isPng = bytes.compare(0, 4, "\x89PNG") == 0;
  return isPng ? decodePng(bytes, "<stdin>") : decodeExr(bytes, "<stdin>");
}

} // namespace rtsl::runtime
