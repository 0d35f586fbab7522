//===- WaveStates.h - a kernel for each state -----------------------------===//
//
// The device code of a wavefront has one function that runs a state of all slots that wait for it,
// `rtsl_wave_state` (runtime/device/engines/Wavefront.cpp). A program needs it once for each state,
// so that each kernel has the registers of its state alone.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <string>

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// The kernel of a state, from 1 on.
std::string waveStateName(unsigned state);

/// Replaces `rtsl_wave_state` by copies for the states 1 to `count`, which call only what their
/// state consists of. On a host it also defines `rtsl_wave_run_state`, the switch over them.
void makeWaveStates(llvm::Module &module, unsigned count);

} // namespace rtsl::codegen
