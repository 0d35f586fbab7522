#include "runtime/scene/lights/LightTree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rtsl::runtime {

namespace {

using Vector = std::array<double, 3>;

double dot(const Vector &a, const Vector &b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Beyond it squares of distances leave the range of a float.
constexpr double farthest = 1e15;

struct Box {
  Vector lower = {farthest, farthest, farthest}, upper = {-farthest, -farthest, -farthest};

  void add(const Vector &low, const Vector &high) {
    for (int axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], low[axis]);
      upper[axis] = std::max(upper[axis], high[axis]);
    }
  }
  double extent(int axis) const { return upper[axis] - lower[axis]; }
  double squareDiagonal() const {
    double square = 0;
    for (int axis = 0; axis < 3; ++axis)
      square += extent(axis) * extent(axis);
    return square;
  }
};

/// What the cost of a set of lamps depends on.
struct Set {
  Box box;
  double power = 0;
  Vector axes = {};
  double count = 0;

  void add(const Lamp &lamp) {
    box.add(lamp.lower, lamp.upper);
    power += lamp.power;
    for (int axis = 0; axis < 3; ++axis)
      axes[axis] += lamp.axis[axis];
    ++count;
  }
  void add(const Set &other) {
    box.add(other.box.lower, other.box.upper);
    power += other.power;
    for (int axis = 0; axis < 3; ++axis)
      axes[axis] += other.axes[axis];
    count += other.count;
  }
  /// 0 for an empty set. Normals of one direction count 1, of all directions 4: in the ratio of the
  /// solid angles into which they shine, by the cosine.
  double cost() const {
    if (count == 0)
      return 0;
    const double resultant = std::min(std::sqrt(dot(axes, axes)) / count, 1.0);
    return power * box.squareDiagonal() * (4 - 3 * resultant);
  }
};

/// A cosine that is lower by the rounding of normals: the cone becomes wider, not narrower.
float roundedDown(double cosine) {
  constexpr double rounding = 0x1p-40;
  const auto rounded = float(cosine);
  if (cosine >= 1 - rounding)
    return 1;
  return double(rounded) > cosine ? std::nextafter(rounded, 0.0f) : rounded;
}

double middleOf(const Lamp &lamp, int axis) {
  return 0.5 * (lamp.lower[axis] + lamp.upper[axis]);
}

constexpr int buckets = 16;
/// From here on lamps are divided by their number alone: the depth has a limit.
constexpr int deepestChosen = 64;

class Builder {
public:
  explicit Builder(std::vector<Lamp> given) : lamps(std::move(given)) {
    for (Lamp &lamp : lamps) {
      for (int axis = 0; axis < 3; ++axis) {
        lamp.lower[axis] = cut(lamp.lower[axis], -farthest);
        lamp.upper[axis] = std::max(lamp.lower[axis], cut(lamp.upper[axis], farthest));
      }
      // Of a lamp that shines on both sides either normal is right: lamps that are parallel have
      // the same.
      if (lamp.isTwoSided && isBackward(lamp.axis))
        for (double &one : lamp.axis)
          one = -one;
      total += lamp.power;
    }
  }

  std::vector<RtslLightNode> build() {
    nodes.resize(1);
    divide(0, lamps.size(), /*number=*/0, /*parent=*/0, /*depth=*/0);
    return std::move(nodes);
  }

private:
  static double cut(double place, double ifNotNumber) {
    return std::isnan(place) ? ifNotNumber : std::clamp(place, -farthest, farthest);
  }

  static bool isBackward(const Vector &axis) {
    const auto largest = std::max_element(
        axis.begin(), axis.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    return *largest < 0;
  }

  void divide(std::size_t first, std::size_t last, std::uint32_t number, std::uint32_t parent,
              int depth) {
    describe(first, last, nodes[number]);
    nodes[number].parent |= parent;
    if (last - first == 1) {
      nodes[number].first = lamps[first].emitter;
      nodes[number].part = lamps[first].part;
      return;
    }
    const std::size_t middle = depth < deepestChosen ? choose(first, last) : (first + last) / 2;
    const auto children = static_cast<std::uint32_t>(nodes.size());
    nodes[number].first = children;
    nodes[number].part = RTSL_INNER_LIGHT_NODE;
    nodes.resize(nodes.size() + 2);
    divide(first, middle, children, number, depth + 1);
    divide(middle, last, children + 1, number, depth + 1);
  }

  /// Orders the lamps so that those of the first child come first; returns where the second begins.
  std::size_t choose(std::size_t first, std::size_t last) {
    Box middles;
    Set whole;
    for (std::size_t i = first; i < last; ++i) {
      const Vector middle = {middleOf(lamps[i], 0), middleOf(lamps[i], 1), middleOf(lamps[i], 2)};
      middles.add(middle, middle);
      whole.add(lamps[i]);
    }
    const double longest =
        std::max({whole.box.extent(0), whole.box.extent(1), whole.box.extent(2)});
    double least = std::numeric_limits<double>::infinity();
    int leastAxis = -1, leastBucket = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(middles.extent(axis) > 0))
        continue;
      std::array<Set, buckets> sets;
      for (std::size_t i = first; i < last; ++i)
        sets[bucketOf(lamps[i], axis, middles)].add(lamps[i]);
      std::array<Set, buckets> behind; // of a bucket: it and those after it
      for (int i = buckets; i-- > 0;) {
        behind[i] = sets[i];
        if (i + 1 < buckets)
          behind[i].add(behind[i + 1]);
      }
      Set before;
      for (int i = 1; i < buckets; ++i) {
        before.add(sets[i - 1]);
        // Across the longest side, so that nodes do not become thin.
        const double cost = (before.cost() + behind[i].cost()) * (longest / whole.box.extent(axis));
        if (before.count != 0 && behind[i].count != 0 && cost < least) {
          least = cost;
          leastAxis = axis;
          leastBucket = i;
        }
      }
    }
    if (leastAxis < 0) // all are in the same place
      return (first + last) / 2;
    const auto second = std::stable_partition(
        lamps.begin() + std::ptrdiff_t(first), lamps.begin() + std::ptrdiff_t(last),
        [&](const Lamp &lamp) { return bucketOf(lamp, leastAxis, middles) < leastBucket; });
    return std::size_t(second - lamps.begin());
  }

  static int bucketOf(const Lamp &lamp, int axis, const Box &middles) {
    const double share = (middleOf(lamp, axis) - middles.lower[axis]) / middles.extent(axis);
    return std::min(int(share * buckets), buckets - 1);
  }

  void describe(std::size_t first, std::size_t last, RtslLightNode &node) const {
    Set set;
    bool isTwoSided = false, hasAllNormals = false;
    for (std::size_t i = first; i < last; ++i) {
      set.add(lamps[i]);
      isTwoSided |= lamps[i].isTwoSided;
      hasAllNormals |= dot(lamps[i].axis, lamps[i].axis) == 0;
    }
    for (int axis = 0; axis < 3; ++axis)
      node.middle[axis] = float(0.5 * (set.box.lower[axis] + set.box.upper[axis]));
    // Around the box as it is seen from the middle after rounding.
    double square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const double middle = double(node.middle[axis]);
      const double side = std::max(middle - set.box.lower[axis], set.box.upper[axis] - middle);
      square += side * side;
    }
    node.squareRadius = float(square);
    node.cosine = -1;
    const double length = std::sqrt(dot(set.axes, set.axes));
    if (!hasAllNormals && length > 0) {
      double least = 1;
      for (std::size_t i = first; i < last; ++i)
        least = std::min(least, dot(set.axes, lamps[i].axis) / length);
      for (int axis = 0; axis < 3; ++axis)
        node.axis[axis] = float(set.axes[axis] / length);
      // Almost nothing is outside of the hemispheres of normals that spread more.
      node.cosine = least > 0 ? roundedDown(least) : -1;
    }
    // A power above 0 must not become 0 as a float.
    node.power = std::max(float(set.power / total), std::numeric_limits<float>::min());
    node.parent = isTwoSided ? RTSL_SHINES_ON_BOTH_SIDES : 0;
  }

  std::vector<Lamp> lamps;
  double total = 0;
  std::vector<RtslLightNode> nodes;
};

} // namespace

std::vector<RtslLightNode> buildLightTree(std::vector<Lamp> lamps) {
  return Builder(std::move(lamps)).build();
}

} // namespace rtsl::runtime
