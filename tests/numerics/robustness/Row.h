//===- Row.h - one stiff or extreme case ----------------------------------===//
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rtsl::numerics {

/// What a row found.
struct Outcome {
  double worst = 0;          // in the row's unit; infinite where an answer is plainly wrong
  std::uint64_t cases = 0;   // that were judged
  std::string where;         // the worst case, to be looked at; empty if there was nothing wrong
};

/// A generator of hard inputs, an exact oracle, and the measure of error. The bound lies in bounds.json.
struct Row {
  const char *name;        // family.case
  const char *description; // what is done, to what, compared with what
  const char *unit;        // of `worst`
  std::uint64_t cases;     // of a full run; --quick runs a hundredth, at least 1000
  Outcome (*run)(std::uint64_t cases, std::uint32_t seed);
  double (*nanoseconds)(); // a call of the code under test, on easy inputs
};

std::vector<Row> triangleRows();
std::vector<Row> boxRows();
std::vector<Row> spawnRows();
std::vector<Row> sumRows();

} // namespace rtsl::numerics
