#include "runtime/accel/trees/WideTree.h"

#include "runtime/device/trees/Children.h"
#include "runtime/device/trees/Grid.h"
#include "support/Parallel.h"

#include <unordered_map>
#include <utility>

namespace rtsl::runtime {

using namespace device::build;

namespace {

//===----------------------------------------------------------------------===//
// Which nodes become one
//===----------------------------------------------------------------------===//

bool isForOneThread(const BinaryTree &tree, std::size_t boxes) {
  return boxes <= largestForOneThread(tree.boxes.size());
}

class Choices {
public:
  Choices(const BinaryTree &tree, unsigned threads) : tree(tree), choices(tree.nodes.size()) {
    if (tree.nodes.empty())
      return;
    std::vector<std::uint32_t> roots;
    findSubtrees(0, roots);
    std::vector<Costs> costs(roots.size());
    forEachInParallel(threads, roots.size(),
                      [&](std::size_t i) { costs[i] = chooseBelow(roots[i]); });
    for (std::size_t i = 0; i < roots.size(); ++i)
      known[roots[i]] = costs[i];
    const float cost = chooseBelow(0).of[1] / halfArea(tree.nodes[0].bounds);
    costOfTree = cost > 0 && cost < device::infinity ? cost : 0;
  }

  float cost() const { return costOfTree; }

  /// For forEachSubtree.
  BinaryNode at(std::uint32_t node) const {
    return {choices[node], tree.nodes[node].children[0], tree.nodes[node].children[1]};
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

  Costs chooseBelow(std::uint32_t number) {
    if (const auto found = known.find(number); found != known.end())
      return found->second;
    const BinaryTree::Node &node = tree.nodes[number];
    const float area = halfArea(node.bounds);
    if (node.isLeaf())
      return costsOfLeaf(area, node.count);
    const Costs left = chooseBelow(node.children[0]), right = chooseBelow(node.children[1]);
    return choose(choices[number], area, node.count, left, right, tree.mostInLeaf);
  }

  const BinaryTree &tree;
  std::vector<Choice> choices; // by node
  std::unordered_map<std::uint32_t, Costs> known;
  float costOfTree = 0;
};

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
      wide.nodes[0] = emptyNode();
    else
      fillFrom(0, 0);
  }

  /// Makes a node, and all below it.
  void fillFrom(std::size_t index, std::uint32_t node) {
    if (isUpperPart && isForOneThread(tree, tree.nodes[node].count))
      later.push_back({index, node});
    else
      fill(index, tree.nodes[node].bounds, Children(choices, node));
  }

  WideTree wide;
  /// Nodes of `wide` that are left out, and those of the binary tree.
  std::vector<std::pair<std::size_t, std::uint32_t>> later;

private:
  void fill(std::size_t index, const Bounds &all, const Children &children) {
    const std::uint32_t slots = slotsOf(all, children.count, [&](unsigned child) -> const Bounds & {
      return tree.nodes[children.nodes[child]].bounds;
    });
    const std::size_t firstNode = wide.nodes.size(), firstItem = wide.contents.size();
    RtslBvhNode node = emptyNode();
    setGrid(node, all);
    node.firstNode = std::uint32_t(firstNode);
    node.firstItem = std::uint32_t(firstItem);
    Children inner;
    forEachInOrder(slots, children.count, [&](unsigned child, unsigned slot) {
      fillSlot(node, slot, children.nodes[child], children.choices[child], inner);
    });
    wide.nodes[index] = node;
    wide.nodes.resize(firstNode + inner.count);
    for (unsigned i = 0; i < inner.count; ++i)
      fillFrom(firstNode + i, inner.nodes[i]);
  }

  void fillSlot(RtslBvhNode &node, unsigned slot, std::uint32_t child, Choice choice,
                Children &inner) {
    setBox(node, slot, tree.nodes[child].bounds);
    if (choice.isNode) {
      node.inner |= std::uint8_t(1u << slot);
      node.child[slot] = std::uint8_t(RTSL_INNER_CHILD + slot);
      inner.add(child, choice);
      return;
    }
    const BinaryTree::Node &leaf = tree.nodes[child];
    node.child[slot] = RTSL_LEAF(wide.contents.size() - node.firstItem, leaf.count);
    for (std::uint32_t i = 0; i < leaf.count; ++i)
      wide.contents.push_back(tree.boxes[leaf.first + i].number);
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

WideTree widen(const BinaryTree &tree, unsigned threads) {
  const Choices choices(tree, threads);
  Widening top(tree, choices, true);
  top.run();
  std::vector<WideTree> subtrees(top.later.size());
  forEachInParallel(threads, subtrees.size(), [&](std::size_t i) {
    Widening below(tree, choices, false);
    below.fillFrom(0, top.later[i].second);
    subtrees[i] = std::move(below.wide);
  });
  for (std::size_t i = 0; i < subtrees.size(); ++i)
    insert(top.wide, top.later[i].first, subtrees[i]);
  top.wide.cost = choices.cost();
  return std::move(top.wide);
}

} // namespace rtsl::runtime
