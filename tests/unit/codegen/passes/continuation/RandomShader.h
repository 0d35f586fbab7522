// Random shaders that trace: level 1 IR, valid by construction, for comparing ways to run them.
#pragma once

#include <cstdint>
#include <string>

namespace rtsl::test {

/// A module with materials A (record of class id 1) and B (2), a background Sky (3), a camera and
/// the entries of runtime/device/ray/Abi.h. Traces stand in loops, branches, switches and behind
/// early returns; variables, among them an array that is indexed at run time, are alive across
/// them. The same seed gives the same text.
std::string randomModule(std::uint32_t seed);

} // namespace rtsl::test
