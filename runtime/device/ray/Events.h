//===- Events.h - what happens in a sample, apart from its color ----------===//
//
// Exceptions. The first that a sample meets ends it: its rays send no more rays, and when the
// active shaders have returned, their color is discarded and the `exception` of the scene sets that
// of the sample. Programs that were compiled without exceptions contain none of this code, because
// rtsl_features is a constant.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "runtime/device/ray/Abi.h"
#include "runtime/device/ray/Color.h"
#include "runtime/device/ray/Warp.h"

namespace rtsl::device {

inline bool hasEvents(const RtslState &state) {
  return rtsl_features(const_cast<RtslState *>(&state)) & RTSL_FEATURE_EVENTS;
}

inline bool hasExceptions(const RtslState &state) {
  return rtsl_features(const_cast<RtslState *>(&state)) & RTSL_FEATURE_EXCEPTIONS;
}

inline void startEvents(RtslState &state, RtslEvents &events, uint32_t x, uint32_t y,
                        uint32_t sample) {
  if (!hasEvents(state))
    return;
  events = {x, y, sample, RTSL_EXCEPTION_NONE, 0};
  state.events = &events;
}

/// RtslEvents::x of a call of which only the values matter, not what it prints.
constexpr uint32_t unheard = 0xffffffffu;

inline void raise(const RtslState &state, uint32_t exception) {
  if (hasExceptions(state) && state.events && state.events->exception == RTSL_EXCEPTION_NONE)
    state.events->exception = exception;
}

/// Has the sample met an exception that ends it?
inline bool isAbandoned(const RtslState &state) {
  bool heeds = !(rtsl_features(const_cast<RtslState *>(&state)) & RTSL_FEATURE_UNHEEDED);
  return hasExceptions(state) && heeds && state.events->exception != RTSL_EXCEPTION_NONE;
}

/// The color of a sample with an exception that no object of the scene handles: red, yellow or
/// magenta; white if colors are not RGB.
inline void exceptionColor(uint32_t exception, float *color, uint32_t components) {
  forEachComponent(components, [&](uint32_t i) { color[i] = 1; });
  if (components != 3)
    return;
  color[1] = exception == RTSL_EXCEPTION_BAD_RAY ? 1.0f : 0.0f;
  color[2] = exception == RTSL_EXCEPTION_INDEX ? 1.0f : 0.0f;
}

/// To be called at the end of a sample whose color is in SampleColor.
inline void endEvents(RtslState &state) {
  if (!hasExceptions(state) || !isAbandoned(state))
    return;
  const RtslLaunch &launch = *state.launch;
  uint32_t exception = state.events->exception;
  if (launch.status)
    countUp(&launch.status->exceptions[exception]);
  const uint32_t components = rtsl_color_components(&launch);
  exceptionColor(exception, state.SampleColor, components);
  if (launch.exception) {
    forEachComponent(components, [&](uint32_t i) { state.SampleColor[i] = 0; });
    state.ExceptionCode = int32_t(exception);
    rtsl_rt_Exception_exception(&state, launch.exception);
  }
}

} // namespace rtsl::device
