#include "runtime/scene/Emitters.h"

#include "runtime/program/ProgramHost.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <utility>

namespace rtsl::runtime {

namespace {

/// Points at which an instance is looked at.
constexpr std::uint32_t points = 64;

class Finder {
public:
  Finder(const Program &program, const RtslLaunch &launch) : program(program), launch(launch) {}

  /// The power of an instance; 0: it does not shine, as far as it was seen.
  double powerOf(std::uint32_t number) {
    const RtslInstance &instance = launch.instances[number];
    const ClassInfo *material = classOf(instance.material);
    if (!material || !has(*material, "emission"))
      return 0;
    if (instance.primitive != 0) {
      const ClassInfo *primitive = classOf(instance.primitive);
      if (!primitive || !has(*primitive, "generateSample") || !has(*primitive, "samplePDF"))
        return 0;
      return mean(number, 0);
    }
    // All instances of a mesh with one material shine alike.
    const auto [known, isNew] = radiances.try_emplace({instance.mesh, instance.material}, 0.0);
    if (isNew)
      known->second = mean(number, launch.meshes[instance.mesh].triangleCount);
    return known->second > 0 ? known->second * areaOf(instance) : 0;
  }

  /// The area of a triangle in world space.
  double areaOf(const RtslInstance &instance, std::uint32_t triangle) const {
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

private:
  const ClassInfo *classOf(RtslRef object) const {
    std::uint32_t id;
    std::memcpy(&id, launch.records + object, sizeof id);
    for (const ClassInfo &info : program.classes)
      if (info.id == id)
        return &info;
    return nullptr;
  }
  static bool has(const ClassInfo &info, const char *method) {
    return std::find(info.methods.begin(), info.methods.end(), method) != info.methods.end();
  }

  double areaOf(const RtslInstance &instance) const {
    double area = 0;
    for (std::uint32_t i = 0; i < launch.meshes[instance.mesh].triangleCount; ++i)
      area += areaOf(instance, i);
    return area;
  }

  /// The mean over points, of a mesh over points of triangles spread over its list.
  double mean(std::uint32_t number, std::uint32_t triangles) const {
    double sum = 0;
    for (std::uint32_t sample = 0; sample < points; ++sample) {
      const auto triangle =
          triangles ? static_cast<std::uint32_t>(
                          (std::uint64_t(sample / 2) * 0x9e3779b97f4a7c15u >> 16) % triangles)
                    : 0u;
      const float one = program.emittedPower(&launch, number, triangle, sample);
      if (one > 0 && std::isfinite(one))
        sum += double(one);
    }
    return sum / points;
  }

  const Program &program;
  const RtslLaunch &launch;
  std::map<std::pair<std::uint32_t, RtslRef>, double> radiances; // of meshes with a material
};

} // namespace

Emitters::Emitters(const Program &program, const RtslLaunch &complete) {
  const ProgramHost host{program.slots};
  RtslLaunch launch = complete;
  launch.host = &host;
  Finder finder(program, launch);
  std::vector<double> powers;
  double total = 0;
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i)
    if (const double power = finder.powerOf(i); power > 0 && std::isfinite(total + power)) {
      emitters.push_back({i, 0, 0});
      powers.push_back(power);
      total += power;
    }
  double sum = 0;
  for (std::size_t i = 0; i < emitters.size(); ++i) {
    sum += powers[i];
    emitters[i].chances = i + 1 == emitters.size() ? 1.0f : static_cast<float>(sum / total);
    const RtslInstance &instance = launch.instances[emitters[i].instance];
    if (instance.primitive != 0)
      continue;
    emitters[i].firstTriangle = static_cast<std::uint32_t>(triangleChances.size());
    const std::uint32_t count = launch.meshes[instance.mesh].triangleCount;
    std::vector<double> areas(count);
    double area = 0;
    for (std::uint32_t triangle = 0; triangle < count; ++triangle)
      areas[triangle] = area += finder.areaOf(instance, triangle);
    for (std::uint32_t triangle = 0; triangle < count; ++triangle)
      triangleChances.push_back(triangle + 1 == count ? 1.0f
                                                      : static_cast<float>(areas[triangle] / area));
  }
}

void Emitters::fill(RtslLaunch &launch) const {
  launch.emitters = emitters.data();
  launch.emitterCount = static_cast<std::uint32_t>(emitters.size());
  launch.triangleChances = triangleChances.data();
  launch.triangleChanceCount = static_cast<std::uint32_t>(triangleChances.size());
}

} // namespace rtsl::runtime
