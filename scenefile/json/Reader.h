//===- Reader.h - reading JSON values, with error messages ----------------===//
#pragma once

#include "scenefile/json/JsonValue.h"

#include <initializer_list>
#include <string>

namespace rtsl::scene {

/// Throws WrongType unless `value` is of `kind`. `what` begins the message: "`camera`".
const JsonValue &expect(const JsonValue &value, JsonValue::Kind kind, const std::string &what);

/// Throws UnknownKey for the keys of an object that are not in `known`, with a suggestion.
void checkKeys(const JsonValue &object, std::initializer_list<const char *> known,
               const std::string &what);

/// A required member: throws MissingKey.
const JsonValue &require(const JsonValue &object, const char *key, const std::string &what);

/// A finite number.
double readNumber(const JsonValue &value, const std::string &what);

/// An integer in [lowest, highest]: throws WrongType, OutOfRange.
std::uint32_t readInteger(const JsonValue &value, std::uint32_t lowest, std::uint32_t highest,
                          const std::string &what);

/// Any 32-bit integer, for `id`.
std::int32_t readId(const JsonValue &value);

/// The file that a path of a scene file means: paths are relative to the scene's folder, those of
/// included files to theirs, and those from the command line to the working directory.
std::string resolvePath(const JsonValue &path, const std::string &sceneFile);

/// A list of exactly `count` numbers.
std::vector<double> readNumbers(const JsonValue &value, std::size_t count, const std::string &what);

} // namespace rtsl::scene
