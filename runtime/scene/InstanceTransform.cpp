#include "runtime/scene/InstanceTransform.h"

#include "runtime/device/ray/Box.h"
#include "runtime/geometry/Transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::runtime {

namespace {

using device::largestSide;

} // namespace

RtslTransform identityTransform() {
  RtslTransform identity{};
  for (int i = 0; i < 3; ++i)
    identity.linear[4 * i] = 1, identity.inverse[4 * i] = 1;
  return identity;
}

RtslTransform roundedTransform(const Transform &transform, const std::string &name,
                               const std::optional<Place> &place) {
  RtslTransform result{};
  Transform rounded;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) {
      const float value = float(transform.columns[column][row]);
      if (!std::isfinite(value) || std::fabs(value) > largestSide)
        throw Error(ErrorCode::DegenerateGeometry,
                    fmt::format("the transform of `{}` is out of range: row {} of column {} is {}",
                                name, row, column, transform.columns[column][row]),
                    place);
      rounded.columns[column][row] = double(value);
      (column == 3 ? result.translation[row] : result.linear[3 * column + row]) = value;
    }
  const LinearInverse inverse = invertLinear(rounded);
  if (!(inverse.condition <= largestCondition))
    throw Error(ErrorCode::DegenerateGeometry,
                std::isinf(inverse.condition)
                    ? fmt::format("the transform of `{}` flattens it", name)
                    : fmt::format("the transform of `{}` nearly flattens it: its condition number "
                                  "is {:.2g}, more than {:g}",
                                  name, inverse.condition, largestCondition),
                place);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      result.inverse[3 * column + row] = inverse.columns[column][row];
  return result;
}

void setWorldBounds(RtslInstance &instance, const Bounds &bounds, const RtslTransform &transform) {
  if (instance.transform == 0) {
    for (int i = 0; i < 3; ++i) {
      instance.lower[i] = device::outwards(bounds.lower[i], -1);
      instance.upper[i] = device::outwards(bounds.upper[i], 1);
    }
    return;
  }
  for (int row = 0; row < 3; ++row) {
    double lower = transform.translation[row], upper = lower, size = std::fabs(lower);
    for (int column = 0; column < 3; ++column) {
      const double factor = transform.linear[3 * column + row];
      if (factor == 0)
        continue; // 0 times an infinite side
      const double a = factor * double(bounds.lower[column]),
                   b = factor * double(bounds.upper[column]);
      lower += std::min(a, b);
      upper += std::max(a, b);
      size += std::max(std::fabs(a), std::fabs(b));
    }
    // The ray that is tested inside is rounded to floats once more than the one that meets this
    // box.
    const double margin = size * 0x1p-19 + double(std::numeric_limits<float>::min());
    const auto side = [](double x) {
      return float(std::clamp(x, -double(largestSide), double(largestSide)));
    };
    instance.lower[row] = side(lower - margin);
    instance.upper[row] = side(upper + margin);
  }
}

Bounds boundsOf(const Mesh &mesh) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Bounds bounds{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (std::uint32_t index : mesh.indices)
    for (int axis = 0; axis < 3; ++axis) {
      const float x = mesh.positions[3 * std::size_t(index) + std::size_t(axis)];
      bounds.lower[axis] = std::min(bounds.lower[axis], x);
      bounds.upper[axis] = std::max(bounds.upper[axis], x);
    }
  return bounds;
}

} // namespace rtsl::runtime
