//===- BlockSearch.h - a ray through a tree over blocks -------------------===//
//
// Children are entered wherever rangeInBox finds a range, so what BoxRange.h says of nested boxes
// (rangeShare) holds: the tree and the order of its children affect only the time. Nothing depends
// on jumps that a processor cannot predict but whether a child is a block and when a node is done.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/accel/BlockTree.h"
#include "runtime/device/traverse/Bvh.h"
#include "runtime/device/traverse/EightRanges.h"

#include <immintrin.h>

#include <cstddef>
#include <cstdint>

namespace rtsl::runtime {

/// Which children of a node a ray enters, and how far away: for each the upper 16 bits of the
/// distance, which order as the distances do, because these are not negative; noChild for the
/// others.
class Entered {
public:
  static constexpr std::uint32_t noChild = 0xffff;

  Entered() = default;
  /// Those that are entered no later than they are left.
  [[gnu::always_inline]] Entered(__m256 near, __m256 far) {
    const __m256 isMissed = _mm256_cmp_ps(near, far, _CMP_NLE_UQ); // all bits
    const __m256i upper = _mm256_srli_epi32(_mm256_castps_si256(_mm256_or_ps(near, isMissed)), 16);
    distances = _mm_packus_epi32(_mm256_castsi256_si128(upper), _mm256_extracti128_si256(upper, 1));
  }

  static std::uint32_t upperBits(float distance) {
    std::uint32_t bits;
    __builtin_memcpy(&bits, &distance, sizeof bits);
    return bits >> 16;
  }

  struct Nearest {
    std::uint32_t slotAndDistance;

    std::uint32_t distance() const { return slotAndDistance & 0xffff; }
    unsigned slot() const { return slotAndDistance >> 16; }
  };
  Nearest nearest() const {
    return {std::uint32_t(_mm_cvtsi128_si32(_mm_minpos_epu16(distances)))};
  }

  bool isEmpty() const { return _mm_test_all_ones(distances); }

  void remove(unsigned slot) {
    constexpr std::uint16_t none = noChild;
    static constexpr std::uint16_t ones[15] = {0, 0, 0, 0, 0, 0, 0, none};
    const auto *from = reinterpret_cast<const __m128i *>(ones + 7 - slot);
    distances = _mm_or_si128(distances, _mm_loadu_si128(from));
  }

private:
  __m128i distances; // by slot, 16 bits each
};

/// A ray as the boxes of nodes need it.
class BoxRay {
public:
  /// `ray` must outlive it.
  [[gnu::always_inline]] BoxRay(const device::TriangleRay &ray, float tMin)
      : ray(ray), sides{sideAlong(0, ray.inverse.x), sideAlong(1, ray.inverse.y),
                        sideAlong(2, ray.inverse.z)},
        // not below 0, as distances in boxes, so that their bits are in order (Entered)
        tMin(_mm256_set1_ps(tMin > 0 ? tMin * (1.0f - 2 * device::rangeShare) : 0.0f)) {}

  /// The children of the node that it enters before tMax.
  [[gnu::always_inline]] Entered enter(const BlockNode &node, float tMax) const {
    device::EightRanges ranges;
    ranges.near = tMin;
    ranges.far = _mm256_set1_ps(tMax);
    const auto narrow = [&](int axis, float origin, float inverse) {
      const unsigned enters = sides[axis], leaves = unsigned(2 * axis + 3) - enters;
      ranges.narrow(_mm256_load_ps(node.sides[enters]), _mm256_load_ps(node.sides[leaves]), origin,
                    inverse);
    };
    narrow(0, ray.origin.x, ray.inverse.x);
    narrow(1, ray.origin.y, ray.inverse.y);
    narrow(2, ray.origin.z, ray.inverse.z);
    return {ranges.near, ranges.far * _mm256_set1_ps(device::bvhSlack)};
  }

private:
  /// The number of the side at which the ray enters boxes along an axis, in BlockNode::sides.
  static unsigned sideAlong(unsigned axis, float inverse) { return axis + 3 * (inverse < 0); }

  const device::TriangleRay &ray;
  const unsigned sides[3]; // where it enters, by axis
  const __m256 tMin;
};

struct NoPause {
  void operator()(std::uint32_t) const {}
};

/// Calls test(place) for each block that may have hits between tMin and limit(), nearer ones first
/// on the whole. limit() may shrink in a test. test returns true to stop; then so does this.
/// Before a child of a node is read, pause(child) is called (BlockNode::children).
template <typename Limit, typename Test, typename Pause = NoPause>
[[gnu::always_inline]] inline bool searchBlocks(const BlockTree &tree,
                                                const device::TriangleRay &ray, float tMin,
                                                Limit limit, Test test, Pause pause = {}) {
  if (tree.isEmpty())
    return false;
  struct Open {
    Entered children; // those that have still to be visited
    const BlockNode *node;
  };
  Open stack[device::maxBvhDepth + 1]; // the last one is written, but never kept
  Open *top = stack;
  const BoxRay boxRay(ray, tMin);
  float end = limit() * device::cullSlack;
  std::uint32_t endBits = Entered::upperBits(end);
  Open open;
  open.node = tree.nodes.begin();
  open.children = boxRay.enter(*open.node, end);
  for (;;) {
    const Entered::Nearest nearest = open.children.nearest();
    if (nearest.distance() > endBits) {
      if (top == stack)
        return false;
      open = *--top;
      continue;
    }
    const std::uint32_t child = open.node->children[nearest.slot()];
    open.children.remove(nearest.slot());
    pause(child);
    if (child & BlockNode::isBlock) {
      if (test(child & ~BlockNode::isBlock))
        return true;
      end = limit() * device::cullSlack;
      endBits = Entered::upperBits(end);
      continue;
    }
    *top = open;
    top += !open.children.isEmpty();
    tree.prefetch(open.node->children[open.children.nearest().slot()]); // what may be visited next
    open.node = &tree.node(child);
    open.children = boxRay.enter(*open.node, end);
  }
}

} // namespace rtsl::runtime
