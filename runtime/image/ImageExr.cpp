//===- ImageExr.cpp - OpenEXR ---------------------------------------------===//
//
// Encoded and decoded in memory: OpenEXR's own files write the line table in a destructor, where a
// full disk is not reported.
//
//===----------------------------------------------------------------------===//
#include "runtime/image/ImageClaim.h"
#include "runtime/image/ImageFormats.h"
#include "support/ErrorMessages.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <exception>

namespace rtsl::runtime {

namespace {

class MemoryOutput : public Imf::OStream {
public:
  MemoryOutput() : Imf::OStream("memory") {}
  void write(const char *from, int count) override {
    if (position + std::size_t(count) > bytes.size())
      bytes.resize(position + std::size_t(count));
    std::memcpy(bytes.data() + position, from, std::size_t(count));
    position += std::size_t(count);
  }
  std::uint64_t tellp() override { return position; }
  void seekp(std::uint64_t to) override { position = to; }

  std::string bytes;

private:
  std::size_t position = 0;
};

class MemoryInput : public Imf::IStream {
public:
  explicit MemoryInput(const std::string &bytes) : Imf::IStream("memory"), bytes(bytes) {}
  bool read(char *to, int count) override {
    if (std::size_t(count) > bytes.size() - std::min(position, bytes.size()))
      throw std::runtime_error("the file ends too early");
    std::memcpy(to, bytes.data() + position, std::size_t(count));
    position += std::size_t(count);
    return position < bytes.size();
  }
  std::uint64_t tellg() override { return position; }
  void seekg(std::uint64_t to) override { position = to; }
  void clear() override {}

private:
  const std::string &bytes;
  std::size_t position = 0;
};

std::vector<std::string> channelNames(std::uint32_t channels) {
  if (channels == 1)
    return {"Y"};
  if (channels == 3)
    return {"R", "G", "B"};
  // The file sorts its channels by name.
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < channels; ++i)
    names.push_back(channels > 10 ? fmt::format("C{:02}", i) : fmt::format("C{}", i));
  return names;
}

Imf::Slice slice(const float *pixels, std::uint32_t channel, std::uint32_t channels,
                 std::uint32_t width) {
  return Imf::Slice(Imf::FLOAT, reinterpret_cast<char *>(const_cast<float *>(pixels + channel)),
                    sizeof(float) * channels, sizeof(float) * channels * width);
}

/// OpenEXR addresses pixels by their position in the whole picture, of which (0, 0) may be outside.
const float *originOf(const Image &image, const Imath::V2i &first) {
  return image.pixels.data() -
         (std::ptrdiff_t(first.y) * image.width + first.x) * std::ptrdiff_t(image.channels);
}

/// Adds the channels of a picture to a file that is to be written.
void addChannels(const Image &image, const std::vector<std::string> &names, Imf::Header &header,
                 Imf::FrameBuffer &frame) {
  const float *origin = originOf(image, header.dataWindow().min);
  for (std::uint32_t c = 0; c < image.channels; ++c) {
    header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
    frame.insert(names[c], slice(origin, c, image.channels, image.width));
  }
}

std::vector<std::string> channelNames(const Layer &layer) {
  std::vector<std::string> names = layer.channels;
  if (names.empty())
    names = channelNames(layer.image.channels);
  for (std::string &name : names)
    name = layer.name + "." + name;
  return names;
}

/// The channels that are read: those of the picture itself, without layers beside it.
std::vector<std::string> channelsOfPicture(const Imf::ChannelList &channels) {
  if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
    return {"R", "G", "B"};
  std::vector<std::string> all, withoutLayer;
  for (auto channel = channels.begin(); channel != channels.end(); ++channel) {
    all.emplace_back(channel.name());
    if (all.back().find('.') == std::string::npos)
      withoutLayer.push_back(all.back());
  }
  return withoutLayer.empty() ? all : withoutLayer;
}

/// Throws std::runtime_error if the file cannot hold the pixels of its header.
void requireHeld(const Imf::Header &header, std::size_t fileBytes) {
  constexpr const char *compressions[] = {"none",  "rle", "zips", "zip",  "piz",
                                          "pxr24", "b44", "b44a", "dwaa", "dwab"};
  const auto compression = std::size_t(header.compression());
  const Imath::Box2i &window = header.dataWindow();
  ImageClaim claim;
  claim.format = "openexr";
  claim.compression = compression < std::size(compressions) ? compressions[compression] : "";
  claim.width = std::uint64_t(std::int64_t(window.max.x) - window.min.x + 1);
  claim.height = std::uint64_t(std::int64_t(window.max.y) - window.min.y + 1);
  for (auto channel = header.channels().begin(); channel != header.channels().end(); ++channel) {
    const Imf::Channel &stored = channel.channel();
    ++claim.channels;
    const std::int64_t sampled = std::int64_t(stored.xSampling) * stored.ySampling;
    claim.pixelBytes += std::uint64_t((stored.type == Imf::HALF ? 2 : 4) / sampled);
  }
  if (const std::string why = whyFileTooSmall(claim, fileBytes); !why.empty())
    throw std::runtime_error(why);
}

} // namespace

std::string encodeExr(const Image &image, const std::vector<Layer> &layers,
                      const std::string &path) {
  try {
    const Imath::V2i first(int(image.left), int(image.top));
    const Imath::Box2i data(first, first + Imath::V2i(int(image.width) - 1, int(image.height) - 1));
    const Imath::Box2i whole({0, 0}, {int(image.wholeWidth) - 1, int(image.wholeHeight) - 1});
    Imf::Header header(image.wholeWidth ? whole : data, data);
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    addChannels(image, channelNames(image.channels), header, frame);
    for (const Layer &layer : layers)
      addChannels(layer.image, channelNames(layer), header, frame);
    MemoryOutput output;
    {
      Imf::OutputFile file(output, header);
      file.setFrameBuffer(frame);
      file.writePixels(int(image.height));
    }
    return std::move(output.bytes);
  } catch (const std::exception &error) {
    throw Error(message::cannotWrite(path, error.what()), Place{path});
  }
}

Image decodeExr(const std::string &bytes, const std::string &path) {
  try {
    MemoryInput input(bytes);
    Imf::InputFile file(input);
    requireHeld(file.header(), bytes.size());
    Imath::Box2i window = file.header().dataWindow();
    const std::vector<std::string> names = channelsOfPicture(file.header().channels());
    if (names.empty())
      throw std::runtime_error("it has no channels");
    Image image(std::uint32_t(window.max.x - window.min.x + 1),
                std::uint32_t(window.max.y - window.min.y + 1), std::uint32_t(names.size()));
    Imf::FrameBuffer frame;
    for (std::uint32_t c = 0; c < image.channels; ++c)
      frame.insert(names[c], slice(originOf(image, window.min), c, image.channels, image.width));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return image;
  } catch (const std::exception &error) {
    throw Error(message::imageDamaged(path, error.what()), Place{path});
  }
}

} // namespace rtsl::runtime
