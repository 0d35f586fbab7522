//===- Machine.h - the machine of a measurement ---------------------------===//
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rtsl::report {

/// Facts as (name, value): processor, cores, memory, system. Unknown ones are left out.
std::vector<std::pair<std::string, std::string>> machineFacts();

} // namespace rtsl::report
