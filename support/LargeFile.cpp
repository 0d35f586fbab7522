#include "support/LargeFile.h"

#include "support/AtomicFile.h"
#include "support/Parallel.h"

#include <atomic>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace rtsl {

namespace {

/// Reads the bytes of `to`, of which the first is at `offset`. False if there are fewer, or on an
/// error.
bool readAt(int file, char *to, std::size_t count, std::size_t offset) {
  while (count > 0) {
    const ssize_t got = ::pread(file, to, count, off_t(offset));
    if (got <= 0)
      return false;
    to += got;
    count -= std::size_t(got);
    offset += std::size_t(got);
  }
  return true;
}

/// Nothing if the file is not a regular one, or cannot be read.
LargeArray<char> readRegularFile(const std::string &path) {
  struct stat status;
  // A pipe must not be opened twice.
  if (path == "-" || ::stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode))
    return {};
  LargeArray<char> bytes{std::size_t(status.st_size)};
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  std::atomic<bool> isRead{file >= 0};
  forRangesInParallel(0, bytes.size(), 4 << 20, [&](std::size_t first, std::size_t last) {
    if (!isRead || !readAt(file, bytes.data() + first, last - first, first))
      isRead = false;
  });
  if (file >= 0)
    ::close(file);
  return isRead ? std::move(bytes) : LargeArray<char>();
}

} // namespace

LargeFile::LargeFile(const std::string &path) : large(readRegularFile(path)) {
  if (large.empty())
    other = readFile(path);
}

} // namespace rtsl
