#include "CheckpointFile.h"

#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"
#include "tools/common/OptionValues.h"

#include <fmt/format.h>

#include <filesystem>

namespace rtsl::tool {

void addCheckpointOptions(CLI::App &command, CheckpointOptions &options) {
  command
      .add_option("--checkpoint", options.file,
                  "save the rendering in this file, and resume from it if it exists")
      ->type_name("FILE");
  command
      .add_option("--resume", options.resumed,
                  "the same with a file that must exist: the checkpoint of an earlier rendering")
      ->type_name("FILE");
  command
      .add_option_function<std::string>(
          "--checkpoint-every",
          [&options](const std::string &text) {
            options.seconds = parseDuration("--checkpoint-every", text);
          },
          "the time between checkpoints (default: 30s)")
      ->type_name("TIME");
}

void completeCheckpointOptions(CheckpointOptions &options) {
  if (options.resumed.empty())
    return;
  if (options.file.empty())
    options.file = options.resumed;
  if (options.file != options.resumed)
    throw CLI::ValidationError(
        "--resume", "the rendering is saved in the same file again; leave out `--checkpoint`");
}

/// Where a file lies or will lie.
static std::filesystem::path placeOf(const std::string &file) {
  namespace fs = std::filesystem;
  std::error_code unknown;
  fs::path path = fs::absolute(file, unknown);
  for (int depth = 0; depth < 40 && fs::is_symlink(path, unknown); ++depth)
    path = path.parent_path() / fs::read_symlink(path, unknown);
  return fs::weakly_canonical(path, unknown);
}

void checkCheckpointFile(const CheckpointOptions &options, const std::string &output,
                         const DependencyOptions &dependencies,
                         const std::vector<std::string> &sources,
                         const std::vector<std::string> &filesRead) {
  const std::string &file = options.file;
  if (file.empty())
    return;
  std::error_code unknown;
  if (!options.resumed.empty() && !std::filesystem::exists(file, unknown))
    throw Error(message::noCheckpoint(file), Place{file})
        .note("`--checkpoint` begins a rendering, and resumes it if the file exists");
  if (std::filesystem::exists(file, unknown) && !std::filesystem::is_regular_file(file, unknown) &&
      !std::filesystem::is_directory(file, unknown))
    throw Error(message::checkpointNotRegular(file), Place{file});
  checkFileWritable(file);
  refuseToOverwrite(file, sources);
  refuseToOverwrite(file, filesRead);
  std::vector<std::string> outputs{output};
  if (dependencies.isAsked)
    outputs.push_back(dependencyFile(dependencies, output, sources));
  for (const std::string &other : outputs)
    if (placeOf(file) == placeOf(other))
      throw Error(message::checkpointIsOutput(file), Place{file}).note("give different files");
}

CheckpointFile::CheckpointFile(CheckpointOptions options, runtime::Identity identity)
    : options(std::move(options)), identity(std::move(identity)) {
  removeUnfinishedFiles(this->options.file);
}

runtime::PartialRendering CheckpointFile::read(std::uint64_t pixels, std::uint32_t components,
                                               bool isAdaptive) const {
  std::error_code unknown;
  if (!std::filesystem::exists(options.file, unknown))
    return {};
  return runtime::parseCheckpoint(readFile(options.file), options.file, identity, pixels,
                                  components, isAdaptive);
}

void CheckpointFile::write(const runtime::PartialRendering &rendering, bool isLast) {
  try {
    runtime::writeCheckpoint(options.file, identity, rendering);
  } catch (const Error &error) {
    if (isLast) {
      lastFailure = error;
      return;
    }
    ++failures;
    whyNot = error.what();
  }
}

void CheckpointFile::report(Messages &messages) const {
  if (lastFailure)
    messages.report(*lastFailure);
  else if (failures)
    messages.diagnostics.report(Code::checkpointsFailed, {}, failures, whyNot);
}

} // namespace rtsl::tool
