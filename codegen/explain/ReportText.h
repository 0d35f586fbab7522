//===- ReportText.h - costs and savings of splitting, as text -------------===//
#pragma once

#include "codegen/passes/continuation/Report.h"

namespace rtsl {

/// For users: a block of lines for each function.
std::string toText(const SplitReport &report);

/// "4 bytes", "0 to 4 bytes".
std::string toText(const BytesRange &range);

/// ": 2 constants, normal, sum" of these values; "" if there are none.
std::string listOf(const std::vector<LiveValue> &values);

} // namespace rtsl
