//===- Casting.h - casting nodes to their class ---------------------------===//
//
// `cast<T>` for a node whose kind is known, `dynCast<T>` for one whose kind is tested. They work on
// both trees: every node class has a static `Kind`.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cassert>
#include <memory>

namespace rtsl {

template <typename T, typename Node>
const T &cast(const Node &node) {
  assert(node.kind == T::Kind);
  return static_cast<const T &>(node);
}

/// Null if `node` is null or of another kind.
template <typename T, typename Node>
const T *dynCast(const Node *node) {
  return node && node->kind == T::Kind ? static_cast<const T *>(node) : nullptr;
}
template <typename T, typename Node>
T *dynCast(Node *node) {
  return node && node->kind == T::Kind ? static_cast<T *>(node) : nullptr;
}
template <typename T, typename Node>
T *dynCast(const std::unique_ptr<Node> &node) {
  return dynCast<T>(node.get());
}

} // namespace rtsl
