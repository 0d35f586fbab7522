//===- Programs.cpp - the programs engine, for compiled programs ----------===//
//
// Separate from Device.cpp, because it refers to the slots of methods with payloads.
//
//===----------------------------------------------------------------------===//
#include "runtime/device/engines/Programs.h"

using namespace rtsl;

extern "C" {

void rtsl_trace_payload(RtslState *parent, float ox, float oy, float oz, float dx, float dy,
                        float dz, float tmin, float tmax, void *payload, int32_t root,
                        uint32_t mask, float time, uint32_t rayType, uint32_t how) {
  device::trace(*parent,
                {{ox, oy, oz}, {dx, dy, dz}, tmin, tmax, payload, root, mask, time, rayType}, how);
}

void rtsl_generate(const RtslLaunch *launch, uint32_t x, uint32_t y, uint32_t sample,
                   float *color) {
  device::generate(*launch, x, y, sample, color);
}

} // extern "C"
