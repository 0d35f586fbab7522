//===- LaunchSizes.h - launches of the size of a file without a format ----===//
#pragma once

#include "scenefile/SceneFile.h"

#include <functional>

namespace rtsl::scene {

/// A buffer member, as its class declares it.
struct BufferMember {
  std::uint32_t dimensions = 0; // 0: the class has no buffer of this name
  std::uint64_t elementBytes = 0;
};

/// The buffer member with these names.
using FindBuffer =
    std::function<BufferMember(const std::string &className, const std::string &member)>;

/// Sets the size of launches that have an index for each element of a file without a format: how
/// many that are depends on the type of the member of the ray generation that takes the buffer.
/// Throws BadBuffer, MissingKey, OutOfRange, and the errors of reading a file.
void setLaunchSizes(SceneDescription &description, const FindBuffer &findBuffer);

} // namespace rtsl::scene
