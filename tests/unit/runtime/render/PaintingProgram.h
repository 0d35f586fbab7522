//===- PaintingProgram.h - a program for tests of backends ----------------===//
#pragma once

#include "runtime/render/HostMegakernel.h"

#include <atomic>

namespace rtsl::test {

/// How many lanes of a painting program have begun.
extern std::atomic<unsigned> lanesBegun;

/// A lane of a program that paints (x, y, seed) times the number of the sample, from 1, and takes
/// its time for a pixel if it has a depth, in milliseconds.
void paint(const RtslJob *job, std::uint32_t lane);

/// A program of such lanes.
runtime::MegakernelCode codeOf(void (*runLane)(const RtslJob *, std::uint32_t));

runtime::FlatScene emptyScene();

/// 20 x 10 pixels, 3 samples, depth 0, seed 7.
runtime::RenderOptions small();

} // namespace rtsl::test
