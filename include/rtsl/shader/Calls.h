//===- Calls.h - methods that trace, called through references ------------===//
//
// Such a method was split at its traces like any other, and its caller at the call. Its frame is
// above that of the caller, because it belongs to the same ray: RTSL_CALL_HEADER bytes for
// returning to the caller, then its arguments and result, then the values that it needs after its
// own traces.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Rays.h"

#include <new>

extern "C" {
/// The ray continues with `object`, on a frame above `end` (null: the caller has none); `resume` is
/// the state in which the caller continues. Returns the address of the arguments.
void *rtsl_call(RtslState *state, const void *end, std::int32_t resume, RtslRef object);
/// Restores the caller's frame and object. Returns the next state.
std::int32_t rtsl_return(RtslState *state);
}

namespace rtsl {
inline namespace RTSL_ARITHMETIC {

namespace detail {
/// A frame begins at a multiple of eight bytes, because it may contain addresses.
inline char *frameAfter(void *end) {
  const auto at = reinterpret_cast<std::uintptr_t>(end);
  return static_cast<char *>(end) + (8 - at % 8) % 8;
}
} // namespace detail

/// Runs a method of `object` on a frame of its own, then the state `after` of the caller, whose
/// frame is `frame`. `call` has the method and its arguments.
template <int N, typename Frame, typename Step, typename Call>
inline Next callThen(State<N> &rt, const Frame &frame, Step after, Reference object,
                     const Call &call) {
  new (rtsl_call(rawState(rt), &frame + 1, static_cast<Next>(after), object.object)) Call(call);
  return -static_cast<Next>(Call::begin);
}
/// The same where the caller has no frame.
template <int N, typename Step, typename Call>
inline Next callThen(State<N> &rt, Step after, Reference object, const Call &call) {
  new (rtsl_call(rawState(rt), nullptr, static_cast<Next>(after), object.object)) Call(call);
  return -static_cast<Next>(Call::begin);
}

/// Returns from a called method.
template <int N>
inline Next returnToCaller(State<N> &rt) {
  return rtsl_return(rawState(rt));
}

/// The frame of a called method.
template <typename Frame>
inline Frame &calledFrameAt(void *memory) {
  return frameAt<Frame>(static_cast<char *>(memory) + RTSL_CALL_HEADER);
}

/// The arguments and result of the method that this frame's method has called.
template <typename Call, typename Frame>
inline const Call &callAbove(Frame &frame) {
  return calledFrameAt<Call>(detail::frameAfter(&frame + 1));
}
/// The same where the caller has no frame.
template <typename Call>
inline const Call &callAbove(void *memory) {
  return calledFrameAt<Call>(memory);
}

} // namespace RTSL_ARITHMETIC
} // namespace rtsl
