//===- JsonValue.cpp - nlohmann's parser, and a cursor for positions ------===//
//
// nlohmann's SAX parser checks the syntax and unescapes strings but does not give the positions of
// tokens. Its events come in the order of the tokens, so a cursor that steps over one token for
// each event has them; it can be simple, because the parser has already checked the token.
//
//===----------------------------------------------------------------------===//
#include "scenefile/json/JsonValue.h"
#include "support/ByteOrderMark.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <limits>

namespace rtsl::scene {

namespace {

constexpr std::size_t deepestNesting = 256;

/// White space, separators and brackets.
bool isPunctuation(char c) {
  return c != '\0' && std::strchr(" \t\r\n,:{}[]", c);
}

struct Token {
  std::uint32_t line, column, length;
};

class Cursor {
public:
  explicit Cursor(const std::string &text) : text(text) {
    position = lineStart = byteOrderMarkLength(text); // it has no column
  }

  /// Steps over the next string, number, literal or bracket.
  Token next() {
    while (position < text.size() && std::strchr(" \t\r\n,:", text[position])) {
      if (text[position] == '\n') {
        ++line;
        lineStart = position + 1;
      }
      ++position;
    }
    std::size_t start = position;
    if (position < text.size() && text[position] == '"') {
      for (++position; position < text.size() && text[position] != '"'; ++position)
        if (text[position] == '\\')
          ++position;
      ++position;
      return at(start + 1, position - start - 2); // inside the quotes
    }
    if (position < text.size() && std::strchr("{}[]", text[position]))
      ++position;
    else
      while (position < text.size() && !isPunctuation(text[position]))
        ++position;
    return at(start, position - start);
  }

private:
  Token at(std::size_t start, std::size_t length) const {
    return {line, std::uint32_t(start - lineStart + 1), std::uint32_t(length)};
  }

  const std::string &text;
  std::size_t position = 0, lineStart = 0;
  std::uint32_t line = 1;
};

Place placeOfOffset(const std::string &text, const std::string &file, std::size_t offset,
                    std::size_t length) {
  offset = std::min(offset, text.size());
  // The end of the text is shown at the end of its last non-empty line.
  if (offset == text.size()) {
    while (offset > 0 && std::strchr(" \t\r\n", text[offset - 1]))
      --offset;
    length = 1;
  }
  std::uint32_t line =
      std::uint32_t(1 + std::count(text.begin(), text.begin() + std::ptrdiff_t(offset), '\n'));
  std::size_t newline = offset == 0 ? std::string::npos : text.rfind('\n', offset - 1);
  std::size_t lineStart = newline == std::string::npos ? 0 : newline + 1;
  return {file, line, std::uint32_t(offset - lineStart + 1),
          std::uint32_t(std::max<std::size_t>(length, 1))};
}

class TreeBuilder : public nlohmann::json_sax<nlohmann::json> {
public:
  TreeBuilder(const std::string &text, const std::string &file)
      : text(text), file(std::make_shared<const std::string>(file)), cursor(text) {}

  bool null() override { return add(JsonValue::Kind::Null); }
  bool boolean(bool value) override {
    bool good = add(JsonValue::Kind::Boolean);
    added->boolean = value;
    return good;
  }
  bool number_integer(std::int64_t value) override { return number(double(value), true); }
  bool number_unsigned(std::uint64_t value) override { return number(double(value), true); }
  bool number_float(double value, const std::string &) override { return number(value, false); }
  bool string(std::string &value) override {
    bool good = add(JsonValue::Kind::String);
    added->string = std::move(value);
    return good;
  }
  bool binary(nlohmann::json::binary_t &) override { return false; } // cannot occur in text

  bool start_object(std::size_t) override { return open(JsonValue::Kind::Object); }
  bool start_array(std::size_t) override { return open(JsonValue::Kind::Array); }
  bool end_object() override { return close(); }
  bool end_array() override { return close(); }

  bool key(std::string &value) override {
    Token token = cursor.next();
    JsonValue &object = *stack.back();
    JsonKey key{std::move(value), token.line, token.column, token.length};
    auto same = std::find_if(object.members.begin(), object.members.end(),
                             [&](const auto &member) { return member.first.text == key.text; });
    if (same != object.members.end()) {
      error = Error(message::keyTwice(key.text), object.place(key))
                  .related(object.place(same->first), "it is given here first");
      return false;
    }
    object.members.emplace_back(std::move(key), JsonValue());
    return true;
  }

  bool parse_error(std::size_t position, const std::string &token,
                   const nlohmann::json::exception &exception) override {
    std::string message = exception.what();
    if (message.find("number overflow") != std::string::npos) {
      const std::size_t length = token.size();
      const std::size_t start = position > length ? position - length : 0;
      error = Error(message::numberTooLarge(token, std::numeric_limits<double>::max()),
                    placeOfOffset(text, *file, start, length));
      return false;
    }
    // "[json.exception...] parse error at ...: syntax error while parsing X - REASON; last read:
    // '...'; expected Y"
    std::size_t reason = message.find(" - ");
    std::size_t bracket = message.find("] ");
    message = reason != std::string::npos    ? message.substr(reason + 3)
              : bracket != std::string::npos ? message.substr(bracket + 2)
                                             : message;
    if (std::size_t last = message.find("; last read: '"); last != std::string::npos) {
      std::size_t end = message.rfind("'; expected ");
      message = message.substr(0, last) +
                (end == std::string::npos || end < last ? "" : message.substr(end + 1));
    }
    bool atEnd = message.find("unexpected end of input") != std::string::npos;
    // The parser has read up to the end of the offending token.
    std::size_t end = atEnd ? text.size() : std::clamp<std::size_t>(position, 1, text.size());
    std::size_t start = atEnd ? end : end - 1;
    if (message.find("unexpected string literal") != std::string::npos) {
      while (start > 0 && (text[start - 1] != '"' || (start > 1 && text[start - 2] == '\\')))
        --start;
      start -= start > 0;
    } else if (!atEnd && message.find("invalid string") == std::string::npos &&
               !isPunctuation(text[start])) {
      while (start > 0 && !isPunctuation(text[start - 1]))
        --start;
    }
    std::size_t length = end - start;
    Place place = placeOfOffset(text, *file, start, length);
    error = Error(message::notJson(message), place);
    char wrong = start < text.size() ? text[start] : '\0';
    std::size_t before =
        start == 0 ? std::string::npos : text.find_last_not_of(" \t\r\n", start - 1);
    if ((wrong == '}' || wrong == ']') && before != std::string::npos && text[before] == ',')
      error->note("JSON allows no comma after the last element");
    else if (wrong == '/')
      error->note("JSON has no comments");
    return false;
  }

  JsonValue root;
  std::optional<Error> error;

private:
  /// Adds a value of `kind` at the current position, and points `added` at it.
  bool add(JsonValue::Kind kind) {
    Token token = cursor.next();
    if (stack.empty()) {
      added = &root;
    } else if (stack.back()->kind == JsonValue::Kind::Array) {
      stack.back()->elements.emplace_back();
      added = &stack.back()->elements.back();
    } else {
      added = &stack.back()->members.back().second;
    }
    added->kind = kind;
    added->file = file;
    added->line = token.line;
    added->column = token.column;
    added->length = token.length;
    return true;
  }

  bool number(double value, bool isInteger) {
    add(JsonValue::Kind::Number);
    added->number = value;
    added->isInteger = isInteger;
    return true;
  }

  bool open(JsonValue::Kind kind) {
    add(kind);
    // Each open value is the last of its parent, which does not grow meanwhile: pointers stay
    // valid.
    stack.push_back(added);
    if (stack.size() <= deepestNesting)
      return true;
    error = Error(message::nestedTooDeep(deepestNesting), added->place());
    return false;
  }

  bool close() {
    cursor.next();
    stack.back()->elements.shrink_to_fit(); // a scene of a million instances has twelve million
    stack.back()->members.shrink_to_fit();
    stack.pop_back();
    return true;
  }

  const std::string &text;
  std::shared_ptr<const std::string> file;
  Cursor cursor;
  std::vector<JsonValue *> stack;
  JsonValue *added = nullptr;
};

} // namespace

const JsonValue *JsonValue::find(const std::string &key) const {
  for (const auto &member : members)
    if (member.first.text == key)
      return &member.second;
  return nullptr;
}

JsonValue *JsonValue::find(const std::string &key) {
  return const_cast<JsonValue *>(static_cast<const JsonValue *>(this)->find(key));
}

const char *describe(JsonValue::Kind kind) {
  switch (kind) {
  case JsonValue::Kind::Null:
    return "null";
  case JsonValue::Kind::Boolean:
    return "a truth value";
  case JsonValue::Kind::Number:
    return "a number";
  case JsonValue::Kind::String:
    return "a string";
  case JsonValue::Kind::Array:
    return "a list";
  case JsonValue::Kind::Object:
    return "an object";
  }
  return "something else";
}

JsonValue parseJson(const std::string &text, const std::string &file) {
  TreeBuilder builder(text, file);
  bool good = nlohmann::json::sax_parse(text, &builder);
  if (builder.error)
    throw *builder.error;
  if (!good)
    throw Error(message::notJsonAtAll(), Place{file});
  return std::move(builder.root);
}

} // namespace rtsl::scene
