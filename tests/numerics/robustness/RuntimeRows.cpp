//===- RuntimeRows.cpp - the rows of numerics-robustness ------------------===//
#include "Row.h"

namespace rtsl::numerics {

void addOptions(CLI::App &) {}

std::vector<Row> allRows(Path) {
  std::vector<Row> rows;
  for (const auto &family : {triangleRows(), boxRows(), spawnRows(), sumRows()})
    rows.insert(rows.end(), family.begin(), family.end());
  return rows;
}

} // namespace rtsl::numerics
