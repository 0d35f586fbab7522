#include "scenefile/TransformReader.h"

#include "scenefile/Reader.h"

#include <fmt/format.h>

namespace rtsl::scene {

using runtime::Transform;

namespace {

Transform readScale(const JsonValue &value) {
  if (value.kind == JsonValue::Kind::Number) {
    double s = readNumber(value, "`scale`");
    return Transform::scale(s, s, s);
  }
  std::vector<double> s = readNumbers(value, 3, "`scale`");
  return Transform::scale(s[0], s[1], s[2]);
}

/// {"axis": [x, y, z], "angle": degrees}, or degrees about x, then y, then z.
Transform readRotation(const JsonValue &value) {
  if (value.kind == JsonValue::Kind::Array) {
    std::vector<double> angles = readNumbers(value, 3, "`rotate`");
    return Transform::rotate({1, 0, 0}, angles[0])
        .then(Transform::rotate({0, 1, 0}, angles[1]))
        .then(Transform::rotate({0, 0, 1}, angles[2]));
  }
  expect(value, JsonValue::Kind::Object, "`rotate`");
  checkKeys(value, {"axis", "angle"}, "`rotate`");
  const JsonValue &axisValue = require(value, "axis", "`rotate`");
  std::vector<double> axis = readNumbers(axisValue, 3, "`axis`");
  if (axis[0] == 0 && axis[1] == 0 && axis[2] == 0)
    throw Error(ErrorCode::OutOfRange, "the axis of a rotation has no direction",
                axisValue.place());
  return Transform::rotate({axis[0], axis[1], axis[2]},
                           readNumber(require(value, "angle", "`rotate`"), "`angle`"));
}

Transform readMatrix(const JsonValue &value) {
  std::vector<double> m = readNumbers(value, 16, "`matrix`");
  if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
    throw Error(ErrorCode::OutOfRange, "the last row of `matrix` is not 0 0 0 1", value.place())
        .note("a matrix is given by its columns: the translation is in the numbers 13 to 15");
  Transform transform;
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 3; ++row)
      transform.columns[column][row] = m[std::size_t(4 * column + row)];
  return transform;
}

} // namespace

Transform readTransform(const JsonValue &value) {
  Transform transform;
  if (value.kind == JsonValue::Kind::Array) {
    for (const JsonValue &element : value.elements)
      transform = transform.then(readTransform(element));
    return transform;
  }
  expect(value, JsonValue::Kind::Object, "`transform`");
  checkKeys(value, {"translate", "rotate", "scale", "matrix"}, "`transform`");
  if (const JsonValue *matrix = value.find("matrix")) {
    if (value.members.size() > 1)
      throw Error(ErrorCode::WrongType,
                  "`matrix` cannot be combined with other keys; use a list of transforms",
                  value.place());
    transform = readMatrix(*matrix);
  }
  if (const JsonValue *scale = value.find("scale"))
    transform = transform.then(readScale(*scale));
  if (const JsonValue *rotate = value.find("rotate"))
    transform = transform.then(readRotation(*rotate));
  if (const JsonValue *translate = value.find("translate")) {
    std::vector<double> t = readNumbers(*translate, 3, "`translate`");
    transform = transform.then(Transform::translate(t[0], t[1], t[2]));
  }
  if (transform.determinant() == 0)
    throw Error(ErrorCode::OutOfRange, "this transform flattens what it is applied to",
                value.place());
  return transform;
}

} // namespace rtsl::scene
