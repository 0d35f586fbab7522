#include "scenefile/mistakes/Members.h"

namespace rtsl::scene {

static double squareOf(const std::array<double, 3> &a) {
  return a[0] * a[0] + a[1] * a[1] + a[2] * a[2];
}

bool isFlat(const Vector &a, const Vector &b) {
  constexpr double rounding = 0x1p-22;
  const std::array<double, 3> from{a[0], a[1], a[2]}, to{b[0], b[1], b[2]};
  std::array<double, 3> normal;
  for (std::size_t i = 0, j = 1, k = 2; i < 3; ++i, j = (j + 1) % 3, k = (k + 1) % 3)
    normal[i] = from[j] * to[k] - from[k] * to[j];
  return squareOf(normal) <= rounding * rounding * squareOf(from) * squareOf(to);
}

std::optional<std::string> whyFlat(const Vector &a, const Vector &b) {
  if (!isFlat(a, b))
    return std::nullopt;
  const bool isPoint = a == Vector{} || b == Vector{};
  return isPoint ? "one of its sides is 0" : "its sides are parallel";
}

} // namespace rtsl::scene
