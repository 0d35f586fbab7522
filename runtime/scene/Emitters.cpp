#include "runtime/scene/Emitters.h"

#include "runtime/program/ProgramHost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace rtsl::runtime {

namespace {

/// Points at which an instance is looked at.
constexpr std::uint32_t points = 64;

/// The area of a triangle in world space.
double areaOf(const RtslLaunch &launch, const RtslInstance &instance, std::uint32_t triangle) {
  const RtslMesh &mesh = launch.meshes[instance.mesh];
  const float *m = launch.transforms[instance.transform].linear;
  const std::uint32_t *index = mesh.indices + 3 * std::size_t(triangle);
  const auto edge = [&](int to, int row) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      sum += double(m[3 * i + row]) * (double(mesh.positions[3 * std::size_t(index[to]) + i]) -
                                       double(mesh.positions[3 * std::size_t(index[0]) + i]));
    return sum;
  };
  double square = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double component = edge(1, j) * edge(2, k) - edge(1, k) * edge(2, j);
    square += component * component;
  }
  return 0.5 * std::sqrt(square);
}

/// For each triangle of an instance of a mesh, the area of it and those before it.
std::vector<double> areasOf(const RtslLaunch &launch, const RtslInstance &instance) {
  std::vector<double> areas(launch.meshes[instance.mesh].triangleCount);
  double area = 0;
  for (std::uint32_t i = 0; i < areas.size(); ++i)
    areas[i] = area += areaOf(launch, instance, i);
  return areas;
}

/// What an instance sends out.
struct Emission {
  double power = 0; // 0: nothing
  /// For each triangle of a mesh, or primitive of an object with several, a measure of its share:
  /// the sum of it and those before it.
  std::vector<double> parts;
};

/// What instances of a scene send out, as far as it is seen.
class Finder {
public:
  Finder(const Objects &objects, const RtslLaunch &launch) : objects(objects), launch(launch) {}

  Emission emissionOf(std::uint32_t number) {
    const RtslInstance &instance = launch.instances[number];
    if (!has(instance.material, "emission"))
      return {};
    if (instance.primitive == 0)
      return ofMesh(number, instance);
    if (!has(instance.primitive, "generateSample") || !has(instance.primitive, "samplePDF"))
      return {};
    return instance.boxCount == 0 ? Emission{mean(number, 0), {}} : ofPrimitives(number, instance);
  }

private:
  /// All instances of a mesh with one material shine alike.
  Emission ofMesh(std::uint32_t number, const RtslInstance &instance) {
    const auto [known, isNew] = radiances.try_emplace({instance.mesh, instance.material}, 0.0);
    if (isNew)
      known->second = mean(number, launch.meshes[instance.mesh].triangleCount);
    if (!(known->second > 0))
      return {};
    Emission emission;
    emission.parts = areasOf(launch, instance);
    emission.power = known->second * emission.parts.back();
    return emission;
  }

  /// Each primitive is looked at, at fewer points the more there are.
  Emission ofPrimitives(std::uint32_t number, const RtslInstance &instance) const {
    const std::uint32_t each = std::max(points / instance.boxCount, 2u);
    Emission emission;
    emission.parts.reserve(instance.boxCount);
    for (std::uint32_t part = 0; part < instance.boxCount; ++part) {
      double sum = 0;
      for (std::uint32_t sample = 0; sample < each; ++sample)
        sum += power(number, part, sample);
      emission.parts.push_back(emission.power += sum / each);
    }
    return emission;
  }

  bool has(RtslRef object, const char *method) const {
    return hasMethod(*objects.at(object).classInfo, method);
  }

  /// The mean over points, of a mesh over points of triangles spread over its list.
  double mean(std::uint32_t number, std::uint32_t triangles) const {
    double sum = 0;
    for (std::uint32_t sample = 0; sample < points; ++sample) {
      const auto triangle =
          triangles ? static_cast<std::uint32_t>(
                          (std::uint64_t(sample / 2) * 0x9e3779b97f4a7c15u >> 16) % triangles)
                    : 0u;
      sum += power(number, triangle, sample);
    }
    return sum / points;
  }

  /// 0 if it is not known. More than the largest float counts as that: the brightest surface is
  /// worth finding.
  double power(std::uint32_t number, std::uint32_t part, std::uint32_t sample) const {
    const float one = objects.program().emittedPower(&launch, number, part, sample);
    return one > 0 ? std::min(one, std::numeric_limits<float>::max()) : 0;
  }

  const Objects &objects;
  const RtslLaunch &launch;
  std::map<std::pair<std::uint32_t, RtslRef>, double> radiances; // of meshes with a material
};

/// Adds the chances to choose one of several, or one before it: ascending sums over the last one,
/// which gets 1.
void addChances(const std::vector<double> &sums, std::vector<float> &chances) {
  for (std::size_t i = 0; i < sums.size(); ++i)
    chances.push_back(i + 1 == sums.size() ? 1.0f : static_cast<float>(sums[i] / sums.back()));
}

} // namespace

Emitters::Emitters(const Objects &objects, const RtslLaunch &complete) {
  const ProgramHost host{objects.program().slots};
  RtslLaunch launch = complete;
  launch.host = &host;
  Finder finder(objects, launch);
  std::vector<double> powers; // of each emitter and those before it
  double total = 0;
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    const Emission emission = finder.emissionOf(i);
    if (!(emission.power > 0 && std::isfinite(total + emission.power)))
      continue;
    emitters.push_back({i, static_cast<std::uint32_t>(partChances.size()), 0});
    addChances(emission.parts, partChances);
    powers.push_back(total += emission.power);
  }
  std::vector<float> chances;
  addChances(powers, chances);
  for (std::size_t i = 0; i < emitters.size(); ++i)
    emitters[i].chances = chances[i];
}

void Emitters::fill(RtslLaunch &launch) const {
  launch.emitters = emitters.data();
  launch.emitterCount = static_cast<std::uint32_t>(emitters.size());
  launch.partChances = partChances.data();
  launch.partChanceCount = static_cast<std::uint32_t>(partChances.size());
}

} // namespace rtsl::runtime
