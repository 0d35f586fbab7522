//===- Format.h - C++ as clang-format writes it ---------------------------===//
#pragma once

#include <string>

namespace rtsl::cpp {

/// The code in this project's own style, by clang-format's library.
std::string format(const std::string &code);

} // namespace rtsl::cpp
