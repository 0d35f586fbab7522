//===- ClosestName.cpp - the name that was meant --------------------------===//
#include "support/ClosestName.h"

#include <algorithm>
#include <cctype>

namespace rtsl {

/// Distance of optimal string alignment (Damerau 1964): insertions, deletions, substitutions and
/// swaps of neighbours.
static std::size_t editDistance(const std::string &a, const std::string &b) {
  std::vector<std::size_t> twoAbove(b.size() + 1), above(b.size() + 1), row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j)
    above[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substitution = above[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, substitution});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        row[j] = std::min(row[j], twoAbove[j - 2] + 1);
    }
    std::swap(twoAbove, above);
    std::swap(above, row);
  }
  return above[b.size()];
}

static std::string lowered(const std::string &text) {
  std::string result = text;
  for (char &c : result)
    c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string closestName(const std::string &name, const std::vector<std::string> &candidates) {
  // Names of hundreds of letters are not misspelled, and the distance takes time proportional to
  // the product of the lengths.
  if (name.empty() || name.size() > 80)
    return "";
  std::string best;
  std::size_t bestDistance = std::max<std::size_t>(1, name.size() / 3) + 1;
  const std::string lowerName = lowered(name);
  for (const std::string &candidate : candidates) {
    const std::size_t longer = std::max(candidate.size(), name.size());
    const std::size_t shorter = std::min(candidate.size(), name.size());
    if (candidate == name || longer - shorter >= bestDistance || longer == 1)
      continue;
    std::size_t distance = editDistance(name, candidate);
    const std::string lowerCandidate = lowered(candidate);
    distance = std::min(distance, 1 + editDistance(lowerName, lowerCandidate));
    if (distance < bestDistance) {
      bestDistance = distance;
      best = candidate;
    }
  }
  return best;
}

} // namespace rtsl
