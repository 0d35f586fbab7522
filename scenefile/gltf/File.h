//===- File.h - a glTF file and the buffers that it refers to -------------===//
//
//   gltf::File file("chair.glb");
//   const JsonValue &mesh = file.element("meshes", *node.find("mesh"), "`mesh` of `nodes.3`");
//
// glTF is JSON, so it is read with the reader of scene files: mistakes are shown at their position.
// In the binary container (.glb) there are no positions; there messages name the file and the part.
// Parts of a file are named as by --set: `meshes.0.primitives.1`.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "scenefile/gltf/Parts.h"
#include "scenefile/json/JsonValue.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace rtsl::scene::gltf {

struct Mention;

/// What of the colors of its vertices a mesh has: factors of its material's base color and, if they
/// have alpha, of its opacity.
enum class VertexColors { None, Rgb, Rgba };

/// What a file of another format has that was made a glTF file.
struct Prepared {
  /// Makes what an author would write for a material, in place of what its JSON says.
  std::function<JsonValue(std::size_t material, VertexColors colors, const Mention &mention,
                          Modules &modules, std::vector<Warning> &warnings)>
      material;
  std::vector<std::string> files; // that it refers to, for dependencies
  std::vector<Warning> warnings;
};

class File {
public:
  /// Reads a file and checks what does not depend on its buffers' bytes. Throws the errors of
  /// readFile, JsonSyntax, MissingKey, WrongType, NotSupported, BadMesh (a damaged container).
  explicit File(std::string path);
  /// The same for bytes in memory; `path` is for messages and for relative paths.
  File(const std::string &bytes, std::string path);

  /// A file of another format, as JSON with one buffer.
  File(JsonValue json, std::string binary, std::string path, Prepared prepared);

  const std::string &path() const { return name; }
  const JsonValue &root() const { return json; }

  /// A list of the file, such as `nodes`; empty if it is left out. Its elements are objects.
  const std::vector<JsonValue> &list(const char *key) const;
  /// `lights` of the extension KHR_lights_punctual.
  const std::vector<JsonValue> &lights() const;

  /// The element of a list that a number refers to. `what` begins messages. Throws OutOfRange.
  std::size_t index(const char *key, const JsonValue &number, const std::string &what) const;
  const JsonValue &element(const char *key, const JsonValue &number,
                           const std::string &what) const {
    return list(key)[index(key, number, what)];
  }

  /// The bytes of a buffer, which are read once. Throws the errors of readFile, and BadBuffer.
  std::string_view buffer(std::size_t number) const;

  /// The path in a URI, relative to the file's folder. Throws NotSupported for other schemes.
  static std::string pathOf(const JsonValue &uri);
  /// The file that it means.
  std::string resolve(const JsonValue &uri) const;

  /// The file itself and those of its buffers, for dependencies.
  std::vector<std::string> files() const;

  /// Null: its materials are those of its JSON.
  const Prepared *prepared() const { return ready ? &*ready : nullptr; }

  /// What the file uses that has no meaning here, by name.
  const std::vector<Warning> &warnings() const { return allWarnings; }

private:
  void readContainer(const std::string &bytes);
  void checkRoot();
  void checkExtensions();
  std::optional<std::uint64_t> sizeOf(const JsonValue &buffer, std::size_t number) const;
  void checkBuffers();
  std::string load(const JsonValue &buffer, std::size_t number) const;

  std::string name;
  JsonValue json;
  std::string binary; // of the container
  bool hasBinary = false;
  std::optional<Prepared> ready;
  std::vector<Warning> allWarnings;
  mutable std::mutex mutex;
  mutable std::map<std::size_t, std::string> buffers; // those that were read
};

/// Whether a path ends with this, which has no capitals, in letters of either case.
bool hasEnding(const std::string &path, std::string_view ending);

/// Is it a file of a model, glTF, OBJ or PLY, by its name?
bool isModel(const std::string &path);

/// Is it a `data:` URI? Then its bytes are in it.
bool isDataUri(const std::string &uri);
/// The bytes of a `data:` URI in base64. Throws BadBuffer.
std::string bytesOfDataUri(const JsonValue &uri, const std::string &what);

/// The extension of this name of an element; null: it has none. Throws WrongType.
const JsonValue *extension(const JsonValue &element, const char *name);

/// An error that names the file: one without a position would not say where it is. So do those that
/// it carries.
Error named(const Error &error, const std::string &path);
Warning named(Warning warning, const std::string &path);

} // namespace rtsl::scene::gltf
