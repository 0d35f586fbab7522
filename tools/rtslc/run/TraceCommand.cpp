//===- TraceCommand.cpp - rtslc trace -------------------------------------===//
//
// Rays of the user's against a mesh: runs a scene of library/queries.
//
//===----------------------------------------------------------------------===//
#include "RunCommand.h"
#include "codegen/driver/StandardLibrary.h"
#include "scenefile/files/NumberFiles.h"
#include "support/Error.h"
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
  bool isAny = false;
};

/// How many numbers a ray of the file has: 6 or 8.
std::size_t numbersOfRay(const std::string &file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension != ".npy" && extension != ".csv")
    throw Error(ErrorCode::BadBuffer, fmt::format("`{}` is neither .npy nor .csv", file));
  const std::vector<std::size_t> shape =
      extension == ".npy" ? scene::NpyFile(file, scene::NpyFile::Part::Header).shape()
                          : scene::readCsv(file, {}).shape;
  if (shape.size() == 2 && (shape[1] == 6 || shape[1] == 8))
    return shape[1];
  throw Error(ErrorCode::BadBuffer,
              fmt::format("`{}` has the shape ({}): rays have 6 numbers, origin and direction, or "
                          "8, origin, tmin, direction and tmax",
                          file, fmt::join(shape, ", ")));
}

int trace(TraceOptions options) {
  RunOptions &run = options.run;
  run.scene = fmt::format("{}/queries/{}.json", libraryFolder(), options.isAny ? "any" : "nearest");
  try {
    const char *const rays = numbersOfRay(options.rays) == 8 ? "rays" : "lines";
    run.inputs = {{rays, options.rays}};
    run.overrides = {fmt::format("render.size={}", rays),
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
                   "a ray a row, .npy or .csv: origin and direction, or origin, tmin, direction "
                   "and tmax")
      ->type_name("FILE")
      ->required();
  command
      ->add_option("--out", options->hits,
                   "t, triangle, u, v of the nearest hit of each ray, -1 where there is none: "
                   ".npy, or the elements as they lie in memory")
      ->type_name("FILE");
  command->add_flag("--any", options->isAny, "only whether a ray hits anything: a bool a ray");
  addRunOptions(*command, options->run);
  command->footer("examples:\n  rtslc trace bunny.ply --rays rays.npy --out hits.npy\n"
                  "  rtslc trace bunny.ply --rays rays.csv --any --out seen.csv --target=gpu");
  command->callback([options, command, &action] {
    completeRunOptions(*command, options->run);
    action = [options] { return trace(*options); };
  });
}

} // namespace rtsl::tool
