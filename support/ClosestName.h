//===- ClosestName.h - the name that was meant ----------------------------===//
#pragma once

#include <string>
#include <vector>

namespace rtsl {

/// The candidate that is most like `name`, or empty: at most a third of its letters may be wrong,
/// missing, doubled or swapped. Case alone never counts as more than one mistake.
std::string closestName(const std::string &name, const std::vector<std::string> &candidates);

} // namespace rtsl
