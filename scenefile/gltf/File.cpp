#include "scenefile/gltf/File.h"

#include "scenefile/json/Reader.h"
#include "support/AtomicFile.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;

namespace {

constexpr std::array lists = {"accessors", "animations", "buffers",   "bufferViews",
                              "cameras",   "images",     "materials", "meshes",
                              "nodes",     "samplers",   "scenes",    "textures"};

constexpr std::array extensions = {"EXT_texture_webp",        "KHR_lights_punctual",
                                   "KHR_materials_clearcoat", "KHR_materials_emissive_strength",
                                   "KHR_materials_ior",       "KHR_materials_sheen",
                                   "KHR_materials_specular",  "KHR_materials_transmission",
                                   "KHR_materials_unlit",     "KHR_materials_volume",
                                   "KHR_mesh_quantization",   "KHR_texture_transform"};

bool isKnown(const std::string &extension) {
  return std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
}

/// What a .glb file is that has neither the container's beginning nor JSON.
Error noContainer(const std::string &bytes, const std::string &path) {
  constexpr std::string_view pointer = "version https://git-lfs";
  if (bytes.empty())
    return Error(message::noContainer("it is empty"), Place{path});
  if (bytes.compare(0, pointer.size(), pointer) == 0)
    return std::move(Error(message::noContainer("it is a pointer of Git LFS"), Place{path})
                         .note("`git lfs pull` fetches the file"));
  std::string start;
  for (const char byte : bytes.substr(0, 4))
    start += fmt::format("{}{:02x}", start.empty() ? "" : " ", std::uint8_t(byte));
  if (bytes[0] == '<')
    return std::move(Error(message::noContainer("it begins with `<`, as web pages do"), Place{path})
                         .note("the address of the page was downloaded, not that of the file"));
  return std::move(Error(message::noContainer("its first bytes are " + start), Place{path})
                       .note("export or download it again"));
}

bool isJson(const std::string &bytes) {
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  return start != std::string::npos && (bytes[start] == '{' || bytes[start] == '[');
}

std::uint32_t wordAt(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  for (std::size_t i = 4; i-- > 0;)
    word = word << 8 | std::uint8_t(bytes[at + i]);
  return word;
}

/// A container has no lines.
void forgetPositions(JsonValue &value) {
  std::vector<JsonValue *> open{&value};
  while (!open.empty()) {
    JsonValue &one = *open.back();
    open.pop_back();
    one.line = one.column = one.length = 0;
    for (JsonValue &element : one.elements)
      open.push_back(&element);
    for (auto &[key, member] : one.members) {
      key.line = key.column = key.length = 0;
      open.push_back(&member);
    }
  }
}

constexpr std::string_view base64Marker = ";base64,";

int valueOfHex(char c) {
  if (c >= '0' && c <= '9')
    return c - '0';
  const char lower = char(c | 0x20);
  return lower >= 'a' && lower <= 'f' ? lower - 'a' + 10 : -1;
}

/// Decodes the %XX of a URI.
std::string decodePercent(const std::string &uri) {
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const bool isCode = uri[i] == '%' && i + 2 < uri.size() && valueOfHex(uri[i + 1]) >= 0 &&
                        valueOfHex(uri[i + 2]) >= 0;
    text += isCode ? char(16 * valueOfHex(uri[i + 1]) + valueOfHex(uri[i + 2])) : uri[i];
    if (isCode)
      i += 2;
  }
  return text;
}

int valueOfBase64(char c) {
  if (c >= 'A' && c <= 'Z')
    return c - 'A';
  if (c >= 'a' && c <= 'z')
    return c - 'a' + 26;
  if (c >= '0' && c <= '9')
    return c - '0' + 52;
  return c == '+' ? 62 : c == '/' ? 63 : -1;
}

/// Does a message with this text and place say which file it is about?
bool namesFile(const std::string &text, const std::optional<Place> &place,
               const std::string &path) {
  return (place && (place->line != 0 || place->file != path)) ||
         text.find(path) != std::string::npos;
}

} // namespace

bool hasEnding(const std::string &path, std::string_view ending) {
  return path.size() > ending.size() &&
         std::equal(ending.rbegin(), ending.rend(), path.rbegin(),
                    [](char a, char b) { return a == (b >= 'A' && b <= 'Z' ? b - 'A' + 'a' : b); });
}

bool isModel(const std::string &path) {
  return hasEnding(path, ".gltf") || hasEnding(path, ".glb") || hasEnding(path, ".obj") ||
         hasEnding(path, ".ply");
}

bool isDataUri(const std::string &uri) {
  return uri.compare(0, 5, "data:") == 0;
}

std::string bytesOfDataUri(const JsonValue &uri, const std::string &what) {
  const std::string &text = uri.string;
  const std::size_t comma = text.find(base64Marker);
  if (comma == std::string::npos)
    throw Error(message::uriNotBase64(what), uri.place());
  std::size_t end = text.size();
  while (end > comma + base64Marker.size() && text[end - 1] == '=')
    --end;
  std::string bytes;
  bytes.reserve((end - comma) * 3 / 4);
  std::uint32_t bits = 0;
  int count = 0;
  for (std::size_t i = comma + base64Marker.size(); i < end; ++i) {
    const int value = valueOfBase64(text[i]);
    if (value < 0)
      throw Error(message::uriByteNotBase64(what, i), uri.place());
    bits = bits << 6 | std::uint32_t(value);
    count += 6;
    if (count >= 8) {
      count -= 8;
      bytes += char(bits >> count & 0xff);
    }
  }
  return bytes;
}

const JsonValue *extension(const JsonValue &element, const char *name) {
  const JsonValue *all = element.find("extensions");
  if (!all)
    return nullptr;
  expect(*all, Kind::Object, "`extensions`");
  const JsonValue *found = all->find(name);
  if (found)
    expect(*found, Kind::Object, fmt::format("`{}`", name));
  return found;
}

Error named(const Error &error, const std::string &path) {
  const bool isKnown = namesFile(error.what(), error.place, path);
  Error result = isKnown ? error
                         : Error({error.code, fmt::format("`{}`: {}", path, error.what())},
                                 error.place ? error.place : Place{path});
  if (!isKnown)
    result.notes = error.notes;
  result.further.clear();
  for (const Error &further : error.further)
    result.further.push_back(named(further, path));
  return result;
}

Warning named(Warning warning, const std::string &path) {
  if (!namesFile(warning.message, warning.place, path))
    warning.message = fmt::format("`{}`: {}", path, warning.message);
  return warning;
}

File::File(std::string path) : File(readFile(path), path) {}

File::File(const std::string &bytes, std::string path) : name(std::move(path)) {
  try {
    if (bytes.compare(0, 4, "glTF") == 0)
      readContainer(bytes);
    else if (hasEnding(name, ".glb") && !isJson(bytes))
      throw noContainer(bytes, name);
    else
      json = parseJson(bytes, name);
    checkRoot();
    checkExtensions();
    checkBuffers();
  } catch (const Error &error) {
    throw named(error, name);
  }
}

File::File(JsonValue given, std::string bytes, std::string path, Prepared prepared)
    : name(std::move(path)), json(std::move(given)), binary(std::move(bytes)), hasBinary(true),
      ready(std::move(prepared)), allWarnings(ready->warnings) {
  checkRoot();
}

/// A header of 12 bytes, then chunks: a length, a type, and so many bytes.
void File::readContainer(const std::string &bytes) {
  constexpr std::uint32_t jsonChunk = 0x4e4f534a, binaryChunk = 0x004e4942;
  const auto fail = [&](const Message &why) { throw Error(why, Place{name}); };
  if (bytes.size() < 20)
    fail(message::containerTruncated(bytes.size()));
  if (const std::uint32_t version = wordAt(bytes, 4); version != 2)
    throw Error(message::containerVersion(version), Place{name});
  const std::uint64_t length = wordAt(bytes, 8);
  if (length > bytes.size())
    fail(message::containerShorter(length, bytes.size()));
  bool hasJson = false;
  for (std::uint64_t at = 12; at + 8 <= length;) {
    const std::uint64_t size = wordAt(bytes, at);
    const std::uint32_t type = wordAt(bytes, at + 4);
    at += 8;
    if (size > length - at)
      fail(message::containerChunk(size, at, length));
    if (!hasJson && type != jsonChunk)
      fail(message::firstChunkNotJson());
    if (type == jsonChunk && !hasJson) {
      try {
        json = parseJson(bytes.substr(at, size), name);
      } catch (const Error &error) { // whose line is not one of the file
        throw Error({error.code, error.what()}, Place{name});
      }
      hasJson = true;
    } else if (type == binaryChunk && !hasBinary) {
      binary = bytes.substr(at, size);
      hasBinary = true;
    }
    at += size;
  }
  if (!hasJson)
    fail(message::containerWithoutJson());
  forgetPositions(json);
}

void File::checkRoot() {
  expect(json, Kind::Object, "a glTF file");
  const JsonValue &asset = expect(require(json, "asset", "a glTF file"), Kind::Object, "`asset`");
  const JsonValue &version =
      expect(require(asset, "version", "`asset`"), Kind::String, "`version` of `asset`");
  if (version.string.compare(0, 2, "2.") != 0)
    throw Error(message::modelVersion(version.string), version.place());
  // Later versions 2.x add only what readers may ignore, unless the file needs such a version.
  const JsonValue *needed = asset.find("minVersion");
  if (needed && expect(*needed, Kind::String, "`minVersion` of `asset`").string != "2.0")
    throw Error(message::modelVersion(needed->string), needed->place());
  ErrorCollector errors;
  for (const char *key : lists)
    if (const JsonValue *found = json.find(key))
      errors.attempt([&] {
        expect(*found, Kind::Array, fmt::format("`{}`", key));
        for (std::size_t i = 0; i < found->elements.size(); ++i)
          expect(found->elements[i], Kind::Object, fmt::format("`{}.{}`", key, i));
      });
  errors.attempt([&] {
    if (const JsonValue *punctual = extension(json, "KHR_lights_punctual")) {
      const JsonValue &lights = require(*punctual, "lights", "`KHR_lights_punctual`");
      expect(lights, Kind::Array, "`lights`");
      for (std::size_t i = 0; i < lights.elements.size(); ++i)
        expect(lights.elements[i], Kind::Object, fmt::format("`lights.{}`", i));
    }
  });
  errors.throwIfAny();
}

void File::checkExtensions() {
  ErrorCollector errors;
  const auto forEach = [&](const char *key, auto visit) {
    if (const JsonValue *found = json.find(key))
      errors.attempt([&] {
        expect(*found, Kind::Array, fmt::format("`{}`", key));
        for (const JsonValue &extension : found->elements)
          if (!isKnown(expect(extension, Kind::String, "an extension").string))
            visit(extension);
      });
  };
  std::vector<std::string> missing;
  forEach("extensionsRequired", [&](const JsonValue &extension) {
    missing.push_back(extension.string);
    errors.add(Error(message::requiredExtension(extension.string), extension.place()));
  });
  forEach("extensionsUsed", [&](const JsonValue &extension) {
    if (std::find(missing.begin(), missing.end(), extension.string) == missing.end())
      allWarnings.push_back({message::extensionIgnored(extension.string, name), extension.place()});
  });
  errors.throwIfAny();
}

/// The bytes that a buffer has, without reading them. Nothing: what is known only when it is read,
/// which may fail.
std::optional<std::uint64_t> File::sizeOf(const JsonValue &buffer, std::size_t number) const {
  const JsonValue *uri = buffer.find("uri");
  if (!uri && number == 0 && hasBinary)
    return binary.size();
  if (!uri || uri->kind != Kind::String)
    return {};
  if (isDataUri(uri->string)) {
    const std::size_t start = uri->string.find(base64Marker);
    if (start == std::string::npos)
      return {};
    const std::size_t end = uri->string.find_last_not_of('=') + 1;
    const auto isBase64 = [](char c) { return valueOfBase64(c) >= 0; };
    if (!std::all_of(uri->string.begin() + start + base64Marker.size(), uri->string.begin() + end,
                     isBase64))
      return {};
    return (end - start - base64Marker.size()) * 3 / 4;
  }
  if (uri->string.find("://") != std::string::npos)
    return {};
  std::error_code failed;
  const std::string path = resolve(*uri);
  if (!std::filesystem::is_regular_file(path, failed))
    return {};
  const std::uintmax_t size = std::filesystem::file_size(path, failed);
  return failed ? std::nullopt : std::optional<std::uint64_t>(size);
}

/// Buffers that have fewer bytes than their `byteLength`: errors where a view needs them.
void File::checkBuffers() {
  const auto wholeOf = [](const JsonValue &object, const char *key) {
    const JsonValue *found = object.find(key);
    return found && found->kind == Kind::Number && found->number >= 0
               ? std::uint64_t(std::min(found->number, 0x1p53))
               : 0;
  };
  ErrorCollector errors;
  const std::vector<JsonValue> &all = list("buffers"), &views = list("bufferViews");
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::uint64_t length = wholeOf(all[i], "byteLength");
    const std::optional<std::uint64_t> size = sizeOf(all[i], i);
    if (!size || *size >= length)
      continue;
    const Place place = all[i].find("byteLength")->place();
    std::size_t beyond = views.size(); // a view that needs missing bytes, and no more than promised
    for (std::size_t j = views.size(); j-- > 0;) {
      const std::uint64_t end = wholeOf(views[j], "byteOffset") + wholeOf(views[j], "byteLength");
      const JsonValue *buffer = views[j].find("buffer");
      if (buffer && buffer->kind == Kind::Number && buffer->number == double(i) && end > *size &&
          end <= length)
        beyond = j;
    }
    if (beyond == views.size())
      allWarnings.push_back({message::bufferShort(i, *size, length), place});
    else
      errors.add(Error(message::bufferWithoutView(i, *size, length, beyond,
                                                  wholeOf(views[beyond], "byteOffset") +
                                                      wholeOf(views[beyond], "byteLength")),
                       place));
  }
  errors.throwIfAny();
}

const std::vector<JsonValue> &File::list(const char *key) const {
  static const std::vector<JsonValue> none;
  const JsonValue *found = json.find(key);
  return found ? found->elements : none;
}

const std::vector<JsonValue> &File::lights() const {
  static const std::vector<JsonValue> none;
  const JsonValue *punctual = extension(json, "KHR_lights_punctual");
  return punctual ? punctual->find("lights")->elements : none;
}

std::size_t File::index(const char *key, const JsonValue &number, const std::string &what) const {
  const std::uint32_t index = readInteger(number, 0, 0xffffffff, what);
  const std::size_t count = std::string_view(key) == "lights" ? lights().size() : list(key).size();
  if (index >= count)
    throw Error(message::indexTooLarge(what, index, key, count, count == 1 ? "" : "s"),
                number.place());
  return index;
}

std::string File::pathOf(const JsonValue &uri) {
  if (const std::size_t colon = uri.string.find("://"); colon != std::string::npos)
    throw Error(message::uriScheme(uri.string.substr(0, colon)), uri.place());
  return decodePercent(uri.string);
}

std::string File::resolve(const JsonValue &uri) const {
  const std::filesystem::path folder = std::filesystem::path(name).parent_path();
  return (folder / pathOf(uri)).lexically_normal().string();
}

std::string_view File::buffer(std::size_t number) const {
  const std::lock_guard lock(mutex);
  const JsonValue &buffer = list("buffers").at(number);
  if (!buffer.find("uri") && number == 0 && hasBinary)
    return binary;
  auto found = buffers.find(number);
  if (found == buffers.end())
    found = buffers.emplace(number, load(buffer, number)).first;
  return found->second;
}

std::string File::load(const JsonValue &buffer, std::size_t number) const {
  const std::string what = fmt::format("`buffers.{}`", number);
  const JsonValue *uri = buffer.find("uri");
  if (!uri)
    throw Error(message::uriMissing(what), buffer.place());
  expect(*uri, Kind::String, fmt::format("`uri` of {}", what));
  if (isDataUri(uri->string))
    return bytesOfDataUri(*uri, what);
  try {
    return readFile(resolve(*uri));
  } catch (Error &error) {
    if (!error.place || error.place->line == 0)
      error.place = uri->place();
    throw;
  }
}

std::vector<std::string> File::files() const {
  std::vector<std::string> found{name};
  for (const JsonValue &buffer : list("buffers"))
    if (const JsonValue *uri = buffer.find("uri"); uri && uri->kind == Kind::String &&
                                                   !isDataUri(uri->string) &&
                                                   uri->string.find("://") == std::string::npos)
      found.push_back(resolve(*uri));
  if (ready)
    found.insert(found.end(), ready->files.begin(), ready->files.end());
  return found;
}

} // namespace rtsl::scene::gltf
