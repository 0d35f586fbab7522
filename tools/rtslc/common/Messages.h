//===- Messages.h - diagnostics for the user ------------------------------===//
#pragma once

#include "CommandLine.h"
#include "frontend/diagnostics/Diagnostics.h"
#include "support/Error.h"

#include <map>
#include <string>

namespace rtsl::tool {

/// The sources and messages of one run. Prints the messages once, on request or on destruction.
class Messages {
public:
  explicit Messages(const CommonOptions &options);
  ~Messages() { print(); }

  SourceManager sources;
  Diagnostics diagnostics{sources};

  /// Records what the runtime or a scene file threw, with its place, and what else it found wrong.
  void report(const Error &error);
  Diagnostic &report(const Message &message, SourceRange range);

  void report(const Warning &warning);

  /// The range of a place in a file, which is read if no source has its name yet.
  SourceRange rangeOf(const Place &place);

  /// Writes all messages to standard error.
  void print();
  /// They are not to be written, because they are known already.
  void silence() { printed = true; }
  ExitStatus status() const { return diagnostics.hasErrors() ? Diagnosed : Fine; }

private:
  /// A file, or an override: "--set path.to.key=value".
  FileId fileOf(const std::string &name);

  const CommonOptions &options;
  std::map<std::string, FileId> overrides;
  bool printed = false;
};

} // namespace rtsl::tool
