//===- ImagePng.cpp - PNG by libpng ---------------------------------------===//
#include "runtime/image/ImageFormats.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <png.h>

#include <cmath>
#include <csetjmp>
#include <cstring>

namespace rtsl::runtime {

namespace {

/// libpng reports errors by longjmp. No object with a destructor may be created between setjmp and
/// the calls, so all of them belong to the callers.
struct PngError {
  std::jmp_buf jump;
  char message[256] = "";
};

void fail(png_structp png, png_const_charp message) {
  auto *error = static_cast<PngError *>(png_get_error_ptr(png));
  std::strncpy(error->message, message, sizeof error->message - 1);
  std::longjmp(error->jump, 1);
}

void ignoreWarning(png_structp, png_const_charp) {}

void append(png_structp png, png_bytep bytes, png_size_t count) {
  static_cast<std::string *>(png_get_io_ptr(png))
      ->append(reinterpret_cast<const char *>(bytes), count);
}

void flushNothing(png_structp) {}

struct Source {
  const std::string *bytes;
  std::size_t position;
};

void take(png_structp png, png_bytep bytes, png_size_t count) {
  auto *source = static_cast<Source *>(png_get_io_ptr(png));
  if (count > source->bytes->size() - source->position)
    png_error(png, "the file ends too early");
  std::memcpy(bytes, source->bytes->data() + source->position, count);
  source->position += count;
}

bool write(PngError &error, std::string &out, const Image &image, std::vector<png_bytep> &rows) {
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &error, fail, ignoreWarning);
  if (!png)
    return false;
  png_infop info = png_create_info_struct(png);
  if (!info || setjmp(error.jump)) {
    png_destroy_write_struct(&png, &info);
    return false;
  }
  png_set_write_fn(png, &out, append, flushNothing);
  png_set_IHDR(png, info, image.width, image.height, 8,
               image.channels == 1 ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_sRGB(png, info, PNG_sRGB_INTENT_PERCEPTUAL);
  png_write_info(png, info);
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return true;
}

/// Reads the pixels as they are in the file, at least 8 bits a channel, palettes as their colors.
bool read(PngError &error, Source &source, Pixels &pixels, std::vector<png_bytep> &rows) {
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &error, fail, ignoreWarning);
  if (!png)
    return false;
  png_infop info = png_create_info_struct(png);
  if (!info || setjmp(error.jump)) {
    png_destroy_read_struct(&png, &info, nullptr);
    return false;
  }
  png_set_read_fn(png, &source, take);
  png_read_info(png, info);
  png_set_expand(png);
  png_set_swap(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  pixels.width = png_get_image_width(png, info);
  pixels.height = png_get_image_height(png, info);
  pixels.channels = png_get_channels(png, info);
  pixels.isSecondAlpha = true;
  pixels.format = png_get_bit_depth(png, info) == 16 ? TexelFormat::Unorm16 : TexelFormat::Unorm8;
  const png_size_t rowBytes = png_get_rowbytes(png, info);
  if (rowBytes != png_size_t(pixels.width) * pixels.channels * bytesOf(pixels.format))
    png_error(png, "unexpected layout of rows");
  if (pixels.height > mostImageBytes / rowBytes)
    png_error(png, "the image is too large");
  // Deflate makes at most 1032 bytes of one: memory is requested only for pixels that may be there.
  if (pixels.height * rowBytes / 1032 > source.bytes->size())
    png_error(png, "the file ends too early");
  pixels.bytes.resize(pixels.height * rowBytes);
  rows.resize(pixels.height);
  for (std::uint32_t y = 0; y < pixels.height; ++y)
    rows[y] = pixels.bytes.data() + y * rowBytes;
  png_read_image(png, rows.data());
  png_read_end(png, nullptr);
  png_destroy_read_struct(&png, &info, nullptr);
  return true;
}

} // namespace

std::string encodePng(const Image &given, const std::string &path) {
  const Image image = given.channels == 1 ? given : toRgb(given);
  std::vector<png_byte> bytes(image.pixels.size());
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = png_byte(encodeSrgb(image.pixels[i]) * 255.0f + 0.5f);
  std::vector<png_bytep> rows(image.height);
  for (std::uint32_t y = 0; y < image.height; ++y)
    rows[y] = bytes.data() + std::size_t(y) * image.width * image.channels;
  PngError error;
  std::string out;
  if (!write(error, out, image, rows))
    throw Error(message::cannotWrite(path, error.message), Place{path});
  return out;
}

Pixels decodePngPixels(const std::string &bytes, const std::string &path) {
  PngError error;
  Source source{&bytes, 0};
  Pixels pixels;
  std::vector<png_bytep> rows;
  if (!read(error, source, pixels, rows))
    throw Error(message::imageDamaged(path, error.message), Place{path});
  return pixels;
}

Image decodePng(const std::string &bytes, const std::string &path) {
  const Pixels pixels = decodePngPixels(bytes, path);
  const bool isWide = pixels.format == TexelFormat::Unorm16;
  const std::uint32_t colors = pixels.channels <= 2 ? 1 : 3; // without alpha
  Image image(pixels.width, pixels.height, colors);
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const std::size_t from = i / colors * pixels.channels + i % colors;
    std::uint16_t wide = 0;
    if (isWide)
      std::memcpy(&wide, pixels.bytes.data() + 2 * from, 2);
    image.pixels[i] =
        decodeSrgb(isWide ? float(wide) / 65535.0f : float(pixels.bytes[from]) / 255.0f);
  }
  return image;
}

float encodeSrgb(float linear) {
  if (!(linear > 0)) // also for NaN
    return 0;
  if (linear >= 1)
    return 1;
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1 / 2.4f) - 0.055f;
}

float decodeSrgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

} // namespace rtsl::runtime
