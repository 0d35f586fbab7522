//===- PlyCheck.h - is a PLY file whole? ----------------------------------===//
//
// assimp reads a PLY file that ends too early without a word: what is missing becomes zeros. A PLY
// header says how much is to follow, so this counts it.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <string>

namespace rtsl::runtime {

/// Empty if `bytes` hold all elements that the header declares, or if the header makes no sense
/// (assimp says that better). Otherwise what is missing: "ends in element 7 of 12 of `face`".
std::string findMissingPlyElements(const std::string &bytes);

} // namespace rtsl::runtime
