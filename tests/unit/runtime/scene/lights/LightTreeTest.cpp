// The light tree: its construction (runtime/scene/lights/LightTree.h), and how lamps are chosen
// from it (runtime/device/engines/LightTree.h).
#include "runtime/device/engines/LightTree.h"
#include "runtime/scene/lights/LightTree.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <random>
#include <set>
#include <vector>

using namespace rtsl;
using namespace rtsl::device;
using rtsl::runtime::buildLightTree;
using rtsl::runtime::Lamp;

namespace {

std::vector<std::uint32_t> leavesOf(const std::vector<RtslLightNode> &nodes) {
  std::vector<std::uint32_t> leaves;
  for (std::uint32_t i = 0; i < nodes.size(); ++i)
    if (nodes[i].part != RTSL_INNER_LIGHT_NODE)
      leaves.push_back(i);
  return leaves;
}

double sumOfChances(const std::vector<RtslLightNode> &nodes, Vec3 point) {
  double sum = 0;
  for (const std::uint32_t leaf : leavesOf(nodes))
    sum += double(chanceOfLeaf(nodes.data(), leaf, point));
  return sum;
}

Lamp lampAt(double x, double y, double z, double size, double power, std::uint32_t number) {
  return {{x - size, y - size, z - size},
          {x + size, y + size, z + size},
          {},
          false,
          power,
          number,
          RTSL_WHOLE_EMITTER};
}

class Scenes {
public:
  explicit Scenes(unsigned seed) : random(seed) {}

  double uniform(double from, double to) {
    return std::uniform_real_distribution<double>(from, to)(random);
  }
  std::array<double, 3> direction() {
    for (;;) {
      const std::array<double, 3> v = {uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
      const double length = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
      if (length > 0.1 && length <= 1)
        return {v[0] / length, v[1] / length, v[2] / length};
    }
  }
  /// Lamps of all kinds: flat ones that shine on one or both sides, and round ones.
  std::vector<Lamp> lamps(unsigned count, double middle = 0, double spread = 10) {
    std::vector<Lamp> all;
    for (unsigned i = 0; i < count; ++i) {
      Lamp lamp = lampAt(middle + uniform(-spread, spread), middle + uniform(-spread, spread),
                         middle + uniform(-spread, spread), uniform(0, 0.05 * spread),
                         std::pow(10, uniform(-3, 3)), i);
      if (i % 3 != 0) {
        lamp.axis = direction();
        lamp.isTwoSided = i % 3 == 2;
      }
      all.push_back(lamp);
    }
    return all;
  }
  Vec3 point(double middle = 0, double spread = 15) {
    return {float(middle + uniform(-spread, spread)), float(middle + uniform(-spread, spread)),
            float(middle + uniform(-spread, spread))};
  }

private:
  std::mt19937 random;
};

std::uint32_t choose(const std::vector<RtslLightNode> &nodes, Vec3 point, std::uint32_t draw) {
  const std::uint32_t key[2] = {draw, 17};
  return chooseLeaf(nodes.data(), point, randomNumber(key, 0), key);
}

} // namespace

TEST(LightTree, EachLampIsALeafOnce) {
  Scenes scenes(1);
  for (const unsigned count : {1u, 2u, 3u, 100u, 5000u}) {
    const std::vector<RtslLightNode> nodes = buildLightTree(scenes.lamps(count));
    EXPECT_EQ(nodes.size(), 2 * std::size_t(count) - 1);
    std::set<std::uint32_t> emitters;
    for (const std::uint32_t leaf : leavesOf(nodes))
      emitters.insert(nodes[leaf].first);
    EXPECT_EQ(emitters.size(), count);
    for (std::uint32_t i = 0; i < nodes.size(); ++i)
      if (nodes[i].part == RTSL_INNER_LIGHT_NODE)
        for (std::uint32_t child : {nodes[i].first, nodes[i].first + 1}) {
          EXPECT_EQ(nodes[child].parent & ~RTSL_SHINES_ON_BOTH_SIDES, i);
        }
  }
}

TEST(LightTree, ChancesOfAllLampsAddUpToOne) {
  Scenes scenes(2);
  std::vector<Lamp> lamps = scenes.lamps(300);
  for (Lamp &lamp : lamps)
    lamp.axis = {}; // each of them shines on every point
  const std::vector<RtslLightNode> nodes = buildLightTree(lamps);
  for (int i = 0; i < 100; ++i)
    EXPECT_NEAR(sumOfChances(nodes, scenes.point()), 1, 1e-5);
}

/// Of lamps that face away from a point a node may bound more light than its children: then none is
/// chosen.
TEST(LightTree, LampsAreChosenWithTheirChances) {
  Scenes scenes(3);
  const std::vector<RtslLightNode> nodes = buildLightTree(scenes.lamps(40));
  constexpr std::uint32_t draws = 200000;
  for (int i = 0; i < 5; ++i) {
    const Vec3 point = scenes.point();
    std::vector<double> chosen(nodes.size(), 0);
    double none = 0;
    for (std::uint32_t draw = 0; draw < draws; ++draw) {
      const std::uint32_t leaf = choose(nodes, point, draw);
      ++(leaf == RTSL_NO_LIGHT_LEAF ? none : chosen[leaf]);
    }
    double square = 0, sum = 0;
    int cells = -1;
    const auto compare = [&](double seen, double chance) {
      sum += chance;
      if (chance * draws < 10) {
        EXPECT_LT(seen, 40);
        return;
      }
      ++cells;
      square += std::pow(seen - chance * draws, 2) / (chance * draws);
    };
    for (const std::uint32_t leaf : leavesOf(nodes))
      compare(chosen[leaf], double(chanceOfLeaf(nodes.data(), leaf, point)));
    ASSERT_LE(sum, 1 + 1e-5);
    compare(none, 1 - sum);
    ASSERT_GT(cells, 3);
    // chi-square: 4 standard deviations above its mean
    EXPECT_LT(square, cells + 4 * std::sqrt(2.0 * cells));
  }
}

/// A chance of 0 would leave out light: of a lamp that shines at the point it is above 0.
TEST(LightTree, EachLampThatShinesAtAPointIsReached) {
  Scenes scenes(4);
  const std::vector<Lamp> lamps = scenes.lamps(400);
  const std::vector<RtslLightNode> nodes = buildLightTree(lamps);
  int shining = 0, dark = 0;
  for (int i = 0; i < 50; ++i) {
    const Vec3 point = scenes.point();
    for (const std::uint32_t leaf : leavesOf(nodes)) {
      const Lamp &lamp = lamps[nodes[leaf].first];
      const double middle[3] = {0.5 * (lamp.lower[0] + lamp.upper[0]),
                                0.5 * (lamp.lower[1] + lamp.upper[1]),
                                0.5 * (lamp.lower[2] + lamp.upper[2])};
      double along = 0, length = 0;
      for (int axis = 0; axis < 3; ++axis) {
        along += lamp.axis[axis] * (double(point[axis]) - middle[axis]);
        length += lamp.axis[axis] * lamp.axis[axis];
      }
      const bool shines = length == 0 || (lamp.isTwoSided ? along != 0 : along > 0);
      const float chance = chanceOfLeaf(nodes.data(), leaf, point);
      if (shines) {
        ++shining;
        EXPECT_GT(chance, 0) << nodes[leaf].first;
      }
      dark += chance == 0;
    }
  }
  EXPECT_GT(shining, 10000);
  EXPECT_GT(dark, 500); // those that face away are left out
}

TEST(LightTree, NearAndStrongLampsAreChosenMoreOften) {
  std::vector<Lamp> lamps;
  for (std::uint32_t i = 0; i < 1000; ++i)
    lamps.push_back(lampAt(i, 2, 0, 0.1, i == 900 ? 50 : 1, i));
  const std::vector<RtslLightNode> nodes = buildLightTree(lamps);
  for (const std::uint32_t leaf : leavesOf(nodes)) {
    const std::uint32_t lamp = nodes[leaf].first;
    if (lamp == 100 || lamp == 900) {
      EXPECT_GT(chanceOfLeaf(nodes.data(), leaf, {float(lamp), 0, 0}), 0.03F) << lamp;
    }
  }
}

TEST(LightTree, ExtremeScenes) {
  constexpr double inf = std::numeric_limits<double>::infinity();
  Scenes scenes(5);
  std::vector<std::vector<Lamp>> all;
  all.emplace_back(100, lampAt(1, 2, 3, 0, 1, 0)); // in the same place, without a size
  all.push_back(scenes.lamps(100, 1e7, 10));       // far from the origin
  all.push_back(scenes.lamps(100, 0, 1e14));       // huge
  all.push_back(scenes.lamps(100, 0, 1e-14));      // tiny
  all.push_back({lampAt(0, 0, 0, inf, 1, 0), lampAt(0, 0, 0, 1, 1, 1)}); // without an end
  all.push_back({lampAt(0, 0, 0, 1, 1e300, 0), lampAt(9, 0, 0, 1, 1e-300, 1)});
  std::vector<Lamp> spaced; // ever closer: no split halves them
  for (std::uint32_t i = 0; i < 500; ++i)
    spaced.push_back(lampAt(std::ldexp(1.0, -int(i)), 0, 0, 0, 1, i));
  all.push_back(spaced);
  for (std::vector<Lamp> &lamps : all) {
    for (std::size_t i = 0; i < lamps.size(); ++i) {
      lamps[i].axis = {};
      lamps[i].emitter = std::uint32_t(i);
    }
    const std::vector<RtslLightNode> nodes = buildLightTree(lamps);
    ASSERT_EQ(nodes.size(), 2 * lamps.size() - 1);
    const Lamp &first = lamps.front();
    const std::vector<Vec3> points = {
        {1, 2, 3},
        {0, 0, 0},
        {1e7F, 1e7F, 1e7F},
        {1e-14F, 0, 0},
        {1e18F, 0, 0},
        {-1e30F, 5, 1e4},
        {float(first.lower[0]), float(first.upper[1]), float(first.lower[2])}};
    for (const Vec3 &point : points) {
      EXPECT_NEAR(sumOfChances(nodes, point), 1, 1e-4);
      for (std::uint32_t draw = 0; draw < 100; ++draw) {
        const std::uint32_t leaf = choose(nodes, point, draw);
        ASSERT_LT(leaf, nodes.size());
        EXPECT_GT(chanceOfLeaf(nodes.data(), leaf, point), 0);
      }
    }
  }
}

/// What one tree is made of has no part in another: the same lamps give the same nodes.
TEST(LightTree, IsTheSameEachTime) {
  const std::vector<RtslLightNode> one = buildLightTree(Scenes(6).lamps(1000)),
                                   other = buildLightTree(Scenes(6).lamps(1000));
  ASSERT_EQ(one.size(), other.size());
  EXPECT_EQ(std::memcmp(one.data(), other.data(), one.size() * sizeof one[0]), 0);
}
