#include "runtime/scene/lights/Emitters.h"

#include "runtime/program/ProgramHost.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace rtsl::runtime {

namespace {

/// Points at which an instance is looked at.
constexpr std::uint32_t points = 64;

using Vector = std::array<double, 3>;

double lengthOf(const Vector &a) {
  return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]);
}

/// The normal of a triangle in world space, of twice the length of its area.
Vector doubleAreaOf(const RtslLaunch &launch, const RtslInstance &instance,
                    std::uint32_t triangle) {
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
  Vector area;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    area[i] = edge(1, j) * edge(2, k) - edge(1, k) * edge(2, j);
  }
  return area;
}

/// For each triangle of an instance of a mesh, the area of it and those before it.
std::vector<double> areasOf(const RtslLaunch &launch, const RtslInstance &instance) {
  std::vector<double> areas(launch.meshes[instance.mesh].triangleCount);
  double area = 0;
  for (std::uint32_t i = 0; i < areas.size(); ++i)
    areas[i] = area += 0.5 * lengthOf(doubleAreaOf(launch, instance, i));
  return areas;
}

/// What is seen of an emitter at several points.
struct Look {
  double mean = 0;
  bool isSeen[2] = {}; // something, from before and from behind

  void add(double power, std::uint32_t sample) { isSeen[sample & 1] |= power > 0; }
};

/// What an instance sends out.
struct Emission {
  double power = 0; // 0: nothing
  /// For each triangle of a mesh, or primitive of an object with several, a measure of its share:
  /// the sum of it and those before it.
  std::vector<double> parts;
  Look look;
  /// The normal of each primitive that is flat; empty: some is not, or it is a mesh.
  std::vector<Vector> normals;
};

/// Estimates what instances of a scene send out by looking at points on them.
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
    return ofPrimitives(number, instance);
  }

private:
  /// The emission of an instance of a mesh. All instances of a mesh with one material shine alike.
  Emission ofMesh(std::uint32_t number, const RtslInstance &instance) {
    const auto [known, isNew] = looks.try_emplace({instance.mesh, instance.material});
    if (isNew)
      known->second = lookAtMesh(number, launch.meshes[instance.mesh].triangleCount);
    Emission emission;
    emission.look = known->second;
    if (!(emission.look.mean > 0))
      return {};
    emission.parts = areasOf(launch, instance);
    emission.power = emission.look.mean * emission.parts.back();
    return emission;
  }

  /// Looks at points of triangles that are spread over the mesh's list.
  Look lookAtMesh(std::uint32_t number, std::uint32_t triangles) const {
    Look look;
    Vector unused;
    for (std::uint32_t sample = 0; sample < points; ++sample) {
      const auto triangle = static_cast<std::uint32_t>(
          (std::uint64_t(sample / 2) * 0x9e3779b97f4a7c15u >> 16) % triangles);
      const double one = power(number, triangle, sample, unused);
      look.mean += one / points;
      look.add(one, sample);
    }
    return look;
  }

  /// Each primitive is looked at, at fewer points the more there are.
  Emission ofPrimitives(std::uint32_t number, const RtslInstance &instance) const {
    const std::uint32_t count = std::max(instance.boxCount, 1u);
    const std::uint32_t each = std::max(points / count, 2u);
    Emission emission;
    bool isFlat = true;
    for (std::uint32_t part = 0; part < count; ++part) {
      double sum = 0;
      Vector first{};
      for (std::uint32_t sample = 0; sample < each; ++sample) {
        Vector normal;
        const double one = power(number, part, sample, normal);
        sum += one;
        emission.look.add(one, sample);
        if (sample == 0)
          first = normal;
        isFlat &= areParallel(first, normal);
      }
      emission.power += sum / each;
      if (instance.boxCount != 0)
        emission.parts.push_back(emission.power);
      if (isFlat)
        emission.normals.push_back(first);
    }
    if (!isFlat)
      emission.normals.clear();
    return emission;
  }

  static bool areParallel(const Vector &a, const Vector &b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] > 1 - 0x1p-20;
  }

  bool has(RtslRef object, const char *method) const {
    return hasMethod(*objects.at(object).classInfo, method);
  }

  /// 0 if it is not known. More than the largest float counts as that: the brightest surface is
  /// worth finding.
  double power(std::uint32_t number, std::uint32_t part, std::uint32_t sample,
               Vector &normal) const {
    float at[3];
    const float one = objects.program().emittedPower(&launch, number, part, sample, at);
    normal = {at[0], at[1], at[2]};
    return one > 0 ? std::min(one, std::numeric_limits<float>::max()) : 0;
  }

  const Objects &objects;
  const RtslLaunch &launch;
  std::map<std::pair<std::uint32_t, RtslRef>, Look> looks; // at meshes with a material
};

//===----------------------------------------------------------------------===//
// Lamps of the light tree
//===----------------------------------------------------------------------===//

bool moves(const RtslLaunch &launch, const RtslInstance &instance) {
  return launch.transforms[instance.transform].motion != 0 ||
         (instance.primitive == 0 && launch.meshes[instance.mesh].keyTimes);
}

void addPoint(Lamp &lamp, const Vector &point) {
  for (int axis = 0; axis < 3; ++axis) {
    lamp.lower[axis] = std::min(lamp.lower[axis], point[axis]);
    lamp.upper[axis] = std::max(lamp.upper[axis], point[axis]);
  }
}

Vector inWorld(const RtslTransform &transform, double x, double y, double z) {
  Vector point;
  for (int row = 0; row < 3; ++row)
    point[row] = double(transform.linear[row]) * x + double(transform.linear[3 + row]) * y +
                 double(transform.linear[6 + row]) * z + double(transform.translation[row]);
  return point;
}

/// A lamp with an empty box and no normal.
Lamp emptyLamp(std::uint32_t emitter, std::uint32_t part, double power) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  return {{inf, inf, inf}, {-inf, -inf, -inf}, {}, false, power, emitter, part};
}

/// The whole emitter, wherever it is while the shutter is open.
Lamp wholeLamp(const RtslLaunch &launch, const RtslInstance &instance, std::uint32_t emitter,
               double power) {
  Lamp lamp = emptyLamp(emitter, RTSL_WHOLE_EMITTER, power);
  if (instance.primitive != 0 || instance.transform != 0) {
    addPoint(lamp, {instance.lower[0], instance.lower[1], instance.lower[2]});
    addPoint(lamp, {instance.upper[0], instance.upper[1], instance.upper[2]});
    return lamp;
  }
  const RtslMesh &mesh = launch.meshes[instance.mesh];
  for (std::size_t i = 0; i < std::size_t(mesh.vertexCount) * mesh.keyCount; ++i) {
    const float *at = mesh.positions + 3 * i;
    addPoint(lamp, {at[0], at[1], at[2]});
  }
  return lamp;
}

/// The lamp of one triangle of a mesh, or primitive of an object with several, that does not move.
Lamp partLamp(const RtslLaunch &launch, const RtslInstance &instance, std::uint32_t emitter,
              std::uint32_t part, double power) {
  Lamp lamp = emptyLamp(emitter, part, power);
  const RtslTransform &transform = launch.transforms[instance.transform];
  if (instance.primitive == 0) {
    const RtslMesh &mesh = launch.meshes[instance.mesh];
    for (int corner = 0; corner < 3; ++corner) {
      const float *at =
          mesh.positions + 3 * std::size_t(mesh.indices[3 * std::size_t(part) + corner]);
      addPoint(lamp, inWorld(transform, at[0], at[1], at[2]));
    }
    return lamp;
  }
  const RtslBox &box = launch.boxes[instance.firstBox + part];
  for (int corner = 0; corner < 8; ++corner)
    addPoint(lamp, inWorld(transform, (corner & 1 ? box.upper : box.lower)[0],
                           (corner & 2 ? box.upper : box.lower)[1],
                           (corner & 4 ? box.upper : box.lower)[2]));
  return lamp;
}

/// Sets the sides on which a lamp with this normal shines.
void setSides(Lamp &lamp, const Vector &normal, const Look &look) {
  const double length = lengthOf(normal);
  if (!(length > 0 && std::isfinite(length)))
    return;
  lamp.isTwoSided = look.isSeen[0] && look.isSeen[1];
  for (int axis = 0; axis < 3; ++axis)
    lamp.axis[axis] = normal[axis] / (look.isSeen[0] ? length : -length);
}

/// The lamps of an emitter.
std::vector<Lamp> lampsOf(const RtslLaunch &launch, const RtslInstance &instance,
                          std::uint32_t emitter, const Emission &emission, bool isDivided) {
  std::vector<Lamp> lamps;
  const bool hasNormals = !moves(launch, instance);
  if (!isDivided) {
    lamps.push_back(wholeLamp(launch, instance, emitter, emission.power));
    if (hasNormals && emission.parts.empty() && !emission.normals.empty())
      setSides(lamps.back(), emission.normals.front(), emission.look);
    return lamps;
  }
  for (std::uint32_t part = 0; part < emission.parts.size(); ++part) {
    const double share = emission.parts[part] - (part ? emission.parts[part - 1] : 0);
    const double power = share * (instance.primitive == 0 ? emission.look.mean : 1);
    if (!(power > 0))
      continue;
    lamps.push_back(partLamp(launch, instance, emitter, part, power));
    if (instance.primitive == 0)
      setSides(lamps.back(), doubleAreaOf(launch, instance, part), emission.look);
    else if (!emission.normals.empty())
      setSides(lamps.back(), emission.normals[part], emission.look);
  }
  return lamps;
}

/// The most lamps into which emitters are divided: some 25 MB of nodes.
constexpr std::size_t mostLamps = std::size_t(1) << 18;

/// Which emitters are divided into their parts: those that rest, the ones with fewest parts first.
std::vector<bool> findDivided(const RtslLaunch &launch, const std::vector<RtslEmitter> &emitters,
                              const std::vector<Emission> &emissions) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t i = 0; i < emitters.size(); ++i)
    if (!emissions[i].parts.empty() && !moves(launch, launch.instances[emitters[i].instance]))
      order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return emissions[a].parts.size() < emissions[b].parts.size();
  });
  std::vector<bool> isDivided(emitters.size(), false);
  std::size_t lamps = emitters.size();
  for (const std::uint32_t emitter : order) {
    lamps += emissions[emitter].parts.size() - 1;
    if (lamps > mostLamps)
      break;
    isDivided[emitter] = true;
  }
  return isDivided;
}

/// With fewer lamps there is little to gain (docs/benchmarks.md).
constexpr std::size_t fewestInTree = 8;

/// Adds the chances to choose one of several, or one before it: ascending sums over the last one,
/// which gets 1.
void addChances(const std::vector<double> &sums, std::vector<float> &chances) {
  for (std::size_t i = 0; i < sums.size(); ++i)
    chances.push_back(i + 1 == sums.size() ? 1.0f : static_cast<float>(sums[i] / sums.back()));
}

} // namespace

Emitters::Emitters(const Objects &objects, const RtslLaunch &complete, LampChoice choice) {
  const ProgramHost host{objects.program().slots};
  RtslLaunch launch = complete;
  launch.host = &host;
  Finder finder(objects, launch);
  std::vector<Emission> emissions;
  std::vector<double> powers; // of each emitter and those before it
  double total = 0;
  for (std::uint32_t i = 0; i < launch.instanceCount; ++i) {
    Emission emission = finder.emissionOf(i);
    if (!(emission.power > 0 && std::isfinite(total + emission.power)))
      continue;
    emitters.push_back({i, static_cast<std::uint32_t>(partChances.size()), 0, 0, 0});
    addChances(emission.parts, partChances);
    powers.push_back(total += emission.power);
    emissions.push_back(std::move(emission));
  }
  std::vector<float> chances;
  addChances(powers, chances);
  for (std::size_t i = 0; i < emitters.size(); ++i)
    emitters[i].chances = chances[i];
  if (choice == LampChoice::ByPower || emitters.empty())
    return;

  const std::vector<bool> isDivided = findDivided(launch, emitters, emissions);
  std::vector<Lamp> lamps;
  for (std::uint32_t i = 0; i < emitters.size(); ++i) {
    emitters[i].firstLeaf = static_cast<std::uint32_t>(leaves.size());
    emitters[i].isDivided = isDivided[i];
    leaves.resize(leaves.size() + (isDivided[i] ? emissions[i].parts.size() : 1),
                  RTSL_NO_LIGHT_LEAF);
    const std::vector<Lamp> some =
        lampsOf(launch, launch.instances[emitters[i].instance], i, emissions[i], isDivided[i]);
    lamps.insert(lamps.end(), some.begin(), some.end());
  }
  if (choice == LampChoice::Automatic && lamps.size() < fewestInTree)
    leaves.clear();
  else
    addTree(std::move(lamps));
}

void Emitters::addTree(std::vector<Lamp> lamps) {
  if (lamps.empty()) // areas that are 0
    return;
  nodes = buildLightTree(std::move(lamps));
  for (std::uint32_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].part != RTSL_INNER_LIGHT_NODE) {
      const RtslEmitter &emitter = emitters[nodes[i].first];
      leaves[emitter.firstLeaf + (emitter.isDivided ? nodes[i].part : 0)] = i;
    }
}

void Emitters::fill(RtslLaunch &launch) const {
  launch.emitters = emitters.data();
  launch.emitterCount = static_cast<std::uint32_t>(emitters.size());
  launch.partChances = partChances.data();
  launch.partChanceCount = static_cast<std::uint32_t>(partChances.size());
  if (nodes.empty())
    return;
  launch.needs |= RTSL_HAS_LIGHT_TREE;
  launch.lightNodes = nodes.data();
  launch.lightNodeCount = static_cast<std::uint32_t>(nodes.size());
  launch.lightLeaves = leaves.data();
  launch.lightLeafCount = static_cast<std::uint32_t>(leaves.size());
}

} // namespace rtsl::runtime
