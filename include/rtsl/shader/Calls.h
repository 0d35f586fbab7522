//===- Calls.h - methods that trace and are called through references ------===//
//
// Such a method was split at its traces like any other, and its caller at the call. Its frame lies
// above that of the caller, for it is the same ray's: RTSL_CALL_HEADER bytes that say where the
// caller goes on, then what it was given and returns, then what it needs when its own rays come
// back.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "rtsl/shader/Rays.h"

#include <new>

extern "C" {
/// The ray goes on with `object`, on a frame above what ends at `end` (null: the caller has none);
/// `resume` is the state in which the caller goes on. Gives where arguments lie.
void *rtsl_call(RtslState *state, const void *end, std::int32_t resume, RtslRef object);
/// The caller's frame and object again. Gives the state that follows.
std::int32_t rtsl_return(RtslState *state);
}

namespace rtsl {
inline namespace RTSL_ARITHMETIC {

namespace detail {
/// A frame begins at a multiple of eight bytes, for it may hold addresses.
inline char *frameBehind(void *end) {
  const auto at = reinterpret_cast<std::uintptr_t>(end);
  return static_cast<char *>(end) + (8 - at % 8) % 8;
}
} // namespace detail

/// Runs a method of `object` on a frame of its own, then the state `after` of the caller, whose
/// frame is `frame`. `call` says which method it is, and what it is given.
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

/// A method that was called is over.
template <int N>
inline Next returnToCaller(State<N> &rt) {
  return rtsl_return(rawState(rt));
}

/// The frame of a method that was called.
template <typename Frame>
inline Frame &calledFrameAt(void *memory) {
  return frameAt<Frame>(static_cast<char *>(memory) + RTSL_CALL_HEADER);
}

/// What the method that this frame's has called was given and returned.
template <typename Call, typename Frame>
inline const Call &callAbove(Frame &frame) {
  return calledFrameAt<Call>(detail::frameBehind(&frame + 1));
}
/// The same where the caller has no frame.
template <typename Call>
inline const Call &callAbove(void *memory) {
  return calledFrameAt<Call>(memory);
}

} // namespace RTSL_ARITHMETIC
} // namespace rtsl
