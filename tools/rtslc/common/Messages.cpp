//===- Messages.cpp - diagnostics for the user ----------------------------===//
#include "Messages.h"

#include <cstdio>
#include <cstdlib>
#include <unistd.h>

namespace rtsl::tool {

namespace {

Code codeFor(ErrorCode code) {
  switch (code) {
#define RTSL_DIAGNOSTIC(...)
#define RTSL_RUNTIME_ERROR(id, number, error, meaning)                                             \
  case ErrorCode::error:                                                                           \
    return Code::id;
#include "frontend/diagnostics/DiagnosticCodes.def"
    // rtslc reads no packages.

  case ErrorCode::BadPackage:
  case ErrorCode::Internal:
    break; // Main.cpp ends the run with its own status
  }
  throw std::logic_error("a fault of the runtime reached the user's messages");
}

bool wantsColour(const std::string &ansi) {
  if (ansi != "auto")
    return ansi == "always";
  const char *noColour = std::getenv("NO_COLOR");
  return isatty(STDERR_FILENO) && !(noColour && *noColour);
}

} // namespace

Messages::Messages(const CommonOptions &options) : options(options) {
  diagnostics.errorLimit = options.errorLimit;
  diagnostics.warnings = options.warnings;
}

FileId Messages::fileOf(const std::string &name) {
  if (name.rfind("--set ", 0) == 0) {
    FileId &shown = overrides[name];
    if (!shown)
      shown = sources.add("command line", name);
    return shown;
  }
  FileId file = sources.find(name);
  std::string whyNot;
  if (!file)
    file = sources.addFile(name, whyNot).value_or(0);
  if (!file) // it is gone or unreadable: the name still helps
    file = sources.add(name, "");
  return file;
}

SourceRange Messages::rangeOf(const Place &place) {
  if (place.line ==
      0) // a file as a whole: the message names it, and it may be a device or a gigabyte
    return {};
  const FileId file = fileOf(place.file);
  const std::uint32_t begin = sources.offset(file, {place.line, place.column});
  return {file, begin, begin + place.length};
}

void Messages::report(const Error &error) {
  if (error.code == ErrorCode::Internal)
    throw error;
  const SourceRange range = error.place ? rangeOf(*error.place) : SourceRange{};
  Diagnostic &diagnostic = report({error.code, error.what()}, range);
  for (const RelatedPlace &related : error.relatedPlaces)
    diagnostic.label(rangeOf(related.place), related.text);
  for (const std::string &note : error.notes)
    diagnostic.note(note);
  if (error.replacement)
    diagnostic.fix(range, *error.replacement);
  for (const Error &further : error.further)
    report(further);
}

Diagnostic &Messages::report(const Message &message, SourceRange range) {
  return diagnostics.reportText(codeFor(message.code), range, message.text);
}

void Messages::report(const Warning &warning) {
  const SourceRange range = warning.place ? rangeOf(*warning.place) : SourceRange{};
  diagnostics.reportText(Code::sceneWarning, range, warning.message);
}

void Messages::print() {
  if (printed)
    return;
  printed = true;
  const std::string text = options.jsonDiagnostics
                               ? renderJson(diagnostics)
                               : renderText(diagnostics, wantsColour(options.ansi));
  std::fwrite(text.data(), 1, text.size(), stderr);
}

} // namespace rtsl::tool
