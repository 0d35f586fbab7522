//===- KeyFrames.cpp - numbers that change from frame to frame, for C -----===//
#include "scenefile/json/KeyFrames.h"
#include "runtime/c/Handle.h"
#include "support/ErrorMessages.h"

#include <cmath>

using rtsl::c::guarded;

extern "C" int rtslAtFrame(double frame, const double *frames, const double *numbers, uint32_t keys,
                           size_t count, RtslInterpolation interpolation, double *result) {
  return guarded(0, {{frames, "frames"}, {numbers, "numbers", count}, {result, "result"}}, [&] {
    rtsl::c::requireChoice(interpolation, RTSL_STEP_FRAMES + 1, "interpolation");
    if (keys == 0)
      throw rtsl::Error(rtsl::message::noFrames());
    for (std::uint32_t i = 1; i < keys; ++i)
      if (!(frames[i - 1] < frames[i]))
        throw rtsl::Error(rtsl::message::framesNotAscending(frames[i], frames[i - 1]));
    const rtsl::scene::FramePlace place = rtsl::scene::placeAmong({frames, frames + keys}, frame);
    const double *of = numbers + place.key * count, *next = numbers + place.next * count;
    for (std::size_t i = 0; i < count; ++i)
      result[i] = interpolation == RTSL_STEP_FRAMES || place.next == place.key
                      ? of[i]
                      : rtsl::scene::between(of[i], next[i], place.share);
    return 1;
  });
}
