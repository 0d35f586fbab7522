//===- Panes.cpp - light that passes transparent surfaces -----------------===//
#include "CompiledShaders.h"
#include "HighPrecision.h"
#include "MeshOf.h"
#include "Row.h"
#include "SpawnCases.h"
#include "Timing.h"
#include "Worst.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace rtsl::numerics {

namespace {

using device::Vec3;

/// So many let the light of a lamp pass (runtime/device/engines/ShadowRay.h), and so many more are
/// behind the lamp.
constexpr int mostPanes = 64, mostBehind = 2;

/// Distances between surfaces, along their normals, in the last place of the largest coordinate: a
/// ray that leaves a surface skips less than 5.2 of them (`spawning.gaps`). At each of the panes it
/// starts again, from a rounded point, so its end is off by some of them for each.
constexpr double narrowest = 6, endOfRay = 8;

/// The angle between panes and the ray has at least this cosine.
constexpr float smallestCosineOfPanes = 0.125f;

struct Pane {
  Triangle triangle;
  float share;
};

/// A point of a triangle, and a lamp behind panes.
struct Window {
  Ray eye; // towards the point
  Triangle floor;
  Vec3 point, towards;
  float away = 0;     // of the lamp, in units of `towards`
  float strength = 1; // of the lamp
  std::vector<Pane> panes;
  int before = 0; // so many are before the lamp, the rest behind it

  std::string text() const {
    std::string said =
        fmt::format("{}, {}, lamp at {:a} times {}", eye.text(), floor.text(), away, show(towards));
    for (const Pane &pane : panes)
      said += fmt::format("\n         {:a} by {}", pane.share, pane.triangle.text());
    return said;
  }
};

/// The window in a scene.
class Scene {
public:
  explicit Scene(Path path)
      : shaders({"tests/numerics/robustness/shaders/Panes.rtsl",
                 "tests/numerics/robustness/shaders/Probe.rtsl"},
                {"PaneLamp", "Panes", "LitPoint", "Probe"}, {{"", "Panes"}, {"", "LitPoint"}},
                path) {}

  void place(const Window &window) {
    shaders.restart();
    runtime::Scene &scene = shaders.scene();
    camera = scene.addObject("Probe");
    reader = scene.addObject("LitPoint");
    const RtslRef lamp = scene.addObject("PaneLamp"), panes = scene.addObject("Panes");
    scene.setCamera(camera);
    scene.addLight(lamp);
    scene.addMeshInstance(scene.addMesh(meshOf({window.floor})), reader);
    if (!window.panes.empty()) {
      std::vector<Triangle> triangles;
      for (const Pane &pane : window.panes)
        triangles.push_back(pane.triangle);
      scene.addMeshInstance(scene.addMesh(meshOf(triangles)), panes);
    }
    shaders.finish();
    float *shares = shaders.member(panes, "shares");
    for (const Pane &pane : window.panes)
      *shares++ = pane.share;
    shaders.set(lamp, "towards", {window.towards.x, window.towards.y, window.towards.z});
    shaders.set(lamp, "away", {window.away});
    shaders.set(lamp, "strength", {window.strength});
    shaders.set(camera, "origin", {window.eye.origin.x, window.eye.origin.y, window.eye.origin.z});
    shaders.set(camera, "direction",
                {window.eye.direction.x, window.eye.direction.y, window.eye.direction.z});
  }
  float light() const { return says(0)[0]; }
  /// (0, 0, 0) if the eye sees something else, or nothing.
  Vec3 point() const { return device::load(says(1).data()); }

private:
  std::array<float, 3> says(float what) const {
    shaders.set(reader, "says", {what});
    return shaders.look();
  }

  CompiledShaders shaders;
  RtslRef camera = 0, reader = 0;
};

Scene &sceneOf(Path path) {
  static Scene only(path); // a program has one
  return only;
}

double lengthOf(Vec3 v) {
  return std::sqrt(double(v.x) * v.x + double(v.y) * v.y + double(v.z) * v.z);
}

/// A triangle around a point, with this normal.
Triangle around(Random &random, Vec3 center, Vec3 normal, float size) {
  const Vec3 x = device::normalized(device::cross(normal, random.direction())),
             y = device::cross(normal, x);
  const auto corner = [&](float turn) {
    return center + (x * std::cos(turn) + y * std::sin(turn)) * size;
  };
  const float turn = random.between(0, 6.2831853f);
  return {{corner(turn), corner(turn + 2.0943951f), corner(turn + 4.1887902f)}};
}

/// A direction at a cosine above smallestCosineOfPanes to another one.
Vec3 directionAbout(Random &random, Vec3 other) {
  for (;;)
    if (const Vec3 direction = random.direction();
        device::dot(direction, other) > smallestCosineOfPanes)
      return direction;
}

/// Panes one after the other along the ray from `window.point`, and the lamp between two of them or
/// behind all: all parallel, or each turned in its own way.
void addPanes(Random &random, Window &window) {
  const double unit = lengthOf(window.towards);
  const Vec3 along = window.towards * float(1 / unit);
  const float far = window.floor.largestCoordinate();
  const double last = std::ldexp(double(far), -22);
  const bool isParallel = random.integer(0, 1);
  Vec3 normal = directionAbout(random, along);
  double distance = 0, slope = 1 / double(smallestCosineOfPanes); // of the surface before
  // So far along the normals of both surfaces.
  const auto goOn = [&](double height) {
    const double next = 1 / double(device::dot(normal, along));
    distance += height * last * std::max(slope, next);
    slope = next;
  };
  window.before = random.integer(1, mostPanes);
  window.strength = std::exp2(random.between(-4, 4));
  const int count = window.before + random.integer(0, mostBehind);
  for (int i = 0; i < count; ++i) {
    if (!isParallel)
      normal = directionAbout(random, along);
    goOn(random.integer(0, 1) ? random.between(3, 50) : std::exp2(random.between(3, 12)));
    window.panes.push_back({around(random, window.point + along * float(distance), normal,
                                   far * std::exp2(random.between(-8, -2))),
                            random.between(0.5f, 1)});
    if (i + 1 == window.before) {
      goOn(endOfRay * (window.before + 1));
      window.away = float(distance / unit);
      goOn(endOfRay * (window.before + 1));
    }
  }
}

/// Whether all surfaces are far enough from their neighbours and from the lamp that there is no
/// doubt which light arrives.
bool isClear(const Window &window) {
  const double unit = lengthOf(window.towards);
  double largest = std::max(double(window.floor.largestCoordinate()),
                            lengthOf(window.point) + double(window.away) * unit);
  for (const Pane &pane : window.panes)
    largest = std::max(largest, double(pane.triangle.largestCoordinate()));
  const double lastPlace = std::ldexp(1.0, std::ilogb(largest) - 23);
  const double ofTheEnd = endOfRay * (window.before + 1);
  std::vector<Plane> planes = {Plane(window.floor)};
  std::vector<double> places = {0};
  for (const Pane &pane : window.panes) {
    const std::optional<double> t = crossing(pane.triangle, window.point, window.towards);
    planes.emplace_back(pane.triangle);
    if (!t || !planes.back().isGood)
      return false;
    places.push_back(*t);
  }
  const auto inLastPlaces = [&](std::size_t i, double t) {
    return std::fabs(t - places[i]) * unit * std::fabs(planes[i].cosine(window.towards)) /
           lastPlace;
  };
  for (std::size_t i = 0; i + 1 < places.size(); ++i)
    if (!(places[i + 1] > places[i]) || inLastPlaces(i, places[i + 1]) < narrowest ||
        inLastPlaces(i + 1, places[i]) < narrowest)
      return false;
  for (std::size_t i = 0; i < places.size(); ++i)
    if ((places[i] < double(window.away)) != (int(i) <= window.before) ||
        inLastPlaces(i, double(window.away)) < ofTheEnd)
      return false;
  return true;
}

std::optional<Window> randomWindow(Random &random, Scene &scene) {
  Window window;
  window.floor = triangleToLeave(random);
  const Plane plane(window.floor);
  window.eye = rayTowards(random, window.floor, -8, 0);
  const double cosine = plane.cosine(window.eye.direction);
  if (!plane.isGood || std::fabs(cosine) < smallestCosineOfPanes)
    return std::nullopt;
  scene.place(window);
  window.point = scene.point();
  if (device::largest(window.point) == 0)
    return std::nullopt;
  const Vec3 onwards =
      Vec3{float(plane.normal[0]), float(plane.normal[1]), float(plane.normal[2])} *
      (cosine > 0 ? 1.0f : -1.0f);
  const float length = std::ldexp(1.0f, random.integer(-20, 20));
  window.towards = directionAbout(random, onwards) * length;
  addPanes(random, window);
  if (!isClear(window))
    return std::nullopt;
  return window;
}

/// The product of the shares of all panes before the lamp, and of none behind it.
Outcome runPanes(Path path, std::uint64_t cases, std::uint32_t seed) {
  Random random(seed);
  Worst worst;
  Scene &scene = sceneOf(path);
  for (std::uint64_t i = 0; i < cases; ++i) {
    const std::optional<Window> window = randomWindow(random, scene);
    if (!window)
      continue;
    scene.place(*window);
    const Vec3 seen = scene.point();
    if (!(seen.x == window->point.x && seen.y == window->point.y && seen.z == window->point.z))
      continue; // a pane is before the point
    Precise exact = window->strength;
    for (int k = 0; k < window->before; ++k)
      exact *= Precise(window->panes[std::size_t(k)].share);
    worst.add(roundingUnits(scene.light(), exact) / window->before, [&] {
      return fmt::format("{:a}, {} panes, {}", scene.light(), window->before, window->text());
    });
  }
  return worst.outcome();
}

double nanosecondsAWindow(Path path) {
  Window window;
  window.eye = {{0, 0, 1}, {0, 0, -1}};
  window.floor = {{{{-9, -9, 0}, {9, -9, 0}, {0, 9, 0}}}};
  window.towards = {0, 0, -1};
  window.away = 9;
  for (int i = 1; i <= 8; ++i) {
    const float z = -float(i);
    window.panes.push_back({{{{{-9, -9, z}, {9, -9, z}, {0, 9, z}}}}, 0.75f});
  }
  Scene &scene = sceneOf(path);
  scene.place(window);
  constexpr int count = 100'000;
  return timeOf(count, [&] {
    float sum = 0;
    for (int i = 0; i < count; ++i)
      sum += scene.light();
    return sum;
  });
}

} // namespace

std::vector<Row> paneRows(Path path) {
  const auto row = rowsOf(path, nanosecondsAWindow);
  return {
      row("attenuation.panes",
          "the light of a lamp behind 1 to 64 transparent triangles, from 6 ulp apart, and before "
          "others",
          "rounding units times the number of triangles", 100'000, runPanes)};
}

} // namespace rtsl::numerics
