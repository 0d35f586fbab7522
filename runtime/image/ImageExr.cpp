//===- ImageExr.cpp - OpenEXR ---------------------------------------------===//
//
// Encoded and decoded in memory: OpenEXR's own files write the line table in a destructor, where a
// full disk is not reported.
//
//===----------------------------------------------------------------------===//
#include "runtime/image/ImageFormats.h"

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

} // namespace

std::string encodeExr(const Image &image, const std::string &path) {
  try {
    Imf::Header header(int(image.width), int(image.height));
    header.compression() = Imf::ZIP_COMPRESSION;
    Imf::FrameBuffer frame;
    std::vector<std::string> names = channelNames(image.channels);
    for (std::uint32_t c = 0; c < image.channels; ++c) {
      header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
      frame.insert(names[c], slice(image.pixels.data(), c, image.channels, image.width));
    }
    MemoryOutput output;
    {
      Imf::OutputFile file(output, header);
      file.setFrameBuffer(frame);
      file.writePixels(int(image.height));
    }
    return std::move(output.bytes);
  } catch (const std::exception &error) {
    throw Error(ErrorCode::FileUnwritable, fmt::format("cannot write `{}`: {}", path, error.what()),
                Place{path});
  }
}

Image decodeExr(const std::string &bytes, const std::string &path) {
  try {
    MemoryInput input(bytes);
    Imf::InputFile file(input);
    Imath::Box2i window = file.header().dataWindow();
    std::vector<std::string> names;
    const Imf::ChannelList &channels = file.header().channels();
    for (auto channel = channels.begin(); channel != channels.end(); ++channel)
      names.push_back(channel.name());
    if (names.empty())
      throw std::runtime_error("it has no channels");
    if (channels.findChannel("R") && channels.findChannel("G") && channels.findChannel("B"))
      names = {"R", "G", "B"};
    Image image(std::uint32_t(window.max.x - window.min.x + 1),
                std::uint32_t(window.max.y - window.min.y + 1), std::uint32_t(names.size()));
    Imf::FrameBuffer frame;
    // OpenEXR addresses pixels by their position in the data window.
    const float *base =
        image.pixels.data() - (std::ptrdiff_t(window.min.y) * image.width + window.min.x) *
                                  std::ptrdiff_t(image.channels);
    for (std::uint32_t c = 0; c < image.channels; ++c)
      frame.insert(names[c], slice(base, c, image.channels, image.width));
    file.setFrameBuffer(frame);
    file.readPixels(window.min.y, window.max.y);
    return image;
  } catch (const std::exception &error) {
    throw Error(ErrorCode::BadImage, fmt::format("cannot read `{}`: {}", path, error.what()),
                Place{path});
  }
}

} // namespace rtsl::runtime
