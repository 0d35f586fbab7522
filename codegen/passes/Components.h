//===- Components.h - strongly connected components of a graph ------------===//
#pragma once

#include "llvm/ADT/DenseMap.h"
#include "llvm/ADT/DenseSet.h"
#include "llvm/ADT/STLFunctionalExtras.h"
#include "llvm/ADT/SetVector.h"
#include "llvm/ADT/SmallVector.h"

#include <algorithm>
#include <vector>

namespace rtsl {

/// The strongly connected components of a part of a graph, successors first (Tarjan, "Depth-first
/// search and linear graph algorithms", 1972).
template <typename Node>
class Components {
public:
  using Part = llvm::SmallSetVector<Node, 16>;
  /// Calls `visit` for each successor of the node.
  using Successors = llvm::function_ref<void(Node, llvm::function_ref<void(Node)> visit)>;

  static std::vector<Part> of(const Part &part, Successors successors) {
    Components components(part, successors);
    for (Node node : part)
      if (!components.numbers.count(node))
        components.visit(node);
    return std::move(components.found);
  }

private:
  Components(const Part &part, Successors successors) : part(part), successors(successors) {}

  unsigned visit(Node node) {
    const unsigned number = numbers[node] = ++count;
    unsigned low = number;
    stack.push_back(node);
    open.insert(node);
    successors(node, [&](Node next) {
      if (!part.contains(next))
        return;
      if (auto known = numbers.find(next); known == numbers.end())
        low = std::min(low, visit(next));
      else if (open.contains(next))
        low = std::min(low, known->second);
    });
    if (low == number) {
      Part &component = found.emplace_back();
      do {
        component.insert(stack.back());
        open.erase(stack.pop_back_val());
      } while (!component.contains(node));
    }
    return low;
  }

  const Part &part;
  Successors successors;
  std::vector<Part> found;
  llvm::DenseMap<Node, unsigned> numbers;
  llvm::DenseSet<Node> open;
  llvm::SmallVector<Node> stack;
  unsigned count = 0;
};

} // namespace rtsl
