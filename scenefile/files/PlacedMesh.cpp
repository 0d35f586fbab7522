#include "scenefile/files/PlacedMesh.h"

#include "runtime/geometry/Transform.h"
#include "runtime/scene/InstanceTransform.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rtsl::scene {

using runtime::Mesh;
using runtime::Transform;

namespace {

/// Normals among the attributes get length 1 where they are read, after they have been interpolated
/// and transformed.
template <typename Attributes>
bool hasNormals(const Attributes &attributes) {
  return std::any_of(attributes.begin(), attributes.end(), [](const auto &attribute) {
    return attribute.space == runtime::NamedAttribute::Space::Normal;
  });
}

} // namespace

const Transform *placeOf(const GeometryDescription &geometry, const SceneDescription &scene) {
  if (!scene.placesMeshes || scene.isAnimated || geometry.primitive ||
      !geometry.meshTimes.empty() || !geometry.transform.isIdentity() ||
      geometry.placements.size() != 1)
    return nullptr;
  const InstanceDescription &instance = geometry.placements.front();
  if (instance.inPart || instance.selector != 0 || instance.transform.moves() ||
      hasNormals(geometry.attributes))
    return nullptr;
  const Transform &toWorld = instance.transform.still();
  // A reflection would exchange vertices, by which barycentric coordinates go.
  const bool turnsOver = !(toWorld.determinant() > 0);
  return toWorld.isIdentity() || turnsOver ? nullptr : &toWorld;
}

bool place(Mesh &mesh, const Transform &toWorld) {
  if (hasNormals(mesh.attributes) || !staysAccurate(mesh, toWorld))
    return false;
  mesh.apply(toWorld, Mesh::NormalLengths::Alike);
  return true;
}

bool staysAccurate(const Mesh &mesh, const Transform &toWorld) {
  constexpr double unit = 0x1p-24;                 // of rounding to a float
  constexpr double least = 0x1p-40, most = 0x1p40; // sizes whose powers are far from any limit
  if (!(runtime::invertLinear(toWorld).condition <= runtime::largestCondition))
    return false; // an error, which is that of the instance
  const auto &columns = toWorld.columns;
  std::array<double, 3> largest{}, worst{}; // coordinates of the file; errors in world space
  double reach = 0;
  for (std::size_t i = 0; i + 2 < mesh.positions.size(); i += 3)
    for (std::size_t row = 0; row < 3; ++row) {
      double exact = columns[3][row];
      for (std::size_t column = 0; column < 3; ++column)
        exact += columns[column][row] * double(mesh.positions[i + column]);
      largest[row] = std::max(largest[row], std::fabs(double(mesh.positions[i + row])));
      if (!(std::fabs(exact) <= most))
        return false;
      worst[row] = std::max(worst[row], std::fabs(double(float(exact)) - exact));
      reach = std::max(reach, std::fabs(exact));
    }
  if (reach < least)
    return false;
  for (std::size_t row = 0; row < 3; ++row) {
    double size = 0;
    for (std::size_t column = 0; column < 3; ++column)
      size += std::fabs(columns[column][row]) * largest[column];
    if (!(worst[row] <= 4 * unit * size))
      return false;
  }
  return true;
}

} // namespace rtsl::scene
