//===- TreeBuild.h - the memory of a build --------------------------------===//
#pragma once

#include "runtime/device/trees/Children.h"
#include "runtime/device/trees/Items.h"
#include "runtime/device/trees/Lanes.h"

namespace rtsl::device::build {

/// No path from the root of the binary tree is longer, and so none of the wide one.
constexpr uint32_t mostHeight = 63;

/// After so many rounds clusters are joined in pairs; usual are 20 to 70 in all. `mostRounds` has
/// the 32 of pairs, and those that begin before the host knows that one cluster is left.
constexpr uint32_t manyRounds = 150, mostRounds = manyRounds + 40;

/// Bits of the place of an item on the curve, along each axis, and the passes to sort by them.
constexpr uint32_t bitsOfAxis = 20, sortPasses = 3 * bitsOfAxis / digitBits;
static_assert(3 * bitsOfAxis % digitBits == 0);

/// A node of the wide tree before it is written.
struct WideNode {
  uint32_t node; // of the binary tree
  uint32_t firstNode, firstItem;
  uint32_t slots; // slotsOf
};

/// A round of joining clusters (Clusters.h).
struct Round {
  uint32_t clusters;
  bool isInPairs; // each cluster is joined with the next one
};

/// A level of the wide tree (Widen.h): its nodes, and the first item of a leaf of theirs.
struct Level {
  uint32_t first, end, firstItem;
};

/// A call of forSumsBefore (Sums.h).
struct SumCall {
  uint32_t begun, tiles;
  uint64_t sum; // of all
};

/// What the steps of a refit share, beside the nodes, the items and the sums.
struct TreeRefit {
  uint32_t trees;     // their roots are the first level
  uint32_t *levels;   // the numbers of the nodes, level by level
  RtslBox *itemBoxes; // by item
  RtslBox *nodeBoxes; // by node
  double *costs;      // by node: of all below it, times the area of the tree
  double
      *costsOfTrees; // by number in `levels`: what a ray that enters the root is expected to cost
};

/// What all steps of a build share. n is the number of items, at least 1.
struct TreeBuild {
  Items items; // `launch` null: the boxes are given
  uint32_t count;

  // The binary tree. Its leaves, one for each item, are nodes 0 to n - 1, in the order of a curve;
  // the others follow in the order of rounds, the root last. Before the leaves are made the box of
  // item i is that of node n + i.
  RtslBox *boxes;    // 2 n
  uint8_t *heights;  // 2 n: levels below
  BinaryNode *inner; // node n + i
  Costs *costs;      // of node n + i
  RtslBox *centres;  // ranges of the items' centres

  uint64_t *keys[2]; // of the curve; before and after a pass of sorting
  uint32_t *order[2];
  uint64_t *numbers;  // to be summed: one for each element, or for each digit and tile
  SumCall *calls;     // 2, in turn
  uint64_t *words[2]; // by tile of a call: what it has told the others

  Round *rounds;         // mostRounds
  uint32_t *clusters[2]; // their nodes, before and after a round
  uint32_t *nearest;     // of each cluster, the one to be joined with

  Level *levels;      // mostHeight + 2
  WideNode *wide;     // n; may be where the keys are
  uint32_t *contents; // the items in the order of the wide tree
  RtslBvhNode *nodes;
  RtslTreeItem *treeItems;

  TreeRefit refit; // of trees that are there; `items` has a range for each with items

  // Not by an index, which would put a kernel's copy of this into memory.
  uint64_t *keysOf(uint32_t which) const { return which ? keys[1] : keys[0]; }
  uint32_t *orderOf(uint32_t which) const { return which ? order[1] : order[0]; }
  uint32_t *clustersOf(uint32_t which) const { return which ? clusters[1] : clusters[0]; }
  uint64_t *wordsOf(uint32_t which) const { return which ? words[1] : words[0]; }

  bool isItem(uint32_t node) const { return node < count; }
  /// The item of such a node.
  uint32_t itemOf(uint32_t node) const { return order[sortPasses & 1][node]; }

  BinaryNode at(uint32_t node) const {
    if (!isItem(node))
      return inner[node - count];
    BinaryNode leaf = {};
    leaf.choice.items = 1;
    return leaf;
  }
};

} // namespace rtsl::device::build
