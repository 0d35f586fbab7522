#include "runtime/accel/WideTree.h"

#include "support/WorkerThreads.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>
#include <utility>

namespace rtsl::runtime {

namespace {

constexpr unsigned width = 8;
// Of a ray that enters the box: the time for a node, and for an item.
constexpr float costOfNode = 1.0f, costOfItem = 1.0f;

//===----------------------------------------------------------------------===//
// Which nodes become one
//===----------------------------------------------------------------------===//

bool isForOneThread(const BinaryTree &tree, std::size_t boxes) {
  return boxes <= largestForOneThread(tree.boxes.size());
}

/// The best ways to replace a node of the binary tree by up to eight subtrees.
struct Choice {
  /// If it is one subtree: whether that is a node, or a leaf.
  bool isNode = false;
  /// ofLeft[j - 2], for up to j subtrees: how many of them are below the left child; 0: as for one
  /// less. For j = width they are the children of the node itself.
  std::array<std::uint8_t, width - 1> ofLeft{};
};

/// The cost for up to j subtrees, at j; j < width.
using Costs = std::array<float, width>;

class Choices {
public:
  Choices(const BinaryTree &tree, unsigned threads) : tree(tree), choices(tree.nodes.size()) {
    if (tree.nodes.empty())
      return;
    std::vector<std::uint32_t> roots;
    findSubtrees(0, roots);
    std::vector<Costs> costs(roots.size());
    forEachOnThreads(threads, roots.size(), [&](std::size_t i) { costs[i] = choose(roots[i]); });
    for (std::size_t i = 0; i < roots.size(); ++i)
      known[roots[i]] = costs[i];
    choose(0);
  }

  bool isNode(std::uint32_t node) const { return choices[node].isNode; }

  /// Appends the children of a node of the wide tree.
  void appendChildren(std::uint32_t node, std::vector<std::uint32_t> &children) const {
    appendSplit(node, width, children);
  }

private:
  /// Subtrees for threads.
  void findSubtrees(std::uint32_t number, std::vector<std::uint32_t> &roots) const {
    const BinaryTree::Node &node = tree.nodes[number];
    if (isForOneThread(tree, node.count)) {
      roots.push_back(number);
      return;
    }
    for (const std::uint32_t child : node.children)
      findSubtrees(child, roots);
  }

  Costs choose(std::uint32_t number) {
    if (const auto found = known.find(number); found != known.end())
      return found->second;
    const BinaryTree::Node &node = tree.nodes[number];
    const float area = halfArea(node.bounds), asLeaf = area * float(node.count) * costOfItem;
    Costs costs;
    if (node.isLeaf()) {
      costs.fill(asLeaf);
      return costs;
    }
    const Costs left = choose(node.children[0]), right = choose(node.children[1]);
    Choice &choice = choices[number];
    std::array<float, width + 1> split{}; // into exactly j
    for (unsigned j = 2; j <= width; ++j) {
      unsigned best = 1;
      for (unsigned k = 1; k < j; ++k)
        if (k < width && j - k < width && left[k] + right[j - k] < left[best] + right[j - best])
          best = k;
      choice.ofLeft[j - 2] = std::uint8_t(best);
      split[j] = left[best] + right[j - best];
    }
    const float asNode = area * costOfNode + split[width];
    choice.isNode = node.count > RTSL_MOST_LEAF_ITEMS || asNode < asLeaf;
    costs[0] = 0;
    costs[1] = choice.isNode ? asNode : asLeaf;
    for (unsigned j = 2; j < width; ++j) {
      costs[j] = std::min(costs[j - 1], split[j]);
      if (!(split[j] < costs[j - 1]))
        choice.ofLeft[j - 2] = 0;
    }
    return costs;
  }

  void appendSplit(std::uint32_t node, unsigned count, std::vector<std::uint32_t> &subtrees) const {
    const unsigned ofLeft = choices[node].ofLeft[count - 2];
    append(tree.nodes[node].children[0], ofLeft, subtrees);
    append(tree.nodes[node].children[1], count - ofLeft, subtrees);
  }

  void append(std::uint32_t node, unsigned count, std::vector<std::uint32_t> &subtrees) const {
    while (count > 1 && choices[node].ofLeft[count - 2] == 0)
      --count;
    if (count == 1)
      subtrees.push_back(node);
    else
      appendSplit(node, count, subtrees);
  }

  const BinaryTree &tree;
  std::vector<Choice> choices; // by node
  std::unordered_map<std::uint32_t, Costs> known;
};

//===----------------------------------------------------------------------===//
// Slots
//===----------------------------------------------------------------------===//

/// Slot s is for the child furthest in the direction (x, y, z), where bit 0, 1, 2 of s tells
/// whether x, y, z is 1 or -1. So for rays of any octant the order of slots, with the bits of the
/// octant flipped, is from front to back on the whole. By the largest gain first.
std::array<unsigned, width> slotsOf(const BinaryTree &tree, const Bounds &all,
                                    const std::vector<std::uint32_t> &children) {
  float gain[width][width]; // by child and slot
  for (unsigned child = 0; child < children.size(); ++child) {
    const Bounds &box = tree.nodes[children[child]].bounds;
    for (unsigned slot = 0; slot < width; ++slot) {
      gain[child][slot] = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float offset =
            (box.lower[axis] - all.lower[axis]) - (all.upper[axis] - box.upper[axis]);
        gain[child][slot] += slot >> axis & 1 ? offset : -offset;
      }
    }
  }
  std::array<unsigned, width> slots;
  unsigned placed = 0, taken = 0; // bits of children, and of slots
  for (unsigned step = 0; step < children.size(); ++step) {
    unsigned bestChild = width, bestSlot = width;
    for (unsigned child = 0; child < children.size(); ++child)
      for (unsigned slot = 0; slot < width; ++slot)
        if (!(placed >> child & 1) && !(taken >> slot & 1) &&
            (bestChild == width || gain[child][slot] > gain[bestChild][bestSlot])) {
          bestChild = child;
          bestSlot = slot;
        }
    slots[bestChild] = bestSlot;
    placed |= 1u << bestChild;
    taken |= 1u << bestSlot;
  }
  return slots;
}

//===----------------------------------------------------------------------===//
// Boxes on a grid
//===----------------------------------------------------------------------===//

/// a - b for floats, as a sum of two doubles: the rounded difference and its error.
struct Difference {
  double rounded, error;

  Difference(double a, double b) : rounded(a - b) {
    const double part = rounded - a;
    error = (a - (rounded - part)) - (b + part);
  }
};

float stepOf(const RtslBvhNode &node, int axis) {
  return std::ldexp(1.0f, int(node.exponent[axis]) - 127);
}

/// The largest number of steps that does not go beyond `side`.
double stepsBelow(double origin, double side, double step) {
  const Difference distance(side, origin);
  const double steps = std::floor(distance.rounded / step);
  return steps * step == distance.rounded && distance.error < 0 ? steps - 1 : steps;
}

/// The smallest number of steps that reaches `side`.
double stepsAbove(double origin, double side, double step) {
  const Difference distance(side, origin);
  const double steps = std::ceil(distance.rounded / step);
  return steps * step == distance.rounded && distance.error > 0 ? steps + 1 : steps;
}

//===----------------------------------------------------------------------===//
// The wide tree
//===----------------------------------------------------------------------===//

class Widening {
public:
  Widening(const BinaryTree &tree, const Choices &choices, bool isUpperPart)
      : tree(tree), choices(choices), isUpperPart(isUpperPart) {
    wide.nodes.emplace_back();
  }

  /// The whole tree, or its upper part.
  void run() {
    if (tree.nodes.empty())
      fill(0, {}, {});
    else if (!choices.isNode(0))
      fill(0, tree.nodes[0].bounds, {0});
    else
      fillFrom(0, 0);
  }

  /// Makes a node, and all below it.
  void fillFrom(std::size_t index, std::uint32_t node) {
    if (isUpperPart && isForOneThread(tree, tree.nodes[node].count)) {
      later.push_back({index, node});
      return;
    }
    std::vector<std::uint32_t> children;
    choices.appendChildren(node, children);
    fill(index, tree.nodes[node].bounds, children);
  }

  WideTree wide;
  /// Nodes of `wide` that are left out, and those of the binary tree.
  std::vector<std::pair<std::size_t, std::uint32_t>> later;

private:
  void fill(std::size_t index, const Bounds &all, const std::vector<std::uint32_t> &children) {
    const std::array<unsigned, width> slots = slotsOf(tree, all, children);
    const std::size_t firstNode = wide.nodes.size(), firstItem = wide.contents.size();
    RtslBvhNode node{};
    setGrid(node, all);
    node.firstNode = std::uint32_t(firstNode);
    node.firstItem = std::uint32_t(firstItem);
    std::fill_n(&node.lower[0][0], sizeof node.lower, std::uint8_t(255));
    std::vector<std::uint32_t> inner;
    for (unsigned slot = 0; slot < width; ++slot) {
      const auto place = std::find(slots.begin(), slots.begin() + children.size(), slot);
      if (place == slots.begin() + children.size())
        continue;
      const std::uint32_t child = children[std::size_t(place - slots.begin())];
      setBox(node, slot, tree.nodes[child].bounds);
      if (choices.isNode(child)) {
        node.inner |= std::uint8_t(1u << slot);
        node.child[slot] = std::uint8_t(RTSL_INNER_CHILD + slot);
        inner.push_back(child);
      } else {
        const BinaryTree::Node &leaf = tree.nodes[child];
        node.child[slot] = RTSL_LEAF(wide.contents.size() - firstItem, leaf.count);
        for (std::uint32_t i = 0; i < leaf.count; ++i)
          wide.contents.push_back(tree.boxes[leaf.first + i].number);
      }
    }
    wide.nodes[index] = node;
    wide.nodes.resize(firstNode + inner.size());
    for (std::size_t i = 0; i < inner.size(); ++i)
      fillFrom(firstNode + i, inner[i]);
  }

  const BinaryTree &tree;
  const Choices &choices;
  const bool isUpperPart;
};

/// Puts a subtree, whose root is the first of its nodes, in the place of a node.
void insert(WideTree &tree, std::size_t place, const WideTree &subtree) {
  const auto nodes = std::uint32_t(tree.nodes.size()) - 1; // all but the root
  const auto items = std::uint32_t(tree.contents.size());
  for (std::size_t i = 0; i < subtree.nodes.size(); ++i) {
    RtslBvhNode node = subtree.nodes[i];
    node.firstNode += nodes;
    node.firstItem += items;
    if (i == 0)
      tree.nodes[place] = node;
    else
      tree.nodes.push_back(node);
  }
  tree.contents.insert(tree.contents.end(), subtree.contents.begin(), subtree.contents.end());
}

} // namespace

void setGrid(RtslBvhNode &node, const Bounds &all) {
  for (int axis = 0; axis < 3; ++axis) {
    node.origin[axis] = all.lower[axis];
    unsigned exponent = 1;
    const double size = double(all.upper[axis]) - double(all.lower[axis]);
    if (size > 0)
      exponent = unsigned(std::clamp(std::ilogb(size) - 7 + 127, 1, 254));
    // The size is below 2^8 steps, and 255 may be too few.
    const auto isTooFine = [&] {
      return stepsAbove(all.lower[axis], all.upper[axis], std::ldexp(1.0, int(exponent) - 127)) >
             255;
    };
    while (isTooFine())
      ++exponent;
    node.exponent[axis] = std::uint8_t(exponent);
  }
}

void setBox(RtslBvhNode &node, unsigned slot, const Bounds &box) {
  for (int axis = 0; axis < 3; ++axis) {
    const double origin = node.origin[axis], step = stepOf(node, axis);
    node.lower[axis][slot] = std::uint8_t(stepsBelow(origin, box.lower[axis], step));
    node.upper[axis][slot] = std::uint8_t(stepsAbove(origin, box.upper[axis], step));
  }
}

WideTree widen(const BinaryTree &tree, unsigned threads) {
  const Choices choices(tree, threads);
  Widening top(tree, choices, true);
  top.run();
  std::vector<WideTree> subtrees(top.later.size());
  forEachOnThreads(threads, subtrees.size(), [&](std::size_t i) {
    Widening below(tree, choices, false);
    below.fillFrom(0, top.later[i].second);
    subtrees[i] = std::move(below.wide);
  });
  for (std::size_t i = 0; i < subtrees.size(); ++i)
    insert(top.wide, top.later[i].first, subtrees[i]);
  return std::move(top.wide);
}

} // namespace rtsl::runtime
