#include "runtime/buffers/BufferFiles.h"

#include "runtime/buffers/NumberFiles.h"
#include "runtime/buffers/NumpyTypes.h"
#include "runtime/buffers/PlyColumns.h"
#include "runtime/scene/ValueStore.h"
#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>
#include <new>
#include <numeric>
#include <string_view>

namespace rtsl::runtime {

namespace {

/// How many numbers an element has in a file: those of a color may be red, green and blue.
std::size_t numbersOf(const ValueType &type, std::uint32_t colorComponents) {
  if (type.kind == ValueType::Kind::Struct)
    return type.elementSize / 4;
  std::size_t count =
      type.kind == ValueType::Kind::Color ? colorComponents : std::size_t(type.rows) * type.columns;
  for (const std::uint32_t size : type.arraySizes)
    count *= size;
  return count;
}

/// A number as the bits of a component.
std::uint32_t wordOf(double number, const ValueType &type, const std::string &what) {
  std::uint32_t word = 0;
  switch (type.kind) {
  case ValueType::Kind::Int:
  case ValueType::Kind::UInt: {
    const bool isSigned = type.kind == ValueType::Kind::Int;
    const double lowest = isSigned ? -2147483648.0 : 0.0;
    const double highest = isSigned ? 2147483647.0 : 4294967295.0;
    if (!(number >= lowest && number <= highest && number == std::floor(number)))
      throw Error(message::wholeNumberOutOfRange(what, lowest, highest, number));
    return isSigned ? std::uint32_t(std::int32_t(number)) : std::uint32_t(number);
  }
  case ValueType::Kind::Bool:
    return number != 0;
  default: {
    const float single = static_cast<float>(number);
    if (std::isinf(single) && !std::isinf(number))
      throw Error(message::floatTooLarge(what, number));
    std::memcpy(&word, &single, sizeof word);
    return word;
  }
  }
}

/// Numbers in the layout of the elements.
std::shared_ptr<Value::Words> wordsOf(const std::vector<double> &numbers, std::size_t given,
                                      const ValueType &type, std::uint32_t colorComponents,
                                      const std::string &what) {
  std::vector<std::uint32_t> words;
  const bool isColor = type.kind == ValueType::Kind::Color && given != colorComponents;
  words.reserve(isColor ? numbers.size() / given * colorComponents : numbers.size());
  for (std::size_t i = 0; i < numbers.size(); i += isColor ? given : 1) {
    if (!isColor) {
      words.push_back(wordOf(numbers[i], type, what));
      continue;
    }
    std::vector<float> color;
    for (std::size_t j = 0; j < given; ++j)
      color.push_back(static_cast<float>(numbers[i + j]));
    for (const float component : colorFromNumbers(color, colorComponents))
      words.push_back(wordOf(double(component), type, what));
  }
  return std::make_shared<Value::Words>(std::move(words));
}

std::vector<std::uint32_t> sizesOf(const std::vector<std::size_t> &shape, std::size_t rank,
                                   const std::string &what) {
  std::vector<std::uint32_t> sizes;
  for (std::size_t i = 0; i < rank; ++i) {
    if (shape[i] > std::numeric_limits<std::uint32_t>::max())
      throw Error(message::tooManyElements(what));
    sizes.push_back(static_cast<std::uint32_t>(shape[i]));
  }
  return sizes;
}

bool hasReferences(const ValueType &type) {
  return type.kind == ValueType::Kind::Reference ||
         std::any_of(type.fields.begin(), type.fields.end(),
                     [](const MemberInfo &field) { return hasReferences(field.type); });
}

/// Makes the words of bools 0 or 1, of a struct or number of the type at `words`.
void makeBools(std::uint32_t *words, const ValueType &type, std::size_t bytes) {
  if (type.kind == ValueType::Kind::Bool)
    for (std::size_t i = 0; i < bytes / 4; ++i)
      words[i] = words[i] != 0;
  if (type.kind != ValueType::Kind::Struct)
    return;
  std::size_t count = 1;
  for (const std::uint32_t size : type.arraySizes)
    count *= size;
  for (std::size_t i = 0; i < count; ++i)
    for (const MemberInfo &field : type.fields)
      makeBools(words + (i * (bytes / count) + field.offset) / 4, field.type, field.type.size);
}

/// Elements that lie in a file as they do in memory.
std::shared_ptr<Value::Words> wordsAt(const char *elements, std::size_t bytes,
                                      const ValueType &type) {
  auto words = std::make_shared<Value::Words>(bytes / 4);
  std::memcpy(words->data(), elements, bytes);
  if (type.kind == ValueType::Kind::Bool || type.kind == ValueType::Kind::Struct)
    for (std::size_t i = 0; i < bytes; i += type.elementSize)
      makeBools(words->data() + i / 4, type, type.elementSize);
  return words;
}

/// The shape of a file for a buffer, such as "n, m, 3".
std::string shapeTaken(const ValueType &type, std::size_t numbers) {
  constexpr std::string_view names[] = {"n", "m", "k"};
  std::string shape;
  for (std::size_t i = 0; i < type.bufferRank; ++i)
    shape += fmt::format("{}{}", i ? ", " : "", names[i]);
  return numbers == 1 ? shape : fmt::format("{}, {}", shape, numbers);
}

/// The number of numbers, or structs, that a file of this shape has for an element. The dimensions
/// of the buffer come first, those of an element follow. Throws WrongType.
std::size_t checkShape(const std::string &file, const std::vector<std::size_t> &shape,
                       const ValueType &type, std::size_t numbers, const std::string &what) {
  std::size_t given = 1;
  for (std::size_t i = type.bufferRank; i < shape.size(); ++i)
    given *= shape[i];
  const bool isColor = type.kind == ValueType::Kind::Color && type.arraySizes.empty();
  if (shape.size() < type.bufferRank ||
      (given != numbers && !(isColor && (given == 1 || given == 3))))
    throw Error(message::bufferShape(what, type.name, shapeTaken(type, numbers),
                                     type.kind == ValueType::Kind::Struct ? " of structs" : "",
                                     file, fmt::join(shape, ", ")));
  return given;
}

/// Whether elements of a .npy file are the words of the type.
bool liesAs(const ValueType &type, std::string_view elementType) {
  switch (type.kind) {
  case ValueType::Kind::Float:
  case ValueType::Kind::Color:
    return elementType == "<f4";
  case ValueType::Kind::Int:
    return elementType == "<i4";
  case ValueType::Kind::UInt:
    return elementType == "<u4";
  default:
    return false;
  }
}

/// The elements of a file without a format.
Value readElements(const BufferDescription &buffer, const ValueType &type, std::size_t numbers,
                   const std::string &what) {
  const std::string bytes = readFile(buffer.file);
  const std::size_t stride = 4 * numbers;
  std::vector<std::size_t> shape(buffer.shape.begin(), buffer.shape.end());
  if (shape.empty() && type.bufferRank == 1) {
    if (bytes.size() % stride != 0)
      throw Error(message::bufferFileElements(buffer.file, bytes.size(), what, type.name, stride));
    shape.push_back(bytes.size() / stride);
  }
  if (shape.size() != type.bufferRank)
    throw Error(message::bufferShapeRank(what, type.name, type.bufferRank));
  const auto count = std::accumulate(shape.begin(), shape.end(), 1.0,
                                     [](double a, auto b) { return a * double(b); });
  if (count * double(stride) != double(bytes.size()))
    throw Error(message::bufferFileSize(buffer.file, bytes.size(), fmt::join(shape, " x "), stride,
                                        count * double(stride)));
  return Value::block(wordsAt(bytes.data(), bytes.size(), type),
                      sizesOf(shape, shape.size(), what));
}

/// Structs of a .npy file.
Value readStructs(const std::string &path, const ValueType &type, const std::string &what) {
  std::size_t count = 1; // of a fixed-length array of structs
  for (const std::uint32_t size : type.arraySizes)
    count *= size;
  const NpyFile::StructType structType{numpyType(type), type.elementSize / count};
  const NpyFile file(path, NpyFile::Part::Whole, &structType);
  checkShape(path, file.shape(), type, count, what);
  return Value::block(wordsAt(file.elements(), file.count() * structType.bytes, type),
                      sizesOf(file.shape(), type.bufferRank, what));
}

} // namespace

std::string extensionOf(const BufferDescription &buffer) {
  return std::filesystem::path(buffer.file).extension().string();
}

Value zeros(const std::vector<std::uint32_t> &sizes, const ValueType &type,
            const std::string &what) {
  if (sizes.size() != type.bufferRank)
    throw Error(message::bufferSizeRank(what, type.name, type.bufferRank,
                                        type.bufferRank == 1 ? "" : "s", sizes.size()));
  const double bytes = std::accumulate(sizes.begin(), sizes.end(), double(type.elementSize),
                                       [](double a, std::uint32_t b) { return a * double(b); });
  constexpr double gibibyte = 1 << 30;
  try {
    if (bytes > double(std::numeric_limits<std::int64_t>::max()))
      throw std::bad_alloc();
    auto words = std::make_shared<Value::Words>(static_cast<std::size_t>(bytes) / 4);
    return Value::block(std::move(words), sizes);
  } catch (const std::bad_alloc &) {
    throw Error(message::noMemoryForBuffer(what, bytes / gibibyte,
                                           double(MemoryReservation::all()) / gibibyte));
  }
}

Value readBuffer(const BufferDescription &buffer, const ValueType &type,
                 std::uint32_t colorComponents, const std::string &what) {
  if (type.bufferRank == 0)
    throw Error(message::notBuffer(what, type.name));
  if (buffer.file.empty())
    return zeros(buffer.shape, type, what);
  if (hasReferences(type))
    throw Error(message::typeNotInFile(what, type.name));
  const std::size_t numbers = numbersOf(type, colorComponents);
  const std::string extension = extensionOf(buffer);
  if (type.kind == ValueType::Kind::Struct && extension == ".npy")
    return readStructs(buffer.file, type, what);
  if (type.kind == ValueType::Kind::Struct && (extension == ".csv" || extension == ".ply"))
    throw Error(message::structsNotInFile(buffer.file, what, type.name)).note(".npy holds them");
  if (extension != ".npy" && extension != ".csv" && extension != ".ply")
    return readElements(buffer, type, numbers, what);
  if (extension == ".npy") {
    const NpyFile file(buffer.file);
    const std::size_t given = checkShape(buffer.file, file.shape(), type, numbers, what);
    if (given == numbers && liesAs(type, file.elementType())) {
      return Value::block(wordsAt(file.elements(), 4 * file.count(), type),
                          sizesOf(file.shape(), type.bufferRank, what));
    }
    return Value::block(wordsOf(file.numbers(), given, type, colorComponents, what),
                        sizesOf(file.shape(), type.bufferRank, what));
  }
  const NumberArray array = extension == ".ply"
                                ? readPly(buffer.file, buffer.element, buffer.columns)
                                : readCsv(buffer.file, buffer.columns);
  const std::size_t given = checkShape(buffer.file, array.shape, type, numbers, what);
  return Value::block(wordsOf(array.numbers, given, type, colorComponents, what),
                      sizesOf(array.shape, type.bufferRank, what));
}

std::optional<std::size_t> lengthOf(const BufferDescription &buffer) {
  if (!buffer.shape.empty())
    return buffer.shape.front();
  const std::string extension = extensionOf(buffer);
  if (extension == ".npy") {
    const NpyFile file(buffer.file, NpyFile::Part::Header);
    return file.shape().empty() ? 1 : file.shape().front();
  }
  if (extension == ".csv")
    return readCsv(buffer.file, buffer.columns).shape.front();
  if (extension == ".ply")
    return plyCount(buffer.file, buffer.element);
  return std::nullopt;
}

} // namespace rtsl::runtime
