#include "runtime/buffers/BufferOutput.h"

#include "runtime/buffers/NumpyTypes.h"
#include "support/AtomicFile.h"
#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

namespace rtsl::runtime {

namespace {

/// What comes before the elements in a .npy file.
std::string npyHeader(const OutputBuffer &buffer) {
  std::vector<std::uint32_t> shape = buffer.sizes;
  for (const std::uint32_t size : elementShape(buffer.type, buffer.type.elementSize))
    shape.push_back(size);
  std::string header = fmt::format("{{'descr': {}, 'fortran_order': False, 'shape': {}, }}",
                                   numpyType(buffer.type), tupleOf(shape));
  constexpr std::size_t before = 10, alignment = 64; // magic, version and length; of the numbers
  header.append(alignment - (before + header.size() + 1) % alignment, ' ');
  header += '\n';
  std::string file = "\x93NUMPY";
  file += {1, 0, static_cast<char>(header.size() & 0xff), static_cast<char>(header.size() >> 8)};
  return file + header;
}

/// Bools, a byte each, as .npy has them.
std::string bytesOfBools(const OutputBuffer &buffer) {
  std::string bytes;
  for (std::size_t i = 0; i < buffer.bytes; i += 4)
    bytes += static_cast<char>(buffer.elements[i] != 0);
  return bytes;
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

void checkBufferFile(const std::string &path, const std::string &buffer, bool holdsStructs,
                     const std::string &type) {
  if (holdsStructs && std::filesystem::path(path).extension() == ".csv")
    throw Error(message::structsNotInFile(path, "`" + buffer + "`", type)).note(".npy holds them");
}

void writeBuffer(const std::string &path, const OutputBuffer &buffer) {
  const std::string extension = std::filesystem::path(path).extension().string();
  checkBufferFile(path, buffer.member, buffer.type.kind == ValueType::Kind::Struct,
                  buffer.type.name);
  if (extension == ".csv")
    return writeFileAtomically(path, csvOf(buffer));
  // The elements are written from where they lie: there may be no memory for another copy.
  const std::string_view elements(reinterpret_cast<const char *>(buffer.elements), buffer.bytes);
  if (extension != ".npy")
    return writeFileAtomically(path, elements);
  const std::string header = npyHeader(buffer);
  if (buffer.type.kind == ValueType::Kind::Bool)
    return writeFileAtomically(path, header + bytesOfBools(buffer));
  writeFileAtomically(path, std::vector<std::string_view>{header, elements});
}

} // namespace rtsl::runtime
