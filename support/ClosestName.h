//===- ClosestName.h - the name that was meant ----------------------------===//
#pragma once

#include <string>
#include <vector>

namespace rtsl {

/// The candidate that is most similar to `name`, or empty: at most a third of its letters may be
/// wrong, missing, doubled or swapped. Differences in case alone count as one mistake at most.
std::string closestName(const std::string &name, const std::vector<std::string> &candidates);

} // namespace rtsl
