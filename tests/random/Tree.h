//===- Tree.h - a random program as a tree that can be made smaller -------===//
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::random {

struct Node;
using NodePtr = std::unique_ptr<Node>;

/// What the shrinker may do with a node.
enum class Role : unsigned char {
  Expression, // replace it by the simplest value of its type, or by a part of that type
  Fixed,      // leave it as it is; what is below may change. Targets, indices kept in range
  Statement,  // replace it by the statements inside of it
  List,       // delete any of the children: they stand on lines of their own
};

/// A piece of program text. Each `$` of `text` stands for the next child; a List is its children.
struct Node {
  Role role = Role::Fixed;
  std::string text;
  std::vector<NodePtr> children;
  std::string type;     // of an Expression, as the author would write it
  std::string simplest; // value of that type

  void print(std::string &to, unsigned indent = 0) const;
};

/// The text of the whole tree.
std::string toText(const Node &root);
std::size_t sizeOf(const Node &root); // nodes in it
NodePtr copy(const Node &root);

template <typename... Children>
NodePtr makeNode(Role role, std::string text, Children... children) {
  auto node = std::make_unique<Node>();
  node->role = role;
  node->text = std::move(text);
  (node->children.push_back(std::move(children)), ...);
  return node;
}
inline NodePtr makeList() {
  return makeNode(Role::List, "");
}

} // namespace rtsl::random
