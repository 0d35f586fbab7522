//===- Tree.cpp - a random program as a tree that can be made smaller -----===//
#include "Tree.h"

namespace rtsl::random {

void Node::print(std::string &to, unsigned indent) const {
  if (role == Role::List) {
    for (const NodePtr &child : children) {
      to.append(2 * indent, ' ');
      child->print(to, indent);
      to += '\n';
    }
    return;
  }
  std::size_t next = 0;
  for (char c : text) {
    if (c != '$') {
      to += c;
      continue;
    }
    const Node &child = *children[next++];
    if (child.role != Role::List) {
      child.print(to, indent);
      continue;
    }
    // Lists stand between braces.
    to += '\n';
    child.print(to, indent + 1);
    to.append(2 * indent, ' ');
  }
}

std::string toText(const Node &root) {
  std::string text;
  root.print(text);
  return text;
}

std::size_t sizeOf(const Node &root) {
  std::size_t size = 1;
  for (const NodePtr &child : root.children)
    size += sizeOf(*child);
  return size;
}

NodePtr copy(const Node &root) {
  auto node = std::make_unique<Node>();
  node->role = root.role;
  node->text = root.text;
  node->type = root.type;
  node->simplest = root.simplest;
  for (const NodePtr &child : root.children)
    node->children.push_back(copy(*child));
  return node;
}

} // namespace rtsl::random
