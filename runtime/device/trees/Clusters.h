//===- Clusters.h - a binary tree by joining neighbours -------------------===//
//
// Parallel locally-ordered clustering (Meister and Bittner, "Parallel Locally-Ordered Clustering
// for Bounding Volume Hierarchy Construction", 2018): in each round every cluster finds, among its
// neighbours on the curve, the one with which its box would be the smallest, and those that find
// each other become one. The height of a tree is limited: a cluster is not joined if it would
// become too high for all clusters to be joined in pairs afterwards. They are joined in pairs when
// nothing else can be joined, or after many rounds.
//
// The functions are steps, as in Sort.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/trees/Sums.h"

namespace rtsl::device::build {

/// How far along the curve clusters look for others.
constexpr uint32_t searchRadius = 8;

/// The largest height that a cluster may have in a round with so many: if all are joined in pairs
/// from there on, the tree is not higher than mostHeight.
inline uint32_t heightLimit(uint32_t clusters) {
  uint32_t levels = 0; // of joining in pairs
  while ((uint64_t(1) << levels) < clusters)
    ++levels;
  return mostHeight - levels;
}

inline void makeLeaf(const TreeBuild &build, uint32_t i) {
  build.boxes[i] = build.boxes[build.count + build.itemOf(i)];
  build.clusters[0][i] = i;
  build.heights[i] = 0;
}

inline void startClusters(const TreeBuild &build, uint32_t) {
  build.rounds[0] = {build.count, false};
}

/// Of several neighbours that are equally near, the result is the one whose number differs in the
/// lowest bits: so in a row of equal boxes all find each other in pairs. In any row, some do.
inline void findNearest(const TreeBuild &build, uint32_t i, uint32_t number) {
  const Round round = build.rounds[number];
  if (i >= round.clusters)
    return;
  if (round.isInPairs) {
    build.nearest[i] = (i ^ 1) < round.clusters ? i ^ 1 : i;
    return;
  }
  const uint32_t *const clusters = build.clustersOf(number & 1);
  const RtslBox box = build.boxes[clusters[i]];
  const uint32_t limit = heightLimit(round.clusters);
  const bool mayBeTooHigh = number >= limit; // a round adds one at most
  const uint32_t first = i < searchRadius ? 0 : i - searchRadius;
  const uint32_t last = i + searchRadius < round.clusters ? i + searchRadius : round.clusters - 1;
  float least = infinity;
  uint32_t nearest = i, difference = ~0u;
  for (uint32_t other = first; other <= last; ++other) {
    if (other == i || (mayBeTooHigh && (build.heights[clusters[i]] >= limit ||
                                        build.heights[clusters[other]] >= limit)))
      continue;
    RtslBox joined = build.boxes[clusters[other]];
    extend(joined, box);
    const float area = halfArea(joined);
    const float size = area < infinity ? area : infinity; // not NaN
    if (size < least || (size == least && (other ^ i) < difference)) {
      least = size;
      nearest = other;
      difference = other ^ i;
    }
  }
  build.nearest[i] = nearest;
}

inline bool isJoined(const TreeBuild &build, uint32_t i) {
  return build.nearest[i] != i && build.nearest[build.nearest[i]] == i;
}

/// Counts the clusters that are left: each is 1 in the lower half of the sum. The first of two that
/// are joined makes a node: 1 in the upper half.
inline uint64_t countOfCluster(const TreeBuild &build, uint32_t i) {
  if (!isJoined(build, i))
    return 1;
  return build.nearest[i] < i ? 0 : uint64_t(1) << 32 | 1;
}

inline Costs costsOf(const TreeBuild &build, uint32_t node) {
  return build.isItem(node) ? costsOfLeaf(halfArea(build.boxes[node]), 1)
                            : build.costs[node - build.count];
}

inline uint32_t itemsBelow(const TreeBuild &build, uint32_t node) {
  return build.at(node).choice.items;
}

inline void joinNodes(const TreeBuild &build, uint32_t node, uint32_t left, uint32_t right) {
  RtslBox box = build.boxes[left];
  extend(box, build.boxes[right]);
  build.boxes[node] = box;
  const uint8_t leftHeight = build.heights[left], rightHeight = build.heights[right];
  build.heights[node] = uint8_t((leftHeight > rightHeight ? leftHeight : rightHeight) + 1);
  BinaryNode inner;
  inner.left = left;
  inner.right = right;
  const uint32_t i = node - build.count, items = itemsBelow(build, left) + itemsBelow(build, right);
  build.costs[i] =
      choose(inner.choice, halfArea(box), items, costsOf(build, left), costsOf(build, right));
  build.inner[i] = inner;
}

inline void sumClusters(const TreeBuild &build, uint32_t thread, uint32_t number, uint32_t call) {
  forSumsBefore(
      build, thread, build.rounds[number].clusters, call,
      [&](uint32_t i) { return countOfCluster(build, i); },
      [&](uint32_t i, uint64_t sum) { build.numbers[i] = sum; });
}

/// Joins a cluster with its nearest one, or moves it to the next round as it is. A round with m
/// clusters begins with n - m nodes that are no leaves.
inline void moveCluster(const TreeBuild &build, uint32_t i, uint32_t number) {
  const Round round = build.rounds[number];
  if (i >= round.clusters)
    return;
  const uint32_t *const from = build.clustersOf(number & 1);
  const uint64_t sum = build.numbers[i], count = countOfCluster(build, i);
  uint32_t node = from[i];
  if (count >> 32) {
    node = build.count + (build.count - round.clusters) + uint32_t(sum >> 32);
    joinNodes(build, node, from[i], from[build.nearest[i]]);
  }
  if (count)
    build.clustersOf(~number & 1)[uint32_t(sum)] = node;
  if (i + 1 != round.clusters)
    return;
  const uint32_t left = uint32_t(sum) + uint32_t(count);
  build.rounds[number + 1] = {left,
                              round.isInPairs || left == round.clusters || number == manyRounds};
}

} // namespace rtsl::device::build
