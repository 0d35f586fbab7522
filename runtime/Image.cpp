#include "runtime/Image.h"

#include "runtime/AtomicFile.h"
#include "runtime/ColorBasis.h"
#include "runtime/ImageFormats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>

namespace rtsl::runtime {

namespace {

enum class Format { Png, Exr };

Format formatOf(const std::string &path) {
  std::size_t dot = path.find_last_of("./");
  std::string extension = dot == std::string::npos || path[dot] == '/' ? "" : path.substr(dot + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  if (extension == "png")
    return Format::Png;
  if (extension == "exr")
    return Format::Exr;
  throw Error(
      ErrorCode::UnsupportedFormat,
      fmt::format("cannot tell the format of `{}`: a picture's name ends in `.png` or `.exr`",
                  path),
      Place{path});
}

} // namespace

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

void checkWritable(const std::string &path) {
  formatOf(path);
  checkFileWritable(path);
}

void writeImage(const std::string &path, const Image &image) {
  Format format = formatOf(path);
  if (image.width == 0 || image.height == 0 || image.channels == 0 ||
      image.pixels.size() != std::size_t(image.width) * image.height * image.channels)
    throw Error(ErrorCode::BadImage, fmt::format("cannot write `{}`: the picture is empty", path),
                Place{path});
  writeFileAtomically(path,
                      format == Format::Png ? encodePng(image, path) : encodeExr(image, path));
}

Image readImage(const std::string &path) {
  Format format = formatOf(path);
  std::string bytes = readFile(path);
  return format == Format::Png ? decodePng(bytes, path) : decodeExr(bytes, path);
}

} // namespace rtsl::runtime
