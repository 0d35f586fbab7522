//===- WaveStates.h - a kernel for each state -----------------------------===//
//
// The device code of a wavefront has one function that runs a state of all slots that wait for it,
// `rtsl_wave_state` (runtime/device/organisations/Wavefront.cpp). A program needs it once for each
// state, so that each kernel has the registers of its state alone. That of persistent blocks has
// one for a task, `rtsl_block_state` (Persistent.cpp), whose copies load and store only what their
// state needs.
//
//===----------------------------------------------------------------------===//
#pragma once

namespace llvm {
class Module;
} // namespace llvm

namespace rtsl::codegen {

/// Replaces `rtsl_wave_state`, or `rtsl_block_state`, by copies for the states 1 to `count`, which
/// call only what their state consists of: `rtsl_wave_state_1` and so on; likewise, if it is there,
/// `rtsl_wave_light`, for the states that call `illuminate` and have at least `litFrom`
/// instructions, without those of the runtime. Where they are declared it also defines
/// `rtsl_wave_run_state`, `rtsl_block_run_state` and `rtsl_wave_run_light`, the switch over them.
void makeWaveStates(llvm::Module &module, unsigned count, unsigned litFrom);

} // namespace rtsl::codegen
