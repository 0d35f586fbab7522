//===- Path.h - the ways that a shader can run ----------------------------===//
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace rtsl::numerics {

/// Machine code in this process (strict, fast, or with arithmetic in double), emitted C++, and the
/// whole program of a GPU, on the CPU or on the first CUDA device. What is not called fast or
/// double is strict, and has to give the same bits.
enum class Path : std::uint8_t { Strict, Fast, Double, Cpp, Megakernel, Gpu };

inline const std::map<std::string, Path> pathNames = {
    {"strict", Path::Strict},         {"fast", Path::Fast},
    {"double", Path::Double},         {"cpp", Path::Cpp},
    {"megakernel", Path::Megakernel}, {"gpu", Path::Gpu}};

} // namespace rtsl::numerics
