//===- CheckpointFile.h - rtslc render --checkpoint and --resume -----------===//
#pragma once

#include "runtime/render/passes/Checkpoint.h"
#include "tools/rtslc/common/Messages.h"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::tool {

struct CheckpointOptions {
  std::string file;    // empty: there is none
  std::string resumed; // the same, if it must exist; otherwise empty
  double seconds = 30;
};

/// Adds --checkpoint, --resume and --checkpoint-every.
void addCheckpointOptions(CLI::App &command, CheckpointOptions &options);
/// When all options are read. Throws CLI::ValidationError if there are two files.
void completeCheckpointOptions(CheckpointOptions &options);

/// Throws BadCheckpoint if there is no checkpoint that must exist, and FileUnwritable or
/// OverwritesInput if checkpoints cannot be written, or would replace the output (or its dependency
/// file) or an input. As checkOutputs().
void checkCheckpointFile(const CheckpointOptions &options, const std::string &output,
                         const DependencyOptions &dependencies,
                         const std::vector<std::string> &sources,
                         const std::vector<std::string> &filesRead = {});

/// The checkpoints of one rendering.
class CheckpointFile {
public:
  CheckpointFile(CheckpointOptions options, runtime::Identity identity);

  /// The rendering of the file; without samples if there is no file. Throws BadCheckpoint.
  runtime::PartialRendering read(std::uint64_t pixels, std::uint32_t components,
                                 bool isAdaptive) const;

  /// Replaces the file. What fails is reported by report().
  void write(const runtime::PartialRendering &rendering, bool isLast);
  double seconds() const { return options.seconds; }

  /// To be called after the last write: reports an error if that failed, and a warning if others
  /// did.
  void report(Messages &messages) const;

private:
  const CheckpointOptions options;
  const runtime::Identity identity;
  unsigned failures = 0; // of writes that were not the last
  std::string whyNot;    // the last one's
  std::optional<Error> lastFailure;
};

} // namespace rtsl::tool
