#include "scenefile/gltf/Mesh.h"

#include "scenefile/gltf/Accessor.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <numeric>
#include <optional>
#include <set>

namespace rtsl::scene::gltf {

using Kind = JsonValue::Kind;

namespace {

constexpr std::uint32_t triangles = 4, triangleStrip = 5; // and 6, a fan

std::uint32_t modeOf(const JsonValue &primitive, const std::string &part) {
  const JsonValue *mode = primitive.find("mode");
  return mode ? readInteger(*mode, 0, 6, fmt::format("`mode` of `{}`", part)) : triangles;
}

/// The accessors of a primitive, checked.
struct Vertices {
  Accessor positions;
  std::optional<Accessor> normals, uvs, indices;

  Vertices(const File &file, const JsonValue &primitive, const std::string &part)
      : positions(file, require(attributes(primitive, part), "POSITION", named(part)),
                  fmt::format("`POSITION` of `{}`", part)),
        normals(attribute(file, primitive, part, "NORMAL", "VEC3")),
        uvs(attribute(file, primitive, part, "TEXCOORD_0", "VEC2")) {
    positions.require("VEC3");
    if (const JsonValue *number = primitive.find("indices")) {
      indices.emplace(file, *number, fmt::format("`indices` of `{}`", part));
      indices->require("SCALAR");
    }
  }

  static std::string named(const std::string &part) {
    return fmt::format("`attributes` of `{}`", part);
  }

  static const JsonValue &attributes(const JsonValue &primitive, const std::string &part) {
    return expect(require(primitive, "attributes", fmt::format("`{}`", part)), Kind::Object,
                  named(part));
  }

  std::optional<Accessor> attribute(const File &file, const JsonValue &primitive,
                                    const std::string &part, const char *name,
                                    const char *type) const { // null: any
    const JsonValue *number = attributes(primitive, part).find(name);
    if (!number)
      return std::nullopt;
    std::optional<Accessor> accessor(std::in_place, file, *number,
                                     fmt::format("`{}` of `{}`", name, part));
    if (type)
      accessor->require(type);
    if (accessor->count() != positions.count())
      throw Error(message::attributeCountsDiffer(part, accessor->count(), name, positions.count()),
                  number->place());
    return accessor;
  }
};

/// What the morph targets of a primitive add to its positions or normals.
std::vector<Accessor> differencesOf(const File &file, const JsonValue &primitive,
                                    const std::string &part, std::size_t target, const char *name,
                                    std::size_t count) {
  const std::string what = fmt::format("`targets.{}` of `{}`", target, part);
  const JsonValue &attributes =
      expect(primitive.find("targets")->elements[target], Kind::Object, what);
  const JsonValue *number = attributes.find(name);
  if (!number)
    return {};
  Accessor accessor(file, *number, fmt::format("`{}` of {}", name, what));
  accessor.require("VEC3");
  if (accessor.count() != count)
    throw Error(message::attributeCountsDiffer(part, accessor.count(), name, count),
                number->place());
  return {std::move(accessor)};
}

/// Adds the morph targets to the positions or normals of a primitive, by their weights.
void morph(std::vector<float> &values, const File &file, const JsonValue &primitive,
           const std::string &part, const char *name, const std::vector<double> &weights) {
  std::vector<double> sums(values.begin(), values.end());
  for (std::size_t target = 0; target < weights.size(); ++target)
    if (weights[target] != 0)
      for (const Accessor &differences :
           differencesOf(file, primitive, part, target, name, values.size() / 3)) {
        const std::vector<float> numbers = differences.floats();
        for (std::size_t i = 0; i < sums.size(); ++i)
          sums[i] += weights[target] * double(numbers[i]);
      }
  std::transform(sums.begin(), sums.end(), values.begin(), [](double sum) { return float(sum); });
}

/// The vertices of triangles, from those of a strip or a fan.
std::vector<std::uint32_t> trianglesOf(const std::vector<std::uint32_t> &vertices,
                                       std::uint32_t mode) {
  if (mode == triangles)
    return {vertices.begin(), vertices.end() - std::ptrdiff_t(vertices.size() % 3)};
  std::vector<std::uint32_t> result;
  for (std::size_t i = 2; i < vertices.size(); ++i) {
    const std::size_t odd = i % 2; // of a strip, every other triangle is turned
    if (mode == triangleStrip)
      result.insert(result.end(), {vertices[i - 2], vertices[i - 1 + odd], vertices[i - odd]});
    else
      result.insert(result.end(), {vertices[i - 1], vertices[i], vertices[0]});
  }
  return result;
}

/// A number from 0 on in decimal digits, or nothing.
std::optional<std::size_t> wholeNumber(std::string_view text) {
  std::size_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    return std::nullopt;
  return number;
}

} // namespace

std::string partOfPrimitive(std::size_t mesh, std::size_t primitive) {
  return fmt::format("meshes.{}.primitives.{}", mesh, primitive);
}

const JsonValue &primitiveOf(const File &file, const std::string &part, const Place &place) {
  const std::string_view start = "meshes.", middle = ".primitives.";
  const std::string_view text = part;
  const std::size_t at = text.find(middle);
  if (text.substr(0, start.size()) == start && at != std::string_view::npos) {
    const auto mesh = wholeNumber(text.substr(start.size(), at - start.size()));
    const auto primitive = wholeNumber(text.substr(at + middle.size()));
    const auto &meshes = file.list("meshes");
    const JsonValue *primitives =
        mesh && *mesh < meshes.size() ? meshes[*mesh].find("primitives") : nullptr;
    if (primitives && primitive && *primitive < primitives->elements.size())
      return expect(primitives->elements[*primitive], Kind::Object, fmt::format("`{}`", part));
  }
  throw Error(message::noSuchModelMesh(file.path(), part), place);
}

bool hasTriangles(const JsonValue &primitive, const std::string &part) {
  return modeOf(primitive, part) >= triangles;
}

std::size_t targetCount(const JsonValue &primitive, const std::string &part) {
  const JsonValue *targets = primitive.find("targets");
  return targets
             ? expect(*targets, Kind::Array, fmt::format("`targets` of `{}`", part)).elements.size()
             : 0;
}

void checkPrimitive(const File &file, const JsonValue &primitive, const std::string &part) {
  modeOf(primitive, part);
  const Vertices vertices(file, primitive, part);
  for (std::size_t target = 0; target < targetCount(primitive, part); ++target)
    for (const char *name : {"POSITION", "NORMAL"})
      differencesOf(file, primitive, part, target, name, vertices.positions.count());
}

VertexColors vertexColorsOf(const File &file, const JsonValue &primitive, const std::string &part) {
  const std::optional<Accessor> colors =
      Vertices(file, primitive, part).attribute(file, primitive, part, "COLOR_0", nullptr);
  if (!colors)
    return VertexColors::None;
  if (colors->json().find("type")->string == "VEC4")
    return VertexColors::Rgba;
  colors->require("VEC3");
  return VertexColors::Rgb;
}

std::vector<Warning> warningsOf(const JsonValue &primitive, const std::string &part) {
  std::vector<Warning> warnings;
  if (!hasTriangles(primitive, part))
    warnings.push_back({message::pointsAndLinesIgnored(part), primitive.place()});
  std::set<std::string> ignored; // each once
  for (std::size_t target = 0; target < targetCount(primitive, part); ++target)
    for (const auto &[name, number] : primitive.find("targets")->elements[target].members)
      if (name.text != "POSITION" && name.text != "NORMAL" && ignored.insert(name.text).second)
        warnings.push_back({message::targetAttributeIgnored(name.text, part), number.place()});
  return warnings;
}

namespace {

/// The name of an attribute in shaders: of `TEXCOORD_1` `uv1`, of `COLOR_0` `color`, of `TANGENT`
/// `tangent`, and of one of the author's own, such as `_WEAR`, `wear`. Empty: it has none.
std::string shaderNameOf(const std::string &name) {
  const auto after = [&](const std::string &start) { return name.substr(start.size()); };
  const auto begins = [&](const std::string &start) {
    return name.compare(0, start.size(), start) == 0;
  };
  if (name == "TANGENT")
    return "tangent";
  if (begins("TEXCOORD_"))
    return "uv" + after("TEXCOORD_");
  if (begins("COLOR_"))
    return name == "COLOR_0" ? "color" : "color" + after("COLOR_");
  if (!begins("_"))
    return "";
  std::string own = after("_");
  std::transform(own.begin(), own.end(), own.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return own;
}

void flip(std::vector<float> &uvs) {
  for (std::size_t i = 1; i < uvs.size(); i += 2)
    uvs[i] = 1 - uvs[i];
}

/// Adds the attributes that are requested, and the names of the others.
void addAttributes(runtime::Mesh &mesh, const File &file, const JsonValue &primitive,
                   const std::string &part, const Vertices &vertices,
                   const runtime::MeshRequest &request) {
  for (const auto &[key, number] : Vertices::attributes(primitive, part).members) {
    const std::string name = shaderNameOf(key.text);
    if (name.empty())
      continue;
    if (!request.wants(name)) {
      mesh.otherAttributes.push_back(name);
      continue;
    }
    const Accessor accessor = *vertices.attribute(file, primitive, part, key.text.c_str(), nullptr);
    std::vector<float> numbers = accessor.floats();
    const auto components =
        std::uint32_t(numbers.size() / std::max<std::size_t>(accessor.count(), 1));
    const bool isUv = key.text.compare(0, 9, "TEXCOORD_") == 0;
    if (isUv && components == 2)
      flip(numbers);
    if (name == "color")
      for (float &one : numbers)
        one = std::clamp(one, 0.0f, 1.0f);
    mesh.attributes.push_back(runtime::floatAttribute(name, components, numbers));
    mesh.attributes.back().isRgb = key.text.compare(0, 6, "COLOR_") == 0;
    if (name == "tangent" && components == 4)
      mesh.attributes.back().space = runtime::NamedAttribute::Space::Tangent;
  }
}

} // namespace

runtime::Mesh readMesh(const File &file, const std::string &part,
                       const runtime::MeshRequest &request, const std::vector<double> &weights) {
  try {
    const JsonValue &primitive = primitiveOf(file, part, Place{file.path()});
    const std::uint32_t mode = modeOf(primitive, part);
    const Vertices vertices(file, primitive, part);
    runtime::Mesh mesh;
    mesh.positions = vertices.positions.floats();
    morph(mesh.positions, file, primitive, part, "POSITION", weights);
    if (vertices.normals) {
      mesh.normals = vertices.normals->floats();
      morph(mesh.normals, file, primitive, part, "NORMAL", weights);
    }
    if (vertices.uvs) {
      mesh.uvs = vertices.uvs->floats();
      flip(mesh.uvs);
    }
    std::vector<std::uint32_t> indices;
    if (vertices.indices) {
      indices = vertices.indices->integers();
    } else {
      indices.resize(vertices.positions.count());
      std::iota(indices.begin(), indices.end(), 0u);
    }
    mesh.indices = trianglesOf(indices, mode);
    addAttributes(mesh, file, primitive, part, vertices, request);
    if (request.keepsOrder)
      mesh.order = {true, mesh.vertexCount(), mesh.triangleCount(), {}, {}};
    runtime::validateMesh(mesh, fmt::format("{}/{}", file.path(), part));
    return mesh;
  } catch (const Error &error) {
    throw named(error, file.path());
  }
}

} // namespace rtsl::scene::gltf
