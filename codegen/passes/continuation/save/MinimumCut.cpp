//===- MinimumCut.cpp - what to save and what to recompute ----------------===//
//
// Maximum flow by blocking flows (Dinic, "Algorithm for solution of a problem of maximum flow in a
// network with power estimation", 1970). As they are built the graphs have no circles, so the first
// flow goes along all of their edges, whatever the distances; that leaves little to the phases,
// which would be as many as the longest chain of operands.
//
//===----------------------------------------------------------------------===//
#include "codegen/passes/continuation/save/MinimumCut.h"

#include <algorithm>

namespace rtsl::continuation {

namespace {

class Network {
public:
  explicit Network(unsigned nodes) : edgesOf(nodes), next(nodes) {}

  void connect(unsigned from, unsigned to, std::int64_t capacity) {
    edgesOf[from].push_back(edges.size());
    edges.push_back({to, capacity});
    edgesOf[to].push_back(edges.size());
    edges.push_back({from, 0});
  }

  std::int64_t maximumFlow(unsigned source, unsigned sink);
  /// Nodes to which more could flow from the source: the smallest source side of a minimum cut.
  std::vector<bool> sourceSide(unsigned source);

private:
  struct Edge {
    unsigned to;
    std::int64_t capacity; // what is left of it; edge i ^ 1 goes back
  };
  bool measure(unsigned source, unsigned sink);
  bool isAhead(unsigned node, unsigned index) const {
    return level.empty() ? index % 2 == 0 : level[edges[index].to] == level[node] + 1;
  }
  std::int64_t augment(unsigned node, unsigned sink, std::int64_t limit);

  std::vector<Edge> edges;
  std::vector<llvm::SmallVector<unsigned, 6>> edgesOf;
  std::vector<int> level; // empty: none has been measured, and every edge leads ahead
  std::vector<unsigned> next;
};

/// Distances from the source along edges that have capacity left; true if the sink can be reached.
bool Network::measure(unsigned source, unsigned sink) {
  level.assign(edgesOf.size(), -1);
  std::vector<unsigned> queue = {source};
  level[source] = 0;
  for (std::size_t i = 0; i < queue.size(); ++i)
    for (unsigned index : edgesOf[queue[i]]) {
      const Edge &edge = edges[index];
      if (edge.capacity > 0 && level[edge.to] < 0) {
        level[edge.to] = level[queue[i]] + 1;
        queue.push_back(edge.to);
      }
    }
  return level[sink] >= 0;
}

/// Sends at most so much from the node to the sink, along edges that lead ahead.
std::int64_t Network::augment(unsigned node, unsigned sink, std::int64_t limit) {
  if (node == sink)
    return limit;
  std::int64_t all = 0;
  for (; next[node] < edgesOf[node].size(); ++next[node]) {
    unsigned index = edgesOf[node][next[node]];
    if (edges[index].capacity <= 0 || !isAhead(node, index))
      continue;
    std::int64_t sent =
        augment(edges[index].to, sink, std::min(limit - all, edges[index].capacity));
    edges[index].capacity -= sent;
    edges[index ^ 1].capacity += sent;
    all += sent;
    if (all == limit) // more may fit through this edge
      break;
  }
  return all;
}

std::int64_t Network::maximumFlow(unsigned source, unsigned sink) {
  std::int64_t flow = augment(source, sink, impossible);
  // With infinite capacity all the way nothing separates source and sink.
  while (flow < impossible && measure(source, sink)) {
    std::fill(next.begin(), next.end(), 0u);
    flow += augment(source, sink, impossible - flow);
  }
  return flow;
}

std::vector<bool> Network::sourceSide(unsigned source) {
  std::vector<bool> reached(edgesOf.size());
  std::vector<unsigned> stack = {source};
  reached[source] = true;
  while (!stack.empty()) {
    unsigned node = stack.back();
    stack.pop_back();
    for (unsigned index : edgesOf[node])
      if (edges[index].capacity > 0 && !reached[edges[index].to]) {
        reached[edges[index].to] = true;
        stack.push_back(edges[index].to);
      }
  }
  return reached;
}

/// What is decided without a cut. A needed value that cannot be recomputed is saved; one whose
/// operands are there anyway is recomputed if that alone is cheaper. Then it is there too, for
/// nothing more, as is what costs nothing to recompute of such values. Of most shaders little is
/// left.
class Foregone {
public:
  explicit Foregone(const std::vector<ValueNode> &values) : isThere(values.size()) {
    for (unsigned v = 0; v < values.size(); ++v) {
      const ValueNode &value = values[v];
      if (value.recomputeCost >= impossible) {
        isThere[v] = value.needed && value.saveCost < impossible;
        if (isThere[v])
          cost += value.saveCost;
        continue;
      }
      const bool isDecided = value.recomputeCost < value.saveCost &&
                             std::all_of(
                                 value.operands.begin(), value.operands.end(),
                                 [&](unsigned operand) { return isThere[operand]; });
      isThere[v] = isDecided && (value.needed || value.recomputeCost == 0);
      if (isThere[v] && value.needed)
        cost += value.recomputeCost;
    }
  }

  std::vector<bool> isThere;
  std::int64_t cost = 0; // of those that are needed
};

} // namespace

Choice chooseSaved(const std::vector<ValueNode> &values) {
  const unsigned count = values.size();
  const Foregone foregone(values);
  std::vector<unsigned> nodeOf(count); // N(v) of those that are open; R(v) is the next
  unsigned nodes = 2;
  const unsigned source = 0, sink = 1;
  for (unsigned v = 0; v < count; ++v)
    if (!foregone.isThere[v]) {
      nodeOf[v] = nodes;
      nodes += 2;
    }

  Network network(nodes);
  for (unsigned v = 0; v < count; ++v) {
    if (foregone.isThere[v])
      continue;
    const unsigned needed = nodeOf[v], recomputed = needed + 1;
    if (values[v].needed)
      network.connect(source, needed, impossible);
    network.connect(needed, recomputed, values[v].saveCost);
    network.connect(recomputed, sink, values[v].recomputeCost);
    for (unsigned operand : values[v].operands)
      if (!foregone.isThere[operand])
        network.connect(recomputed, nodeOf[operand], impossible);
  }
  std::int64_t flow = network.maximumFlow(source, sink);

  Choice choice;
  choice.saved.resize(count);
  choice.recomputed.resize(count);
  choice.feasible = flow < impossible;
  if (!choice.feasible)
    return choice;
  choice.cost = flow + foregone.cost;
  std::vector<bool> side = network.sourceSide(source);
  std::vector<bool> isUsed(count);
  for (unsigned v = count; v-- > 0;) { // operands after what they are used for
    if (foregone.isThere[v]) {
      const bool isWanted = values[v].needed || isUsed[v];
      choice.recomputed[v] = isWanted && values[v].recomputeCost < impossible;
      choice.saved[v] = isWanted && !choice.recomputed[v];
    } else {
      choice.recomputed[v] = side[nodeOf[v]] && side[nodeOf[v] + 1];
      choice.saved[v] = side[nodeOf[v]] && !side[nodeOf[v] + 1];
    }
    if (choice.recomputed[v])
      for (unsigned operand : values[v].operands)
        isUsed[operand] = true;
  }
  return choice;
}

} // namespace rtsl::continuation
