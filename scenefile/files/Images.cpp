#include "scenefile/files/Images.h"

#include "scenefile/Models.h"
#include "scenefile/SceneFile.h"
#include "scenefile/gltf/Textures.h"
#include "scenefile/json/Choices.h"
#include "scenefile/json/Reader.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"
#include "support/Parallel.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace rtsl::scene {

using runtime::ColorSpace;
using runtime::Filter;
using runtime::TexelFormat;
using runtime::Wrap;
using Kind = JsonValue::Kind;

namespace {

constexpr Choice<Filter> filters[] = {{"nearest", Filter::Nearest},
                                      {"bilinear", Filter::Linear},
                                      {"trilinear", Filter::Trilinear},
                                      {"anisotropic", Filter::Anisotropic}};
constexpr Choice<Wrap> wraps[] = {{"repeat", Wrap::Repeat},
                                  {"mirror", Wrap::Mirror},
                                  {"clamp", Wrap::Clamp},
                                  {"black", Wrap::Black}};
constexpr Choice<ColorSpace> colorSpaces[] = {
    {"auto", ColorSpace::ByFile}, {"linear", ColorSpace::Linear}, {"srgb", ColorSpace::Srgb}};
constexpr Choice<TexelFormat> formats[] = {{"unorm8", TexelFormat::Unorm8},
                                           {"unorm16", TexelFormat::Unorm16},
                                           {"float16", TexelFormat::Float16},
                                           {"float32", TexelFormat::Float32}};

class ImageReader {
public:
  ImageReader(const JsonValue &image, const std::function<std::string(const JsonValue &)> &resolve)
      : image(image), resolve(resolve), isVolume(imageClass(image) == "sampler3D") {}

  ImageDescription read() {
    description.place = image.place();
    const bool isRaw = image.find("raw");
    errors.attempt([&] {
      if (isRaw)
        checkKeys(image,
                  {"class", "raw", "size", "format", "channels", "wrap", "filter", "anisotropy"},
                  "a raw image");
      else
        checkKeys(image,
                  {"class", "file", "part", "slices", "colorSpace", "wrap", "filter", "anisotropy"},
                  "an image");
    });
    if (isRaw)
      readRaw();
    else
      readFiles();
    key("part", [&](const JsonValue &value) { readPart(value); });
    key("colorSpace", [&](const JsonValue &value) {
      description.colorSpace = choose(value, colorSpaces, "`colorSpace`");
    });
    key("filter", [&](const JsonValue &value) { readFilter(value); });
    key("wrap", [&](const JsonValue &value) { readWrap(value); });
    key("anisotropy", [&](const JsonValue &value) {
      description.sampling.anisotropy = readInteger(value, 1, 256, "`anisotropy`");
    });
    errors.throwIfAny();
    return std::move(description);
  }

private:
  template <typename Read>
  void key(const char *name, Read read) {
    if (const JsonValue *value = image.find(name))
      errors.attempt([&] { read(*value); });
  }

  void addFile(const JsonValue &value, const char *what) {
    description.files.push_back(resolve(expect(value, Kind::String, what)));
  }

  void readFiles() {
    errors.attempt([&] {
      if (!isVolume)
        return addFile(require(image, "file", "an image of a sampler2D"), "`file`");
      const JsonValue &slices = require(image, "slices", "an image of a sampler3D");
      expect(slices, Kind::Array, "`slices`");
      if (slices.elements.empty())
        throw Error(message::noSlices(), slices.place());
      for (const JsonValue &slice : slices.elements)
        errors.attempt([&] { addFile(slice, "a slice"); });
    });
  }

  void readPart(const JsonValue &value) {
    description.part = expect(value, Kind::String, "`part`").string;
    const JsonValue *file = image.find("file");
    if (!file || file->kind != Kind::String || !gltf::isModel(file->string))
      throw Error(message::partWithoutModel(), value.place());
  }

  void readRaw() {
    description.isRaw = true;
    runtime::Texels &shape = description.shape;
    shape.channels = 1;
    key("raw", [&](const JsonValue &value) { addFile(value, "`raw`"); });
    errors.attempt([&] {
      const JsonValue &size = require(image, "size", "a raw image");
      readNumbers(size, isVolume ? 3 : 2, "`size`");
      constexpr std::uint32_t most = 0x7fffffff;
      shape.width = readInteger(size.elements[0], 1, most, "the width");
      shape.height = readInteger(size.elements[1], 1, most, "the height");
      if (isVolume)
        shape.depth = readInteger(size.elements[2], 1, most, "the depth");
    });
    key("format",
        [&](const JsonValue &value) { shape.format = choose(value, formats, "`format`"); });
    key("channels", [&](const JsonValue &value) {
      shape.channels = readInteger(value, 1, 4, "`channels`");
      if (shape.channels == 3)
        throw Error(message::badChannelCount(), value.place());
    });
  }

  void readFilter(const JsonValue &value) {
    description.sampling.filter = choose(value, filters, "`filter`");
    if (isVolume && description.sampling.filter == Filter::Anisotropic)
      throw Error(message::anisotropicVolume(), value.place());
  }

  /// One for all axes, or a list.
  void readWrap(const JsonValue &value) {
    auto &wrap = description.sampling.wrap;
    if (value.kind == Kind::String)
      return wrap.fill(choose(value, wraps, "`wrap`"));
    expect(value, Kind::Array, "`wrap`");
    const std::size_t axes = isVolume ? 3 : 2;
    if (value.elements.size() != axes)
      throw Error(message::wrapCount(axes, value.elements.size()), value.place());
    for (std::size_t i = 0; i < axes; ++i)
      wrap[i] = choose(value.elements[i], wraps, "`wrap`");
  }

  const JsonValue &image;
  const std::function<std::string(const JsonValue &)> &resolve;
  bool isVolume;
  ImageDescription description;
  ErrorCollector errors;
};

/// Everything that images must have in common to be one.
std::string identity(const ImageDescription &image, const std::string &className) {
  const runtime::Texels &shape = image.shape;
  const runtime::Sampling &sampling = image.sampling;
  return fmt::format("{} {} {} {} {} {} {} {} {} {} {} {} {} {} {}", className, image.isRaw,
                     int(shape.format), shape.width, shape.height, shape.depth, shape.channels,
                     int(image.colorSpace), int(sampling.filter), int(sampling.wrap[0]),
                     int(sampling.wrap[1]), int(sampling.wrap[2]), sampling.anisotropy, image.part,
                     fmt::join(image.files, "\n"));
}

runtime::Texels load(const ImageDescription &image, const SceneDescription &scene) {
  if (image.isRaw)
    return runtime::readRawTexels(image.files.front(), image.shape);
  if (!image.part.empty())
    return runtime::texelsOf(
        {gltf::readImage(scene.models->open(image.files.front()), image.part, image.colorSpace)});
  std::vector<runtime::Pixels> slices;
  for (const std::string &file : image.files) {
    slices.push_back(runtime::readPixels(file, image.colorSpace));
    const runtime::Pixels &first = slices.front(), &slice = slices.back();
    if (slice.width != first.width || slice.height != first.height ||
        slice.channels != first.channels || slice.format != first.format)
      throw Error(message::slicesDiffer(file, image.files.front()));
  }
  return runtime::texelsOf(slices);
}

} // namespace

bool isImageClass(const std::string &name) {
  return name == "sampler2D" || name == "sampler3D";
}

bool isImage(const JsonValue &value) {
  if (value.kind != Kind::Object)
    return false;
  if (const JsonValue *className = value.find("class"))
    return className->kind == Kind::String && isImageClass(className->string);
  const auto has = [&](const char *key, Kind kind) {
    const JsonValue *found = value.find(key);
    return found && found->kind == kind;
  };
  return has("file", Kind::String) || has("slices", Kind::Array) || has("raw", Kind::String);
}

void forEachValue(const JsonValue &value, const std::function<void(const JsonValue &)> &visit) {
  for (const auto &[key, member] : value.members)
    if (key.text == "constructor")
      forEachValue(member, visit);
    else
      visit(member);
  for (const JsonValue &element : value.elements)
    visit(element);
}

std::string imageClass(const JsonValue &image) {
  if (const JsonValue *className = image.find("class"))
    return className->string;
  const JsonValue *size = image.find("size");
  const bool isVolume = image.find("slices") || (size && size->elements.size() == 3);
  return isVolume ? "sampler3D" : "sampler2D";
}

ImageDescription readImage(const JsonValue &image,
                           const std::function<std::string(const JsonValue &)> &resolve) {
  return ImageReader(image, resolve).read();
}

namespace {

using ChannelsOfMember =
    std::function<std::uint32_t(const std::string &className, const std::string &member)>;

/// Which channels are read of the images of a scene, in whatever members they are.
class ImageChannels {
public:
  ImageChannels(const SceneDescription &description, const ChannelsOfMember &channelsOf)
      : description(description), channelsOf(channelsOf) {
    for (const auto &[key, value] : description.root->members)
      if (key.text != "images")
        visit(value, all);
    for (const auto &value : description.placedValues)
      visit(*value, all);
  }

  std::uint32_t of(const JsonValue &image) const {
    const auto found = channels.find(&image);
    return found == channels.end() ? all : found->second;
  }

private:
  static constexpr std::uint32_t all = runtime::MemberInfo::allChannels;

  /// A value somewhere in the scene. `read`: the channels that are read if it is an image.
  void visit(const JsonValue &value, std::uint32_t read) {
    if (value.kind == Kind::String) {
      if (const auto named = description.images.find(value.string);
          named != description.images.end())
        channels[named->second.image] |= read;
    } else if (isImage(value)) {
      channels[&value] |= read;
    } else if (value.kind == Kind::Array) {
      for (const JsonValue &element : value.elements)
        visit(element, read);
    } else if (value.kind == Kind::Object) {
      const JsonValue *className = value.find("class");
      const bool isObject = className && className->kind == Kind::String;
      for (const auto &[key, member] : value.members)
        visit(member, isObject && key.text != "constructor"
                          ? channelsOf(className->string, key.text)
                          : all);
    }
  }

  const SceneDescription &description;
  const ChannelsOfMember &channelsOf;
  std::map<const JsonValue *, std::uint32_t> channels;
};

/// An image, and what the program reads of it.
struct ReadImage {
  const ImageDescription *description;
  bool withLevels;
  std::uint32_t channels;
};

} // namespace

ImageFiles::ImageFiles(const SceneDescription &description,
                       const std::function<bool(const std::string &)> &withLevels,
                       const ChannelsOfMember &channelsOf) {
  const ImageChannels channels(description, channelsOf);
  std::map<std::string, std::size_t> known;
  std::vector<ReadImage> images;
  for (const auto &[json, image] : description.imageValues) {
    const std::string className = imageClass(*json);
    const auto [found, isNew] = known.emplace(identity(image, className), images.size());
    if (isNew)
      images.push_back(
          {&image, image.sampling.filter >= Filter::Trilinear && withLevels(className), 0});
    images[found->second].channels |= channels.of(*json);
    numbers[json] = found->second;
  }
  results.resize(images.size());
  forEachInParallel(0, images.size(), [&](std::size_t i) {
    Result &result = results[i];
    try {
      result.texels = load(*images[i].description, description);
      result.notFinite = runtime::dropNotFinite(result.texels);
      result.negative = runtime::negativeTexels(result.texels);
      runtime::dropChannels(result.texels, images[i].channels);
      if (images[i].withLevels)
        runtime::addLevels(result.texels);
    } catch (...) {
      result.failure = std::current_exception();
    }
  });
}

runtime::Texels ImageFiles::take(std::size_t number) {
  Result &result = results[number];
  if (result.failure)
    std::rethrow_exception(result.failure);
  return std::move(result.texels);
}

} // namespace rtsl::scene
