//===- ItemList.h - a few items of the world, without a tree --------------===//
//
// Embree calls back for each primitive and each instance that a ray reaches. If the world has few
// of them, they are not in Embree's tree: a ray tests all of their boxes, eight at a time, and
// then the items whose boxes it enters. What these hit makes the search of the tree, which has only
// triangles then, shorter.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/TriangleBlock.h"
#include "runtime/device/traverse/EightRanges.h"

#include <array>
#include <cstdint>
#include <vector>

namespace rtsl::runtime {

class ItemList {
public:
  static constexpr std::size_t most = 32;

  /// The parts of a ray in the boxes of items.
  struct Entered {
    std::uint32_t items; // bit i: item i is entered before the limit
    // of those: device::rangeInBox, widened; they hold no hit elsewhere
    alignas(32) float near[most], far[most];

    device::Range range(unsigned item) const { return {near[item], far[item]}; }

    /// Takes out the item that is entered first; there must be one.
    unsigned takeNearest() {
      auto nearest = unsigned(__builtin_ctz(items));
      for (std::uint32_t others = items & (items - 1); others != 0; others &= others - 1) {
        const auto i = unsigned(__builtin_ctz(others));
        nearest = near[i] < near[nearest] ? i : nearest;
      }
      items &= ~(1u << nearest);
      return nearest;
    }
  };

  ItemList() = default;
  /// At most `most` boxes.
  explicit ItemList(const std::vector<RtslBox> &boxes)
      : eights((boxes.size() + lanes - 1) / lanes) {
    for (std::size_t i = 0; i < lanes * eights; ++i)
      for (int axis = 0; axis < 3; ++axis) {
        const bool isEmpty = i >= boxes.size(); // then no ray enters it
        EightBoxes &eight = groups[i / lanes];
        eight.sides[0][axis][i % lanes] = isEmpty ? device::infinity : boxes[i].lower[axis];
        eight.sides[1][axis][i % lanes] = isEmpty ? -device::infinity : boxes[i].upper[axis];
      }
  }

  bool isEmpty() const { return eights == 0; }

  /// The items that may have hits from `epsilon` on, up to `limit`.
  [[gnu::always_inline]] Entered enter(const device::TriangleRay &ray, float epsilon,
                                       float limit) const {
    Entered entered;
    std::uint32_t items = 0; // in a register: in `entered` it would be stored and loaded again
    for (std::size_t i = 0; i < eights; ++i)
      items |= enterEight(ray, groups[i], epsilon, limit, entered.near + lanes * i,
                          entered.far + lanes * i)
               << lanes * i;
    entered.items = items;
    return entered;
  }

private:
  static constexpr std::size_t lanes = TriangleBlock::lanes;
  struct alignas(32) EightBoxes {
    float sides[2][3][lanes]; // lower, upper
  };

  /// Returns the lanes that are entered.
  [[gnu::always_inline]] static unsigned enterEight(const device::TriangleRay &ray,
                                                    const EightBoxes &boxes, float epsilon,
                                                    float limit, float *nears, float *fars) {
    device::EightRanges ranges;
#pragma GCC unroll 3
    for (int axis = 0; axis < 3; ++axis) {
      const float inverse = ray.inverse[axis];
      const unsigned first = inverse < 0; // an index, because a branch would often be mispredicted
      ranges.narrow(_mm256_load_ps(boxes.sides[first][axis]),
                    _mm256_load_ps(boxes.sides[1 - first][axis]), ray.origin[axis], inverse);
    }
    const unsigned entered = ranges.widen(epsilon, limit);
    _mm256_store_ps(nears, ranges.near);
    _mm256_store_ps(fars, ranges.far);
    return entered;
  }

  std::size_t eights = 0;
  std::array<EightBoxes, most / lanes> groups;
};

} // namespace rtsl::runtime
