//===- Meshes.cpp - rays through the edges of a mesh, by the whole renderer ===//
#include "RayTarget.h"
#include "Row.h"
#include "Timing.h"
#include "Worst.h"

#include "runtime/device/ray/Vector.h"

#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// A closed mesh around the origin: an octahedron whose faces were divided three times, its
/// vertices moved in and out. It is star-shaped, so that the origin sees all of it.
struct ClosedMesh {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> faces;

  ClosedMesh() {
    vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (std::uint32_t x : {0u, 1u})
      for (std::uint32_t y : {2u, 3u})
        for (std::uint32_t z : {4u, 5u})
          faces.push_back({x, y, z});
    for (int i = 0; i < 3; ++i)
      divide();
    Random random(7);
    for (Vec3 &vertex : vertices)
      vertex = device::normalized(vertex) * random.between(0.6f, 1.7f);
  }

  runtime::Mesh mesh() const {
    runtime::Mesh result;
    for (const Vec3 &vertex : vertices)
      result.positions.insert(result.positions.end(), {vertex.x, vertex.y, vertex.z});
    for (const auto &face : faces)
      result.indices.insert(result.indices.end(), face.begin(), face.end());
    return result;
  }

private:
  void divide() {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t a, std::uint32_t b) {
      const auto [place, isNew] =
          middles.try_emplace({std::min(a, b), std::max(a, b)}, std::uint32_t(vertices.size()));
      if (isNew)
        vertices.push_back((vertices[a] + vertices[b]) * 0.5f);
      return place->second;
    };
    std::vector<std::array<std::uint32_t, 3>> divided;
    for (const auto &[a, b, c] : faces) {
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      divided.insert(divided.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(divided);
  }
};

struct MeshTarget : ClosedMesh, RayTarget {
  explicit MeshTarget(Path path) : RayTarget(mesh(), path) {}
};

const MeshTarget &target(Path path) {
  static const MeshTarget only(path); // a program has one
  return only;
}

/// From inside to a vertex or a point of an edge; from the origin itself, or from beside it. The
/// direction has any length.
Ray throughAnEdge(Random &random, const ClosedMesh &mesh) {
  const auto &face = mesh.faces[random.index(mesh.faces.size())];
  const Vec3 from = mesh.vertices[face[0]], to = mesh.vertices[face[1]];
  const Vec3 aim = random.integer(0, 1) ? from : from + (to - from) * random.between(0, 1);
  const Vec3 origin = random.integer(0, 1) ? Vec3{0, 0, 0} : random.inBox(0.01f);
  return {origin, (aim - origin) * std::ldexp(1.0f, random.integer(-30, 30))};
}

Outcome runEdges(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Ray ray = throughAnEdge(random, target(path));
    worst.count(!target(path).meet(ray.origin, ray.direction), [&] { return ray.text(); });
  }
  return worst.outcome();
}

/// Rays that leave a point of an edge towards the inside: the mesh is closed, so they meet it
/// again.
Outcome runLeaving(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  for (std::uint64_t i = 0; i < cases; ++i) {
    const Ray ray = throughAnEdge(random, target(path));
    if (!target(path).meet(ray.origin, ray.direction))
      continue; // the other row's
    // Back to about where it came from.
    const Vec3 onwards = (random.inBox(0.01f) - device::normalized(ray.direction)) *
                         std::ldexp(1.0f, random.integer(-10, 10));
    worst.count(!target(path).meetsAgain(ray.origin, ray.direction, onwards),
                [&] { return ray.text(); });
  }
  return worst.outcome();
}

double nanosecondsAMeeting(Path path) {
  constexpr int count = 100'000;
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += *target(path).meet({0, 0, 0}, {0.001f * float(i & 255), 0.25f, 5});
    return sum;
  });
}

} // namespace

std::vector<Row> meshRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAMeeting);
  return {
      row("meshes.edges",
          "camera rays from inside a closed mesh of 512 triangles, through its edges and vertices, "
          "with directions of length 2^-30 to 2^30: those that see through it",
          "misses", 1'000'000, runEdges),
      row("meshes.leaving",
          "rays that leave such points towards the inside: those that do not meet the mesh again",
          "misses", 200'000, runLeaving),
  };
}

} // namespace rtsl::numerics
