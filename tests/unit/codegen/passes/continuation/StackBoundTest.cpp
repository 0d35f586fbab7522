// The bound of the stack against all ways that rays can take.
#include "runtime/device/engines/StackBound.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

using namespace rtsl;

namespace {

struct Graph {
  std::vector<uint32_t> sent, sentLast;
};

/// The most levels of any sample, by running all of them.
uint32_t longest(const Graph &graph, uint32_t kind, uint32_t level, uint32_t further) {
  uint32_t most = level;
  for (uint32_t other = 0; further > 0 && other < graph.sent.size(); ++other) {
    if (graph.sent[kind] >> other & 1)
      most = std::max(most, longest(graph, other, level + 1, further - 1));
    if (graph.sentLast[kind] >> other & 1)
      most = std::max(most, longest(graph, other, level, further - 1));
  }
  return most;
}

TEST(StackBound, IsTheLongestWay) {
  std::mt19937 random(5);
  uint32_t grows = 0;
  for (int round = 0; round < 300; ++round) {
    const uint32_t kinds = 1 + random() % 4;
    Graph graph;
    for (uint32_t kind = 0; kind < kinds; ++kind) {
      graph.sent.push_back(random() & random() & ((1u << kinds) - 1));
      graph.sentLast.push_back(random() & random() & ((1u << kinds) - 1));
    }
    const bool hasGenerate = random() % 2;
    auto levels = [&](uint32_t depth) {
      return device::mostLevels(
          kinds, hasGenerate, depth, [&](uint32_t kind) { return graph.sent[kind]; },
          [&](uint32_t kind) { return graph.sentLast[kind]; });
    };
    for (uint32_t depth = 0; depth < 5; ++depth)
      ASSERT_EQ(levels(depth),
                hasGenerate ? longest(graph, kinds - 1, 1, depth + 1) : longest(graph, 0, 1, depth))
          << "round " << round << ", depth " << depth;
    grows += levels(200) > levels(100);
  }
  EXPECT_GT(grows, 50u);
  EXPECT_LT(grows, 250u);
}

} // namespace
