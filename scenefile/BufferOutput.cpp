#include "scenefile/BufferOutput.h"

#include "support/AtomicFile.h"
#include "support/Error.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <filesystem>
#include <vector>

namespace rtsl::scene {

using runtime::OutputBuffer;
using runtime::ValueType;

namespace {

/// The dimensions of an element: of its arrays, then of a matrix its columns and rows.
std::vector<std::uint32_t> elementShape(const OutputBuffer &buffer) {
  const ValueType &type = buffer.type;
  std::vector<std::uint32_t> shape = type.arraySizes;
  if (type.kind == ValueType::Kind::Color) {
    std::uint32_t numbers = type.elementSize / 4;
    for (const std::uint32_t size : type.arraySizes)
      numbers /= size;
    shape.push_back(numbers);
    return shape;
  }
  if (type.columns > 1)
    shape.push_back(type.columns);
  if (type.rows > 1)
    shape.push_back(type.rows);
  return shape;
}

std::string npyOf(const OutputBuffer &buffer) {
  std::vector<std::uint32_t> shape = buffer.sizes;
  for (const std::uint32_t size : elementShape(buffer))
    shape.push_back(size);
  const bool isBool = buffer.type.kind == ValueType::Kind::Bool;
  const char *type = isBool                                      ? "|b1"
                     : buffer.type.kind == ValueType::Kind::Int  ? "<i4"
                     : buffer.type.kind == ValueType::Kind::UInt ? "<u4"
                                                                 : "<f4";
  std::string header = fmt::format("{{'descr': '{}', 'fortran_order': False, 'shape': ({}{}), }}",
                                   type, fmt::join(shape, ", "), shape.size() == 1 ? "," : "");
  constexpr std::size_t before = 10, alignment = 64; // magic, version and length; of the numbers
  header.append(alignment - (before + header.size() + 1) % alignment, ' ');
  header += '\n';
  std::string file = "\x93NUMPY";
  file += {1, 0, static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)};
  file += header;
  if (!isBool)
    return file.append(reinterpret_cast<const char *>(buffer.elements), buffer.bytes);
  for (std::size_t i = 0; i < buffer.bytes; i += 4)
    file += static_cast<char>(buffer.elements[i] != 0);
  return file;
}

std::string csvOf(const OutputBuffer &buffer) {
  std::size_t columns = buffer.type.elementSize / 4;
  if (columns == 1 && buffer.sizes.size() == 2)
    columns = buffer.sizes[1];
  std::string text;
  for (std::size_t i = 0; i < buffer.bytes / 4; ++i) {
    std::uint32_t word = 0;
    std::memcpy(&word, buffer.elements + 4 * i, sizeof word);
    float number = 0;
    std::memcpy(&number, &word, sizeof number);
    switch (buffer.type.kind) {
    case ValueType::Kind::Int:
      text += fmt::format("{}", static_cast<std::int32_t>(word));
      break;
    case ValueType::Kind::UInt:
    case ValueType::Kind::Bool:
      text += fmt::format("{}", word);
      break;
    default:
      text += fmt::format("{}", number);
    }
    text += (i + 1) % columns == 0 ? '\n' : ',';
  }
  return text;
}

} // namespace

void writeBuffer(const std::string &path, const OutputBuffer &buffer) {
  const std::string extension = std::filesystem::path(path).extension().string();
  const bool hasFormat = extension == ".npy" || extension == ".csv";
  if (hasFormat && buffer.type.kind == ValueType::Kind::Struct)
    throw Error(ErrorCode::NotSupported,
                fmt::format("`{}` cannot hold `{}`, a `{}`: its elements are structs", path,
                            buffer.member, buffer.type.name))
        .note("a file with another ending gets the elements as they lie in memory");
  writeFileAtomically(
      path, extension == ".npy" ? npyOf(buffer)
            : extension == ".csv"
                ? csvOf(buffer)
                : std::string(reinterpret_cast<const char *>(buffer.elements), buffer.bytes));
}

} // namespace rtsl::scene
