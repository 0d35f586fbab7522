//===- SearchTriangles.h - a ray through the triangles of a space ---------===//
#pragma once

#include "runtime/accel/BlockSearch.h"
#include "runtime/embree/EmbreeContext.h"
#include "support/Fibers.h"

#include <cstdint>

namespace rtsl::runtime {

/// Passes the triangles that the ray may hit to its visitor. True if the search is over.
template <typename Ray>
[[gnu::cold, gnu::noinline]] bool visitTriangles(const EmbreeContext &context) {
  const Ray &ray = context.rayAs<Ray>();
  const auto visit = [&](std::uint32_t place) {
    const TriangleBlock &block = context.space->triangles.block(place);
    for (unsigned i = 0; i < TriangleBlock::lanes && block.instance[i] != RTSL_NO_HIT; ++i)
      if (context.visitItem({device::instanceOf(ray, block.instance[i]), block.triangle[i]}))
        return true;
    return false;
  };
  return searchBlocks(
      context.space->triangles, ray, context.state->Epsilon, [&] { return context.limit(); },
      visit);
}

/// Searches the triangles of the space for the nearest hit, or for any. True if the search is over.
/// While a node or a block is loaded, other rays of this thread go on, if it has any.
template <typename Ray, bool anyHit>
[[gnu::noinline]] bool searchTriangles(const EmbreeContext &context) {
  RtslState &state = *context.state;
  const Ray &ray = context.rayAs<Ray>();
  const auto test = [&](std::uint32_t place) {
    const TriangleBlock &block = context.space->triangles.block(place);
    const Occluder item = {place, false};
    if constexpr (anyHit) {
      if (!testBlock(state, ray, block, true))
        return false;
      context.occluder = item;
      return true;
    } else {
      if (context.isTested(item) || !testBlock(state, ray, block, false))
        return false;
      context.found = item;
      return context.endsAtHit(item);
    }
  };
  const BlockTree &tree = context.space->triangles;
  const auto limit = [&] { return state.nearest; };
  Fibers *const fibers = Fibers::ofThread();
  if (!fibers)
    return searchBlocks(tree, ray, state.Epsilon, limit, test);
  return searchBlocks(tree, ray, state.Epsilon, limit, test, [&](std::uint32_t child) {
    tree.prefetch(child);
    fibers->pause();
  });
}

/// The same, whatever the search is for.
template <typename Ray>
bool searchTriangles(const EmbreeContext &context, bool anyHit) {
  if (__builtin_expect(context.visitor != nullptr, 0))
    return visitTriangles<Ray>(context);
  return anyHit ? searchTriangles<Ray, true>(context) : searchTriangles<Ray, false>(context);
}

} // namespace rtsl::runtime
