//===- NumberFiles.h - arrays of numbers in files -------------------------===//
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rtsl::runtime {

/// Numbers in rows: the last index varies fastest.
struct NumberArray {
  std::vector<std::size_t> shape;
  std::vector<double> numbers;
};

/// A .npy file (format 1 to 3 of NumPy): little-endian integers, floats and bools, or structs, in C
/// order.
class NpyFile {
public:
  enum class Part { Whole, Header };
  struct StructType {
    std::string name; // as NumPy writes it
    std::size_t bytes;
  };
  /// Reads it. With a `structType` its elements must be such structs, without one they must be
  /// numbers; for Part::Header it does not matter. Throws BadBuffer, and the errors of reading a
  /// file.
  explicit NpyFile(const std::string &path, Part part = Part::Whole,
                   const StructType *structType = nullptr);

  const std::vector<std::size_t> &shape() const { return sizes; }
  /// The number of all elements.
  std::size_t count() const { return elementCount; }
  /// The type of numbers as NumPy writes it: "<f4".
  const char *elementType() const;
  /// The elements as they lie in the file. Not of a header alone.
  const char *elements() const { return file.data() + start; }
  std::vector<double> numbers() const;

private:
  void checkLength(const std::string &path, std::size_t bytes, std::size_t elementBytes);

  std::string file;
  std::size_t start = 0, elementCount = 1, type = 0;
  std::vector<std::size_t> sizes;
};

/// Reads numbers between commas, a row a line. The first line may have names; `columns` chooses by
/// them, in this order; empty: all. Throws BadBuffer, UnknownName, and the errors of reading a
/// file.
NumberArray readCsv(const std::string &path, const std::vector<std::string> &columns);

/// The places of the chosen columns among the names of a file. `where` begins the message. Throws
/// UnknownName.
std::vector<std::size_t> placesOf(const std::string &where, const std::vector<std::string> &columns,
                                  const std::vector<std::string> &names);

} // namespace rtsl::runtime
