//===- Selector.h - instances that rays see by choice ---------------------===//
//
// A selector decides for each ray which of its children the ray may enter: `visit` calls visitChild
// for them. It runs when a traversal reaches the box of an instance below the selector, as often as
// that happens, and must give the same answer each time: it sees the ray and its own object, and
// random numbers of its own. So what a ray sees does not depend on the order of a traversal.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/traverse/Instance.h"

namespace rtsl::device {

/// The first dimension of the random numbers in `visit` of a selector: beyond those of any method
/// that runs once per ray, and different for each selector. `first` is the selection of its child
/// 0, which depends on the selectors of the scene alone, and not on where records lie. Multiples of
/// the golden ratio are far apart, so that `visit` may draw many numbers.
inline uint32_t dimensionOfSelector(uint32_t first) {
  return 0xc0000000u | (first * 0x9e3779b9u) >> 4;
}

/// `visitChild(child)`.
inline void visitChild(RtslState &state, int32_t child) {
  if (child == state.wantedChild)
    state.isChildVisited = 1;
}

/// Does the selector admit the ray on this path, which is `number` of RtslLaunch::selections?
/// visit(state, object) is the slot of rt_Selector.
template <typename Slots>
bool isTaken(RtslState &state, uint32_t number, const Slots &slots) {
  const RtslSelection &selection = state.launch->selections[number];
  const uint32_t dimension = state.dimension;
  state.dimension = dimensionOfSelector(number - uint32_t(selection.child));
  state.wantedChild = selection.child;
  state.isChildVisited = 0;
  if (rtsl_needs(state.launch) & RTSL_NEEDS_TRANSFORMS)
    describeTransforms(state, selection.transform);
  {
    const InObjectSpace space(state, selection.transform);
    slots.rt_Selector_visit(&state, selection.selector);
  }
  state.dimension = dimension;
  return state.isChildVisited;
}

/// Do all selectors above the instance let the ray reach it?
template <typename Slots>
bool isSelected(RtslState &state, const RtslInstance &instance, const Slots &slots) {
  if (!(rtsl_needs(state.launch) & RTSL_HAS_SELECTORS))
    return true;
  for (uint32_t number = instance.selection; number != 0;
       number = state.launch->selections[number].above)
    if (!isTaken(state, number, slots))
      return false;
  return true;
}

} // namespace rtsl::device
