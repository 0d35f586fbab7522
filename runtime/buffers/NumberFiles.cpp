#include "runtime/buffers/NumberFiles.h"

#include "support/AtomicFile.h"
#include "support/ByteOrderMark.h"
#include "support/ClosestName.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <half.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string_view>

namespace rtsl::runtime {

namespace {

//===----------------------------------------------------------------------===//
// .npy (https://numpy.org/doc/stable/reference/generated/numpy.lib.format.html)
//===----------------------------------------------------------------------===//

/// What follows a key of the header, which is a dictionary in Python's notation.
std::string_view valueOf(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == header.npos)
    return {};
  std::string_view rest = header.substr(at + key.size());
  const std::size_t begin = rest.find_first_not_of(": ");
  return begin == rest.npos ? std::string_view() : rest.substr(begin);
}

/// A struct's type at the beginning of the text: a list with lists in it.
std::string_view structTypeOf(std::string_view text) {
  int depth = 0;
  for (std::size_t i = 0; i < text.size(); ++i) {
    depth += text[i] == '[' ? 1 : text[i] == ']' ? -1 : 0;
    if (depth == 0)
      return text.substr(0, i + 1);
  }
  return text;
}

std::vector<std::size_t> shapeOf(const std::string &path, std::string_view text) {
  std::vector<std::size_t> shape;
  if (text.empty() || text.front() != '(')
    throw Error(message::npyWithoutShape(path));
  text.remove_prefix(1);
  while (true) {
    text.remove_prefix(std::min(text.find_first_not_of(", "), text.size()));
    if (text.empty())
      throw Error(message::npyWithoutShape(path));
    if (text.front() == ')')
      return shape;
    std::size_t size = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), size);
    if (error != std::errc())
      throw Error(message::npyBadShape(path));
    shape.push_back(size);
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  }
}

template <typename Number>
void convert(const char *bytes, std::vector<double> &numbers) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    Number number;
    std::memcpy(&number, bytes + i * sizeof number, sizeof number);
    numbers[i] = static_cast<double>(number);
  }
}

struct ElementType {
  const char *name;
  std::size_t bytes;
  void (*convert)(const char *, std::vector<double> &);
};
constexpr ElementType elementTypes[] = {
    {"<f4", 4, convert<float>},         {"<f8", 8, convert<double>},
    {"<f2", 2, convert<half>},          {"<i4", 4, convert<std::int32_t>},
    {"<i8", 8, convert<std::int64_t>},  {"<u4", 4, convert<std::uint32_t>},
    {"<u8", 8, convert<std::uint64_t>}, {"<i2", 2, convert<std::int16_t>},
    {"<u2", 2, convert<std::uint16_t>}, {"|i1", 1, convert<std::int8_t>},
    {"|u1", 1, convert<std::uint8_t>},  {"|b1", 1, convert<std::uint8_t>},
};

//===----------------------------------------------------------------------===//
// .csv
//===----------------------------------------------------------------------===//

std::string_view trim(std::string_view text) {
  const auto isSpace = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  while (!text.empty() && isSpace(text.front()))
    text.remove_prefix(1);
  while (!text.empty() && isSpace(text.back()))
    text.remove_suffix(1);
  return text;
}

/// Removes the part of `text` up to the separator, and returns it.
std::string_view next(std::string_view &text, char separator) {
  const std::size_t end = std::min(text.find(separator), text.size());
  const std::string_view part = text.substr(0, end);
  text.remove_prefix(std::min(end + 1, text.size()));
  return part;
}

std::vector<std::string_view> cellsOf(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const bool isLast = line.find(',') == line.npos;
    cells.push_back(trim(next(line, ',')));
    if (isLast)
      return cells;
  }
}

bool isNumber(std::string_view text, double &number) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size();
}

} // namespace

/// The beginning of a file, as much as a header can be.
static std::string readStart(const std::string &path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    return readFile(path); // which says why it cannot be read
  std::string start(1 << 17, '\0');
  stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  start.resize(static_cast<std::size_t>(stream.gcount()));
  return start;
}

NpyFile::NpyFile(const std::string &path, Part part, const StructType *structType)
    : file(part == Part::Whole ? readFile(path) : readStart(path)) {
  if (file.size() < 10 || file.compare(0, 6, "\x93NUMPY") != 0)
    throw Error(message::notNpy(path));
  const auto byte = [&](std::size_t i) { return std::size_t(static_cast<unsigned char>(file[i])); };
  const bool isLong = byte(6) >= 2; // the length of the header has 4 bytes
  start = isLong ? 12 : 10;
  std::size_t length = byte(8) | byte(9) << 8;
  if (isLong && file.size() >= start)
    length |= byte(10) << 16 | byte(11) << 24;
  if (byte(6) < 1 || byte(6) > 3 || file.size() < start || file.size() - start < length)
    throw Error(message::npyBadHeader(path));
  std::string_view header = std::string_view(file).substr(start, length);
  start += length;

  const std::string_view name = valueOf(header, "'descr'");
  const bool hasStructs = !name.empty() && name.front() == '[';
  std::size_t elementBytes = 0;
  if (hasStructs) {
    const std::string_view given = structTypeOf(name);
    if (part == Part::Whole && !structType)
      throw Error(message::npyBadElements(path, given));
    if (structType && given != structType->name)
      throw Error(message::npyOtherStructs(path, given, structType->name));
    elementBytes = structType ? structType->bytes : 0;
    header = name.substr(given.size()); // a field may have the name of a key
  } else {
    const auto *const found =
        std::find_if(std::begin(elementTypes), std::end(elementTypes), [&](const ElementType &one) {
          return name.size() > 4 && name.front() == '\'' && name.substr(1, 3) == one.name;
        });
    if (structType)
      throw Error(message::npyOtherStructs(path, name.substr(0, name.find(',')), structType->name));
    if (found == std::end(elementTypes))
      throw Error(message::npyBadElements(path, name.substr(0, name.find(','))));
    type = static_cast<std::size_t>(found - elementTypes);
    elementBytes = found->bytes;
  }
  sizes = shapeOf(path, valueOf(header, "'shape'"));
  if (sizes.size() > 1 && valueOf(header, "'fortran_order'").substr(0, 4) == "True")
    throw Error(message::npyFortranOrder(path));
  std::error_code error;
  if (elementBytes != 0)
    checkLength(
        path, (part == Part::Whole ? file.size() : std::filesystem::file_size(path, error)) - start,
        elementBytes);
}

/// Counts the elements, which take all of these bytes.
void NpyFile::checkLength(const std::string &path, std::size_t bytes, std::size_t elementBytes) {
  if (std::find(sizes.begin(), sizes.end(), std::size_t(0)) != sizes.end())
    elementCount = 0;
  for (const std::size_t size : sizes) {
    if (size != 0 && elementCount > bytes / size)
      throw Error(message::numbersTruncated(path));
    elementCount *= size;
  }
  if (bytes / elementBytes < elementCount)
    throw Error(message::numbersTruncated(path));
  if (bytes != elementCount * elementBytes)
    throw Error(message::numbersTooLong(path));
}

const char *NpyFile::elementType() const {
  return elementTypes[type].name;
}

std::vector<double> NpyFile::numbers() const {
  std::vector<double> numbers(elementCount);
  elementTypes[type].convert(elements(), numbers);
  return numbers;
}

std::vector<std::size_t> placesOf(const std::string &where, const std::vector<std::string> &columns,
                                  const std::vector<std::string> &names) {
  std::vector<std::size_t> places;
  for (const std::string &column : columns) {
    const auto found = std::find(names.begin(), names.end(), column);
    if (found == names.end()) {
      const std::string near = closestName(column, names);
      throw Error(
          message::noSuchColumn(where, column, fmt::join(names, "`, `"),
                                near.empty() ? "" : fmt::format("; did you mean `{}`?", near)));
    }
    places.push_back(static_cast<std::size_t>(found - names.begin()));
  }
  return places;
}

NumberArray readCsv(const std::string &path, const std::vector<std::string> &columns) {
  const std::string file = readFile(path);
  std::string_view text = file;
  text.remove_prefix(byteOrderMarkLength(text)); // of spreadsheets
  NumberArray array;
  std::vector<std::string> names;
  std::vector<std::size_t> places;
  std::size_t width = 0, rows = 0;
  for (std::size_t line = 1; !text.empty(); ++line) {
    const std::string_view written = trim(next(text, '\n'));
    if (written.empty())
      continue;
    const std::vector<std::string_view> cells = cellsOf(written);
    double number = 0;
    if (width == 0) {
      width = cells.size();
      const bool hasNames = !isNumber(cells.front(), number);
      if (hasNames)
        names.assign(cells.begin(), cells.end());
      if (!hasNames && !columns.empty())
        throw Error(message::noColumnNames(path, columns.front()));
      places = placesOf(fmt::format("`{}`", path), columns, names);
      for (std::size_t i = 0; columns.empty() && i < width; ++i)
        places.push_back(i);
      if (hasNames)
        continue;
    }
    if (cells.size() != width)
      throw Error(message::csvColumnCount(path, line, cells.size(), width));
    for (const std::size_t place : places) {
      if (!isNumber(cells[place], number))
        throw Error(message::csvNotNumber(path, cells[place], line));
      array.numbers.push_back(number);
    }
    ++rows;
  }
  array.shape = {rows};
  if (places.size() != 1)
    array.shape.push_back(places.size());
  return array;
}

} // namespace rtsl::runtime
