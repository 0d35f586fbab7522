//===- Error.h - what the runtime throws ----------------------------------===//
//
// ErrorMessages.h declares the messages.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace rtsl {

enum class ErrorCode : std::uint8_t {
  // Files.
  FileNotFound,
  FileUnreadable,
  FileUnwritable,  // a path that cannot be written, or a disk that is full
  OverwritesInput, // an output that is also an input
  UnsupportedFormat,
  // Meshes and images.
  BadMesh, // truncated, empty, not finite, an index out of range
  BadImage,
  BadBuffer,     // a file of numbers that is truncated, damaged, or of another size
  BadCheckpoint, // not a checkpoint, of another rendering or version, truncated, damaged
  BadPackage,    // not a package, of another version, truncated, damaged
  // Scene files.
  NotAScene, // a file of another kind than a scene, or shaders
  JsonSyntax,
  DuplicateKey,
  UnknownKey,
  MissingKey,
  WrongType,
  OutOfRange,
  UnknownName, // of a texture, material or other object
  ReferenceCycle,
  NotSupported,
  BadOverride, // --set
  // Building a scene from a program.
  UnknownClass,
  WrongClass,
  UnknownMember,
  NotSettable, // a member that is not public, or that cannot be changed now
  BadArguments,
  MissingMember,
  DegenerateGeometry,
  MissingMethod,
  IncompleteScene, // no camera, nothing to render
  // Running.
  Cancelled,
  OutOfMemory,
  NoDevice, // no GPU, or no usable one
  Internal,
};

/// The name of a code as scripts see it: "fileNotFound".
const char *name(ErrorCode code);

/// A position in a file. Lines and columns count from 1, columns and lengths in bytes; line 0 means
/// the whole file.
struct Place {
  std::string file;
  std::uint32_t line = 0, column = 0, length = 0;

  bool operator==(const Place &other) const {
    return file == other.file && line == other.line && column == other.column &&
           length == other.length;
  }
};

/// A second position that helps to understand an error.
struct RelatedPlace {
  Place place;
  std::string text;
};

/// What an error says: a row of the table, as a rule (support/ErrorMessages.h).
struct Message {
  ErrorCode code;
  std::string text;
};

class Error : public std::runtime_error {
public:
  explicit Error(const Message &message, std::optional<Place> place = std::nullopt)
      : std::runtime_error(message.text), code(message.code), place(std::move(place)) {}

  /// Suggests a replacement for the text at `place`.
  Error &fix(std::string text) {
    replacement = std::move(text);
    return *this;
  }
  Error &related(Place where, std::string text) {
    relatedPlaces.push_back({std::move(where), std::move(text)});
    return *this;
  }
  Error &note(std::string text) {
    notes.push_back(std::move(text));
    return *this;
  }

  ErrorCode code;
  std::optional<Place> place;
  std::optional<std::string> replacement;
  std::vector<RelatedPlace> relatedPlaces;
  std::vector<std::string> notes;
  /// Further errors in the same input, if its reader could continue.
  std::vector<Error> further;
};

/// A problem that does not stop a run.
struct Warning {
  std::string message;
  std::optional<Place> place;
};

} // namespace rtsl
