#include "runtime/buffers/PlyColumns.h"

#include "runtime/geometry/PlyFormat.h"
#include "support/AtomicFile.h"
#include "support/ClosestName.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <optional>
#include <string_view>

namespace rtsl::runtime {

namespace {

ply::Header headerOf(const std::string &path, std::string_view bytes) {
  if (!ply::isPly(bytes))
    throw Error(message::notPly(path));
  std::size_t lines = 0;
  const std::optional<ply::Header> header = ply::readHeader(bytes, &lines);
  if (!header)
    throw Error(message::plyBadHeader(path, lines));
  return *header;
}

/// The element of this name.
const ply::Element &find(const ply::Header &header, const std::string &name,
                         const std::string &path) {
  std::vector<std::string> names;
  for (const ply::Element &element : header.elements) {
    if (element.name == name)
      return element;
    names.push_back(element.name);
  }
  const std::string near = closestName(name, names);
  throw Error(message::noSuchElement(
      path, name, names.empty() ? "none" : fmt::format("`{}`", fmt::join(names, "`, `")),
      near.empty() ? "" : fmt::format("; did you mean `{}`?", near)));
}

/// The places of the chosen columns among the properties.
std::vector<std::size_t> choose(const ply::Element &element,
                                const std::vector<std::string> &columns, const std::string &path) {
  const std::string where = fmt::format("element `{}` of `{}`", element.name, path);
  std::vector<std::string> names;
  std::vector<std::size_t> places;
  for (const ply::Property &property : element.properties) {
    const auto isThis = [&](const std::string &column) { return column == property.name; };
    if (!property.isList) {
      names.push_back(property.name);
      places.push_back(static_cast<std::size_t>(&property - element.properties.data()));
    } else if (std::any_of(columns.begin(), columns.end(), isThis)) {
      throw Error(message::columnIsList(property.name, where));
    }
  }
  if (places.empty())
    throw Error(message::plyOnlyLists(path, element.name));
  if (columns.empty())
    return places;
  std::vector<std::size_t> chosen;
  for (const std::size_t i : placesOf(where, columns, names))
    chosen.push_back(places[i]);
  return chosen;
}

/// Reads the values of a file, in their order.
class ColumnReader {
public:
  ColumnReader(const std::string &path, std::string_view bytes, const ply::Header &header)
      : path(path), bytes(bytes), body(bytes, header) {}

  /// Appends those of the chosen properties to `numbers`, an element a row.
  void read(const ply::Element &element, const std::vector<std::size_t> &chosen,
            std::vector<double> &numbers) {
    std::vector<double> row(element.properties.size());
    if (element.count <= body.bytesLeft()) // else the file is cut short
      numbers.reserve(element.count * chosen.size());
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (std::size_t p = 0; p < row.size(); ++p) {
        const ply::Property &property = element.properties[p];
        if (!(property.isList ? body.skip(property) : body.readNumber(property.type, row[p])))
          failIn(element, i, property);
      }
      for (const std::size_t place : chosen)
        numbers.push_back(row[place]);
    }
  }

  void skip(const ply::Element &element) {
    for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
      for (const ply::Property &property : element.properties)
        if (!body.skip(property))
          failIn(element, i, property);
  }

  /// Throws unless only white space follows.
  void finish() const {
    if (bytes.substr(bytes.size() - body.bytesLeft()).find_first_not_of(" \t\r\n") != bytes.npos)
      throw Error(message::numbersTooLong(path));
  }

private:
  [[noreturn]] void failIn(const ply::Element &element, std::uint64_t index,
                           const ply::Property &property) const {
    const std::string_view word = body.lastWord();
    if (word.empty())
      throw Error(message::plyTruncated(path, index + 1, element.count, element.name));
    const auto line = 1 + std::count(bytes.data(), word.data(), '\n');
    throw Error(message::plyBadValue(path, word, line, property.name, element.name));
  }

  const std::string &path;
  std::string_view bytes;
  ply::Body body;
};

} // namespace

NumberArray readPly(const std::string &path, const std::string &element,
                    const std::vector<std::string> &columns) {
  const std::string bytes = readFile(path);
  const ply::Header header = headerOf(path, bytes);
  const ply::Element &read = find(header, element, path);
  const std::vector<std::size_t> chosen = choose(read, columns, path);
  NumberArray array;
  ColumnReader reader(path, bytes, header);
  for (const ply::Element &other : header.elements) {
    if (&other == &read)
      reader.read(other, chosen, array.numbers);
    else
      reader.skip(other);
  }
  reader.finish();
  array.shape = {read.count};
  if (chosen.size() != 1)
    array.shape.push_back(chosen.size());
  return array;
}

std::size_t plyCount(const std::string &path, const std::string &element) {
  return find(headerOf(path, readFile(path)), element, path).count;
}

} // namespace rtsl::runtime
