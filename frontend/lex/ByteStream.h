//===- ByteStream.h - a text as the lexer reads it ------------------------===//
#pragma once

#include <CharStream.h>
#include <misc/Interval.h>

#include <string>
#include <string_view>

namespace rtsl {

/// The bytes of a text, each as a character of its own: indices are byte offsets, and nothing is
/// copied. (The stream of the parser library decodes the whole text into four bytes per character.)
class ByteStream final : public antlr4::CharStream {
public:
  explicit ByteStream(std::string_view bytes) : bytes(bytes) {}

  void consume() override { ++position; }
  std::size_t LA(ssize_t i) override {
    // The lexer reads only the next byte and the previous one.
    const std::size_t at = i > 0 ? position + static_cast<std::size_t>(i) - 1
                                 : position - static_cast<std::size_t>(-i);
    return at < bytes.size() ? static_cast<unsigned char>(bytes[at]) : IntStream::EOF;
  }
  ssize_t mark() override { return -1; }
  void release(ssize_t) override {}
  std::size_t index() override { return position; }
  void seek(std::size_t index) override { position = index < bytes.size() ? index : bytes.size(); }
  std::size_t size() override { return bytes.size(); }
  std::string getSourceName() const override { return "text"; }
  std::string getText(const antlr4::misc::Interval &interval) override {
    const auto begin = static_cast<std::size_t>(interval.a);
    if (begin >= bytes.size() || interval.b < interval.a)
      return {};
    return std::string(bytes.substr(begin, static_cast<std::size_t>(interval.b) - begin + 1));
  }
  std::string toString() const override { return std::string(bytes); }

private:
  std::string_view bytes;
  std::size_t position = 0;
};

} // namespace rtsl
