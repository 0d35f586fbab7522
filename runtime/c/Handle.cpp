#include "runtime/c/Handle.h"

#include "support/ErrorMessages.h"

#include <algorithm>
#include <cmath>

namespace runtime = rtsl::runtime;

runtime::Placement RtslScene::takePlacement() {
  runtime::Placement taken = std::exchange(placement, {});
  taken.roots = roots;
  return taken;
}

runtime::Mesh RtslScene::loadMesh(const char *path) const {
  runtime::MeshRequest request = runtime::requestOf(scene.program());
  request.keepsOrder = !attributes.empty();
  return runtime::loadMesh(path, request);
}

void RtslScene::giveAttributes(runtime::Mesh &mesh, const char *name) {
  for (runtime::NamedAttribute &attribute : std::exchange(attributes, {}))
    runtime::addInFileOrder(mesh, std::move(attribute), name);
}

void RtslScene::addMeshInstance(std::uint32_t mesh, RtslObject material) {
  const runtime::Placement placed = takePlacement();
  noteInstance(scene.addMeshInstance(mesh, material, inNode(placed)), placed);
}

namespace rtsl::c {

std::string &lastError() {
  static thread_local std::string message;
  return message;
}

runtime::Value valueOf(const double *numbers, std::size_t count) {
  if (count == 1)
    return runtime::Value(numbers[0]);
  return runtime::Value(std::vector<runtime::Value>(numbers, numbers + count));
}

runtime::Transform transformOf(const double *numbers) {
  runtime::Transform transform;
  for (std::size_t column = 0; column < 4; ++column)
    std::copy_n(numbers + 3 * column, 3, transform.columns[column].begin());
  return transform;
}

runtime::Transform finiteTransform(const double *transform) {
  if (!transform)
    return {};
  if (!std::all_of(transform, transform + 12, [](double x) { return std::isfinite(x); }))
    throw Error(message::transformNotFinite());
  return transformOf(transform);
}

} // namespace rtsl::c
