#include "runtime/image/openimageio/ImageReader.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <string>

namespace rtsl::runtime {

namespace {

void fail(ImageFile &file, ImageFile::Problem problem, const std::string &message) {
  file.problem = problem;
  const std::size_t length = std::min(message.size(), sizeof file.message - 1);
  std::memcpy(file.message, message.data(), length);
  file.message[length] = '\0';
  // One line is enough.
  if (char *end = std::strchr(file.message, '\n'))
    *end = '\0';
}

/// The type in which the channels are read: none is converted with loss.
OIIO::TypeDesc typeFor(const OIIO::ImageSpec &spec) {
  switch (spec.format.basetype) {
  case OIIO::TypeDesc::UINT8:
    return OIIO::TypeDesc::UINT8;
  case OIIO::TypeDesc::UINT16:
    return OIIO::TypeDesc::UINT16;
  case OIIO::TypeDesc::HALF:
    return OIIO::TypeDesc::HALF;
  default:
    return OIIO::TypeDesc::FLOAT;
  }
}

/// A name for bytes in memory: OpenImageIO chooses a reader by its ending.
std::string nameOf(const void *bytes, std::uint64_t size) {
  constexpr unsigned char jpeg[] = {0xff, 0xd8, 0xff};
  const bool isJpeg = size > sizeof jpeg && std::memcmp(bytes, jpeg, sizeof jpeg) == 0;
  return isJpeg ? "bytes.jpg" : "bytes";
}

void read(OIIO::ImageInput *input, std::uint64_t mostBytes,
          void *(*allocate)(void *, std::uint64_t), void *context, ImageFile &file) {
  if (!input)
    return fail(file, ImageFile::Problem::Bad, OIIO::geterror());
  const OIIO::ImageSpec &spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1)
    return fail(file, ImageFile::Problem::Bad, "it has no pixels");
  const OIIO::TypeDesc type = typeFor(spec);
  const int channels = std::min(spec.nchannels, 4);
  file.width = static_cast<std::uint32_t>(spec.width);
  file.height = static_cast<std::uint32_t>(spec.height);
  file.channels = static_cast<std::uint32_t>(channels);
  file.bytesPerChannel = static_cast<std::uint32_t>(type.size());
  file.isFloat = type == OIIO::TypeDesc::HALF || type == OIIO::TypeDesc::FLOAT;
  file.isSecondAlpha = spec.alpha_channel == 1;
  // Files of 8 bits that do not say otherwise are for screens.
  const std::string space = spec.get_string_attribute("oiio:ColorSpace");
  file.isSrgb = space == "sRGB" || (space.empty() && type == OIIO::TypeDesc::UINT8);
  const std::uint64_t pixelBytes = std::uint64_t(file.channels) * file.bytesPerChannel;
  if (std::uint64_t(file.width) * file.height > mostBytes / pixelBytes)
    return fail(file, ImageFile::Problem::TooLarge, "");
  const std::uint64_t bytes = std::uint64_t(file.width) * file.height * pixelBytes;
  file.pixels = allocate(context, bytes);
  if (!file.pixels)
    return fail(file, ImageFile::Problem::NoMemory, "");
  if (!input->read_image(0, 0, 0, channels, type, file.pixels))
    fail(file, ImageFile::Problem::Bad, input->geterror());
}

} // namespace

} // namespace rtsl::runtime

extern "C" __attribute__((visibility("default"))) void
rtslReadImageFile(const char *path, const void *bytes, std::uint64_t size, std::uint64_t mostBytes,
                  void *(*allocate)(void *, std::uint64_t), void *context,
                  rtsl::runtime::ImageFile *file) {
  using rtsl::runtime::ImageFile;
  *file = {};
  try {
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1); // colors as the file has them
    OIIO::Filesystem::IOMemReader memory(const_cast<void *>(bytes), size);
    const auto input =
        bytes ? OIIO::ImageInput::open(rtsl::runtime::nameOf(bytes, size), &config, &memory)
              : OIIO::ImageInput::open(path, &config);
    rtsl::runtime::read(input.get(), mostBytes, allocate, context, *file);
  } catch (const std::bad_alloc &) {
    file->problem = ImageFile::Problem::NoMemory;
  } catch (const std::exception &error) {
    rtsl::runtime::fail(*file, ImageFile::Problem::Bad, error.what());
  }
}
