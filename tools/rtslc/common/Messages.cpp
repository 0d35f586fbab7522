//===- Messages.cpp - diagnostics on their way to the user ----------------===//
#include "Messages.h"

#include <cstdio>
#include <cstdlib>
#include <unistd.h>

namespace rtsl::tool {

namespace {

Code codeFor(ErrorCode code) {
  using E = ErrorCode;
  switch (code) {
  case E::FileNotFound:
    return Code::fileNotFound;
  case E::FileUnreadable:
    return Code::fileUnreadable;
  case E::FileUnwritable:
    return Code::fileUnwritable;
  case E::OverwritesInput:
    return Code::overwritesInput;
  case E::UnsupportedFormat:
    return Code::unsupportedFormat;
  case E::BadMesh:
    return Code::badMesh;
  case E::BadImage:
    return Code::badImage;
  case ErrorCode::BadBuffer:
    return Code::badBuffer;
  case E::NotAScene:
    return Code::notAScene;
  case E::JsonSyntax:
    return Code::sceneSyntax;
  case E::DuplicateKey:
    return Code::sceneDuplicateKey;
  case E::UnknownKey:
    return Code::sceneUnknownKey;
  case E::MissingKey:
    return Code::sceneMissingKey;
  case E::WrongType:
    return Code::sceneWrongType;
  case E::OutOfRange:
    return Code::sceneOutOfRange;
  case E::UnknownName:
    return Code::sceneUnknownName;
  case E::ReferenceCycle:
    return Code::sceneReferenceCycle;
  case E::NotSupported:
    return Code::sceneNotSupported;
  case E::BadOverride:
    return Code::sceneBadOverride;
  case E::UnknownClass:
    return Code::sceneUnknownClass;
  case E::WrongClass:
    return Code::sceneWrongClass;
  case E::UnknownMember:
    return Code::sceneUnknownMember;
  case E::NotSettable:
    return Code::sceneNotSettable;
  case E::BadArguments:
    return Code::sceneBadArguments;
  case E::MissingMember:
    return Code::sceneMissingMember;
  case E::DegenerateGeometry:
    return Code::sceneDegenerateGeometry;
  case E::MissingMethod:
    return Code::sceneMissingMethod;
  case E::IncompleteScene:
    return Code::sceneIncomplete;
  case E::Cancelled:
    return Code::cancelled;
  case E::OutOfMemory:
    return Code::outOfMemory;
  case E::NoDevice:
    return Code::noDevice;
  case E::BadCheckpoint:
    return Code::badCheckpoint;
  // rtslc reads no packages; rtsl-run has messages of its own.
  case E::BadPackage:
  case E::Internal:
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
  Diagnostic &diagnostic =
      diagnostics.report(codeFor(error.code), range, std::string(error.what()));
  for (const RelatedPlace &related : error.relatedPlaces)
    diagnostic.label(rangeOf(related.place), related.text);
  for (const std::string &note : error.notes)
    diagnostic.note(note);
  if (error.replacement)
    diagnostic.fix(range, *error.replacement);
  for (const Error &further : error.further)
    report(further);
}

void Messages::report(const Warning &warning) {
  const SourceRange range = warning.place ? rangeOf(*warning.place) : SourceRange{};
  diagnostics.report(Code::sceneWarning, range, warning.message);
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
