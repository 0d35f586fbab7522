//===- LaunchSizes.h - launches of the size of a file without a format ----===//
#pragma once

#include "scenefile/SceneFile.h"

#include <functional>

namespace rtsl::scene {

/// The bytes of an element of a buffer member, by the names of its class and its own; 0: the class
/// has no buffer of this name, or one of several dimensions.
using ElementBytes =
    std::function<std::uint64_t(const std::string &className, const std::string &member)>;

/// Sets the size of launches that have an index for each element of a file without a format: how
/// many that are depends on the type of the member of the ray generation that takes the buffer.
/// Throws BadBuffer, MissingKey, OutOfRange, and the errors of reading a file.
void setLaunchSizes(SceneDescription &description, const ElementBytes &elementBytes);

} // namespace rtsl::scene
