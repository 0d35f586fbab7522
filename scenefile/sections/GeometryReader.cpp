//===- GeometryReader.cpp - meshes and primitives of a scene file ---------===//
#include "scenefile/sections/GeometryReader.h"

#include "scenefile/Models.h"
#include "scenefile/files/MeshPaths.h"
#include "scenefile/gltf/Mesh.h"
#include "scenefile/graph/Graph.h"
#include "scenefile/graph/KeyTimes.h"
#include "scenefile/graph/TransformReader.h"
#include "scenefile/json/Reader.h"
#include "scenefile/sections/ObjectReader.h"
#include "support/ErrorMessages.h"

#include <utility>

namespace rtsl::scene {

using Kind = JsonValue::Kind;

static void readMeshPart(const JsonValue &part, SceneDescription &scene,
                         GeometryDescription &geometry) {
  expect(part, Kind::String, "`part`");
  for (const MeshPath &key : geometry.mesh)
    gltf::primitiveOf(modelsOf(scene).open(key.path, key.name.place), part.string, part.place());
  geometry.part = part.string;
}

/// A number for each morph target of the part; or {"keys": [lists of them], "times": [...]}.
static void readWeights(const JsonValue &value, SceneDescription &scene,
                        GeometryDescription &geometry) {
  if (geometry.part.empty() || geometry.mesh.size() != 1)
    throw Error(message::weightsWithoutPart(), value.place());
  const MeshPath &file = geometry.mesh.front();
  const std::size_t targets =
      gltf::targetCount(gltf::primitiveOf(modelsOf(scene).open(file.path, file.name.place),
                                          geometry.part, value.place()),
                        geometry.part);
  if (value.kind != Kind::Object) {
    geometry.weights = {readNumbers(value, targets, "`weights`")};
    return;
  }
  checkKeys(value, {"keys", "times"}, "`weights` with keys");
  geometry.meshTimes = readKeyTimes(value, "`weights`");
  for (const JsonValue &key : value.find("keys")->elements)
    geometry.weights.push_back(readNumbers(key, targets, "a key of `weights`"));
}

static void readBackFaces(const JsonValue &value, GeometryDescription &geometry) {
  expect(value, Kind::Boolean, "`backFaces`");
  if (geometry.mesh.empty())
    throw Error(message::backFacesWithoutMesh(), value.place());
  geometry.hasBackFaces = value.boolean;
}

static void readCount(const JsonValue &value, GeometryDescription &geometry) {
  const JsonValue *count = value.find("count");
  if (!count)
    return;
  if (geometry.mesh.empty() && count->kind == Kind::String)
    geometry.count = count;
  else if (geometry.mesh.empty() && readInteger(*count, 1, 0x7fffffff, "`count`"))
    geometry.count = count;
  else
    throw Error(message::countWithoutPrimitive(), count->place());
}

static void readShape(const JsonValue &value, const std::string &what, SceneDescription &scene,
                      GeometryDescription &geometry) {
  const JsonValue *primitive = value.find("primitive"), *mesh = value.find("mesh");
  if (!primitive == !mesh)
    throw Error(primitive ? message::primitiveAndMesh(what) : message::noPrimitiveOrMesh(what),
                value.place());
  if (primitive)
    geometry.primitive = readObject(*primitive, "`primitive`");
  if (mesh) {
    geometry.mesh = readMeshPaths(*mesh, scene.file, geometry.meshTimes);
    if (const JsonValue *part = value.find("part"))
      readMeshPart(*part, scene, geometry);
    if (const JsonValue *weights = value.find("weights"))
      readWeights(*weights, scene, geometry);
    if (const JsonValue *coordinates = value.find("textureCoordinates")) {
      expect(*coordinates, Kind::String, "`textureCoordinates`");
      if (coordinates->string != "file" && coordinates->string != "barycentric")
        throw Error(message::unknownTextureCoordinates(coordinates->string), coordinates->place());
      geometry.isBarycentric = coordinates->string == "barycentric";
    }
  }
}

GeometryDescription readGeometry(const JsonValue &value, const std::string &what,
                                 SceneDescription &scene, ErrorCollector &errors) {
  errors.attempt([&] {
    checkKeys(value,
              {"name", "primitive", "mesh", "part", "weights", "material", "transform", "mask",
               "id", "count", "textureCoordinates", "backFaces", "variables", "attributes"},
              what);
  });
  GeometryDescription geometry;
  geometry.place = value.place();
  geometry.hasShape = errors.attempt([&] { readShape(value, what, scene, geometry); });
  geometry.hasMaterial = errors.attempt(
      [&] { geometry.material = readReference(require(value, "material", what), "`material`"); });
  errors.attempt([&] {
    if (const JsonValue *name = value.find("name")) {
      expect(*name, Kind::String, "`name`");
      geometry.name = {name->string, name->place()};
    }
    if (const JsonValue *mask = value.find("mask"))
      geometry.mask = readInteger(*mask, 0, 0xffffffff, "`mask`");
    if (const JsonValue *id = value.find("id"))
      geometry.id = readId(*id);
    readCount(value, geometry);
  });
  errors.attempt([&] {
    if (const JsonValue *backFaces = value.find("backFaces"))
      readBackFaces(*backFaces, geometry);
  });
  errors.attempt([&] {
    if (const JsonValue *attributes = value.find("attributes")) {
      geometry.attributes = readAttributes(*attributes);
      if (geometry.mesh.empty())
        throw Error(message::attributesWithoutMesh(), attributes->place());
    }
  });
  return geometry;
}

GeometryDescription readObjectOfList(const JsonValue &value, SceneDescription &scene,
                                     ErrorCollector &errors) {
  expect(value, Kind::Object, "an element of `objects`");
  GeometryDescription geometry = readGeometry(value, "an object", scene, errors);
  InstanceDescription placement;
  placement.mask = geometry.mask;
  placement.hasBackFaces = geometry.hasBackFaces;
  placement.id = geometry.id.value_or(0);
  placement.scope = scene.scopes.front().get();
  errors.attempt([&] {
    if (const JsonValue *variables = value.find("variables"))
      placement.scope = addScope(scene, placement.scope, readVariables(*variables));
  });
  errors.attempt([&] {
    if (const JsonValue *transform = value.find("transform"))
      placement.transform = readTransform(*transform);
    if (!geometry.primitive && !placement.transform.moves())
      geometry.transform = std::exchange(placement.transform, {}).still();
  });
  geometry.placements.push_back(placement);
  return geometry;
}

} // namespace rtsl::scene
