//===- ErrorText.h - an error as one line, for tests ----------------------===//
#pragma once

#include "support/Error.h"

#include <string>

namespace rtsl::scene::test {

/// "file:line:column+length: code: message (fix `...`) (note ...)", and a line for each further
/// error.
inline std::string textOf(const Error &error) {
  std::string text;
  if (error.place) {
    text = error.place->file;
    if (error.place->line)
      text += ":" + std::to_string(error.place->line) + ":" + std::to_string(error.place->column) +
              "+" + std::to_string(error.place->length);
    text += ": ";
  }
  text += std::string(name(error.code)) + ": " + error.what();
  if (error.replacement)
    text += " (fix `" + *error.replacement + "`)";
  for (const RelatedPlace &related : error.relatedPlaces)
    text += " (" + std::to_string(related.place.line) + ":" + std::to_string(related.place.column) +
            " " + related.text + ")";
  for (const std::string &note : error.notes)
    text += " (note " + note + ")";
  for (const Error &further : error.further)
    text += "\n" + textOf(further);
  return text;
}

/// What `action` throws, or "no error".
template <typename Action>
std::string errorOf(Action action) {
  try {
    action();
  } catch (const Error &error) {
    return textOf(error);
  }
  return "no error";
}

} // namespace rtsl::scene::test
