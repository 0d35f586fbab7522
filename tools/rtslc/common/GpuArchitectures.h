//===- GpuArchitectures.h - the values of --gpu-arch ----------------------===//
#pragma once

#include <string>
#include <vector>

namespace rtsl::tool {

/// What PTX can be compiled for, the oldest first: "sm_75".
const std::vector<std::string> &gpuArchitectures();

/// The newest of them whose code runs on a GPU of this compute capability (90: sm_90); the oldest
/// one if there is none.
const std::string &gpuArchitecture(int capability);

} // namespace rtsl::tool
