//===- StackUse.cpp - the stack size of machine code ----------------------===//
#include "codegen/emit/StackUse.h"

#include "codegen/emit/RuntimeFunctions.h"

#include "llvm/ADT/SmallPtrSet.h"
#include "llvm/ADT/StringMap.h"
#include "llvm/IR/DiagnosticHandler.h"
#include "llvm/IR/DiagnosticInfo.h"
#include "llvm/IR/InstIterator.h"
#include "llvm/IR/Instructions.h"
#include "llvm/IR/LLVMContext.h"
#include "llvm/IR/Module.h"

#include <algorithm>
#include <set>
#include <string>
#include <vector>

namespace rtsl::codegen {

namespace {

using Index = std::size_t;

/// The return address, the caller's frame pointer, and alignment.
constexpr std::uint64_t callBytes = 32;

struct Node {
  std::string name;
  bool isDefined = false; // in one of the modules
  std::uint64_t frame = 0;
  std::vector<Index> callees; // each once

  /// Functions that each ray passes once: trace, and the switches over classes.
  bool isRuntime() const { return isRuntimeFunction(name); }
};
using Graph = std::vector<Node>;

/// Frame sizes, as the code generator reports them, by function.
using Frames = llvm::StringMap<std::uint64_t>;

struct CollectFrames : llvm::DiagnosticHandler {
  explicit CollectFrames(std::shared_ptr<Frames> frames) : frames(std::move(frames)) {}
  bool handleDiagnostics(const llvm::DiagnosticInfo &info) override {
    const auto *stack = llvm::dyn_cast<llvm::DiagnosticInfoStackSize>(&info);
    if (stack)
      (*frames)[stack->getFunction().getName()] = stack->getStackSize();
    return stack != nullptr;
  }
  std::shared_ptr<Frames> frames;
};

/// Tarjan's strongly connected components of the nodes in `chosen`, callees before callers. Chains
/// of calls may be long, so the walk uses an explicit stack.
std::vector<std::vector<Index>> stronglyConnected(const Graph &graph,
                                                  const std::vector<bool> &chosen) {
  constexpr Index none = ~Index(0);
  struct Step {
    Index node, next;
  };
  std::vector<Index> order(graph.size(), none), low(graph.size(), none), open;
  std::vector<bool> isOpen(graph.size(), false);
  std::vector<std::vector<Index>> components;
  std::vector<Step> walk;
  Index count = 0;
  const auto enter = [&](Index node) {
    order[node] = low[node] = count++;
    open.push_back(node);
    isOpen[node] = true;
    walk.push_back({node, 0});
  };
  for (Index root = 0; root < graph.size(); ++root) {
    if (!chosen[root] || order[root] != none)
      continue;
    enter(root);
    while (!walk.empty()) {
      const Index node = walk.back().node;
      if (walk.back().next < graph[node].callees.size()) {
        const Index callee = graph[node].callees[walk.back().next++];
        if (!chosen[callee])
          continue;
        if (order[callee] == none)
          enter(callee);
        else if (isOpen[callee])
          low[node] = std::min(low[node], order[callee]);
        continue;
      }
      walk.pop_back();
      if (!walk.empty())
        low[walk.back().node] = std::min(low[walk.back().node], low[node]);
      if (low[node] != order[node])
        continue;
      components.emplace_back();
      Index member;
      do {
        member = open.back();
        open.pop_back();
        isOpen[member] = false;
        components.back().push_back(member);
      } while (member != node);
    }
  }
  return components;
}

bool isCycle(const Graph &graph, const std::vector<Index> &component) {
  const std::vector<Index> &callees = graph[component[0]].callees;
  return component.size() > 1 ||
         std::find(callees.begin(), callees.end(), component[0]) != callees.end();
}

std::uint64_t sumOf(const Graph &graph, const std::vector<Index> &nodes) {
  std::uint64_t sum = 0;
  for (Index node : nodes)
    sum += graph[node].frame;
  return sum;
}

/// The heaviest path through the chosen nodes, where `weigh(component)` is the size of a component.
template <typename Weigh>
std::uint64_t longestPath(const Graph &graph, const std::vector<bool> &chosen, Weigh weigh) {
  std::vector<std::uint64_t> below(graph.size(), 0); // from a node on, including itself
  std::uint64_t longest = 0;
  for (const std::vector<Index> &component : stronglyConnected(graph, chosen)) {
    std::uint64_t deepest = 0;
    for (Index node : component)
      for (Index callee : graph[node].callees)
        if (chosen[callee]) // those of the component itself are still 0
          deepest = std::max(deepest, below[callee]);
    const std::uint64_t bytes = deepest + weigh(component);
    for (Index node : component)
      below[node] = bytes;
    longest = std::max(longest, bytes);
  }
  return longest;
}

} // namespace

struct StackUse::Implementation {
  Graph graph;
  llvm::StringMap<Index> indices; // in the graph, by name
  std::shared_ptr<Frames> frames = std::make_shared<Frames>();

  Index nodeOf(llvm::StringRef name) {
    const auto [at, isNew] = indices.try_emplace(name, graph.size());
    if (isNew)
      graph.push_back({name.str(), false, 0, {}});
    return at->second;
  }

  /// The frames of one ray in a cycle of functions. Without the functions of the runtime, which
  /// lead from one ray to the next, there is no cycle left, or one of methods that go from object
  /// to object, or `trace` was inlined.
  std::uint64_t perRay(const Graph &known, const std::vector<Index> &cycle,
                       std::uint64_t referenceChain) const {
    std::uint64_t runtime = 0;
    std::vector<bool> shaders(known.size(), false);
    for (Index node : cycle)
      if (known[node].isRuntime())
        runtime += known[node].frame;
      else
        shaders[node] = true;
    return runtime + longestPath(known, shaders, [&](const std::vector<Index> &part) {
             // Between two calls through the same reference, a member leads to the next object;
             // other functions of the cycle may be called in between.
             return sumOf(known, part) *
                    (isCycle(known, part) ? (referenceChain + 1) * part.size() : 1);
           });
  }
};

StackUse::StackUse(llvm::Module &module) : self(std::make_unique<Implementation>()) {
  for (llvm::Function &function : module) {
    if (function.isDeclaration())
      continue;
    function.addFnAttr("warn-stack-size", "0"); // report each frame
    const Index caller = self->nodeOf(function.getName());
    self->graph[caller].isDefined = true;
    llvm::SmallPtrSet<const llvm::Function *, 16> called;
    for (const llvm::Instruction &instruction : llvm::instructions(function))
      if (const auto *call = llvm::dyn_cast<llvm::CallBase>(&instruction))
        if (const llvm::Function *callee = call->getCalledFunction();
            callee && !callee->isIntrinsic() && called.insert(callee).second) {
          const Index index = self->nodeOf(callee->getName());
          self->graph[caller].callees.push_back(index);
        }
  }
  module.getContext().setDiagnosticHandler(std::make_unique<CollectFrames>(self->frames));
}

StackUse::StackUse() : self(std::make_unique<Implementation>()) {}
StackUse::StackUse(StackUse &&) noexcept = default;
StackUse::StackUse(const StackUse &other) : self(std::make_unique<Implementation>(*other.self)) {
  self->frames = std::make_shared<Frames>(*self->frames);
}
StackUse::~StackUse() = default;

std::string StackUse::text() const {
  std::string text;
  for (const Node &node : self->graph) {
    text += node.name;
    text += node.isDefined ? " " + std::to_string(self->frames->lookup(node.name)) : " -1";
    for (const Index callee : node.callees)
      text += " " + std::to_string(callee);
    text += '\n';
  }
  return text;
}

std::optional<StackUse> StackUse::fromText(llvm::StringRef &text) {
  StackUse use;
  Graph &graph = use.self->graph;
  for (;;) {
    const auto [line, rest] = text.split('\n');
    text = rest;
    if (line.empty())
      break;
    llvm::SmallVector<llvm::StringRef, 16> words;
    line.split(words, ' ');
    std::int64_t frame = 0;
    if (words.size() < 2 || words[1].getAsInteger(10, frame) ||
        !use.self->indices.try_emplace(words[0], graph.size()).second)
      return std::nullopt;
    Node node{words[0].str(), frame >= 0, 0, {}};
    for (const llvm::StringRef word : llvm::drop_begin(words, 2))
      if (word.getAsInteger(10, node.callees.emplace_back()))
        return std::nullopt;
    if (node.isDefined)
      (*use.self->frames)[node.name] = std::uint64_t(frame);
    graph.push_back(std::move(node));
  }
  for (const Node &node : graph)
    for (const Index callee : node.callees)
      if (callee >= graph.size())
        return std::nullopt;
  return use;
}

void StackUse::add(const StackUse &other) {
  for (const Node &node : other.self->graph) {
    const Index index = self->nodeOf(node.name);
    self->graph[index].isDefined |= node.isDefined;
    std::set<Index> callees(self->graph[index].callees.begin(), self->graph[index].callees.end());
    for (Index callee : node.callees)
      if (const Index here = self->nodeOf(other.self->graph[callee].name);
          callees.insert(here).second)
        self->graph[index].callees.push_back(here);
  }
  for (const auto &frame : *other.self->frames) {
    std::uint64_t &largest = (*self->frames)[frame.first()];
    largest = std::max(largest, frame.second);
  }
}

std::uint64_t StackUse::bytes(std::uint64_t rays, std::uint64_t referenceChain) const {
  Graph known = self->graph;
  for (Node &node : known)
    node.frame = node.isDefined ? callBytes + self->frames->lookup(node.name) : 0;
  const std::vector<bool> all(known.size(), true);
  bool isRecursive = false;
  const std::uint64_t path = longestPath(known, all, [&](const std::vector<Index> &component) {
    if (!isCycle(known, component))
      return sumOf(known, component);
    isRecursive = true;
    return rays * self->perRay(known, component, referenceChain);
  });
  if (!isRecursive)
    return path;
  // At the end of the last ray's traversal the runtime calls methods: `intersect`, `anyHit`.
  std::vector<bool> leaves(known.size(), false);
  std::vector<bool> recurses(known.size(), false);
  for (const std::vector<Index> &component : stronglyConnected(known, all)) {
    bool leads = isCycle(known, component);
    for (Index node : component)
      for (Index callee : known[node].callees)
        leads = leads || recurses[callee];
    for (Index node : component) {
      recurses[node] = leads;
      leaves[node] = !leads;
    }
  }
  return path + longestPath(known, leaves, [&](const std::vector<Index> &component) {
           return sumOf(known, component);
         });
}

} // namespace rtsl::codegen
