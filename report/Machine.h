//===- Machine.h - where a measurement was made ---------------------------===//
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace rtsl::report {

/// Facts as (name, value): processor, cores, memory, system. What the system does not tell is left
/// out.
std::vector<std::pair<std::string, std::string>> machineFacts();

} // namespace rtsl::report
