//===- Row.h - one stiff or extreme case ----------------------------------===//
#pragma once

#include "Path.h"

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace CLI {
class App;
}

namespace rtsl::numerics {

/// What a row found.
struct Outcome {
  double worst = 0;        // in the row's unit; infinite where an answer is plainly wrong
  std::uint64_t cases = 0; // that were judged
  std::string where;       // the worst case, to be looked at; empty if there was nothing wrong
};

/// A generator of hard inputs, an exact oracle, and the measure of error. The bound lies in
/// bounds.json.
struct Row {
  std::string name;        // family.case
  std::string description; // what is done, to what, compared with what
  const char *unit;        // of `worst`
  std::uint64_t cases;     // of a full run; --quick runs a hundredth, at least 1000
  std::function<Outcome(std::uint64_t cases, std::uint32_t seed)> run;
  std::function<double()> nanoseconds; // a call of the code under test, on easy inputs
};

/// Makes rows of one path from functions of (path, cases, seed); `nanoseconds(path)` is what a call
/// costs.
template <typename Nanoseconds>
auto rowsOf(Path path, Nanoseconds nanoseconds) {
  return [=](std::string name, std::string description, const char *unit, std::uint64_t cases,
             auto run) {
    return Row{std::move(name),
               std::move(description),
               unit,
               cases,
               [=](std::uint64_t n, std::uint32_t seed) { return run(path, n, seed); },
               [=] { return nanoseconds(path); }};
  };
}

std::vector<Row> triangleRows();
std::vector<Row> boxRows();
std::vector<Row> spawnRows();
std::vector<Row> sumRows();

// Of compiled shaders.
std::vector<Row> meshRows(Path path);
std::vector<Row> meshTriangleRows(Path path);
std::vector<Row> meshSpawnRows(Path path);
std::vector<Row> primitiveBoxRows(Path path);
std::vector<Row> pixelRows(Path path);
std::vector<Row> sphereRows(Path path);
std::vector<Row> quadricRows(Path path);
std::vector<Row> torusRows(Path path);
std::vector<Row> scatteringRows(Path path);
std::vector<Row> refractionRows(Path path);
std::vector<Row> metalRows(Path path);
std::vector<Row> matrixRows(Path path);
std::vector<Row> attenuationRows(Path path);
std::vector<Row> paneRows(Path path);

/// What a program adds to the command line.
void addOptions(CLI::App &app);

/// Those of the program. The runtime's own code is always strict.
std::vector<Row> allRows(Path path);

} // namespace rtsl::numerics
