#include "runtime/geometry/Motion.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace rtsl::runtime {

namespace {

constexpr double radiansPerDegree = 3.14159265358979323846 / 180;

double dot(const Quaternion &a, const Quaternion &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
}

Quaternion normalized(const Quaternion &q) {
  const double length = std::sqrt(dot(q, q));
  return {q[0] / length, q[1] / length, q[2] / length, q[3] / length};
}

/// The key before a time, and the share of the way to the next: as findKey in
/// runtime/device/traverse/Motion.h.
std::pair<std::size_t, double> keyAt(const std::vector<float> &times, double time) {
  std::size_t key = 0;
  while (key + 2 < times.size() && double(times[key + 1]) <= time)
    ++key;
  const double begin = times[key], end = times[key + 1];
  return {key, std::clamp((time - begin) / (end - begin), 0.0, 1.0)};
}

Transform interpolated(const Transform &a, const Transform &b, double share) {
  Transform result;
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      result.columns[column][row] =
          (1 - share) * a.columns[column][row] + share * b.columns[column][row];
  return result;
}

MotionFactor constant(const Transform &map) {
  return {{0.0f}, {map}, {}};
}
bool isConstant(const MotionFactor &factor) {
  return factor.times.size() == 1;
}

/// First `a`, then `b`: one factor, if one of them is constant and the other is not a rotation.
/// Interpolation of numbers and products with a constant may be exchanged.
bool merge(MotionFactor &a, const MotionFactor &b) {
  if (a.isRotation() || b.isRotation() || !(isConstant(a) || isConstant(b)))
    return false;
  MotionFactor merged;
  merged.times = isConstant(a) ? b.times : a.times;
  for (std::size_t i = 0; i < merged.times.size(); ++i)
    merged.maps.push_back(a.maps[isConstant(a) ? 0 : i].then(b.maps[isConstant(b) ? 0 : i]));
  a = std::move(merged);
  return true;
}

auto orderOf(const Turn &turn) {
  return std::tie(turn.from, turn.across, turn.angle);
}

template <typename Element, typename OrderOf>
int compare(const std::vector<Element> &a, const std::vector<Element> &b, OrderOf orderOf) {
  if (a.size() != b.size())
    return a.size() < b.size() ? -1 : 1;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (orderOf(a[i]) != orderOf(b[i]))
      return orderOf(a[i]) < orderOf(b[i]) ? -1 : 1;
  return 0;
}

int compare(const MotionFactor &a, const MotionFactor &b) {
  if (const int times = compare(a.times, b.times, [](float time) { return time; }))
    return times;
  if (const int maps =
          compare(a.maps, b.maps, [](const Transform &map) { return std::tie(map.columns); }))
    return maps;
  return compare(a.turns, b.turns, [](const Turn &turn) { return orderOf(turn); });
}

int compare(const MovingTransform &a, const MovingTransform &b) {
  if (a.factors().size() != b.factors().size())
    return a.factors().size() < b.factors().size() ? -1 : 1;
  for (std::size_t i = 0; i < a.factors().size(); ++i)
    if (const int result = compare(a.factors()[i], b.factors()[i]))
      return result;
  if (a.still().columns != b.still().columns)
    return a.still().columns < b.still().columns ? -1 : 1;
  return 0;
}

//===----------------------------------------------------------------------===//
// Bounds
//===----------------------------------------------------------------------===//

/// Bounds of the lengths of a vector or matrix and of its derivatives by time, during an interval.
struct Speeds {
  double value = 0, first = 0, second = 0;
};

double norm(const std::array<double, 3> &v) {
  return std::hypot(v[0], v[1], v[2]);
}
/// The Frobenius norm of the linear part, which is not below the largest stretch.
double normOfLinear(const Transform &map) {
  return std::hypot(norm(map.columns[0]), norm(map.columns[1]), norm(map.columns[2]));
}

/// The bounds for the linear part and for the translation of a factor, between two of its keys.
std::pair<Speeds, Speeds> speedsOf(const MotionFactor &factor, double middle) {
  if (isConstant(factor))
    return {{normOfLinear(factor.maps[0]), 0, 0}, {norm(factor.maps[0].columns[3]), 0, 0}};
  const std::size_t key = keyAt(factor.times, middle).first;
  const double begin = factor.times[key], end = factor.times[key + 1];
  const bool rests = !(middle > begin && middle < end);
  const double duration = end - begin;
  if (factor.isRotation()) {
    const double speed = rests ? 0 : 2 * std::fabs(factor.turns[key].angle) / duration;
    return {{1, speed, speed * speed}, {}};
  }
  const Transform &a = factor.maps[key], &b = factor.maps[key + 1];
  Transform change;
  for (std::size_t column = 0; column < 4; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      change.columns[column][row] =
          rests ? 0 : (b.columns[column][row] - a.columns[column][row]) / duration;
  return {{std::max(normOfLinear(a), normOfLinear(b)), normOfLinear(change), 0},
          {std::max(norm(a.columns[3]), norm(b.columns[3])), norm(change.columns[3]), 0}};
}

/// The bounds for L v + t, by the product rule.
Speeds mapped(const std::pair<Speeds, Speeds> &factor, const Speeds &v) {
  const auto &[linear, translation] = factor;
  return {linear.value * v.value + translation.value,
          linear.first * v.value + linear.value * v.first + translation.first,
          linear.second * v.value + 2 * linear.first * v.first + linear.value * v.second +
              translation.second};
}

/// The bounds for the points within `radius` of the origin, between two neighbouring key times.
Speeds speedsOf(const MovingTransform &map, double radius, double middle) {
  Speeds speeds{radius, 0, 0};
  for (const MotionFactor &factor : map.factors())
    speeds = mapped(speedsOf(factor, middle), speeds);
  return speeds;
}

/// Extends `swept` by the box at one time, enlarged by `margin`.
void addBox(SweptBox &swept, const Transform &map, const float lower[3], const float upper[3],
            double margin) {
  for (std::size_t row = 0; row < 3; ++row) {
    double low = map.columns[3][row], high = low, size = std::fabs(low);
    for (std::size_t column = 0; column < 3; ++column) {
      const double factor = map.columns[column][row];
      if (factor == 0)
        continue; // 0 times an infinite side
      const double a = factor * double(lower[column]), b = factor * double(upper[column]);
      low += std::min(a, b);
      high += std::max(a, b);
      size += std::max(std::fabs(a), std::fabs(b));
    }
    swept.lower[row] = std::min(swept.lower[row], low - margin);
    swept.upper[row] = std::max(swept.upper[row], high + margin);
    swept.size[row] = std::max(swept.size[row], size);
  }
}

} // namespace

//===----------------------------------------------------------------------===//
// Rotations
//===----------------------------------------------------------------------===//

Quaternion axisRotation(const std::array<double, 3> &axis, double degrees) {
  const double length = norm(axis), half = 0.5 * degrees * radiansPerDegree;
  const double s = std::sin(half) / length;
  return {std::cos(half), s * axis[0], s * axis[1], s * axis[2]};
}

Quaternion product(const Quaternion &b, const Quaternion &a) {
  return {b[0] * a[0] - b[1] * a[1] - b[2] * a[2] - b[3] * a[3],
          b[0] * a[1] + b[1] * a[0] + b[2] * a[3] - b[3] * a[2],
          b[0] * a[2] - b[1] * a[3] + b[2] * a[0] + b[3] * a[1],
          b[0] * a[3] + b[1] * a[2] - b[2] * a[1] + b[3] * a[0]};
}

Transform rotationOf(const Quaternion &q) {
  const auto &[w, x, y, z] = q;
  Transform result;
  result.columns[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)};
  result.columns[1] = {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)};
  result.columns[2] = {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)};
  return result;
}

// Shoemake, "Animating Rotation with Quaternion Curves", SIGGRAPH 1985. q and -q are the same
// orientation; the angle is that of the nearer one.
Turn turnBetween(const Quaternion &from, const Quaternion &to) {
  Turn turn{normalized(from), normalized(to), 0};
  double cosine = dot(turn.from, turn.across);
  const double sign = cosine < 0 ? -1 : 1;
  cosine *= sign;
  Quaternion across;
  for (std::size_t i = 0; i < 4; ++i)
    across[i] = sign * turn.across[i] - cosine * turn.from[i];
  const double sine = std::sqrt(dot(across, across));
  if (sine == 0) { // the same orientation
    const auto &[w, x, y, z] = turn.from;
    turn.across = {-x, w, -z, y};
    return turn;
  }
  turn.across = normalized(across);
  turn.angle = std::atan2(sine, cosine);
  return turn;
}

Turn turnAbout(const std::array<double, 3> &axis, double fromDegrees, double toDegrees) {
  // A quarter of the full circle of quaternions further.
  return {axisRotation(axis, fromDegrees), axisRotation(axis, fromDegrees + 180),
          0.5 * (toDegrees - fromDegrees) * radiansPerDegree};
}

Transform MotionFactor::at(double time) const {
  if (isConstant(*this))
    return maps[0];
  const auto [key, share] = keyAt(times, time);
  if (!isRotation())
    return interpolated(maps[key], maps[key + 1], share);
  const Turn &turn = turns[key];
  const double along = std::cos(share * turn.angle), across = std::sin(share * turn.angle);
  Quaternion q;
  for (std::size_t i = 0; i < 4; ++i)
    q[i] = along * turn.from[i] + across * turn.across[i];
  return rotationOf(q);
}

//===----------------------------------------------------------------------===//
// Products
//===----------------------------------------------------------------------===//

Transform MovingTransform::at(double time) const {
  Transform result = atRest;
  for (const MotionFactor &factor : product)
    result = result.then(factor.at(time));
  return result;
}

std::vector<float> MovingTransform::keyTimes() const {
  std::vector<float> times{0, 1};
  for (const MotionFactor &factor : product)
    if (!isConstant(factor))
      times.insert(times.end(), factor.times.begin(), factor.times.end());
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

MovingTransform MovingTransform::then(const MovingTransform &next) const {
  if (!moves() && !next.moves())
    return atRest.then(next.atRest);
  MovingTransform result;
  const auto add = [&](const MotionFactor &factor) {
    if (result.product.empty() || !merge(result.product.back(), factor))
      result.product.push_back(factor);
  };
  for (const MovingTransform *part : {this, &next}) {
    if (!part->moves() && !part->atRest.isIdentity())
      add(constant(part->atRest));
    for (const MotionFactor &factor : part->product)
      add(factor);
  }
  return result;
}

static bool isTranslation(Transform transform) {
  transform.columns[3] = {0, 0, 0};
  return transform.isIdentity();
}

static bool isScale(const Transform &transform) {
  for (std::size_t column = 0; column < 3; ++column)
    for (std::size_t row = 0; row < 3; ++row)
      if (row != column && transform.columns[column][row] != 0)
        return false;
  return true;
}

/// Are all maps of a transform, and of the keys of its factors, of this kind, and does it turn by
/// no angle?
template <typename IsOfKind>
static bool areMaps(const MovingTransform &transform, IsOfKind isOfKind) {
  const auto rests = [](const Turn &turn) {
    return turn.from == Quaternion{1, 0, 0, 0} && turn.angle == 0;
  };
  const std::vector<MotionFactor> &factors = transform.factors();
  return transform.moves()
             ? std::all_of(
                   factors.begin(), factors.end(),
                   [&](const MotionFactor &factor) {
                     return factor.isRotation()
                                ? std::all_of(factor.turns.begin(), factor.turns.end(), rests)
                                : std::all_of(factor.maps.begin(), factor.maps.end(), isOfKind);
                   })
             : isOfKind(transform.still());
}

bool isTranslation(const MovingTransform &transform) {
  return areMaps(transform, [](const Transform &map) { return isTranslation(map); });
}
bool isScale(const MovingTransform &transform) {
  return areMaps(transform, [](const Transform &map) { return isScale(map); });
}

/// The number, or 1 if it is that but for rounding.
static double roundedToOne(double x) {
  return std::fabs(x - 1) <= mostStretch ? 1 : x;
}

static double squaredScale(const Transform &map) {
  const auto &m = map.columns;
  const auto product = [&](std::size_t i, std::size_t j) {
    return m[i][0] * m[j][0] + m[i][1] * m[j][1] + m[i][2] * m[j][2];
  };
  const double square = (product(0, 0) + product(1, 1) + product(2, 2)) / 3;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j <= i; ++j)
      if (!(std::fabs(product(i, j) - (i == j ? square : 0)) <= mostStretch * square))
        return 0;
  return map.determinant() > 0 ? roundedToOne(square) : 0;
}

double squaredScale(const MovingTransform &transform) {
  if (!transform.moves())
    return squaredScale(transform.still());
  // Between two different rotations, numbers that are interpolated are none.
  const auto turnsAlike = [](const Transform &a, const Transform &b) {
    return std::equal(a.columns.begin(), a.columns.begin() + 3, b.columns.begin());
  };
  double square = 1;
  for (const MotionFactor &factor : transform.factors()) {
    if (factor.isRotation())
      continue;
    for (const Transform &map : factor.maps)
      if (!turnsAlike(map, factor.maps.front()))
        return 0;
    square *= squaredScale(factor.maps.front());
  }
  return roundedToOne(square);
}

bool operator==(const MovingTransform &a, const MovingTransform &b) {
  return compare(a, b) == 0;
}
bool operator<(const MovingTransform &a, const MovingTransform &b) {
  return compare(a, b) < 0;
}

SweptBox sweptBox(const MovingTransform &map, const float lower[3], const float upper[3],
                  float begin, float end) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  SweptBox swept{{inf, inf, inf}, {-inf, -inf, -inf}, {0, 0, 0}};
  double radius = 0;
  for (int i = 0; i < 3; ++i)
    radius = std::hypot(radius, std::max(std::fabs(double(lower[i])), std::fabs(double(upper[i]))));
  if (!map.moves()) {
    addBox(swept, map.still(), lower, upper, 0);
    return swept;
  }
  if (std::isinf(radius)) // an infinite plane that turns is everywhere
    return {{-inf, -inf, -inf}, {inf, inf, inf}, {inf, inf, inf}};
  addBox(swept, map.at(begin), lower, upper, 0);
  const std::vector<float> times = map.keyTimes();
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double from = std::max(times[i], begin), to = std::min(times[i + 1], end);
    if (!(from < to))
      continue;
    const Speeds speeds = speedsOf(map, radius, 0.5 * (from + to));
    // So many parts that the margin is a small share of the box.
    constexpr double share = 1e-3, mostParts = 64;
    const double bulge = speeds.second * (to - from) * (to - from) / 8;
    const double parts =
        std::clamp(std::ceil(std::sqrt(bulge / (share * speeds.value))), 1.0, mostParts);
    for (double part = 0; part <= parts; ++part)
      addBox(swept, map.at(from + (to - from) * (part / parts)), lower, upper,
             bulge / (parts * parts));
  }
  return swept;
}

std::vector<double> timesToCheck(const MovingTransform &map) {
  constexpr int parts = 8;
  std::vector<double> checked;
  const std::vector<float> times = map.keyTimes();
  for (std::size_t i = 0; i + 1 < times.size(); ++i)
    for (int part = 0; part < parts; ++part)
      checked.push_back(times[i] + (double(times[i + 1]) - times[i]) * part / parts);
  checked.push_back(1);
  return checked;
}

} // namespace rtsl::runtime
