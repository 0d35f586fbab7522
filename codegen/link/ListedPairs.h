//===- ListedPairs.h - the boxes of a list in half precision --------------===//
#pragma once

#include "runtime/device/ray/Abi.h"

#include <cstdint>
#include <vector>

namespace rtsl {

/// The words of an RtslListedPairs and its pairs (runtime/device/ray/ListedPairs.h); empty if rays
/// would enter too many of the boxes, because some are small in a large scene, or if the boxes are
/// so few that the test of two at once is not faster.
std::vector<std::int32_t> listedPairs(const std::vector<RtslInstance> &instances);

} // namespace rtsl
