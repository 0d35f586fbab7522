//===- FirstFew.h - the first of many items, in any order -----------------===//
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <utility>
#include <vector>

namespace rtsl {

/// Keeps the `most` items that come first by `Less`, and counts all.
template <typename Item, typename Less>
class FirstFew {
public:
  explicit FirstFew(std::size_t most, Less less = {}) : most(most), less(less) {}

  void add(Item item) {
    ++count;
    items.push_back(std::move(item));
    if (items.size() >= 2 * most + 1) // rare enough to cost little
      shorten();
  }

  void add(FirstFew &&other) {
    count += other.count;
    items.insert(items.end(), std::make_move_iterator(other.items.begin()),
                 std::make_move_iterator(other.items.end()));
    shorten();
  }

  std::uint64_t total() const { return count; }

  /// The first items in their order.
  std::vector<Item> take() {
    shorten();
    std::sort(items.begin(), items.end(), less);
    return std::move(items);
  }

private:
  void shorten() {
    if (items.size() <= most)
      return;
    std::nth_element(items.begin(), items.begin() + std::ptrdiff_t(most), items.end(), less);
    items.erase(items.begin() + std::ptrdiff_t(most), items.end());
  }

  std::size_t most;
  Less less;
  std::vector<Item> items;
  std::uint64_t count = 0;
};

} // namespace rtsl
