//===- HostTraversal.cpp - rtsl_traverse on the host ----------------------===//
#include "runtime/embree/HostScene.h"

#include "runtime/device/traverse/AnyHit.h"
#include "runtime/embree/EmbreeRay.h"

#include <algorithm>
#include <utility>

namespace rtsl::runtime {

RayCounters &rayCounters() {
  static thread_local RayCounters counters;
  return counters;
}

HostScene::HostScene(const Scene &scene, bool useEmbree, unsigned threads,
                     std::optional<TreeKind> tree, KeptTrees kept)
    : ProgramHost{scene.program().slots}, scene(scene), threads(threads), tree(tree),
      structure(scene.structure()), moves(scene.moves()), own(std::move(kept.own)) {
  if (useEmbree) {
    buildEmbree(std::move(kept.embree));
  } else {
    deviceLaunch();
    refitted = own.treeFigures()->isRefitted;
  }
}

void HostScene::buildEmbree(std::unique_ptr<EmbreeScene> kept) {
  embree = std::move(kept);
  refitted = embree && embree->follow(scene, slots, threads);
  if (!refitted)
    embree = std::make_unique<EmbreeScene>(scene, slots, threads);
  seenByAll = nullptr;
  const RtslLaunch all = scene.launch();
  const bool isHidden =
      std::any_of(all.instances, all.instances + all.instanceCount,
                  [](const RtslInstance &instance) { return instance.mask == 0; });
  if (!(all.needs & (RTSL_HAS_ROOTS | RTSL_HAS_SELECTORS)) && !isHidden)
    seenByAll = embree.get();
}

void HostScene::buildOwnTree() const {
  launch = scene.launch();
  own.follow(launch, threads, tree);
  launch.host = this;
  own.trees().install(launch);
}

const RtslLaunch &HostScene::deviceLaunch() const {
  std::call_once(built, [this] { buildOwnTree(); });
  return launch;
}

void HostScene::update() {
  if (hasOwnTree()) { // something else may have changed
    launch = scene.launch();
    launch.host = this;
    own.trees().install(launch);
  }
  const bool isOther = structure != scene.structure();
  if (!isOther && moves == scene.moves())
    return;
  structure = scene.structure();
  moves = scene.moves();
  if (embree) {
    if (isOther)
      buildEmbree();
    else
      embree->update(scene, threads);
  }
  if (hasOwnTree())
    buildOwnTree();
}

KeptTrees HostScene::takeTrees() {
  if (embree)
    embree->rememberBoxes();
  return {std::move(embree), std::move(own)};
}

/// Searches any tree.
template <typename Tree>
std::uint32_t HostScene::search(RtslState &state, std::uint32_t how, const Tree &tree) const {
  return how & RTSL_INVOKE_ANY_HIT ? device::findHitAsking(state, how, FilledSlots{slots}, tree)
                                   : device::findHit(state, how, FilledSlots{slots}, tree);
}

/// Searches our own tree, with a launch that has it: the ray's launch may not have one.
std::uint32_t HostScene::searchOwnTree(RtslState &state, std::uint32_t how) const {
  const RtslLaunch *given = state.launch;
  if (given->nodeCount != 0)
    return search(state, how, device::LaunchTree{false});
  deviceLaunch();
  RtslLaunch withNodes = *given;
  own.trees().install(withNodes);
  state.launch = &withNodes;
  std::uint32_t answer = search(state, how, device::LaunchTree{false});
  state.launch = given;
  return answer;
}

/// Any ray, including those whose hits may be rejected, and those that do not see all instances.
[[gnu::cold, gnu::noinline]] std::uint32_t HostScene::traverseAny(RtslState &state,
                                                                  std::uint32_t how) const {
  if (!device::isGoodRay(state)) {
    ++rayCounters().badRays;
    return RTSL_BAD_RAY;
  }
  if (!embree)
    return searchOwnTree(state, how);
  if (!EmbreeScene::canFollow(state)) {
    ++rayCounters().retracedRays;
    return searchOwnTree(state, how);
  }
  if (how & RTSL_INVOKE_ANY_HIT || state.rayMask != ~0u || state.rayRoot != 0 || !seenByAll)
    return search(state, how, EmbreeTree{*embree});
  const device::ModerateSearch moderate(state, how);
  return embree->traverse(state, how);
}

[[gnu::always_inline]] inline std::uint32_t HostScene::traverseFast(RtslState &state,
                                                                    std::uint32_t how) const {
  if (how & RTSL_INVOKE_ANY_HIT || state.rayMask != ~0u || state.rayRoot != 0 || !seenByAll ||
      !EmbreeScene::isEasy(state))
    return traverseAny(state, how);
  return seenByAll->traverseEasy(state, how);
}

std::uint32_t HostScene::traverse(RtslState &state, std::uint32_t how) const {
  return traverseFast(state, how);
}

} // namespace rtsl::runtime

// Flattened, because calls pass vectors of three by value through memory.
extern "C" [[gnu::flatten]] std::uint32_t rtsl_traverse(RtslState *state, std::uint32_t how) {
  return static_cast<const rtsl::runtime::HostScene *>(state->launch->host)
      ->traverseFast(*state, how);
}
