#include "runtime/geometry/ObjLines.h"

#include "support/LargeArray.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

namespace rtsl::runtime::obj {

namespace {

enum class Line { Position, Uv, Normal, Face, Material, NoMeaning, Unknown };

Line lineOf(std::string_view word) {
  if (word == "v")
    return Line::Position;
  if (word == "f")
    return Line::Face;
  if (word == "vn")
    return Line::Normal;
  if (word == "vt")
    return Line::Uv;
  if (word == "usemtl")
    return Line::Material;
  const bool hasNoMeaning = word == "g" || word == "o" || word == "s" || word == "mtllib";
  return hasNoMeaning ? Line::NoMeaning : Line::Unknown;
}

/// A place in a text, up to which it has been read.
class Cursor {
public:
  explicit Cursor(std::string_view text) : at(text.data()), end(text.data() + text.size()) {}

  bool isAtEnd() const { return at == end; }
  bool isAtEndOfLine() const { return at == end || *at == '\n' || *at == '\r'; }
  bool isAfterWord() const { return isAtEndOfLine() || isBlank(*at); }
  bool isAt(char c) const { return at != end && *at == c; }

  void skipBlanks() {
    while (at != end && isBlank(*at))
      ++at;
  }

  bool skip(char c) {
    if (!isAt(c))
      return false;
    ++at;
    return true;
  }

  std::string_view readWord() {
    const char *start = at;
    while (!isAfterWord())
      ++at;
    return {start, std::size_t(at - start)};
  }

  /// True if only blanks remain.
  bool endLine() {
    skipBlanks();
    skip('\r');
    return at == end || skip('\n');
  }

  /// The rest of the line.
  std::string_view skipLine() {
    const char *start = at;
    const void *newline = std::memchr(at, '\n', std::size_t(end - at));
    const char *last = newline ? static_cast<const char *>(newline) : end;
    at = newline ? last + 1 : end;
    if (last != start && last[-1] == '\r')
      --last;
    return {start, std::size_t(last - start)};
  }

  template <typename Number>
  bool read(Number &number) {
    const auto [after, error] = std::from_chars(at, end, number);
    at = after;
    return error == std::errc();
  }

private:
  static bool isBlank(char c) { return c == ' ' || c == '\t'; }

  const char *at, *end;
};

/// A backslash at the end of a line continues it on the next one.
bool isContinued(std::string_view line) {
  return !line.empty() && line.back() == '\\';
}

/// Functions return false if a line is not allowed.
class Reader {
public:
  Reader(Part &part, Numbers &numbers)
      : cursor(part.text), part(part), numbers(numbers), above(part.before) {}

  bool readAll() {
    part.faceSizes.reserve(part.faceLines);
    part.corners.reserve(3 * numbers.cornerWidth() * part.faceLines);
    while (!cursor.isAtEnd())
      if (!readLine())
        return false;
    return true;
  }

private:
  bool readLine() {
    cursor.skipBlanks();
    if (cursor.isAtEndOfLine())
      return cursor.endLine();
    if (cursor.isAt('#'))
      return !isContinued(cursor.skipLine());
    switch (lineOf(cursor.readWord())) {
    case Line::Position:
      return readPosition();
    case Line::Uv:
      return readUv();
    case Line::Normal:
      return readNumbers(&numbers.normals[3 * above.normals++], 3) && cursor.endLine();
    case Line::Face:
      return readFace();
    case Line::Material:
      return readMaterial();
    case Line::NoMeaning:
      return !isContinued(cursor.skipLine());
    case Line::Unknown:
      break;
    }
    return false;
  }

  /// The rest of the line, which may contain blanks.
  bool readMaterial() {
    cursor.skipBlanks();
    std::string_view name = cursor.skipLine();
    name = name.substr(0, name.find_last_not_of(" \t") + 1);
    part.uses.push_back({part.triangleCount, name});
    return !isContinued(name) && name.find('\r') == std::string_view::npos;
  }

  bool readNumber(float &number) {
    cursor.skipBlanks();
    return cursor.read(number) && std::isfinite(number) && cursor.isAfterWord();
  }

  bool readNumbers(float *to, int count) {
    for (int i = 0; i < count; ++i)
      if (!readNumber(to[i]))
        return false;
    return true;
  }

  /// x y z, optionally with a color. Four numbers would be homogeneous coordinates.
  bool readPosition() {
    const std::size_t number = above.positions++;
    if (!readNumbers(&numbers.positions[3 * number], 3))
      return false;
    cursor.skipBlanks();
    if (cursor.isAtEndOfLine())
      return cursor.endLine();
    ++part.colorCount;
    float unwanted[3];
    return readNumbers(numbers.colors.empty() ? unwanted : &numbers.colors[3 * number], 3) &&
           cursor.endLine();
  }

  /// u v, optionally with w.
  bool readUv() {
    if (!readNumbers(&numbers.uvs[2 * above.uvs++], 2))
      return false;
    cursor.skipBlanks();
    float ignored;
    return (cursor.isAtEndOfLine() || readNumber(ignored)) && cursor.endLine();
  }

  /// Adds an index, which counts from 1, or, if negative, backwards from the last one above.
  bool readIndex(std::size_t count) {
    std::int64_t number;
    if (!cursor.read(number) || count >= none)
      return false;
    if (number < 0)
      number += std::int64_t(count) + 1;
    part.corners.push_back(std::uint32_t(number - 1));
    return number > 0 && number <= std::int64_t(count);
  }

  bool leaveOut(bool isInFile) {
    if (isInFile)
      part.corners.push_back(none);
    return true;
  }

  /// v, v/vt, v//vn or v/vt/vn.
  bool readCorner() {
    if (!readIndex(above.positions))
      return false;
    const bool goesOn = cursor.skip('/');
    const bool hasUv = goesOn && !cursor.isAt('/') && !cursor.isAtEnd();
    if (!(hasUv ? readIndex(above.uvs) : leaveOut(numbers.hasUvs())))
      return false;
    const bool hasNormal = goesOn && cursor.skip('/');
    if (!(hasNormal ? readIndex(above.normals) : leaveOut(numbers.hasNormals())))
      return false;
    return cursor.isAfterWord();
  }

  bool readFace() {
    unsigned count = 0;
    for (cursor.skipBlanks(); !cursor.isAtEndOfLine(); cursor.skipBlanks())
      if (count++ == 4 || !readCorner())
        return false;
    if (count < 3)
      return false;
    part.faceSizes.push_back(std::uint8_t(count));
    part.triangleCount += count - 2;
    return cursor.endLine();
  }

  Cursor cursor;
  Part &part;
  Numbers &numbers;
  LineCounts above;
};

} // namespace

void LineCounts::add(const LineCounts &other) {
  positions += other.positions;
  uvs += other.uvs;
  normals += other.normals;
  faces += other.faces;
}

LineCounts countLines(std::string_view text) {
  LineCounts counts;
  for (Cursor cursor(text); !cursor.isAtEnd(); cursor.skipLine()) {
    cursor.skipBlanks();
    const Line line = lineOf(cursor.readWord());
    counts.positions += line == Line::Position;
    counts.uvs += line == Line::Uv;
    counts.normals += line == Line::Normal;
    counts.faces += line == Line::Face;
  }
  return counts;
}

Numbers::Numbers(const LineCounts &counts, bool wantsColors)
    : positions(largeVector<float>(3 * counts.positions)),
      normals(largeVector<float>(3 * counts.normals)), uvs(largeVector<float>(2 * counts.uvs)),
      colors(largeVector<float>(wantsColors ? positions.size() : 0)) {}

std::vector<Part> cutIntoParts(std::string_view text, std::size_t bytes) {
  std::vector<Part> parts;
  while (!text.empty()) {
    const std::size_t newline = text.find('\n', std::min(bytes, text.size()) - 1);
    Part &part = parts.emplace_back();
    part.text = text.substr(0, newline == std::string_view::npos ? newline : newline + 1);
    text.remove_prefix(part.text.size());
  }
  return parts;
}

bool readLines(Part &part, Numbers &numbers) {
  return Reader(part, numbers).readAll();
}

} // namespace rtsl::runtime::obj
