//===- LargeFile.h - the contents of a large file -------------------------===//
#pragma once

#include "support/LargeArray.h"

#include <string>
#include <string_view>

namespace rtsl {

/// The contents of a file, read on all cores into huge pages.
class LargeFile {
public:
  /// Throws the errors of readFile (AtomicFile.h).
  explicit LargeFile(const std::string &path);

  std::string_view bytes() const {
    return large.empty() ? std::string_view(other) : std::string_view(large.begin(), large.size());
  }

private:
  LargeArray<char> large; // of a regular file that did not change while it was read
  std::string other;      // of anything else
};

} // namespace rtsl
