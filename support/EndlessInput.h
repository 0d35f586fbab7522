//===- EndlessInput.h - input that may never end --------------------------===//
#pragma once

#include <sys/stat.h>
#include <sys/sysmacros.h>
#include <unistd.h>

namespace rtsl {

/// Why the open `file` cannot be an input: a device, such as /dev/zero, may never end. Null if it
/// can: a file, a pipe, a terminal, or /dev/null.
inline const char *whyNoInput(int file) {
  struct stat status;
  if (::fstat(file, &status) != 0)
    return nullptr; // reading reports the error
  const bool isNull = S_ISCHR(status.st_mode) && status.st_rdev == makedev(1, 3);
  if (S_ISBLK(status.st_mode) || (S_ISCHR(status.st_mode) && !isNull && !::isatty(file)))
    return "it is a device";
  return nullptr;
}

} // namespace rtsl
