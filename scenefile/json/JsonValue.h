//===- JsonValue.h - JSON with the position of every value ----------------===//
#pragma once

#include "support/Error.h"

#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rtsl::scene {

struct JsonValue;

/// A key of a JSON object.
struct JsonKey {
  std::string text;
  std::uint32_t line = 0, column = 0, length = 0;
  std::shared_ptr<const std::string> file = nullptr; // null: that of its object
};

struct JsonValue {
  enum class Kind : std::uint8_t { Null, Boolean, Number, String, Array, Object };

  Kind kind = Kind::Null;
  bool boolean = false;
  bool isInteger = false; // a number that was written without a fraction and fits 64 bits
  double number = 0;
  std::string string;
  std::vector<JsonValue> elements; // Array
  // Object, in the order of the file; keys are unique
  std::vector<std::pair<JsonKey, JsonValue>> members;

  // Its beginning: a string inside its quotes, an array or object at its bracket (length 1). The
  // file of an override is its text on the command line, "--set path.to.key=value".
  std::shared_ptr<const std::string> file;
  std::uint32_t line = 0, column = 0, length = 0;
  /// Of a number of a value with key frames: what it is in each of them.
  std::shared_ptr<const std::vector<JsonValue>> keys;
  bool fromOverride = false; // came from --set
  bool isOfLibrary = false;  // as in LocatedName
  bool isIncluded = false;   // from another file than the scene's: paths in it are relative to that

  Place place() const { return {*file, line, column, length}; }
  /// The place of a key of this object, or of the object whose value this is.
  Place place(const JsonKey &key) const {
    return {key.file ? *key.file : *file, key.line, key.column, key.length};
  }
  const JsonValue *find(const std::string &key) const;
  JsonValue *find(const std::string &key);
};

/// "a number", "an object": for messages.
const char *describe(JsonValue::Kind kind);

/// Parses a whole text. Throws Error with JsonSyntax, or DuplicateKey. Nesting deeper than 256 is
/// rejected.
JsonValue parseJson(const std::string &text, const std::string &file);

/// Applies "path.to.key=value": see readSceneFile. A missing last key of an object is added, an
/// array's index must exist or be one past the end. Throws BadOverride.
void applyOverride(JsonValue &root, const std::string &text);

} // namespace rtsl::scene
