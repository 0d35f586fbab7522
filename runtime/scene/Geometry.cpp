#include "runtime/scene/Geometry.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::runtime {

namespace {

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

RtslInstance Geometry::place(const Placement &placement, const std::string &name,
                             const std::optional<rtsl::Place> &where) {
  RtslInstance instance{};
  instance.mask = placement.mask;
  instance.roots = placement.roots;
  if (!placement.transform.isIdentity()) {
    const RtslTransform transform = roundedTransform(placement.transform, name, where);
    instance.transform = std::uint32_t(transforms.size());
    transforms.push_back(transform);
  }
  return instance;
}

std::uint32_t Geometry::addInstance(const Objects &objects, const RtslInstance &instance,
                                    std::string name, std::uint32_t items) {
  objects.requireRole(instance.material, "rt_Material", ifClassic(objects.program(), "shade"));
  if (treeItems + items > 0x7fffffffu)
    throw Error(ErrorCode::OutOfMemory, "the scene has more than 2^31 primitives");
  instances.push_back(instance);
  RtslInstance &added = instances.back();
  added.needs = objects.needsOf(instance.material);
  added.anyHit = objects.at(instance.material).classInfo->anyHit;
  treeItems += items;
  instanceNames.push_back(std::move(name));
  needs |= (instance.transform != 0 ? RTSL_HAS_TRANSFORMS : 0) |
           (instance.roots != 1 ? RTSL_HAS_ROOTS : 0);
  return std::uint32_t(instances.size() - 1);
}

std::uint32_t Geometry::addPrimitive(const Objects &objects, RtslRef primitive, RtslRef material,
                                     const Placement &placement,
                                     const std::function<RtslLaunch()> &launch,
                                     std::vector<Warning> &warnings) {
  objects.requireRole(primitive, "rt_Primitive", {"intersect", "computeBounds"});
  const Objects::Object &info = objects.at(primitive);
  const Bounds given = computeBounds(objects, primitive, launch());
  checkBounds(given, info, warnings);
  RtslInstance instance = place(placement, info.name, info.place);
  instance.primitive = primitive;
  instance.material = material;
  std::copy_n(given.lower, 3, instance.boundMin);
  std::copy_n(given.upper, 3, instance.boundMax);
  setWorldBounds(instance, given, transforms[instance.transform]);
  return addInstance(objects, instance, info.name, 1);
}

std::uint32_t Geometry::addMesh(Mesh mesh, const std::string &name) {
  std::string shown = name.empty() ? fmt::format("mesh {}", meshes.size()) : name;
  validateMesh(mesh, shown);
  auto storage = std::make_unique<NamedMesh>(NamedMesh{std::move(mesh), std::move(shown), {}});
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

const Bounds &Geometry::meshBounds(std::uint32_t mesh) {
  NamedMesh &named = *meshes[mesh];
  if (!named.bounds)
    named.bounds = boundsOf(named.mesh);
  return *named.bounds;
}

std::uint32_t Geometry::addMeshInstance(const Objects &objects, std::uint32_t mesh,
                                        RtslRef material, const Placement &placement) {
  if (mesh >= meshes.size())
    throw Error(ErrorCode::UnknownName, fmt::format("the scene has no mesh number {}", mesh));
  RtslInstance instance = place(placement, meshes[mesh]->name, std::nullopt);
  instance.material = material;
  instance.mesh = mesh;
  if (instance.transform != 0)
    setWorldBounds(instance, meshBounds(mesh), transforms[instance.transform]);
  return addInstance(objects, instance, meshes[mesh]->name,
                     instance.transform != 0 ? 1 : meshTable[mesh].triangleCount);
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
  launch.transforms = transforms.data();
  launch.instanceCount = std::uint32_t(instances.size());
  launch.meshCount = std::uint32_t(meshTable.size());
  launch.transformCount = std::uint32_t(transforms.size());
  launch.needs |= needs;
}

} // namespace rtsl::runtime
