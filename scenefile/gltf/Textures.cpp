#include "scenefile/gltf/Textures.h"

#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <charconv>
#include <filesystem>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;

namespace {

constexpr std::uint32_t mostWhole = 0xffffffff;

// Numbers of OpenGL, which samplers use.
constexpr std::uint32_t nearest = 9728, linear = 9729;
constexpr std::uint32_t clampToEdge = 33071, mirroredRepeat = 33648, repeats = 10497;

const char *wrapOf(const JsonValue &sampler, const char *key, const std::string &what) {
  const JsonValue *wrap = sampler.find(key);
  switch (wrap ? readInteger(*wrap, 0, mostWhole, fmt::format("`{}` of {}", key, what)) : repeats) {
  case clampToEdge:
    return "clamp";
  case mirroredRepeat:
    return "mirror";
  case repeats:
    return "repeat";
  default:
    throw Error(message::badWrapMode(key, what, wrap->number), wrap->place());
  }
}

} // namespace

std::string Mention::beside(const std::string &file) const {
  return (std::filesystem::path(path).parent_path() / file).lexically_normal().string();
}

std::string partOfImage(std::size_t image) {
  return fmt::format("images.{}", image);
}

JsonValue Textures::texture(const JsonValue &info, const std::string &what, Use use) {
  expect(info, Kind::Object, what);
  const JsonValue *transform = extension(info, "KHR_texture_transform");
  const JsonValue *coordinates = transform ? transform->find("texCoord") : nullptr;
  if (!coordinates) // otherwise that is for programs that do not know the extension
    coordinates = info.find("texCoord");
  if (coordinates && readInteger(*coordinates, 0, mostWhole, "`texCoord` of " + what) != 0)
    warnings.push_back({message::texcoordIgnored(what, coordinates->number), coordinates->place()});
  const bool isColor = use == Use::Color || use == Use::Alpha;
  JsonValue pattern = valueAt(info, Kind::Object);
  switch (use) {
  case Use::Color:
    pattern = libraryObject(info, "textures.ImageTexture", modules);
    break;
  case Use::SlopeU:
  case Use::SlopeV:
    pattern = libraryObject(info, "textures.ImageSlope", modules);
    set(pattern, "axis", number(info, use == Use::SlopeU ? 0 : 1));
    break;
  default:
    pattern = libraryObject(info, "textures.ImageChannel", modules);
    set(pattern, "channel", number(info, int(use) - int(Use::Red)));
  }
  set(pattern, "image", image(info, what, isColor));
  if (transform)
    return transformed(std::move(pattern), *transform, "`KHR_texture_transform` of " + what);
  return pattern;
}

JsonValue Textures::image(const JsonValue &info, const std::string &what, bool isColor) {
  const std::size_t textureIndex =
      file.index("textures", require(info, "index", what), "`index` of " + what);
  const JsonValue &texture = file.list("textures")[textureIndex];
  const std::string textureName = fmt::format("`textures.{}`", textureIndex);
  const JsonValue *webp = extension(texture, "EXT_texture_webp");
  const bool hasOther = texture.find("source") != nullptr; // for programs that do not read WebP
  const std::size_t index =
      file.index("images", require(webp && !hasOther ? *webp : texture, "source", textureName),
                 "`source` of " + textureName);
  const JsonValue &source = file.list("images")[index];
  const JsonValue *uri = source.find("uri");
  if (uri)
    expect(*uri, Kind::String, fmt::format("`uri` of `images.{}`", index));
  else
    require(source, "bufferView", fmt::format("`images.{}` without a `uri`", index));
  const bool isFile = uri && !isDataUri(uri->string);
  JsonValue path = text(source, isFile ? mention.beside(file.pathOf(*uri)) : mention.path);
  path.fromOverride = mention.isFromOverride;
  JsonValue image = object(source, {{"file", std::move(path)}});
  if (!isFile)
    set(image, "part", gltf::text(source, partOfImage(index)));
  set(image, "colorSpace", gltf::text(source, isColor ? "srgb" : "linear"));
  setWrapAndFilter(image, texture, textureName);
  return image;
}

void Textures::setWrapAndFilter(JsonValue &image, const JsonValue &texture,
                                const std::string &what) const {
  const JsonValue *number = texture.find("sampler");
  if (!number)
    return;
  const std::size_t index = file.index("samplers", *number, "`sampler` of " + what);
  const JsonValue &sampler = file.list("samplers")[index];
  const std::string name = fmt::format("`samplers.{}`", index);
  set(image, "wrap",
      gltf::list(sampler, {gltf::text(sampler, wrapOf(sampler, "wrapS", name)),
                           gltf::text(sampler, wrapOf(sampler, "wrapT", name))}));
  const auto filterOf = [&](const char *key) {
    const JsonValue *filter = sampler.find(key);
    return filter ? readInteger(*filter, 0, mostWhole, fmt::format("`{}` of {}", key, name)) : 0;
  };
  const std::uint32_t near = filterOf("magFilter"), far = filterOf("minFilter");
  if (near == nearest)
    set(image, "filter", gltf::text(sampler, "nearest"));
  else if (far == nearest || far == linear) // no levels of half the resolution
    set(image, "filter", gltf::text(sampler, "bilinear"));
}

/// glTF turns and moves coordinates that begin at the upper left corner: u' = offset + R S u. Ours
/// begin at the lower left one, so they are mirrored before and after.
JsonValue Textures::transformed(JsonValue pattern, const JsonValue &transform,
                                const std::string &what) {
  std::vector<double> offset{0, 0}, scale{1, 1};
  double rotation = 0;
  if (const JsonValue *found = transform.find("offset"))
    offset = readNumbers(*found, 2, "`offset` of " + what);
  if (const JsonValue *found = transform.find("scale"))
    scale = readNumbers(*found, 2, "`scale` of " + what);
  if (const JsonValue *found = transform.find("rotation"))
    rotation = readNumber(*found, "`rotation` of " + what);
  JsonValue turned = libraryObject(transform, "textures.TransformedPattern", modules);
  if (rotation == 0) {
    set(turned, "scale", numbers(transform, scale));
    set(turned, "offset", numbers(transform, {offset[0], 1 - offset[1] - scale[1]}));
    set(turned, "pattern", std::move(pattern));
    return turned;
  }
  constexpr double degrees = 57.295779513082320877;
  set(turned, "rotation", number(transform, rotation * degrees));
  set(turned, "scale", numbers(transform, {1, -1}));
  set(turned, "offset", numbers(transform, {offset[0], 1 - offset[1]}));
  set(turned, "pattern", std::move(pattern));
  JsonValue scaled = libraryObject(transform, "textures.TransformedPattern", modules);
  set(scaled, "scale", numbers(transform, {scale[0], -scale[1]}));
  set(scaled, "offset", numbers(transform, {0, scale[1]}));
  set(scaled, "pattern", std::move(turned));
  return scaled;
}

runtime::Pixels readImage(const File &file, const std::string &part, runtime::ColorSpace space) {
  const std::string start = "images.";
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(part.data() + std::min(start.size(), part.size()),
                                            part.data() + part.size(), index);
  if (part.compare(0, start.size(), start) != 0 || error != std::errc() ||
      end != part.data() + part.size() || index >= file.list("images").size())
    throw Error(message::noSuchModelImage(file.path(), part));
  try {
    const JsonValue &image = file.list("images")[index];
    const std::string name = file.path() + "/" + part, what = fmt::format("`{}`", part);
    if (const JsonValue *uri = image.find("uri")) {
      expect(*uri, Kind::String, "`uri` of " + what);
      if (!isDataUri(uri->string))
        return runtime::readPixels(file.resolve(*uri), space);
      return runtime::decodePixels(bytesOfDataUri(*uri, what), name, space);
    }
    const std::size_t viewIndex =
        file.index("bufferViews", require(image, "bufferView", what), "`bufferView` of " + what);
    const JsonValue &view = file.list("bufferViews")[viewIndex];
    const std::string ofView = fmt::format("`bufferViews.{}`", viewIndex);
    const std::size_t number =
        file.index("buffers", require(view, "buffer", ofView), "`buffer` of " + ofView);
    const JsonValue *offset = view.find("byteOffset");
    const std::uint64_t begin =
        offset ? readInteger(*offset, 0, mostWhole, "`byteOffset` of " + ofView) : 0;
    const std::uint64_t length =
        readInteger(require(view, "byteLength", ofView), 1, mostWhole, "`byteLength` of " + ofView);
    const std::string_view bytes = file.buffer(number);
    if (begin + length > bytes.size())
      throw Error(message::imageBytesTooLong(ofView, begin + length, number, bytes.size()),
                  view.place());
    return runtime::decodePixels(std::string(bytes.substr(begin, length)), name, space);
  } catch (const Error &error) {
    throw named(error, file.path());
  }
}

} // namespace rtsl::scene::gltf
