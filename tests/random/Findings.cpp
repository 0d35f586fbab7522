//===- Findings.cpp - what went wrong with programs ------------------------===//
#include "Findings.h"

#include <algorithm>

namespace rtsl::random {

const char *name(Failure failure) {
  static const char *const names[] = {"fine", "rejected", "fault", "crash", "hang", "mismatch"};
  return names[static_cast<std::size_t>(failure)];
}

bool areOfBatch(const std::vector<Finding> &findings, std::size_t count) {
  return count > 1 && (findings.size() != count ||
                       std::any_of(findings.begin(), findings.end(), [](const Finding &finding) {
                         return finding.failure == Failure::Rejected ||
                                finding.failure == Failure::Fault;
                       }));
}

} // namespace rtsl::random
