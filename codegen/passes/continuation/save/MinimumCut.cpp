//===- MinimumCut.cpp - the choice between saving and recomputing ---------===//
//
// Maximum flow by blocking flows (Dinic, "Algorithm for solution of a problem of maximum flow in a
// network with power estimation", 1970). The graphs are acyclic as built, so the first flow uses
// all of their edges, regardless of distances; that leaves little to the phases, whose number would
// otherwise be the length of the longest chain of operands.
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
  /// The nodes that the source reaches in the residual graph: the smallest source side of a minimum
  /// cut.
  std::vector<bool> sourceSide(unsigned source);

private:
  struct Edge {
    unsigned to;
    std::int64_t capacity; // residual; edge i ^ 1 is the reverse edge
  };
  bool measure(unsigned source, unsigned sink);
  bool isAhead(unsigned node, unsigned index) const {
    return level.empty() ? index % 2 == 0 : level[edges[index].to] == level[node] + 1;
  }
  std::int64_t augment(unsigned node, unsigned sink, std::int64_t limit);

  std::vector<Edge> edges;
  std::vector<llvm::SmallVector<unsigned, 6>> edgesOf;
  std::vector<int> level; // empty: not computed, and every edge is admissible
  std::vector<unsigned> next;
};

/// Computes distances from the source in the residual graph; true if the sink can be reached.
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

/// Sends at most `limit` units from the node to the sink, along admissible edges.
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
    if (all == limit) // this edge may have capacity left
      break;
  }
  return all;
}

std::int64_t Network::maximumFlow(unsigned source, unsigned sink) {
  std::int64_t flow = augment(source, sink, impossible);
  // If a path has infinite capacity, no cut separates source and sink.
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

/// Decisions that need no cut. A needed value that cannot be recomputed is saved; one whose
/// operands are available is recomputed if that is cheaper. Then it is available too, at no further
/// cost, and so are values that are free to recompute from available ones. In most shaders few
/// decisions remain.
class Presolve {
public:
  explicit Presolve(const std::vector<ValueNode> &values) : isAvailable(values.size()) {
    for (unsigned v = 0; v < values.size(); ++v) {
      const ValueNode &value = values[v];
      if (value.recomputeCost >= impossible) {
        isAvailable[v] = value.needed && value.saveCost < impossible;
        if (isAvailable[v])
          cost += value.saveCost;
        continue;
      }
      const bool isDecided = value.recomputeCost < value.saveCost &&
                             std::all_of(
                                 value.operands.begin(), value.operands.end(),
                                 [&](unsigned operand) { return isAvailable[operand]; });
      isAvailable[v] = isDecided && (value.needed || value.recomputeCost == 0);
      if (isAvailable[v] && value.needed)
        cost += value.recomputeCost;
    }
  }

  std::vector<bool> isAvailable;
  std::int64_t cost = 0; // of the needed ones
};

} // namespace

Choice chooseSaved(const std::vector<ValueNode> &values) {
  const unsigned count = values.size();
  const Presolve presolve(values);
  std::vector<unsigned> nodeOf(count); // N(v) of the undecided values; R(v) is the next node
  unsigned nodes = 2;
  const unsigned source = 0, sink = 1;
  for (unsigned v = 0; v < count; ++v)
    if (!presolve.isAvailable[v]) {
      nodeOf[v] = nodes;
      nodes += 2;
    }

  Network network(nodes);
  for (unsigned v = 0; v < count; ++v) {
    if (presolve.isAvailable[v])
      continue;
    const unsigned needed = nodeOf[v], recomputed = needed + 1;
    if (values[v].needed)
      network.connect(source, needed, impossible);
    network.connect(needed, recomputed, values[v].saveCost);
    network.connect(recomputed, sink, values[v].recomputeCost);
    for (unsigned operand : values[v].operands)
      if (!presolve.isAvailable[operand])
        network.connect(recomputed, nodeOf[operand], impossible);
  }
  std::int64_t flow = network.maximumFlow(source, sink);

  Choice choice;
  choice.saved.resize(count);
  choice.recomputed.resize(count);
  choice.feasible = flow < impossible;
  if (!choice.feasible)
    return choice;
  choice.cost = flow + presolve.cost;
  std::vector<bool> side = network.sourceSide(source);
  std::vector<bool> isUsed(count);
  for (unsigned v = count; v-- > 0;) { // users before operands
    if (presolve.isAvailable[v]) {
      const bool isNeeded = values[v].needed || isUsed[v];
      choice.recomputed[v] = isNeeded && values[v].recomputeCost < impossible;
      choice.saved[v] = isNeeded && !choice.recomputed[v];
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
