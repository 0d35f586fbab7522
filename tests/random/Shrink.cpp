//===- Shrink.cpp - the smallest program that still fails -----------------===//
#include "Shrink.h"

#include <algorithm>

namespace rtsl::random {

namespace {

class Shrinker {
public:
  Shrinker(Program &program, const std::function<bool(const Program &)> &fails, unsigned limit)
      : program(program), fails(fails), remaining(limit) {}
  void run();

private:
  /// Whether the program, as it was changed, still fails.
  bool stillFails() { return remaining > 0 && (--remaining, fails(program)); }
  bool deleteFromLists();
  bool deleteFrom(Node &list);
  bool openStatements();
  bool simplifyExpressions();
  bool replace(NodePtr &slot, NodePtr by);

  Program &program;
  const std::function<bool(const Program &)> &fails;
  unsigned remaining;
};

/// All nodes of a role, outer ones first.
void collect(NodePtr &slot, Role role, std::vector<NodePtr *> &slots) {
  if (slot->role == role)
    slots.push_back(&slot);
  for (NodePtr &child : slot->children)
    collect(child, role, slots);
}

std::vector<NodePtr *> all(NodePtr &root, Role role) {
  std::vector<NodePtr *> slots;
  collect(root, role, slots);
  return slots;
}

/// Takes runs of children out, long ones first (Zeller and Hildebrandt, "Simplifying and isolating
/// failure-inducing input", 2002).
bool Shrinker::deleteFrom(Node &list) {
  bool changed = false;
  for (std::size_t length = list.children.size(); length > 0; length /= 2) {
    for (std::size_t end = list.children.size(); end > 0;) { // users come after what they use
      const std::size_t begin = end > length ? end - length : 0;
      std::vector<NodePtr> before;
      before.swap(list.children);
      std::vector<NodePtr> taken;
      for (std::size_t i = 0; i != before.size(); ++i)
        (i >= begin && i < end ? taken : list.children).push_back(std::move(before[i]));
      if (!taken.empty() && stillFails()) {
        changed = true;
      } else {
        list.children.insert(list.children.begin() + static_cast<std::ptrdiff_t>(begin),
                             std::make_move_iterator(taken.begin()),
                             std::make_move_iterator(taken.end()));
      }
      end = begin;
    }
  }
  return changed;
}

bool Shrinker::deleteFromLists() {
  bool changed = false;
  // A deletion leaves the lists outside of it where they are.
  for (std::size_t i = 0; remaining > 0; ++i) {
    std::vector<NodePtr *> lists = all(program.tree, Role::List);
    if (i >= lists.size())
      break;
    changed |= deleteFrom(**lists[i]);
  }
  return changed;
}

bool Shrinker::replace(NodePtr &slot, NodePtr by) {
  std::swap(slot, by);
  if (stillFails())
    return true;
  std::swap(slot, by);
  return false;
}

/// `if (c) { a; b; }` becomes `a; b;`.
bool Shrinker::openStatements() {
  bool changed = false;
  for (std::size_t i = 0; remaining > 0; ++i) {
    std::vector<NodePtr *> statements = all(program.tree, Role::Statement);
    if (i >= statements.size())
      break;
    NodePtr &slot = *statements[i];
    NodePtr inside = makeNode(Role::Statement, "");
    for (const NodePtr &child : slot->children)
      if (child->role == Role::List) {
        NodePtr lines = copy(*child);
        for (NodePtr &line : lines->children) {
          inside->text += inside->text.empty() ? "$" : " $";
          inside->children.push_back(std::move(line));
        }
      }
    if (!inside->children.empty())
      changed |= replace(slot, std::move(inside));
  }
  return changed;
}

/// Expressions of the same type inside of one, outer ones first.
void partsOf(const Node &node, const std::string &type, std::vector<const Node *> &parts) {
  for (const NodePtr &child : node.children) {
    if (child->role == Role::Expression && child->type == type)
      parts.push_back(child.get());
    partsOf(*child, type, parts);
  }
}

bool Shrinker::simplifyExpressions() {
  bool changed = false;
  for (std::size_t i = 0; remaining > 0; ++i) {
    std::vector<NodePtr *> expressions = all(program.tree, Role::Expression);
    if (i >= expressions.size())
      break;
    NodePtr &slot = *expressions[i];
    if (slot->children.empty() && slot->text == slot->simplest)
      continue;
    NodePtr simplest = makeNode(Role::Expression, slot->simplest);
    simplest->type = slot->type;
    simplest->simplest = slot->simplest;
    if (replace(slot, std::move(simplest))) {
      changed = true;
      continue;
    }
    std::vector<const Node *> parts;
    partsOf(*slot, slot->type, parts);
    std::vector<NodePtr> candidates;
    for (const Node *part : parts)
      if (candidates.size() < 3)
        candidates.push_back(copy(*part));
    for (NodePtr &candidate : candidates)
      if (replace(slot, std::move(candidate))) {
        changed = true;
        --i; // there may be more to win here
        break;
      }
  }
  return changed;
}

void Shrinker::run() {
  for (bool changed = true; changed && remaining > 0;) {
    changed = deleteFromLists();
    changed |= openStatements();
    changed |= simplifyExpressions();
  }
}

} // namespace

void shrink(Program &program, const std::function<bool(const Program &)> &fails, unsigned limit) {
  Shrinker(program, fails, limit).run();
}

} // namespace rtsl::random
