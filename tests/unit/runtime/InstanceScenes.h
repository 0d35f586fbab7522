//===- InstanceScenes.h - random scenes of instances ----------------------===//
#pragma once

#include "tests/unit/runtime/FakeProgram.h"

#include "runtime/geometry/Motion.h"
#include "runtime/scene/Scene.h"

#include <cmath>
#include <random>
#include <utility>
#include <vector>

namespace rtsl::runtime::test {

/// Rotated, and scaled up to a thousandfold, differently along the axes; some mirror.
inline Transform randomTransform(std::mt19937 &random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto draw = [&] { return unit(random); };
  const double size = std::pow(10.0, 1.5 * draw()), x = std::exp(draw()), y = std::exp(draw()),
               z = (random() % 3 == 0 ? -1 : 1) * std::exp(draw());
  const double axisX = draw(), axisY = draw(), angle = 180 * draw();
  const double moveX = 10 * draw(), moveY = 10 * draw(), moveZ = 10 * draw();
  return Transform::scale(size * x, size * y, size * z)
      .then(Transform::rotate({axisX, axisY, 0.5}, angle))
      .then(Transform::translate(moveX, moveY, moveZ));
}

/// Keys of scale, rotation and translation at random times, in the space of another transform that
/// may have keys, too.
inline MovingTransform randomMotion(std::mt19937 &random) {
  std::uniform_real_distribution<double> unit(-1, 1);
  const auto factor = [&](auto mapOf) {
    MotionFactor factor;
    factor.times = {0.125f, 0.5f, 1};
    for (std::size_t i = 0; i < factor.times.size(); ++i)
      factor.maps.push_back(mapOf());
    return MovingTransform(factor);
  };
  MotionFactor rotation;
  rotation.times = {0, 0.25f, 0.75f};
  const double x = unit(random), y = unit(random);
  rotation.turns = {turnAbout({x, y, 0.5}, 10, 500),
                    turnBetween(axisRotation({x, y, 0.5}, 500), axisRotation({1, y, x}, -70))};
  const MovingTransform moves =
      factor([&] {
        const double size = std::exp(unit(random));
        return Transform::scale(size, size * std::exp(unit(random)), -size);
      })
          .then(MovingTransform(rotation))
          .then(factor([&] { return Transform::translate(unit(random), 4 * unit(random), 0); }));
  const bool isInMatrixKeys = random() % 2;
  Transform a = Transform::rotate({0.3, 1, 0}, 180 * unit(random));
  a.columns[3] = {8 * unit(random), 8 * unit(random), 8 * unit(random)};
  Transform b = a;
  b.columns[3][1] += 3;
  b.columns[0][0] *= 1.5;
  return moves.then(isInMatrixKeys ? MovingTransform(MotionFactor{{0.25f, 0.5f}, {a, b}, {}})
                                   : MovingTransform(a));
}

inline Mesh clump(std::mt19937 &random, int triangles) {
  std::uniform_real_distribution<float> unit(-1, 1);
  Mesh mesh;
  for (int i = 0; i < triangles; ++i) {
    const float centre[3] = {unit(random), unit(random), unit(random)};
    for (unsigned corner = 0; corner < 3; ++corner) {
      for (float x : centre)
        mesh.positions.push_back(x + 0.4f * unit(random));
      mesh.indices.push_back(3 * unsigned(i) + corner);
    }
  }
  return mesh;
}

/// A clump whose vertices move.
inline Mesh movingClump(std::mt19937 &random, int triangles) {
  std::vector<Mesh> keys(3, clump(random, triangles));
  for (Mesh &key : keys) {
    const Mesh other = clump(random, triangles);
    for (std::size_t i = 0; i < key.positions.size(); ++i)
      key.positions[i] += 0.5f * other.positions[i];
  }
  return movingMesh(std::move(keys), {0.125f, 0.25f, 0.875f}, {"a", "b", "c"});
}

/// So few instances of randomScene that a traversal by Embree lists them
/// (runtime/embree/ItemList.h).
constexpr int few = 10;

/// Instances of three meshes, of which two are in world space too, of spheres, and of rows of
/// spheres; some of them below selectors, one of which is below the other. One mesh moves, and so
/// do some instances.
inline Scene randomScene(unsigned seed, int instances) {
  std::mt19937 random(seed);
  Scene scene(fakeProgram());
  setCameraAtOrigin(scene);
  const RtslRef material = scene.addObject("Normal", members({}));
  const std::uint32_t meshes[] = {scene.addMesh(clump(random, 40)), scene.addMesh(clump(random, 3)),
                                  scene.addMesh(movingClump(random, 12))};
  const RtslRef sphere = scene.addObject("Sphere", {vector(0.25, 0, 0), 0.75});
  const RtslRef row = scene.addObject("Sphere", {vector(-1, 0.5, 0), 0.35});
  const RtslRef chooser = scene.addObject("Chooser", members({}));
  const std::uint32_t outer = scene.addSelector(chooser, 2),
                      inner = scene.addSelector(chooser, 2, randomTransform(random), outer + 1);
  scene.addMeshInstance(meshes[0], material);
  scene.addMeshInstance(meshes[2], material);
  scene.addPrimitive(row, material, {}, 7);
  for (int i = 0; i < instances; ++i) {
    Placement placement;
    placement.transform = i % 4 == 1 ? randomMotion(random) : randomTransform(random);
    placement.mask = i % 4 == 0 ? 1 : 3;
    placement.roots = i % 3 == 0 ? 2 : i % 3 == 1 ? 3 : 1;
    placement.id = i - 20;
    placement.selection = i % 5 == 0 ? outer + random() % 2 : i % 5 == 1 ? inner + random() % 2 : 0;
    if (i % 6 == 5)
      scene.addPrimitive(row, material, placement, 7);
    else if (i % 3 == 2)
      scene.addPrimitive(sphere, material, placement);
    else
      scene.addMeshInstance(meshes[i % 4 == 0 ? 2 : i % 2], material, placement);
  }
  return scene;
}

} // namespace rtsl::runtime::test
