#include "scenefile/graph/TransformReader.h"

#include "scenefile/graph/KeyTimes.h"
#include "scenefile/json/KeyFrames.h"
#include "scenefile/json/Reader.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <optional>
#include <vector>

namespace rtsl::scene {

using runtime::MotionFactor;
using runtime::MovingTransform;
using runtime::Quaternion;
using runtime::Transform;

namespace {

using Vector = std::array<double, 3>;

Vector readVector(const JsonValue &value, const std::string &what) {
  const std::vector<double> numbers = readNumbers(value, 3, what);
  return {numbers[0], numbers[1], numbers[2]};
}

/// A rotation, as a map, as an orientation, and about its axis if it was given by one.
struct Rotation {
  Transform map;
  Quaternion orientation{1, 0, 0, 0};
  std::optional<Vector> axis; // of length 1
  double degrees = 0;
};

Rotation aboutAxis(const Vector &axis, double degrees) {
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  return {Transform::rotate(axis, degrees), runtime::axisRotation(axis, degrees),
          Vector{axis[0] / length, axis[1] / length, axis[2] / length}, degrees};
}

/// Degrees about x, then y, then z.
Rotation readAngles(const JsonValue &value) {
  const Vector angles = readVector(value, "`rotate`");
  Rotation result;
  int turns = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    Vector axis{0, 0, 0};
    axis[i] = 1;
    const Rotation one = aboutAxis(axis, angles[i]);
    result.map = result.map.then(one.map);
    result.orientation = runtime::product(one.orientation, result.orientation);
    if (angles[i] != 0) {
      ++turns;
      result.axis = axis;
      result.degrees = angles[i];
    }
  }
  if (turns > 1)
    result.axis.reset();
  return result;
}

/// (x, y, z, w), of any length but zero.
Rotation readQuaternion(const JsonValue &value) {
  const std::vector<double> q = readNumbers(value, 4, "`quaternion`");
  const double length = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  if (length == 0)
    throw aboutKeyFrames(Error(message::zeroQuaternion(), value.place()), value);
  Rotation result;
  result.orientation = {q[3] / length, q[0] / length, q[1] / length, q[2] / length};
  result.map = runtime::rotationOf(result.orientation);
  return result;
}

/// {"axis": [x, y, z], "angle": degrees}, {"quaternion": [x, y, z, w]}, or angles.
Rotation readRotation(const JsonValue &value) {
  if (value.kind == JsonValue::Kind::Array)
    return readAngles(value);
  expect(value, JsonValue::Kind::Object, "`rotate`");
  if (const JsonValue *quaternion = value.find("quaternion")) {
    checkKeys(value, {"quaternion"}, "`rotate` with a quaternion");
    return readQuaternion(*quaternion);
  }
  checkKeys(value, {"axis", "angle", "quaternion"}, "`rotate`");
  const JsonValue &axisValue = require(value, "axis", "`rotate`");
  const Vector axis = readVector(axisValue, "`axis`");
  if (axis == Vector{0, 0, 0})
    throw Error(message::axisZero(), axisValue.place());
  return aboutAxis(axis, readNumber(require(value, "angle", "`rotate`"), "`angle`"));
}

Transform readScale(const JsonValue &value) {
  if (value.kind == JsonValue::Kind::Number) {
    const double s = readNumber(value, "`scale`");
    return Transform::scale(s, s, s);
  }
  const Vector s = readVector(value, "`scale`");
  return Transform::scale(s[0], s[1], s[2]);
}

Transform readMatrix(const JsonValue &value) {
  std::vector<double> m = readNumbers(value, 16, "`matrix`");
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    throw Error(message::matrixNotAffine(), value.place())
        .note("a matrix is given by its columns: the translation is in the numbers 13 to 15");
  Transform transform;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      transform.columns[column][row] = m[std::size_t(4 * column + row)];
  return transform;
}

/// An object with scale, rotate and translate, or with a matrix.
struct Parts {
  std::optional<Transform> matrix;
  Transform scale;
  Rotation rotation;
  Transform translation;

  Transform product() const {
    return matrix ? *matrix : scale.then(rotation.map).then(translation);
  }
};

Parts readParts(const JsonValue &value) {
  Parts parts;
  if (const JsonValue *matrix = value.find("matrix")) {
    if (value.members.size() > 1)
      throw Error(message::matrixWithOtherKeys(), value.place());
    parts.matrix = readMatrix(*matrix);
  }
  if (const JsonValue *scale = value.find("scale"))
    parts.scale = readScale(*scale);
  if (const JsonValue *rotate = value.find("rotate"))
    parts.rotation = readRotation(*rotate);
  if (const JsonValue *translate = value.find("translate")) {
    const Vector t = readVector(*translate, "`translate`");
    parts.translation = Transform::translate(t[0], t[1], t[2]);
  }
  if (parts.product().determinant() == 0)
    throw aboutKeyFrames(Error(message::transformFlattens(), value.place()), value);
  return parts;
}

//===----------------------------------------------------------------------===//
// Keys
//===----------------------------------------------------------------------===//

/// The factor with these maps at the keys; a constant if they are all the same.
template <typename MapOf>
MovingTransform interpolated(const std::vector<Parts> &keys, const std::vector<float> &times,
                             MapOf mapOf) {
  MotionFactor factor;
  factor.times = times;
  bool moves = false;
  for (const Parts &key : keys) {
    factor.maps.push_back(mapOf(key));
    moves |= factor.maps.back().columns != factor.maps.front().columns;
  }
  return moves ? MovingTransform(std::move(factor)) : MovingTransform(factor.maps.front());
}

/// The axis of all rotations that turn; none if there are several.
std::optional<Vector> commonAxis(const std::vector<Parts> &keys) {
  std::optional<Vector> axis;
  for (const Parts &key : keys) {
    const Rotation &rotation = key.rotation;
    const bool turns = rotation.orientation != Quaternion{1, 0, 0, 0};
    if (!turns && !rotation.axis)
      continue; // no rotation is one by 0 degrees about any axis
    if (!rotation.axis || (axis && *axis != *rotation.axis))
      return std::nullopt;
    axis = rotation.axis;
  }
  return axis;
}

MovingTransform turning(const std::vector<Parts> &keys, const std::vector<float> &times) {
  const std::optional<Vector> axis = commonAxis(keys);
  MotionFactor factor;
  factor.times = times;
  bool moves = false;
  for (std::size_t i = 0; i + 1 < keys.size(); ++i) {
    const Rotation &from = keys[i].rotation, &to = keys[i + 1].rotation;
    factor.turns.push_back(axis ? runtime::turnAbout(*axis, from.degrees, to.degrees)
                                : runtime::turnBetween(from.orientation, to.orientation));
    moves |= factor.turns.back().angle != 0;
  }
  return moves ? MovingTransform(std::move(factor)) : MovingTransform(keys[0].rotation.map);
}

MovingTransform readKeys(const JsonValue &value) {
  checkKeys(value, {"keys", "times"}, "a transform with keys");
  const std::vector<float> times = readKeyTimes(value, "a transform");
  std::vector<Parts> keys;
  for (const JsonValue &element : value.find("keys")->elements) {
    if (element.kind == JsonValue::Kind::Array || element.find("keys"))
      throw Error(message::keyIsList(), element.place())
          .note("a list of transforms may have one with keys among others");
    expect(element, JsonValue::Kind::Object, "a key");
    checkKeys(element, {"translate", "rotate", "scale", "matrix"}, "a key");
    keys.push_back(readParts(element));
    if (keys.back().matrix.has_value() != keys.front().matrix.has_value())
      throw Error(message::mixedKeys(), element.place());
  }
  if (keys.front().matrix)
    return interpolated(keys, times, [](const Parts &key) { return *key.matrix; });
  return interpolated(keys, times, [](const Parts &key) { return key.scale; })
      .then(turning(keys, times))
      .then(interpolated(keys, times, [](const Parts &key) { return key.translation; }));
}

} // namespace

MovingTransform readTransform(const JsonValue &value) {
  if (value.kind == JsonValue::Kind::Array) {
    MovingTransform transform;
    for (const JsonValue &element : value.elements)
      transform = transform.then(readTransform(element));
    return transform;
  }
  expect(value, JsonValue::Kind::Object, "`transform`");
  if (value.find("keys"))
    return readKeys(value);
  checkKeys(value, {"translate", "rotate", "scale", "matrix", "keys"}, "`transform`");
  return readParts(value).product();
}

} // namespace rtsl::scene
