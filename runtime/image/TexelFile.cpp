//===- TexelFile.cpp - image files for samplers ---------------------------===//
#include "runtime/image/Texels.h"

#include "runtime/image/ImageFormats.h"
#include "runtime/image/openimageio/ImageReader.h"
#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"
#include "support/MachineMemory.h"
#include "support/OwnLibrary.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>

namespace rtsl::runtime {

namespace fs = std::filesystem;

namespace {

/// Throws FileNotFound, FileUnreadable: the messages of the library that reads images are less
/// precise.
void requireReadable(const std::string &path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status))
    throw Error(message::noSuchFile(path));
  if (fs::is_directory(status))
    throw Error(message::isFolder(path));
  if (!std::ifstream(path, std::ios::binary))
    throw Error(message::cannotRead(path, std::strerror(errno)));
}

ReadImageFile openReader() {
  std::string why;
  void *const function = findInOwnLibrary("rtsl-images.so", readImageFileSymbol, why);
  if (!function)
    throw Error(message::noImageLibrary(why));
  return reinterpret_cast<ReadImageFile>(function);
}

void *allocateBytes(void *context, std::uint64_t bytes) {
  auto &vector = *static_cast<std::vector<std::uint8_t> *>(context);
  try {
    vector.resize(bytes);
  } catch (const std::bad_alloc &) {
    return nullptr;
  }
  return vector.data();
}

/// Encoded colors of 16 bits, which the samplers do not decode, as linear floats.
void decode16(Pixels &pixels) {
  const std::size_t count = pixels.bytes.size() / 2;
  const bool hasAlpha = pixels.channels == 4 || (pixels.channels == 2 && pixels.isSecondAlpha);
  std::vector<std::uint8_t> floats(4 * count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint16_t bits;
    std::memcpy(&bits, pixels.bytes.data() + 2 * i, 2);
    const float encoded = static_cast<float>(bits) / 65535.0f;
    const bool isAlpha = hasAlpha && i % pixels.channels == pixels.channels - 1;
    const float value = isAlpha ? encoded : decodeSrgb(encoded);
    std::memcpy(floats.data() + 4 * i, &value, 4);
  }
  pixels.format = TexelFormat::Float32;
  pixels.bytes = std::move(floats);
}

/// Reads a file by OpenImageIO, or these bytes of one. `isEncoded`: it has, or implies, colors in
/// sRGB.
Pixels readByOpenImageIO(const std::string &path, const std::string *bytes, bool &isEncoded) {
  static const ReadImageFile read = openReader();
  Pixels pixels;
  ImageFile file;
  read(path.c_str(), bytes ? bytes->data() : nullptr, bytes ? bytes->size() : 0, mostImageBytes,
       availableMemory(), allocateBytes, &pixels.bytes, &file);
  switch (file.problem) {
  case ImageFile::Problem::None:
    break;
  case ImageFile::Problem::Bad:
    throw Error(message::imageDamaged(path, file.message[0] ? file.message
                                                            : "it is no image of a known format"));
  case ImageFile::Problem::TooLarge:
    throw Error(message::imageFileTooLarge(path, file.width, file.height, mostImageBytes >> 30));
  case ImageFile::Problem::NoMemory:
    throw Error(message::noMemoryForImage(path, file.width, file.height));
  }
  pixels.width = file.width;
  pixels.height = file.height;
  pixels.channels = file.channels;
  pixels.isSecondAlpha = file.isSecondAlpha;
  if (file.bytesPerChannel == 4)
    pixels.format = TexelFormat::Float32;
  else if (file.bytesPerChannel == 2)
    pixels.format = file.isFloat ? TexelFormat::Float16 : TexelFormat::Unorm16;
  else
    pixels.format = TexelFormat::Unorm8;
  isEncoded = file.isSrgb;
  return pixels;
}

const std::string pngSignature = "\x89PNG";

/// Converts pixels to the requested color space.
Pixels inSpace(Pixels pixels, ColorSpace space, bool isEncoded, const std::string &name) {
  const bool isFloat =
      pixels.format == TexelFormat::Float16 || pixels.format == TexelFormat::Float32;
  if (space == ColorSpace::Srgb && isFloat)
    throw Error(message::floatImageNotSrgb(name));
  if (space != ColorSpace::ByFile)
    isEncoded = space == ColorSpace::Srgb;
  if (isEncoded && pixels.format == TexelFormat::Unorm8)
    pixels.format = TexelFormat::Srgb8;
  else if (isEncoded && pixels.format == TexelFormat::Unorm16)
    decode16(pixels);
  return pixels;
}

} // namespace

Pixels readPixels(const std::string &path, ColorSpace space) {
  requireReadable(path);
  std::string start(pngSignature.size(), '\0');
  std::ifstream(path, std::ios::binary).read(start.data(), std::streamsize(start.size()));
  bool isEncoded = true;
  Pixels pixels = start == pngSignature ? decodePngPixels(readFile(path), path)
                                        : readByOpenImageIO(path, nullptr, isEncoded);
  return inSpace(std::move(pixels), space, isEncoded, path);
}

Pixels decodePixels(const std::string &bytes, const std::string &name, ColorSpace space) {
  bool isEncoded = true;
  Pixels pixels = bytes.compare(0, pngSignature.size(), pngSignature) == 0
                      ? decodePngPixels(bytes, name)
                      : readByOpenImageIO(name, &bytes, isEncoded);
  return inSpace(std::move(pixels), space, isEncoded, name);
}

} // namespace rtsl::runtime
