#include "runtime/accel/trees/BinaryTree.h"

#include "runtime/accel/trees/Extent.h"
#include "runtime/device/traverse/Bvh.h"
#include "runtime/device/trees/Bounds.h"
#include "support/Parallel.h"

#include <immintrin.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace rtsl::runtime {

using device::build::halfArea;

namespace {

constexpr unsigned binCount = 16;
// In units of one item's test.
constexpr float costOfNode = 0.3f;

/// Twice the centre; used only for comparisons.
float centre(const NumberedBox &box, int axis) {
  return box.bounds.lower[axis] + box.bounds.upper[axis];
}

unsigned ceilLog2(std::size_t n) {
  unsigned bits = 0;
  while ((std::size_t(1) << bits) < n)
    ++bits;
  return bits;
}

using Iterator = std::vector<NumberedBox>::iterator;

struct Split {
  float cost = std::numeric_limits<float>::infinity();
  int axis = -1;
  unsigned bin = 0; // boxes in lower bins go left
  float first = 0, scale = 0;
};

unsigned binOf(float centre, float first, float scale) {
  return std::min(unsigned((centre - first) * scale), binCount - 1);
}

/// The range of twice the centres, by axis.
struct Centres {
  float first[3], last[3];

  Centres() {
    std::fill_n(first, 3, std::numeric_limits<float>::infinity());
    std::fill_n(last, 3, -std::numeric_limits<float>::infinity());
  }
  void add(const NumberedBox &box) {
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = std::min(first[axis], centre(box, axis));
      last[axis] = std::max(last[axis], centre(box, axis));
    }
  }
  void add(const Centres &other) {
    for (int axis = 0; axis < 3; ++axis) {
      first[axis] = std::min(first[axis], other.first[axis]);
      last[axis] = std::max(last[axis], other.last[axis]);
    }
  }
  /// Bins per unit of twice the centre; 0: the axis cannot be divided.
  float scale(int axis) const {
    const float scale = binCount / (last[axis] - first[axis]);
    return last[axis] > first[axis] && std::isfinite(scale) ? scale : 0;
  }
};

/// What follows the box in memory is read, too.
Extent extentOf(const NumberedBox &box) {
  static_assert(offsetof(NumberedBox, number) == sizeof(Bounds) && sizeof(Bounds) == 24);
  return {_mm_loadu_ps(box.bounds.lower), _mm_loadu_ps(box.bounds.upper)};
}

/// Boxes by the bins of their centres, along each axis.
struct Bins {
  Extent extents[3][binCount];
  std::size_t counts[3][binCount] = {};

  void add(const NumberedBox &box, const Centres &all, const float scale[3]) {
    const Extent extent = extentOf(box);
    for (int axis = 0; axis < 3; ++axis) {
      if (scale[axis] == 0)
        continue;
      const unsigned bin = binOf(centre(box, axis), all.first[axis], scale[axis]);
      extents[axis][bin].add(extent);
      ++counts[axis][bin];
    }
  }
  void add(const Bins &other) {
    for (int axis = 0; axis < 3; ++axis)
      for (unsigned bin = 0; bin < binCount; ++bin) {
        extents[axis][bin].add(other.extents[axis][bin]);
        counts[axis][bin] += other.counts[axis][bin];
      }
  }
};

/// The sum, in any order, of what `collect(begin, end, sum)` makes of parts of the boxes.
template <typename Sum, typename Collect>
Sum collectAll(Iterator begin, Iterator end, unsigned threads, Collect collect) {
  constexpr std::size_t part = std::size_t(1) << 16;
  const std::size_t count = std::size_t(end - begin);
  Sum sum;
  if (count < 4 * part || threads == 1) {
    collect(begin, end, sum);
    return sum;
  }
  std::vector<Sum> sums((count + part - 1) / part);
  forEachInParallel(threads, sums.size(), [&](std::size_t i) {
    collect(begin + std::ptrdiff_t(i * part),
            begin + std::ptrdiff_t(std::min(count, (i + 1) * part)), sums[i]);
  });
  for (const Sum &one : sums)
    sum.add(one);
  return sum;
}

/// The cheapest of the divisions between two bins of an axis, if it is below that of `best`.
void chooseBin(const Bins &bins, int axis, float rootArea, Split &best) {
  float costRight[binCount];
  Extent sweep;
  std::size_t count = 0;
  for (unsigned i = binCount; i-- > 1;) {
    sweep.add(bins.extents[axis][i]);
    count += bins.counts[axis][i];
    costRight[i] =
        count ? float(count) * halfArea(sweep.bounds()) : std::numeric_limits<float>::infinity();
  }
  sweep = {};
  count = 0;
  for (unsigned i = 1; i < binCount; ++i) {
    sweep.add(bins.extents[axis][i - 1]);
    count += bins.counts[axis][i - 1];
    if (count == 0)
      continue;
    const float cost =
        costOfNode + (float(count) * halfArea(sweep.bounds()) + costRight[i]) / rootArea;
    if (cost < best.cost) {
      best.cost = cost;
      best.axis = axis;
      best.bin = i;
    }
  }
}

Split bestSplit(Iterator begin, Iterator end, const Bounds &all, unsigned threads) {
  const auto centres =
      collectAll<Centres>(begin, end, threads, [](Iterator first, Iterator last, Centres &sum) {
        for (; first != last; ++first)
          sum.add(*first);
      });
  const float scale[3] = {centres.scale(0), centres.scale(1), centres.scale(2)};
  const auto bins =
      collectAll<Bins>(begin, end, threads, [&](Iterator first, Iterator last, Bins &sum) {
        for (; first != last; ++first)
          sum.add(*first, centres, scale);
      });
  Split best;
  for (int axis = 0; axis < 3; ++axis)
    if (scale[axis] != 0)
      chooseBin(bins, axis, halfArea(all), best);
  if (best.axis >= 0) {
    best.first = centres.first[best.axis];
    best.scale = scale[best.axis];
  }
  return best;
}

/// Builds the tree of a range of boxes, and reorders these.
class TopDownBuilder {
public:
  using Nodes = std::vector<BinaryTree::Node>;
  /// A subtree to be built later, in place of a node.
  struct Later {
    std::uint32_t node;
    unsigned depth;
  };

  /// Subtrees of up to `smallest` boxes are left out. What other threads run meanwhile has no
  /// effect on the tree.
  TopDownBuilder(std::vector<NumberedBox> &boxes, std::size_t mostInLeaf, std::size_t smallest,
                 unsigned threads)
      : boxes(boxes), mostInLeaf(mostInLeaf), smallest(smallest), threads(threads) {}

  /// Builds the node of these boxes, one or more; returns its index.
  std::uint32_t node(Iterator begin, Iterator end, unsigned depth) {
    const auto index = std::uint32_t(nodes.size());
    const auto count = std::uint32_t(end - begin);
    nodes.push_back({{}, std::uint32_t(begin - boxes.begin()), count, {0, 0}});
    if (count <= smallest) {
      later.push_back({index, depth});
      return index;
    }
    const Bounds all =
        collectAll<Extent>(begin, end, threads, [](Iterator first, Iterator last, Extent &sum) {
          for (; first != last; ++first)
            sum.add(extentOf(*first));
        }).bounds();
    nodes[index].bounds = all;
    if (isLeaf(begin, end, all))
      return index;
    const Iterator middle = divide(begin, end, all, depth);
    const std::uint32_t left = node(begin, middle, depth + 1), right = node(middle, end, depth + 1);
    nodes[index].children[0] = left;
    nodes[index].children[1] = right;
    return index;
  }

  Nodes nodes;
  std::vector<Later> later;

private:
  bool isLeaf(Iterator begin, Iterator end, const Bounds &all) const {
    const std::size_t count = std::size_t(end - begin);
    return count == 1 ||
           (count <= mostInLeaf && !(bestSplit(begin, end, all, threads).cost < float(count)));
  }

  /// Partitions the boxes into left and right, both not empty.
  Iterator divide(Iterator begin, Iterator end, const Bounds &all, unsigned depth) const {
    const std::size_t count = std::size_t(end - begin);
    if (count == 2)
      return begin + 1;
    // Halving needs ceil(log2(count)) levels: from here on the depth permits only even splits.
    const bool mustHalve = depth + ceilLog2(count) + 1 >= unsigned(device::maxBvhDepth);
    if (!mustHalve) {
      const Split split = bestSplit(begin, end, all, threads);
      if (split.axis >= 0) {
        const Iterator middle = std::partition(begin, end, [&](const NumberedBox &box) {
          return binOf(centre(box, split.axis), split.first, split.scale) < split.bin;
        });
        if (middle != begin && middle != end)
          return middle;
      }
    }
    // All centres coincide, or the depth is nearly used up: split at the median of the widest axis.
    int axis = 0;
    for (int i = 1; i < 3; ++i)
      if (all.upper[i] - all.lower[i] > all.upper[axis] - all.lower[axis])
        axis = i;
    const Iterator middle = begin + std::ptrdiff_t(count / 2);
    std::nth_element(begin, middle, end, [axis](const NumberedBox &a, const NumberedBox &b) {
      const float ca = centre(a, axis), cb = centre(b, axis);
      return ca != cb ? ca < cb : a.number < b.number;
    });
    return middle;
  }

  std::vector<NumberedBox> &boxes;
  const std::size_t mostInLeaf, smallest;
  const unsigned threads;
};

/// Puts a subtree, whose root is the first of its nodes, in the place of a node.
void insert(BinaryTree &tree, std::uint32_t place, const TopDownBuilder::Nodes &subtree) {
  const auto moved = std::uint32_t(tree.nodes.size()) - 1; // all but the root
  for (std::size_t i = 0; i < subtree.size(); ++i) {
    BinaryTree::Node node = subtree[i];
    if (!node.isLeaf())
      for (std::uint32_t &child : node.children)
        child += moved;
    if (i == 0)
      tree.nodes[place] = node;
    else
      tree.nodes.push_back(node);
  }
}

} // namespace

BinaryTree buildBinaryTree(std::vector<NumberedBox> boxes, unsigned threads,
                           std::uint32_t mostInLeaf) {
  BinaryTree tree;
  tree.mostInLeaf = mostInLeaf;
  tree.boxes = std::move(boxes);
  if (tree.boxes.empty())
    return tree;
  // The upper part by all threads together, then each subtree by one of them.
  TopDownBuilder top(tree.boxes, mostInLeaf, largestForOneThread(tree.boxes.size()), threads);
  top.node(tree.boxes.begin(), tree.boxes.end(), 0);
  tree.nodes = std::move(top.nodes);
  std::vector<TopDownBuilder::Nodes> subtrees(top.later.size());
  forEachInParallel(threads, subtrees.size(), [&](std::size_t i) {
    const BinaryTree::Node &root = tree.nodes[top.later[i].node];
    const Iterator first = tree.boxes.begin() + root.first;
    TopDownBuilder builder(tree.boxes, mostInLeaf, 0, 1);
    builder.node(first, first + root.count, top.later[i].depth);
    subtrees[i] = std::move(builder.nodes);
  });
  for (std::size_t i = 0; i < subtrees.size(); ++i)
    insert(tree, top.later[i].node, subtrees[i]);
  return tree;
}

} // namespace rtsl::runtime
