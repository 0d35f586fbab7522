#include "runtime/geometry/NamedAttribute.h"

#include "runtime/geometry/Normals.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace rtsl::runtime {

NamedAttribute floatAttribute(std::string name, std::uint32_t components,
                              const std::vector<float> &numbers) {
  NamedAttribute attribute;
  attribute.name = std::move(name);
  attribute.components = components;
  attribute.words.resize(numbers.size());
  if (!numbers.empty()) // else there is no data(), and memcpy needs one
    std::memcpy(attribute.words.data(), numbers.data(), 4 * numbers.size());
  return attribute;
}

std::uint32_t componentsOf(NamedAttribute::Space space) {
  switch (space) {
  case NamedAttribute::Space::Numbers:
    return 0;
  case NamedAttribute::Space::Tangent:
    return 4;
  default:
    return 3;
  }
}

const char *nameOf(NamedAttribute::Space space) {
  static constexpr const char *names[] = {"numbers", "point", "vector", "normal", "tangent"};
  return names[std::size_t(space)];
}

void apply(const Transform &transform, NamedAttribute &attribute) {
  if (attribute.space == NamedAttribute::Space::Numbers || transform.isIdentity())
    return;
  const bool isNormal = attribute.space == NamedAttribute::Space::Normal;
  const auto normalMatrix = normalTransform(transform);
  for (std::size_t i = 0; i + 2 < attribute.words.size(); i += attribute.components) {
    float given[4] = {}, moved[3];
    std::memcpy(given, &attribute.words[i], 4 * attribute.components);
    double sum[3];
    for (std::size_t row = 0; row < 3; ++row) {
      sum[row] = attribute.space == NamedAttribute::Space::Point ? transform.columns[3][row] : 0.0;
      for (std::size_t column = 0; column < 3; ++column)
        sum[row] += (isNormal ? normalMatrix[column][row] : transform.columns[column][row]) *
                    double(given[column]);
    }
    const double length = isNormal ? std::hypot(sum[0], sum[1], sum[2]) : 1.0;
    for (std::size_t row = 0; row < 3; ++row)
      moved[row] = length > 0 ? float(sum[row] / length) : 0.0f;
    std::memcpy(&attribute.words[i], moved, sizeof moved);
    if (attribute.space == NamedAttribute::Space::Tangent && transform.determinant() < 0) {
      given[3] = -given[3];
      std::memcpy(&attribute.words[i + 3], &given[3], sizeof given[3]);
    }
  }
}

bool MeshRequest::wants(const std::string &name) const {
  return std::find(attributes.begin(), attributes.end(), name) != attributes.end();
}

} // namespace rtsl::runtime
