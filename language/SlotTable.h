//===- SlotTable.h - the slots as lists -----------------------------------===//
#pragma once

namespace rtsl {

/// A method that the runtime calls on an object derived from `base`.
struct Slot {
  const char *base;
  const char *method;
};

constexpr Slot methodSlots[] = {
#define RTSL_SLOT(base, method) {#base, #method},
#include "language/Slots.def"
};

constexpr Slot samplingSlots[] = {
#define RTSL_SAMPLING_SLOT(base, method) {#base, #method},
#include "language/SamplingSlots.def"
};

/// The sampling slots that the runtime itself calls, to choose a point on a surface that shines, or
/// a direction of the background.
constexpr Slot surfaceSlots[] = {{"rt_Primitive", "generateSample"},
                                 {"rt_Primitive", "samplePDF"},
                                 {"rt_Material", "emission"},
                                 {"rt_Miss", "sampleDirection"},
                                 {"rt_Miss", "directionPDF"}};

/// Those by which the light of lights passes surfaces; the second one in the engine `classic`
/// alone.
constexpr Slot passingSlots[] = {{"rt_Material", "transmittance"},
                                 {"rt_Material", "diffuseTransmittance"}};

} // namespace rtsl
