//===- Bvh.h - traversal of the tree --------------------------------------===//
//
// Nodes have up to eight children, whose boxes are on a grid (RtslBvhNode). A child is entered
// wherever rangeInBox finds a range in the box of an item in it; docs/gpu.md has the proof. So what
// BoxRange.h says of nested boxes (rangeShare) holds, and the grid affects only the time.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Launch.h"
#include "runtime/device/ray/Vector.h"
#include "runtime/device/ray/Warp.h"
#include "runtime/device/traverse/BoxRange.h"
#include "runtime/device/traverse/TreeVisits.h"
#include "runtime/device/traverse/Triangle.h"

namespace rtsl::device {

/// No path from the root is longer, as the builder guarantees
/// (runtime/accel/trees/BinaryTree.h). Each step down pushes one entry at most.
constexpr int maxBvhDepth = 64;

/// Items are put off if fewer than one in this many lanes would test them; and only if this many
/// entries are on the stack at most.
constexpr int fewLanes = 5, mostPutOff = 32;

/// Sixteen bytes of memory that nobody writes while the program runs.
struct Words {
  uint32_t word[4];
};

/// Loaded at once: the compiler would divide a load of which it reads only parts.
inline Words wordsAt(const void *address, int number) {
  Words words;
  const char *from = static_cast<const char *>(address) + sizeof words * size_t(number);
#ifdef __NVPTX__
  asm("ld.global.nc.v4.b32 {%0, %1, %2, %3}, [%4];"
      : "=r"(words.word[0]), "=r"(words.word[1]), "=r"(words.word[2]), "=r"(words.word[3])
      : "l"((const __attribute__((address_space(1))) char *)from));
#else
  __builtin_memcpy(&words, from, sizeof words);
#endif
  return words;
}

inline uint32_t byteOf(uint32_t word, int i) {
  return word >> (8 * i) & 0xff;
}

/// The words of a node.
struct NodeWords {
  Words words[5];

  explicit NodeWords(const RtslBvhNode &node) {
    for (int i = 0; i < 5; ++i)
      words[i] = wordsAt(&node, i);
  }

  uint32_t word(int i) const { return words[i / 4].word[i % 4]; }
  float origin(int axis) const { return floatOf(word(axis)); }
  /// As RtslBvhNode::exponent, by axis.
  uint32_t exponent(int axis) const { return byteOf(word(3), axis); }
  uint32_t inner() const { return word(3) >> 24; }
  uint32_t firstNode() const { return word(4); }
  uint32_t firstItem() const { return word(5); }
  // Of four slots, the lower ones or the upper ones:
  uint32_t children(int half) const { return word(6 + half); }
  uint32_t sides(int axis, int half, bool isUpper) const {
    const uint32_t lower = word(8 + 2 * axis + half), upper = word(14 + 2 * axis + half);
    return isUpper ? upper : lower;
  }
};
static_assert(offsetof(RtslBvhNode, inner) == 15 && offsetof(RtslBvhNode, firstNode) == 16 &&
              offsetof(RtslBvhNode, child) == 24 && offsetof(RtslBvhNode, lower) == 32 &&
              offsetof(RtslBvhNode, upper) == 56 && sizeof(RtslBvhNode) == 80);

inline float stepOfGrid(uint32_t exponent) {
  return floatOf(exponent << 23);
}

/// The distances at which a ray crosses the planes of a grid, along one axis: plane n at
/// fused(n, step, near), or far.
struct GridAxis {
  float step;
  float near, far; // of plane 0, for sides where the ray enters and leaves
  float size;      // if this is not too large, no other number is

  GridAxis(const NodeWords &node, int axis, float origin, float inverse) {
    step = stepOfGrid(node.exponent(axis)) * inverse;
    const float corner = (node.origin(axis) - origin) * inverse;
    // More than all that rounding changes, here and in rangeInBox, and than bvhSlack.
    const float slack =
        fused(absolute(step), 0x1p-11f, fused(absolute(corner), 0x1p-19f, 0x1p-140f));
    near = corner - slack;
    far = corner + slack;
    size = absolute(step) + absolute(corner);
  }

  float enters(uint32_t planes, int i) const { return fused(float(byteOf(planes, i)), step, near); }
  float leaves(uint32_t planes, int i) const { return fused(float(byteOf(planes, i)), step, far); }
};

/// The bits with which slots are flipped in sets of children, so that nearer ones come later.
inline uint32_t flippedSlots(const TriangleRay &ray) {
  return (ray.inverse.x < 0 ? 0u : 1u) | (ray.inverse.y < 0 ? 0u : 2u) |
         (ray.inverse.z < 0 ? 0u : 4u);
}

/// What the ray may enter of a child of the node, as a set of bits: its items, from bit 0 on, or
/// bit 24 + (its slot with bits flipped) if it is a node.
inline uint32_t childBits(uint8_t child, uint32_t flipped) {
  const uint32_t position = child & 0x1fu;
  return uint32_t(child >> 5) << (position < 24 ? position : position ^ flipped);
}

/// The children that the ray may enter between tMin and tMax, by rangeInBox for the boxes as
/// floats: for numbers of any size, and slower than enteredChildren.
inline uint32_t enteredExactly(const RtslBvhNode &node, const TriangleRay &ray, uint32_t flipped,
                               float tMin, float tMax) {
  uint32_t entered = 0;
#ifdef __clang__
#pragma clang loop unroll(disable)
#endif
  for (int slot = 0; slot < 8; ++slot) {
    float lower[3], upper[3];
    for (int axis = 0; axis < 3; ++axis) {
      const float step = stepOfGrid(node.exponent[axis]);
      lower[axis] = fused(float(node.lower[axis][slot]), step, node.origin[axis]);
      upper[axis] = fused(float(node.upper[axis][slot]), step, node.origin[axis]);
    }
    if (enterBox(lower, upper, ray.origin, ray.inverse, tMin, tMax) < infinity)
      entered |= childBits(node.child[slot], flipped);
  }
  return entered;
}

/// The children that the ray may enter between tMin and tMax. `inMemory` is the same node.
inline uint32_t enteredChildren(const NodeWords &node, const RtslBvhNode &inMemory,
                                const TriangleRay &ray, uint32_t flipped, float tMin, float tMax) {
  const GridAxis x(node, 0, ray.origin.x, ray.inverse.x), y(node, 1, ray.origin.y, ray.inverse.y),
      z(node, 2, ray.origin.z, ray.inverse.z);
  if (!((x.size + y.size) + z.size < 0x1p100f))
    return enteredExactly(inMemory, ray, flipped, tMin, tMax);
  const bool isDownX = ray.inverse.x < 0, isDownY = ray.inverse.y < 0, isDownZ = ray.inverse.z < 0;
  uint32_t entered = 0;
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
  for (int half = 0; half < 2; ++half) {
    const uint32_t nearX = node.sides(0, half, isDownX), farX = node.sides(0, half, !isDownX),
                   nearY = node.sides(1, half, isDownY), farY = node.sides(1, half, !isDownY),
                   nearZ = node.sides(2, half, isDownZ), farZ = node.sides(2, half, !isDownZ);
    // childBits for four children at once
    const uint32_t children = node.children(half);
    const uint32_t isInner = (children & children << 1) & 0x10101010u;
    const uint32_t positions =
        (children ^ (flipped * 0x01010101u & (isInner >> 4) * 0xffu)) & 0x1f1f1f1fu;
    const uint32_t bits = children >> 5 & 0x07070707u;
#ifdef __clang__
#pragma clang loop unroll(full)
#endif
    for (int i = 0; i < 4; ++i) {
      const float near =
          raised(raised(raised(tMin, x.enters(nearX, i)), y.enters(nearY, i)), z.enters(nearZ, i));
      const float far =
          lowered(lowered(lowered(tMax, x.leaves(farX, i)), y.leaves(farY, i)), z.leaves(farZ, i));
      if (near <= far)
        entered |= byteOf(bits, i) << byteOf(positions, i);
    }
  }
  return entered;
}

/// A part of what a traversal has still to visit: bits 31 to 24 of `bits` are children of a node
/// that are to be visited, the largest first, bits 7 to 0 are the slots of all its children that
/// are nodes, and `first` is the first of these in memory. If bits 31 to 24 are 0, the others are
/// items from `first` on.
struct alignas(8) Open {
  uint32_t first, bits;

  bool hasNodes() const { return bits >> 24 != 0; }
};

/// What follows the test of an item: the next one, the items of the instance that the ray has
/// entered, or nothing.
enum class Next { Item, Inside, Nothing };

/// Visits the items of the world's tree that may have hits between tMin and tMax(), those of
/// nearer boxes first on the whole. tMax() may shrink meanwhile; it is called once a node. If it
/// `putsOff` items, those that only few lanes of a warp would test wait for others.
///
/// `Spaces` has ray(), and test(item), which gives Next. If `isNested`, test() may enter the space
/// of an instance: ray() is then the ray there, the items below root() follow, and after them
/// leave(), where the ray is again as it was; there are no spaces in such spaces. One loop visits
/// both kinds of trees, so that the lanes of a warp need not be in the same one, and the code is
/// there once.
template <bool isNested, typename Limit, typename Spaces>
void traverseSpaces(const RtslLaunch &launch, Spaces &spaces, float tMin, Limit tMax,
                    bool putsOff) {
  // Covers cullSlack, and bvhSlack on top.
  constexpr float slack = cullSlack + 0x1p-18f;
  tMin *= 1.0f - 2 * rangeShare;
  uint32_t flipped = flippedSlots(spaces.ray());
  const RtslBvhNode *const nodes = launch.nodes;
  const RtslTreeItem *const treeItems = launch.treeItems;
  TreeVisits visits(launch);
  // Of each tree at most one entry a level, what is put off, and the rest of the items of the leaf
  // from which an instance was entered.
  Open stack[(isNested ? 2 : 1) * maxBvhDepth + mostPutOff + isNested];
  constexpr int inNone = -1;
  int top = 0;
  int outside = inNone; // the entries below it are of the outer tree, where the ray is in an inner
  Open open = {0, 1u << (24 + flipped)}; // the root
  for (;;) {
    uint32_t firstItem = open.first, items = open.bits;
    if (open.hasNodes()) {
      const uint32_t next = 31u - uint32_t(__builtin_clz(open.bits));
      const uint32_t slot = (next & 7) ^ flipped;
      const uint32_t before = uint32_t(__builtin_popcount(open.bits & ((1u << slot) - 1)));
      const RtslBvhNode &inMemory = nodes[open.first + before];
      open.bits &= ~(1u << next);
      if (open.hasNodes())
        stack[top++] = open;
      visits.node();
      const NodeWords node(inMemory);
      const uint32_t entered =
          enteredChildren(node, inMemory, spaces.ray(), flipped, tMin, tMax() * slack);
      firstItem = node.firstItem();
      items = entered & 0x00ffffffu;
      open = {node.firstNode(), (entered & 0xff000000u) | node.inner()};
    } else {
      open.bits = 0;
    }
    for (const int lanes = lanesHere(); items != 0; items &= items - 1) {
      if (putsOff && open.hasNodes() && top < mostPutOff && lanesHere() * fewLanes < lanes) {
        stack[top++] = {firstItem, items};
        break;
      }
      visits.item();
      const Next next = spaces.test(treeItems[firstItem + uint32_t(__builtin_ctz(items))]);
      if (next == Next::Nothing)
        return;
      if (isNested && next == Next::Inside) {
        if (open.hasNodes())
          stack[top++] = open;
        if ((items & (items - 1)) != 0)
          stack[top++] = {firstItem, items & (items - 1)};
        outside = top;
        flipped = flippedSlots(spaces.ray());
        open = {spaces.root(), 1u << (24 + flipped)};
        break;
      }
    }
    if (!open.hasNodes()) {
      if (isNested && top == outside) {
        outside = inNone;
        spaces.leave();
        flipped = flippedSlots(spaces.ray());
      }
      if (top == 0)
        return;
      open = stack[--top];
    }
  }
}

/// The same where all items are in one space: calls test(item), which returns true to stop.
template <typename Limit, typename Test>
void traverseBvh(const RtslLaunch &launch, const TriangleRay &ray, float tMin, Limit tMax,
                 bool putsOff, Test test) {
  struct OneSpace {
    const TriangleRay &inIt;
    Test &isLast;

    const TriangleRay &ray() const { return inIt; }
    Next test(const RtslTreeItem &item) { return isLast(item) ? Next::Nothing : Next::Item; }
    static uint32_t root() { return 0; }
    static void leave() {}
  } space = {ray, test};
  traverseSpaces<false>(launch, space, tMin, tMax, putsOff);
}

} // namespace rtsl::device
