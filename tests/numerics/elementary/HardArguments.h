// Where rounding is hardest. Made by `elementary-exhaustive all --hardest 32`.
#pragma once

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace rtsl::elementary {

inline const std::vector<std::pair<std::string_view, std::vector<std::uint32_t>>> hardArgumentBits =
    {};

} // namespace rtsl::elementary
