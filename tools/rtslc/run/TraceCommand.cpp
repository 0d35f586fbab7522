//===- TraceCommand.cpp - rtslc trace -------------------------------------===//
//
// Rays of the user's against a mesh: runs a scene of library/queries.
//
//===----------------------------------------------------------------------===//
#include "RunCommand.h"
#include "codegen/driver/sources/StandardLibrary.h"
#include "runtime/buffers/NumberFiles.h"
#include "runtime/buffers/PlyColumns.h"
#include "runtime/geometry/Mesh.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"
#include "tools/rtslc/common/Messages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <memory>

namespace rtsl::tool {

namespace {

struct TraceOptions {
  RunOptions run;
  std::string mesh, rays, hits;
  std::vector<std::string> columns;
  std::string element = "vertex"; // of .ply
  bool isAny = false;
};

std::string extensionOf(const std::string &file) {
  return std::filesystem::path(file).extension().string();
}

/// The shape of the numbers in the file, or in the chosen columns.
std::vector<std::size_t> shapeOf(const TraceOptions &options) {
  const std::string &file = options.rays, extension = extensionOf(file);
  if (extension == ".csv")
    return runtime::readCsv(file, options.columns).shape;
  if (extension == ".ply")
    return runtime::readPly(file, options.element, options.columns).shape;
  if (extension != ".npy")
    throw Error(message::rayFormatUnknown(file));
  if (!options.columns.empty())
    throw Error(message::rayFileWithoutColumns(file));
  return runtime::NpyFile(file, runtime::NpyFile::Part::Header).shape();
}

/// How many numbers a ray of the file has: 6 or 8.
std::size_t numbersOfRay(const TraceOptions &options) {
  const std::vector<std::size_t> shape = shapeOf(options);
  if (!shape.empty() && shape[0] == 0)
    throw Error(message::raysMissing(options.rays));
  if (shape.size() == 2 && (shape[1] == 6 || shape[1] == 8))
    return shape[1];
  throw Error(message::rayShape(options.rays, fmt::join(shape, ", ")));
}

int trace(TraceOptions options) {
  RunOptions &run = options.run;
  run.scene = fmt::format("{}/queries/{}.json", libraryFolder(), options.isAny ? "any" : "nearest");
  try {
    runtime::checkMeshFile(options.mesh); // before it is a value of the scene that nobody wrote
    const char *const rays = numbersOfRay(options) == 8 ? "rays" : "lines";
    nlohmann::json buffer = {{"buffer", options.rays}};
    if (!options.columns.empty())
      buffer["columns"] = options.columns;
    if (extensionOf(options.rays) == ".ply")
      buffer["element"] = options.element;
    run.overrides = {fmt::format("rayGeneration.{}={}", rays, buffer.dump()),
                     fmt::format("render.size={}", rays),
                     "objects.0.mesh=" + nlohmann::json(options.mesh).dump()};
  } catch (const Error &error) {
    Messages messages(run.common);
    messages.report(error);
    return messages.status();
  }
  if (!options.hits.empty())
    run.outputs = {{"hits", options.hits}};
  return runLaunches(run);
}

} // namespace

void addTraceCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<TraceOptions>();
  CLI::App *command = app.add_subcommand(traceSummary.command, traceSummary.text);
  command->add_option("MESH", options->mesh, "a mesh: OBJ, PLY or glTF")->required();
  command
      ->add_option("--rays", options->rays,
                   "one ray per row, .npy, .csv or .ply: origin and direction, or origin, tmin, "
                   "direction and tmax")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--columns", options->columns,
                   "names of the columns of .csv or .ply that hold these numbers, in their order; "
                   "default: all columns")
      ->type_name("NAME,...")
      ->delimiter(',');
  command
      ->add_option("--element", options->element,
                   "the element of .ply that has a ray for each of its rows; default: vertex")
      ->type_name("NAME");
  command
      ->add_option("--out", options->hits,
                   "t, triangle, u, v of the nearest hit of each ray, -1 where there is none: "
                   ".npy, or the elements as they lie in memory")
      ->type_name("FILE");
  command->add_flag("--any", options->isAny, "only whether a ray hits anything: one bool per ray");
  addRunOptions(*command, options->run);
  command->footer("examples:\n  rtslc trace bunny.ply --rays rays.npy --out hits.npy\n"
                  "  rtslc trace bunny.ply --rays rays.csv --any --out seen.csv --target=gpu\n"
                  "  rtslc trace bunny.ply --rays points.ply --columns x,y,z,nx,ny,nz --any "
                  "--out hidden.npy");
  command->callback([options, command, &action] {
    completeRunOptions(*command, options->run);
    action = [options] { return trace(*options); };
  });
}

} // namespace rtsl::tool
