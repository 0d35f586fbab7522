//===- Main.cpp - stiff and extreme cases against their bounds ------------===//
//
//   numerics-robustness [ROW...] [--quick] [--json] --bounds bounds.json   rows of the runtime
//   numerics-shaders [ROW...] [--path strict|fast|double|cpp|megakernel|gpu] ...   of shaders
//
// Runs the rows whose names begin with one of the arguments, all of them if there are none. Exit
// status: 0 all bounds hold, 1 some do not, 2 wrong arguments.
//
//===----------------------------------------------------------------------===//
#include "Row.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>
#include <map>

using namespace rtsl::numerics;

namespace {

struct Options {
  std::vector<std::string> rows;
  std::string bounds;
  bool quick = false, json = false;
  std::uint32_t seed = 1;
  Path path = Path::Strict;
};

std::vector<Row> chosenRows(const Options &options) {
  std::vector<Row> rows;
  for (Row &row : allRows(options.path))
    if (options.rows.empty() ||
        std::any_of(options.rows.begin(), options.rows.end(),
                    [&](const std::string &name) { return row.name.rfind(name, 0) == 0; }))
      rows.push_back(std::move(row));
  return rows;
}

/// Paths that have the same bits have the same bounds.
const char *boundSuffix(Path path) {
  return path == Path::Fast ? " fast" : path == Path::Double ? " double" : "";
}

int run(const Options &options) {
  std::ifstream file(options.bounds);
  const nlohmann::json bounds = nlohmann::json::parse(file, nullptr, false);
  if (!bounds.is_object()) {
    fmt::print(stderr, "numerics-robustness: cannot read the bounds in `{}`\n", options.bounds);
    return 2;
  }
  const std::vector<Row> rows = chosenRows(options);
  if (rows.empty()) {
    fmt::print(stderr, "numerics-robustness: there is no such row\n");
    return 2;
  }
  nlohmann::ordered_json document = nlohmann::ordered_json::array();
  bool allHold = true;
  for (const Row &row : rows) {
    // A row of sums needs its million samples for one case.
    const std::uint64_t cases =
        options.quick ? std::max<std::uint64_t>(row.cases / 100, 1000) : row.cases;
    const Outcome outcome = row.run(cases, options.seed);
    const std::string key = row.name + boundSuffix(options.path);
    const bool hasBound = bounds.contains(key);
    const double bound = hasBound ? bounds[key].get<double>() : -1;
    const bool holds = hasBound && outcome.worst <= bound && outcome.cases > 0;
    allHold &= holds;
    const double nanoseconds = options.json ? row.nanoseconds() : 0;
    document.push_back({{"name", row.name},
                        {"description", row.description},
                        {"unit", row.unit},
                        {"cases", outcome.cases},
                        {"bound", bound},
                        {"worst", outcome.worst},
                        {"holds", holds},
                        {"nanoseconds", nanoseconds},
                        {"where", outcome.where}});
    if (!options.json)
      fmt::print("{} {:<24} worst {:.4g}, bound {} ({}; {} cases)\n{}", holds ? "ok    " : "BROKEN",
                 row.name, outcome.worst, hasBound ? fmt::format("{:.4g}", bound) : "missing",
                 row.unit, outcome.cases,
                 holds || outcome.where.empty() ? "" : "       at " + outcome.where + "\n");
  }
  if (options.json)
    fmt::print("{}\n", document.dump(2));
  return allHold ? 0 : 1;
}

} // namespace

int main(int argc, char **argv) {
  CLI::App app("holds arithmetic against exact oracles");
  Options options;
  app.add_option("ROW", options.rows, "rows, or beginnings of their names; all if not given");
  app.add_option("--bounds", options.bounds, "the bounds, as JSON")->required();
  app.add_option("--seed", options.seed, "of the random inputs");
  app.add_option("--path", options.path, "how shaders run")
      ->transform(CLI::CheckedTransformer(pathNames));
  addOptions(app);
  app.add_flag("--quick", options.quick, "a hundredth of the cases");
  app.add_flag("--json", options.json, "for scripts, with the time of a call");
  CLI11_PARSE(app, argc, argv);
  return run(options);
}
