#include "runtime/c/Handle.h"

#include "support/ErrorMessages.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace runtime = rtsl::runtime;

runtime::Placement RtslScene::takePlacement() {
  runtime::Placement taken = std::exchange(placement, {});
  taken.roots = roots;
  return taken;
}

runtime::MeshRequest RtslScene::meshRequest() const {
  runtime::MeshRequest request = runtime::requestOf(scene.program());
  request.keepsOrder = !attributes.empty();
  return request;
}

runtime::Mesh RtslScene::loadMesh(const char *path) const {
  runtime::Mesh mesh = runtime::loadMesh(path, meshRequest());
  setTextureCoordinates(mesh);
  return mesh;
}

void RtslScene::setTextureCoordinates(runtime::Mesh &mesh) const {
  if (areBarycentric)
    mesh.uvs.clear();
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

void requireAll(std::initializer_list<Needed> needed) {
  for (const Needed &one : needed)
    if (!one.pointer && one.count != 0)
      throw Error(message::argumentIsNull(one.name));
}

void requireChoice(unsigned number, unsigned count, const char *what) {
  if (number >= count)
    throw Error(message::noChoiceNumbered(what, number));
}

runtime::Value valueOf(const double *numbers, std::size_t count) {
  if (count == 1)
    return runtime::Value(numbers[0]);
  return runtime::Value(std::vector<runtime::Value>(numbers, numbers + count));
}

std::vector<float> keyTimes(const char *what, const float *first, std::uint32_t count,
                            std::size_t stride) {
  if (count < 2)
    throw Error(message::tooFewKeys(what));
  std::vector<float> times;
  for (std::uint32_t i = 0; i < count; ++i) {
    float time;
    std::memcpy(&time, reinterpret_cast<const char *>(first) + i * stride, sizeof time);
    if (!(time >= 0 && time <= 1) || (i > 0 && !(time > times.back())))
      throw Error(message::keyTimesNotAscending());
    times.push_back(time);
  }
  return times;
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
