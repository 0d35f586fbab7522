//===- ReportJson.h - costs and savings of splitting, as JSON -------------===//
#pragma once

#include "codegen/passes/continuation/Report.h"

#include <nlohmann/json_fwd.hpp>

namespace rtsl {

/// The report for other programs: {"version": 1, "frameSize": ..., "functions": [...]}.
nlohmann::ordered_json jsonOf(const SplitReport &report);

/// The same as text.
std::string toJson(const SplitReport &report);

} // namespace rtsl
