#include "runtime/scene/InstanceTransform.h"

#include "runtime/device/ray/Box.h"
#include "runtime/geometry/Transform.h"
#include "support/ErrorMessages.h"

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
  identity.squaredScale = 1;
  return identity;
}

namespace {

/// `what`: "the transform of `ball`".
RtslTransform rounded(const Transform &transform, const std::string &what,
                      const std::optional<Place> &place) {
  RtslTransform result{};
  Transform exact; // of the rounded numbers
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row) {
      const float value = float(transform.columns[column][row]) + 0.0f; // not -0
      if (!std::isfinite(value) || std::fabs(value) > largestSide)
        throw Error(message::matrixOutOfRange(what, row, column, transform.columns[column][row]),
                    place);
      exact.columns[column][row] = double(value);
      (column == 3 ? result.translation[row] : result.linear[3 * column + row]) = value;
    }
  const LinearInverse inverse = invertLinear(exact);
  if (!(inverse.condition <= largestCondition))
    throw Error(std::isinf(inverse.condition)
                    ? message::transformFlattensObject(what)
                    : message::transformNearlyFlattens(what, inverse.condition, largestCondition),
                place);
  for (int column = 0; column < 3; ++column)
    for (int row = 0; row < 3; ++row)
      result.inverse[3 * column + row] = inverse.columns[column][row];
  return result;
}

/// The same of a transform with a squaredScale: the inverse is that of the numbers as given.
RtslTransform similar(const Transform &transform, double squaredScale, const std::string &what,
                      const std::optional<Place> &place) {
  RtslTransform result = rounded(transform, what, place);
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      result.inverse[3 * column + row] = transform.columns[row][column] / squaredScale;
  result.squaredScale = squaredScale;
  return result;
}

/// `still`: the transform, or at time 0.
RtslTransform stored(const MovingTransform &transform, const Transform &still,
                     const std::string &what, const std::optional<Place> &place) {
  const double square = squaredScale(transform);
  if (square == 1 || (square > 0 && !isScale(transform)))
    return similar(still, square, what, place);
  RtslTransform result = rounded(still, what, place);
  result.squaredScale = -square; // programs of scales alone read the floats
  return result;
}

} // namespace

RtslTransform roundedTransform(const MovingTransform &transform, const std::string &name,
                               const std::optional<Place> &place) {
  const std::string what = fmt::format("the transform of `{}`", name);
  if (!transform.moves())
    return stored(transform, transform.still(), what, place);
  for (const double time : timesToCheck(transform))
    rounded(transform.at(time), fmt::format("{} at time {:.3g}", what, time), place);
  return stored(transform, transform.at(0), what, place);
}

void setWorldBounds(RtslInstance &instance, const Bounds &bounds) {
  for (int i = 0; i < 3; ++i) {
    instance.lower[i] = device::outwards(bounds.lower[i], -1);
    instance.upper[i] = device::outwards(bounds.upper[i], 1);
  }
}

void setWorldBounds(RtslInstance &instance, const Bounds &bounds, const MovingTransform &transform,
                    float begin, float end) {
  MovingTransform map = transform;
  if (!map.moves()) { // as it is stored
    Transform still = map.still();
    for (auto &column : still.columns)
      for (double &x : column)
        x = double(float(x));
    map = still;
  }
  const SweptBox swept = sweptBox(map, bounds.lower, bounds.upper, begin, end);
  for (std::size_t i = 0; i < 3; ++i) {
    // A moving map is rounded to floats, and the ray that is tested inside is rounded once more
    // than the one that meets this box.
    const double margin = swept.size[i] * 0x1p-19 + double(std::numeric_limits<float>::min());
    const auto side = [](double x) {
      return float(std::clamp(x, -double(largestSide), double(largestSide)));
    };
    instance.lower[i] = side(swept.lower[i] - margin);
    instance.upper[i] = side(swept.upper[i] + margin);
  }
}

Bounds boundsOf(const Mesh &mesh) {
  constexpr float inf = std::numeric_limits<float>::infinity();
  Bounds bounds{{inf, inf, inf}, {-inf, -inf, -inf}};
  for (std::size_t key = 0; key < mesh.keyCount(); ++key)
    for (std::uint32_t index : mesh.indices)
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t vertex = key * mesh.vertexCount() + index;
        const float x = mesh.positions[3 * vertex + std::size_t(axis)];
        bounds.lower[axis] = std::min(bounds.lower[axis], x);
        bounds.upper[axis] = std::max(bounds.upper[axis], x);
      }
  return bounds;
}

} // namespace rtsl::runtime
