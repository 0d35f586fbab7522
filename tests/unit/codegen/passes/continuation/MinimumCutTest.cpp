// The choice of what to save against an exhaustive search: on small graphs the cost has to be the
// optimum.
#include "codegen/passes/continuation/save/MinimumCut.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

using namespace rtsl::continuation;

namespace {

/// Tries every set of saved values; what is needed and not saved has to be recomputed. Knows
/// nothing of flows.
std::int64_t cheapestByTrying(const std::vector<ValueNode> &values) {
  const unsigned count = values.size();
  std::int64_t best = impossible;
  for (unsigned set = 0; set < 1u << count; ++set) {
    std::vector<bool> needed(count);
    std::int64_t cost = 0;
    for (unsigned v = count; v-- > 0 && cost < impossible;) { // operands have smaller indices
      bool isNeeded = needed[v] || values[v].needed;
      bool isSaved = set >> v & 1;
      if (!isNeeded)
        continue;
      cost += isSaved ? values[v].saveCost : values[v].recomputeCost;
      if (!isSaved)
        for (unsigned operand : values[v].operands)
          needed[operand] = true;
    }
    best = std::min(best, cost);
  }
  return best;
}

/// What a choice costs, and whether it is one: everything that is needed is there.
std::int64_t costOf(const std::vector<ValueNode> &values, const Choice &choice) {
  std::int64_t cost = 0;
  for (unsigned v = 0; v < values.size(); ++v) {
    EXPECT_FALSE(choice.saved[v] && choice.recomputed[v]);
    if (values[v].needed) {
      EXPECT_TRUE(choice.saved[v] || choice.recomputed[v]);
    }
    if (choice.saved[v])
      cost += values[v].saveCost;
    if (choice.recomputed[v]) {
      cost += values[v].recomputeCost;
      for (unsigned operand : values[v].operands)
        EXPECT_TRUE(choice.saved[operand] || choice.recomputed[operand]);
    }
  }
  return cost;
}

std::vector<ValueNode> randomGraph(std::mt19937 &random, unsigned count) {
  auto below = [&](unsigned bound) { return unsigned(random() % bound); };
  std::vector<ValueNode> values(count);
  for (unsigned v = 0; v < count; ++v) {
    ValueNode &node = values[v];
    if (below(8) != 0) // else an address
      node.saveCost = 1 + below(20);
    if (below(4) != 0) { // else a block argument
      node.recomputeCost = below(3) == 0 ? 0 : below(16);
      for (unsigned n = below(4); v > 0 && n-- > 0;) {
        unsigned operand = below(v);
        if (std::find(node.operands.begin(), node.operands.end(), operand) == node.operands.end())
          node.operands.push_back(operand);
      }
    }
    node.needed = below(3) == 0;
  }
  return values;
}

TEST(MinimumCut, IsTheOptimumOnRandomGraphs) {
  std::mt19937 random(1);
  unsigned feasible = 0, infeasible = 0, mixed = 0;
  for (int round = 0; round < 8000; ++round) {
    std::vector<ValueNode> values = randomGraph(random, 1 + round % 11);
    Choice choice = chooseSaved(values);
    std::int64_t best = cheapestByTrying(values);
    ASSERT_EQ(choice.feasible, best < impossible) << "round " << round;
    if (!choice.feasible) {
      ++infeasible;
      continue;
    }
    ++feasible;
    ASSERT_EQ(choice.cost, best) << "round " << round;
    ASSERT_EQ(costOf(values, choice), best) << "round " << round;
    mixed += std::count(choice.saved.begin(), choice.saved.end(), true) > 0 &&
             std::count(choice.recomputed.begin(), choice.recomputed.end(), true) > 0;
  }
  // The graphs are worth the name.
  EXPECT_GT(feasible, 5000u);
  EXPECT_GT(infeasible, 100u);
  EXPECT_GT(mixed, 2000u);
}

TEST(MinimumCut, SharedOperandIsPaidOnce) {
  // Two dear values from one cheap to save: alone each is better saved, together both are
  // recomputed.
  std::vector<ValueNode> values(3);
  values[0].saveCost = 10;
  values[1] = {8, 1, {0}, true};
  values[2] = {8, 1, {0}, true};
  Choice choice = chooseSaved(values);
  EXPECT_EQ(choice.cost, 12);
  EXPECT_TRUE(choice.saved[0] && choice.recomputed[1] && choice.recomputed[2]);
  values[2].needed = false;
  choice = chooseSaved(values);
  EXPECT_EQ(choice.cost, 8);
  EXPECT_TRUE(choice.saved[1] && !choice.saved[0] && !choice.recomputed[2]);
}

TEST(MinimumCut, AmongEqualsItRecomputesLeast) {
  std::vector<ValueNode> values(2);
  values[0].saveCost = 4;
  values[1] = {5, 1, {0}, true}; // 5 saved, 1 + 4 recomputed
  Choice choice = chooseSaved(values);
  EXPECT_EQ(choice.cost, 5);
  EXPECT_TRUE(choice.saved[1]);
}

TEST(MinimumCut, FailsIfThereIsNoFiniteCut) {
  std::vector<ValueNode> values(1);
  values[0].needed = true;
  EXPECT_FALSE(chooseSaved(values).feasible);
  values[0].needed = false;
  EXPECT_TRUE(chooseSaved(values).feasible);
}

} // namespace
