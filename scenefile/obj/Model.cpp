#include "scenefile/obj/Model.h"

#include "runtime/geometry/Mesh.h"
#include "scenefile/obj/Material.h"
#include "support/AtomicFile.h"
#include "support/ByteOrderMark.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <utility>

namespace rtsl::scene::obj {

using namespace gltf;
using Kind = JsonValue::Kind;
using runtime::MeshGroup;

namespace {

// Numbers of OpenGL.
constexpr double unsignedInt = 5125, floats = 5126;

/// Writes the meshes of a file into a buffer, and the JSON that describes it.
class Writer {
public:
  explicit Writer(const std::string &path) : path(path) {
    source.file = std::make_shared<const std::string>(path);
  }

  void add(const MeshGroup &group, std::size_t material) {
    const runtime::Mesh &mesh = group.mesh;
    std::array<double, 3> low, high;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
      const auto one = double(mesh.positions[i]);
      low[i % 3] = std::min(low[i % 3], one);
      high[i % 3] = std::max(high[i % 3], one);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], low[axis]);
      upper[axis] = std::max(upper[axis], high[axis]);
    }
    JsonValue attributes = object(source, {});
    JsonValue positions = accessor(mesh.positions, floats, "VEC3", 3);
    set(positions, "min", numbers(source, {low[0], low[1], low[2]}));
    set(positions, "max", numbers(source, {high[0], high[1], high[2]}));
    set(attributes, "POSITION", added(std::move(positions)));
    if (!mesh.normals.empty())
      set(attributes, "NORMAL", added(accessor(mesh.normals, floats, "VEC3", 3)));
    if (!mesh.uvs.empty()) {
      std::vector<float> uvs = mesh.uvs; // those of glTF begin at the upper left corner
      for (std::size_t i = 1; i < uvs.size(); i += 2)
        uvs[i] = 1 - uvs[i];
      set(attributes, "TEXCOORD_0", added(accessor(uvs, floats, "VEC2", 2)));
    }
    for (const runtime::NamedAttribute &attribute : mesh.attributes)
      if (attribute.isRgb && !attribute.ofTriangles && attribute.components <= 4)
        set(attributes, "COLOR_0",
            added(accessor(attribute.words, floats, attribute.components == 4 ? "VEC4" : "VEC3",
                           attribute.components)));
    primitives.push_back(
        object(source, {{"attributes", std::move(attributes)},
                        {"indices", added(accessor(mesh.indices, unsignedInt, "SCALAR", 1))},
                        {"material", integer(material)}}));
  }

  /// The length of the diagonal of all meshes' box.
  double size() const {
    double square = 0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      square += (upper[axis] - lower[axis]) * (upper[axis] - lower[axis]);
    return std::max(std::sqrt(square), 1e-30);
  }

  /// The JSON of the whole file.
  JsonValue finish(std::vector<JsonValue> materials) {
    const std::string name = std::filesystem::path(path).stem().string();
    return object(
        source,
        {{"asset", object(source, {{"version", text(source, "2.0")}})},
         {"scenes", list(source, {object(source, {{"nodes", list(source, {integer(0)})}})})},
         {"nodes",
          list(source, {object(source, {{"name", text(source, name)}, {"mesh", integer(0)}})})},
         {"meshes",
          list(source, {object(source, {{"name", text(source, name)},
                                        {"primitives", list(source, std::move(primitives))}})})},
         {"materials", list(source, std::move(materials))},
         {"accessors", list(source, std::move(accessors))},
         {"bufferViews", list(source, std::move(views))},
         {"buffers", list(source, {object(source, {{"byteLength", integer(binary.size())}})})}});
  }

  std::string takeBinary() { return std::move(binary); }

private:
  JsonValue integer(std::size_t value) const {
    JsonValue made = number(source, double(value));
    made.isInteger = true;
    return made;
  }

  template <typename Element>
  JsonValue accessor(const std::vector<Element> &values, double type, const char *shape,
                     std::size_t width) {
    const std::size_t bytes = values.size() * sizeof(Element);
    views.push_back(object(source, {{"buffer", integer(0)},
                                    {"byteOffset", integer(binary.size())},
                                    {"byteLength", integer(bytes)}}));
    binary.append(reinterpret_cast<const char *>(values.data()), bytes);
    return object(source, {{"bufferView", integer(views.size() - 1)},
                           {"componentType", integer(std::size_t(type))},
                           {"count", integer(values.size() / width)},
                           {"type", text(source, shape)}});
  }

  JsonValue added(JsonValue accessor) {
    accessors.push_back(std::move(accessor));
    return integer(accessors.size() - 1);
  }

  const std::string &path;
  JsonValue source;
  std::string binary;
  std::array<double, 3> lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  std::vector<JsonValue> primitives, accessors, views;
};

bool isObj(const std::string &path) {
  return hasEnding(path, ".obj");
}

/// What an OBJ file says about materials.
struct Mentions {
  std::vector<std::pair<std::string, JsonValue>> libraries; // paths
  std::map<std::string, JsonValue> uses;                    // where each is used first
};

Mentions mentionsIn(const std::string &path) {
  Mentions mentions;
  const std::string contents = readFile(path);
  const auto file = std::make_shared<const std::string>(path);
  // Most lines are numbers: only the others are divided into words.
  std::uint32_t number = 0;
  for (std::size_t start = byteOrderMarkLength(contents); start < contents.size(); ++start) {
    const std::size_t end = std::min(contents.find('\n', start), contents.size());
    ++number;
    const std::string_view whole(contents.data() + start, end - start);
    start = end;
    const std::size_t first = whole.find_first_not_of(" \t");
    if (first == std::string_view::npos || (whole[first] != 'm' && whole[first] != 'u'))
      continue;
    std::vector<Line> lines = linesOf(whole);
    if (lines.empty() || lines.front().size() < 2)
      continue;
    Line &line = lines.front();
    line[1].line = number;
    if (line.front().text == "mtllib") {
      // One path, which may contain blanks, or several.
      std::string_view rest = whole.substr(line[1].column - 1);
      rest = rest.substr(0, rest.find_last_not_of(" \t\r") + 1);
      const auto beside = [&](std::string_view name) {
        return (std::filesystem::path(path).parent_path() / name).string();
      };
      if (line.size() == 2 || std::filesystem::exists(beside(rest))) {
        mentions.libraries.emplace_back(rest, sourceAt(file, line[1]));
      } else {
        for (std::size_t i = 1; i < line.size(); ++i) {
          line[i].line = number;
          mentions.libraries.emplace_back(line[i].text, sourceAt(file, line[i]));
        }
      }
    } else if (line.front().text == "usemtl") {
      std::string name;
      for (std::size_t i = 1; i < line.size(); ++i)
        name.append(i == 1 ? "" : " ").append(line[i].text);
      mentions.uses.emplace(std::move(name), sourceAt(file, line[1]));
    }
  }
  return mentions;
}

/// A material of the model; without statements: gray.
struct Known {
  std::optional<Material> material;
  JsonValue source;
};

} // namespace

bool isModel(const std::string &path) {
  return isObj(path) || hasEnding(path, ".ply");
}

std::unique_ptr<File> readModel(const std::string &path) {
  const std::vector<MeshGroup> groups =
      isObj(path) ? runtime::loadMeshGroups(path)
                  : std::vector<MeshGroup>{{"", runtime::loadMesh(path, {{"color"}, false})}};
  const Mentions mentions = isObj(path) ? mentionsIn(path) : Mentions();
  Prepared prepared;
  std::map<std::string, Material> materials;
  for (const auto &[library, source] : mentions.libraries) {
    std::string name = library;
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::filesystem::path relative(name);
    const std::string file =
        (std::filesystem::path(path).parent_path() / relative).lexically_normal().string();
    prepared.files.push_back(file);
    try {
      for (Material &material : readMaterials(file)) {
        material.folder = relative.parent_path().string();
        const auto [first, isNew] = materials.try_emplace(material.name, material);
        const JsonValue &source = first->second.source;
        if (!isNew)
          prepared.warnings.push_back(
              {message::materialNamedTwice(material.name, *source.file, source.line),
               material.source.place()});
      }
    } catch (const Error &error) {
      if (error.code != ErrorCode::FileNotFound)
        throw;
      prepared.warnings.push_back({message::materialFileMissing(library), source.place()});
    }
  }

  Writer writer(path);
  std::vector<JsonValue> named;
  std::vector<Known> known;
  for (const MeshGroup &group : groups) {
    JsonValue source;
    source.file = std::make_shared<const std::string>(path);
    if (const auto use = mentions.uses.find(group.material); use != mentions.uses.end())
      source = use->second;
    Known one{std::nullopt, source};
    if (const auto found = materials.find(group.material); found != materials.end())
      one.material = found->second;
    else if (!group.material.empty())
      prepared.warnings.push_back({message::materialNotInLibrary(group.material), source.place()});
    JsonValue json = object(source, {});
    if (!group.material.empty())
      set(json, "name", text(source, group.material));
    writer.add(group, known.size());
    known.push_back(std::move(one));
    named.push_back(std::move(json));
  }
  prepared.material = [known = std::move(known), size = writer.size()](
                          std::size_t index, VertexColors colors, const Mention &mention,
                          Modules &modules, std::vector<Warning> &warnings) {
    const Known &one = known.at(index);
    return one.material ? obj::materialOf(*one.material, size, colors, mention, modules, warnings)
                        : obj::defaultMaterial(one.source, colors, modules);
  };
  JsonValue json = writer.finish(std::move(named));
  return std::make_unique<File>(std::move(json), writer.takeBinary(), path, std::move(prepared));
}

} // namespace rtsl::scene::obj
