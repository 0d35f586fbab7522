#include "runtime/geometry/ObjDamage.h"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <limits>
#include <vector>

namespace rtsl::runtime {

namespace {

/// The words of a line, without the comment at its end.
std::vector<std::string_view> wordsOf(std::string_view line) {
  line = line.substr(0, line.find('#'));
  std::vector<std::string_view> words;
  while (true) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t\r"), line.size()));
    if (line.empty())
      return words;
    words.push_back(line.substr(0, line.find_first_of(" \t\r")));
    line.remove_prefix(words.back().size());
  }
}

/// Whether a word is a number, and nothing else. One that the type cannot represent is the largest
/// one of its sign.
template <typename Number>
bool readWhole(std::string_view word, Number &number) {
  if (word.size() > 1 && word[0] == '+' && word[1] != '-')
    word.remove_prefix(1);
  const char *end = word.data() + word.size();
  const auto [after, error] = std::from_chars(word.data(), end, number);
  if (error == std::errc::result_out_of_range)
    number = (word[0] == '-' ? -1 : 1) * std::numeric_limits<Number>::max();
  return after == end && error != std::errc::invalid_argument;
}

bool isCorner(std::string_view word, std::int64_t &position) {
  std::size_t slash = word.find('/');
  if (!readWhole(word.substr(0, slash), position))
    return false;
  for (int i = 0; i < 2 && slash != std::string_view::npos; ++i) {
    word.remove_prefix(slash + 1);
    slash = word.find('/');
    std::int64_t index;
    if (const std::string_view part = word.substr(0, slash);
        !part.empty() && !readWhole(part, index))
      return false;
  }
  return slash == std::string_view::npos;
}

std::vector<std::string_view> linesOf(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty()) {
    lines.push_back(text.substr(0, text.find('\n')));
    text.remove_prefix(std::min(lines.back().size() + 1, text.size()));
  }
  return lines;
}

bool isContinued(std::string_view line) {
  const std::size_t last = line.find_last_not_of('\r');
  return last != std::string_view::npos && line[last] == '\\';
}

} // namespace

std::optional<Message> findObjDamage(std::string_view text, const std::string &path) {
  const std::vector<std::string_view> lines = linesOf(text);
  if (std::any_of(lines.begin(), lines.end(), isContinued))
    return std::nullopt;
  const auto isPosition = [](std::string_view line) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    return line.size() > 1 && line[0] == 'v' && (line[1] == ' ' || line[1] == '\t');
  };
  const auto positions = std::count_if(lines.begin(), lines.end(), isPosition);
  std::int64_t above = 0;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    above += isPosition(lines[i]);
    const std::vector<std::string_view> words = wordsOf(lines[i]);
    const std::string_view kind = words.empty() ? "" : words[0];
    if (kind == "v" || kind == "vn" || kind == "vt") {
      for (std::size_t word = 1; word < words.size(); ++word)
        if (float number; !readWhole(words[word], number))
          return message::meshLineNotNumber(path, i + 1, words[word]);
      const std::size_t needed = kind == "vt" ? 1 : 3;
      if (words.size() <= needed)
        return message::meshLineTooShort(path, i + 1, kind, needed);
    } else if (kind == "f") {
      for (std::size_t word = 1; word < words.size(); ++word) {
        std::int64_t corner;
        if (!isCorner(words[word], corner))
          return message::meshLineNotNumber(path, i + 1, words[word]);
        if (corner == 0 || corner > positions || -corner > above)
          return message::meshCornerMissing(path, i + 1, corner, positions);
      }
    }
  }
  return std::nullopt;
}

} // namespace rtsl::runtime
