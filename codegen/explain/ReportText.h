//===- ReportText.h - what splitting cost and saved, as text --------------===//
#pragma once

#include "codegen/passes/continuation/Report.h"

namespace rtsl {

/// For people: a block of lines a function.
std::string toText(const SplitReport &report);

/// "4 bytes", "0 to 4 bytes".
std::string toText(const BytesRange &range);

/// ": 2 constants, normal, sum" of these names of values; "" if there are none.
std::string listOf(const std::vector<std::string> &names);

} // namespace rtsl
