#include "runtime/scene/Geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::runtime {

namespace {

/// A few units in the last place outwards, for the author's sums are rounded; and into the range in
/// which boxes can be multiplied with each other. An infinite primitive stays in the largest box
/// there is.
float outwards(float side, float direction) {
  constexpr float largest = 1e18f;
  float moved = side + direction * (std::fabs(side) * 0x1p-21f + std::numeric_limits<float>::min());
  return std::clamp(moved, -largest, largest);
}

/// The result of the primitive's `computeBounds`; NaN for sides that it does not set.
Bounds computeBounds(const Objects &objects, RtslRef primitive, const RtslLaunch &launch) {
  Bounds given;
  callOutsideOfRays(launch, primitive, [&](RtslState &state) {
    for (int i = 0; i < 3; ++i) { // what computeBounds leaves out shows
      state.BoundMin[i] = std::numeric_limits<float>::quiet_NaN();
      state.BoundMax[i] = std::numeric_limits<float>::quiet_NaN();
    }
    if (objects.program().slots.rt_Primitive_computeBounds)
      objects.program().slots.rt_Primitive_computeBounds(&state, primitive);
    std::copy_n(state.BoundMin, 3, given.lower);
    std::copy_n(state.BoundMax, 3, given.upper);
  });
  return given;
}

/// Throws DegenerateGeometry for NaN or inverted bounds; warns if the box has no area.
void checkBounds(const Bounds &given, const Objects::Object &info, std::vector<Warning> &warnings) {
  const char axes[] = "xyz";
  int flatSides = 0;
  for (int i = 0; i < 3; ++i) {
    if (std::isnan(given.lower[i]) || std::isnan(given.upper[i]))
      throw Error(
          ErrorCode::DegenerateGeometry,
          fmt::format("the bounds of primitive `{}` are not numbers (in {})", info.name, axes[i]),
          info.place);
    if (given.lower[i] > given.upper[i])
      throw Error(ErrorCode::DegenerateGeometry,
                  fmt::format("the bounds of primitive `{}` are inverted: {} runs from {} to {}",
                              info.name, axes[i], given.lower[i], given.upper[i]),
                  info.place);
    flatSides += given.lower[i] == given.upper[i];
  }
  if (flatSides >= 2)
    warnings.push_back({fmt::format("primitive `{}` is {}: no ray can hit it", info.name,
                                    flatSides == 3 ? "a single point" : "a line without width"),
                        info.place});
}

} // namespace

std::uint32_t Geometry::addInstance(const Objects &objects, RtslRef primitive, std::uint32_t mesh,
                                    RtslRef material, std::string name, std::uint32_t primitives,
                                    std::uint32_t mask) {
  objects.requireRole(material, "rt_Material", ifClassic(objects.program(), "shade"));
  if (primitiveTotal + primitives > 0x7fffffffu)
    throw Error(ErrorCode::OutOfMemory, "the scene has more than 2^31 primitives");
  instances.push_back({primitive,
                       material,
                       mesh,
                       std::uint32_t(primitiveTotal),
                       objects.needsOf(material),
                       mask,
                       objects.at(material).classInfo->anyHit,
                       {},
                       {},
                       {},
                       {}});
  primitiveTotal += primitives;
  instanceNames.push_back(std::move(name));
  return std::uint32_t(instances.size() - 1);
}

std::uint32_t Geometry::addPrimitive(const Objects &objects, RtslRef primitive, RtslRef material,
                                     std::uint32_t mask, const std::function<RtslLaunch()> &launch,
                                     std::vector<Warning> &warnings) {
  objects.requireRole(primitive, "rt_Primitive", {"intersect", "computeBounds"});
  const Objects::Object &info = objects.at(primitive);
  const Bounds given = computeBounds(objects, primitive, launch());
  checkBounds(given, info, warnings);
  std::uint32_t instance = addInstance(objects, primitive, 0, material, info.name, 1, mask);
  RtslInstance &added = instances.back();
  std::copy_n(given.lower, 3, added.boundMin);
  std::copy_n(given.upper, 3, added.boundMax);
  for (int i = 0; i < 3; ++i) {
    added.lower[i] = outwards(given.lower[i], -1);
    added.upper[i] = outwards(given.upper[i], 1);
  }
  return instance;
}

std::uint32_t Geometry::addMesh(Mesh mesh, const std::string &name) {
  std::string shown = name.empty() ? fmt::format("mesh {}", meshes.size()) : name;
  validateMesh(mesh, shown);
  auto storage = std::make_unique<NamedMesh>(NamedMesh{std::move(mesh), std::move(shown)});
  Mesh &kept = storage->mesh;
  RtslMesh table{};
  table.positions = kept.positions.data();
  table.normals = kept.normals.empty() ? nullptr : kept.normals.data();
  table.uvs = kept.uvs.empty() ? nullptr : kept.uvs.data();
  table.indices = kept.indices.data();
  table.vertexCount = std::uint32_t(kept.vertexCount());
  table.triangleCount = std::uint32_t(kept.triangleCount());
  meshTable.push_back(table);
  meshes.push_back(std::move(storage));
  return std::uint32_t(meshes.size() - 1);
}

std::uint32_t Geometry::addMeshInstance(const Objects &objects, std::uint32_t mesh,
                                        RtslRef material, std::uint32_t mask) {
  if (mesh >= meshes.size())
    throw Error(ErrorCode::UnknownName, fmt::format("the scene has no mesh number {}", mesh));
  return addInstance(objects, 0, mesh, material, meshes[mesh]->name, meshTable[mesh].triangleCount,
                     mask);
}

void Geometry::useProgram(const Objects &objects) {
  for (RtslInstance &instance : instances)
    instance.needs = objects.needsOf(instance.material);
  dropUnusedAttributes(objects.program());
}

void Geometry::dropUnusedAttributes(const Program &program) {
  attributes.clear();
  std::vector<std::uint32_t> needs(meshes.size(), 0);
  for (const RtslInstance &instance : instances)
    if (instance.primitive == 0)
      needs[instance.mesh] |= instance.needs;
  const auto look = [&](std::size_t i, const char *name, std::uint32_t need,
                        std::vector<float> &values, const float *&inTable) {
    if (values.empty())
      return;
    bool isNeeded = (needs[i] & need) != 0;
    attributes.push_back({meshes[i]->name, name, values.size() * sizeof(float), isNeeded});
    if (isNeeded || program.keepsMeshes)
      return;
    values = {};
    inTable = nullptr;
  };
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    Mesh &mesh = meshes[i]->mesh;
    look(i, "normals", RTSL_NEEDS_NORMALS, mesh.normals, meshTable[i].normals);
    look(i, "texture coordinates", RTSL_NEEDS_TEXTURE_COORDINATES | RTSL_NEEDS_DERIVATIVES,
         mesh.uvs, meshTable[i].uvs);
  }
}

Bounds Geometry::bounds(std::uint32_t instance) const {
  const RtslInstance &one = instances.at(instance);
  Bounds bounds;
  std::copy_n(one.lower, 3, bounds.lower);
  std::copy_n(one.upper, 3, bounds.upper);
  return bounds;
}

std::uint32_t Geometry::primitiveCount(std::uint32_t instance) const {
  const RtslInstance &one = instances.at(instance);
  return one.primitive ? 1 : meshTable[one.mesh].triangleCount;
}

void Geometry::fill(RtslLaunch &launch) const {
  launch.instances = instances.data();
  launch.meshes = meshTable.data();
  launch.instanceCount = std::uint32_t(instances.size());
  launch.meshCount = std::uint32_t(meshTable.size());
}

} // namespace rtsl::runtime
