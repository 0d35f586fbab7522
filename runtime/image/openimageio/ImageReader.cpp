#include "runtime/image/openimageio/ImageReader.h"

#include "runtime/image/Jpeg2000Claim.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <fstream>
#include <memory>
#include <new>
#include <optional>
#include <stdexcept>
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

/// Reads a file, or these bytes of one.
ReadBytes bytesOf(const char *path, const void *bytes, std::uint64_t size) {
  if (bytes)
    return [first = static_cast<const unsigned char *>(bytes), size](std::uint64_t offset,
                                                                     std::size_t count) {
      offset = std::min(offset, size);
      return std::vector<unsigned char>(first + offset,
                                        first + offset + std::min(size - offset, count));
    };
  const auto file = std::make_shared<std::ifstream>(path, std::ios::binary);
  return [file](std::uint64_t offset, std::size_t count) {
    std::vector<unsigned char> found(count);
    file->clear();
    file->seekg(std::streamoff(offset));
    file->read(reinterpret_cast<char *>(found.data()), std::streamsize(count));
    found.resize(std::size_t(std::max<std::streamsize>(file->gcount(), 0)));
    return found;
  };
}

/// The first bytes; zeros after the end of the file.
std::array<unsigned char, startBytes> startOf(const ReadBytes &read) {
  std::array<unsigned char, startBytes> start = {};
  const std::vector<unsigned char> found = read(0, start.size());
  std::copy(found.begin(), found.end(), start.begin());
  return start;
}

/// Refuses what is too large before it is decoded, which opening the file does. False if it has.
bool checkJpeg2000(const ReadBytes &read, std::uint64_t mostBytes, std::uint64_t freeBytes,
                   ImageFile &file) {
  const std::optional<ImageClaim> claim = jpeg2000Claim(read);
  if (!claim)
    return true;
  file.width = static_cast<std::uint32_t>(claim->width);
  file.height = static_cast<std::uint32_t>(claim->height);
  const double pixels = double(claim->width) * double(claim->height);
  const double kept =
      double(std::min<std::uint64_t>(claim->channels, 4)) * (claim->bitsPerSample > 8 ? 2 : 1);
  if (pixels * kept > double(mostBytes))
    file.problem = ImageFile::Problem::TooLarge;
  else if (pixels * (kept + double(claim->pixelBytes)) > double(freeBytes))
    file.problem = ImageFile::Problem::NoMemory;
  else
    return true;
  return false;
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

/// Opens bytes in memory; OpenImageIO chooses a reader by the ending of a name, or tries all. Where
/// there is a configuration, its reader of JPEG files takes the memory only from there.
std::unique_ptr<OIIO::ImageInput> openBytes(const void *bytes, std::uint64_t size,
                                            OIIO::ImageSpec config,
                                            OIIO::Filesystem::IOMemReader &memory) {
  OIIO::Filesystem::IOProxy *const proxy = &memory;
  config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &proxy);
  constexpr unsigned char jpeg[] = {0xff, 0xd8, 0xff};
  const bool isJpeg = size > sizeof jpeg && std::memcmp(bytes, jpeg, sizeof jpeg) == 0;
  auto input = OIIO::ImageInput::open(isJpeg ? "bytes.jpg" : "bytes", &config, &memory);
  if (!input && !isJpeg) { // its message is about a file with this name
    OIIO::geterror();
    throw std::runtime_error("it is damaged, or in no format that OpenImageIO reads");
  }
  return input;
}

/// All that is decoded for a pixel, not only the channels that are read.
ImageClaim claimOf(const OIIO::ImageInput &input) {
  const OIIO::ImageSpec &spec = input.spec();
  const auto positive = [](int number) { return static_cast<std::uint64_t>(std::max(number, 1)); };
  ImageClaim claim;
  claim.format = input.format_name();
  claim.compression = std::string(spec.get_string_attribute("compression"));
  claim.width = positive(spec.width);
  claim.height = positive(spec.height);
  claim.depth = positive(spec.depth);
  claim.channels = positive(spec.nchannels);
  claim.pixelBytes = spec.pixel_bytes(true);
  claim.bitsPerSample = positive(
      spec.get_int_attribute("oiio:BitsPerSample", static_cast<int>(8 * spec.format.size())));
  if (spec.tile_width > 0) {
    claim.tileWidth = positive(spec.tile_width);
    claim.tileHeight = positive(spec.tile_height);
    claim.tileDepth = positive(spec.tile_depth);
  }
  return claim;
}

/// OpenImageIO reads whole strips of a TIFF file into memory of its own, as large as the file says
/// they are, however few rows the image has. Nothing if that is no more than some files need.
std::string whyStripsTooLarge(const OIIO::ImageSpec &spec) {
  constexpr double most = double(std::uint64_t(1) << 32);
  const int rows = spec.get_int_attribute("tiff:RowsPerStrip");
  if (rows <= spec.height || double(rows) * double(spec.scanline_bytes(true)) <= most)
    return {};
  return "its strips have " + std::to_string(rows) + " rows, and the image " +
         std::to_string(spec.height);
}

/// Reads rows from the top, up to `end`, which follow those that have been read.
bool readRows(OIIO::ImageInput &input, int begin, int end, int channels, OIIO::TypeDesc type,
              void *pixels) {
  const OIIO::ImageSpec &spec = input.spec();
  if (spec.tile_width == 0)
    return input.read_scanlines(0, 0, spec.y + begin, spec.y + end, 0, 0, channels, type, pixels);
  return input.read_tiles(0, 0, spec.x, spec.x + spec.width, spec.y + begin, spec.y + end, 0, 1, 0,
                          channels, type, pixels);
}

/// Reads the pixels in pieces, each as large as all before it: a file that claims to be large gets
/// memory only as far as it has pixels. False if the file is damaged; file.pixels is null if there
/// is no memory.
bool readPixels(OIIO::ImageInput &input, int channels, OIIO::TypeDesc type, std::uint64_t rowBytes,
                void *(*allocate)(void *, std::uint64_t), void *context, ImageFile &file) {
  constexpr std::uint64_t firstBytes = std::uint64_t(1) << 26;
  const OIIO::ImageSpec &spec = input.spec();
  const auto height = static_cast<std::uint64_t>(spec.height);
  const auto step = static_cast<std::uint64_t>(std::max(spec.tile_height, 1));
  std::uint64_t rows = 0;
  while (rows < height) {
    std::uint64_t next = std::max(2 * rows, firstBytes / rowBytes);
    next = std::min((next / step + 1) * step, height);
    file.pixels = allocate(context, next * rowBytes);
    if (!file.pixels)
      return true;
    if (!readRows(input, static_cast<int>(rows), static_cast<int>(next), channels, type,
                  static_cast<char *>(file.pixels) + rows * rowBytes))
      return false;
    rows = next;
  }
  return true;
}

void read(OIIO::ImageInput *input, std::uint64_t fileBytes, std::uint64_t mostBytes,
          std::uint64_t freeBytes, void *(*allocate)(void *, std::uint64_t), void *context,
          ImageFile &file) {
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
  file.isSrgb = space == "sRGB" || (space != "Linear" && type == OIIO::TypeDesc::UINT8);
  const std::uint64_t pixelBytes = std::uint64_t(file.channels) * file.bytesPerChannel;
  if (std::uint64_t(file.width) * file.height > mostBytes / pixelBytes)
    return fail(file, ImageFile::Problem::TooLarge, "");
  const ImageClaim claim = claimOf(*input);
  if (const std::string why = whyFileTooSmall(claim, fileBytes); !why.empty())
    return fail(file, ImageFile::Problem::Bad, why);
  if (const std::string why = whyStripsTooLarge(spec); !why.empty())
    return fail(file, ImageFile::Problem::Bad, why);
  if (memoryToRead(claim, pixelBytes) > static_cast<double>(freeBytes))
    return fail(file, ImageFile::Problem::NoMemory, "");
  if (!readPixels(*input, channels, type, file.width * pixelBytes, allocate, context, file))
    fail(file, ImageFile::Problem::Bad, input->geterror());
  else if (!file.pixels)
    fail(file, ImageFile::Problem::NoMemory, "");
}

} // namespace

} // namespace rtsl::runtime

extern "C" __attribute__((visibility("default"))) void
rtslReadImageFile(const char *path, const void *bytes, std::uint64_t size, std::uint64_t mostBytes,
                  std::uint64_t freeBytes, void *(*allocate)(void *, std::uint64_t), void *context,
                  rtsl::runtime::ImageFile *file) {
  using rtsl::runtime::ImageFile;
  *file = {};
  try {
    const std::uint64_t fileBytes = bytes ? size : OIIO::Filesystem::file_size(path);
    const rtsl::runtime::ReadBytes readBytes = rtsl::runtime::bytesOf(path, bytes, size);
    const std::string why =
        rtsl::runtime::whyStartWrong(rtsl::runtime::startOf(readBytes), fileBytes);
    if (!why.empty())
      return rtsl::runtime::fail(*file, ImageFile::Problem::Bad, why);
    if (!rtsl::runtime::checkJpeg2000(readBytes, mostBytes, freeBytes, *file))
      return;
    OIIO::ImageSpec config;
    config.attribute("oiio:UnassociatedAlpha", 1); // colors as the file has them
    OIIO::Filesystem::IOMemReader memory(const_cast<void *>(bytes), size);
    const auto input = bytes ? rtsl::runtime::openBytes(bytes, size, config, memory)
                             : OIIO::ImageInput::open(path, &config);
    rtsl::runtime::read(input.get(), fileBytes, mostBytes, freeBytes, allocate, context, *file);
  } catch (const std::bad_alloc &) {
    if (file->width == 0)
      rtsl::runtime::fail(*file, ImageFile::Problem::Bad,
                          "there is not enough memory for what its header claims");
    else
      file->problem = ImageFile::Problem::NoMemory;
  } catch (const std::exception &error) {
    rtsl::runtime::fail(*file, ImageFile::Problem::Bad, error.what());
  }
}
