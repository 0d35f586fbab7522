//===- NearestName.cpp - what was meant? ----------------------------------===//
#include "runtime/Scene.h"

#include <algorithm>
#include <cctype>

namespace rtsl::runtime {

namespace {

/// Insertions, deletions, substitutions and swaps of neighbours (Damerau 1964, restricted to one
/// edit a place). A difference in case costs nothing.
std::size_t distance(std::string_view a, std::string_view b) {
  auto same = [](char x, char y) {
    return std::tolower((unsigned char)x) == std::tolower((unsigned char)y);
  };
  std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + !same(a[i - 1], b[j - 1])});
      if (i > 1 && j > 1 && same(a[i - 1], b[j - 2]) && same(a[i - 2], b[j - 1]))
        row[j] = std::min(row[j], before[j - 2] + 1);
    }
    before.swap(last);
    last.swap(row);
  }
  return last[b.size()];
}

} // namespace

std::optional<std::string> nearestName(std::string_view name,
                                       const std::vector<std::string> &candidates) {
  std::optional<std::string> best;
  std::size_t bestDistance = std::max<std::size_t>(1, name.size() / 3) + 1;
  for (const std::string &candidate : candidates) {
    if (candidate.size() > name.size() + 8 || name.size() > 64)
      continue;
    std::size_t d = distance(name, candidate);
    if (d < bestDistance && d < std::max(name.size(), candidate.size())) {
      best = candidate;
      bestDistance = d;
    }
  }
  return best;
}

} // namespace rtsl::runtime
