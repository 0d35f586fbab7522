//===- NumberFiles.h - arrays of numbers in files -------------------------===//
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace rtsl::scene {

/// Numbers in rows: the last index varies fastest.
struct NumberArray {
  std::vector<std::size_t> shape;
  std::vector<double> numbers;
};

/// Reads .npy (format 1 to 3 of NumPy): little-endian integers, floats and bools, in C order.
/// Throws BadBuffer, and the errors of reading a file.
NumberArray readNpy(const std::string &path);

/// Reads numbers between commas, a row a line. The first line may have names; `columns` chooses by
/// them, in this order; empty: all. Throws BadBuffer, UnknownName, and the errors of reading a file.
NumberArray readCsv(const std::string &path, const std::vector<std::string> &columns);

} // namespace rtsl::scene
