//===- ShaderRows.cpp - the rows of numerics-shaders ----------------------===//
#include "CompiledShaders.h"
#include "Row.h"

#include <CLI/CLI.hpp>

namespace rtsl::numerics {

void addOptions(CLI::App &app) {
  sourceRoot = RTSL_SOURCE_ROOT;
  app.add_option("--root", sourceRoot, "the tree whose shaders are tested, if it is not this one");
}

std::vector<Row> allRows(Path path) {
  std::vector<Row> rows;
  for (const auto &family : {meshRows, meshTriangleRows, meshSpawnRows, primitiveBoxRows, pixelRows,
                             sphereRows, quadricRows, torusRows, scatteringRows, refractionRows,
                             metalRows, matrixRows, attenuationRows, paneRows})
    for (Row &row : family(path))
      rows.push_back(std::move(row));
  return rows;
}

} // namespace rtsl::numerics
