#include "support/AtomicFile.h"

#include "support/EndlessInput.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace rtsl {

namespace {

constexpr const char *standardOutput = "-";

[[noreturn]] void throwUnwritable(const std::string &path, int error) {
  if (path == standardOutput)
    throw Error(message::cannotWriteStandardOutput(std::strerror(error)));
  throw Error(message::cannotWrite(path, std::strerror(error)), Place{path});
}

constexpr std::string_view temporarySuffix = ".tmp";

/// Folder, with a slash at its end or empty, and beginning of the names of temporary files. They
/// are in the same folder, so that renaming stays within one file system.
std::pair<std::string, std::string> temporaryPrefix(const std::string &path) {
  std::size_t slash = path.find_last_of('/');
  std::string folder = slash == std::string::npos ? "" : path.substr(0, slash + 1);
  std::string file = slash == std::string::npos ? path : path.substr(slash + 1);
  // Shortened, so that the result is a valid name.
  return {folder, fmt::format(".{}.", file.substr(0, 200))};
}

std::string temporaryName(const std::string &path) {
  static std::atomic<unsigned> counter{0};
  const auto [folder, prefix] = temporaryPrefix(path);
  return fmt::format("{}{}{}-{}{}", folder, prefix, ::getpid(), counter++, temporarySuffix);
}

/// Creates the temporary file with the permissions of a new file. It is locked until it is closed
/// or the process ends, which shows removeUnfinishedFiles() that it is in use.
int createTemporary(const std::string &path, std::string &temporary) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    temporary = temporaryName(path);
    int file = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file < 0 && errno != EEXIST)
      return file;
    if (file < 0)
      continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) // or locks are unsupported
      return file;
    ::close(file); // it is being removed
  }
  return -1;
}

/// 0, or errno.
int writeAll(int file, std::string_view bytes) {
  while (!bytes.empty()) {
    ssize_t written = ::write(file, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR)
      continue;
    if (written < 0)
      return errno;
    if (written == 0)
      return ENOSPC;
    bytes.remove_prefix(std::size_t(written));
  }
  return 0;
}

int writeAll(int file, const std::vector<std::string_view> &parts) {
  int error = 0;
  for (const std::string_view part : parts)
    if (error == 0)
      error = writeAll(file, part);
  return error;
}

bool isSpecial(const std::string &path) {
  struct stat status;
  return ::stat(path.c_str(), &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

bool isFolder(const std::string &path) {
  struct stat status;
  return !path.empty() &&
         (path.back() == '/' || (::stat(path.c_str(), &status) == 0 && S_ISDIR(status.st_mode)));
}

/// The target of a symbolic link: the link is kept, its target replaced.
std::string followLinks(std::string path) {
  for (int depth = 0; depth < 40; ++depth) {
    char target[4096];
    ssize_t length = ::readlink(path.c_str(), target, sizeof target);
    if (length <= 0 || length == ssize_t(sizeof target))
      return path;
    std::string next(target, std::size_t(length));
    std::size_t slash = path.find_last_of('/');
    path = next[0] == '/' || slash == std::string::npos ? next : path.substr(0, slash + 1) + next;
  }
  throwUnwritable(path, ELOOP);
}

void writeDirectly(const std::string &path, const std::vector<std::string_view> &parts) {
  int file = ::open(path.c_str(), O_WRONLY | O_CLOEXEC);
  if (file < 0)
    throwUnwritable(path, errno);
  int error = writeAll(file, parts);
  if (::close(file) != 0 && error == 0)
    error = errno;
  if (error)
    throwUnwritable(path, error);
}

} // namespace

void checkFileWritable(const std::string &path) {
  if (path == standardOutput)
    return;
  if (path.empty())
    throwUnwritable(path, ENOENT);
  if (isFolder(path))
    throwUnwritable(path, EISDIR);
  if (isSpecial(path)) {
    if (::access(path.c_str(), W_OK) != 0)
      throwUnwritable(path, errno);
    return;
  }
  std::string target = followLinks(path), temporary;
  if (::access(target.c_str(), F_OK) == 0 && ::access(target.c_str(), W_OK) != 0)
    throwUnwritable(path, errno);
  int file = createTemporary(target, temporary);
  if (file < 0)
    throwUnwritable(path, errno);
  ::close(file);
  ::unlink(temporary.c_str());
}

void writeFileAtomically(const std::string &path, std::string_view bytes) {
  writeFileAtomically(path, std::vector<std::string_view>{bytes});
}

void writeFileAtomically(const std::string &path, const std::vector<std::string_view> &parts) {
  if (path == standardOutput) {
    std::fflush(stdout); // earlier output comes first
    if (const int error = writeAll(STDOUT_FILENO, parts))
      throwUnwritable(path, error);
    return;
  }
  if (path.empty())
    throwUnwritable(path, ENOENT);
  if (isFolder(path))
    throwUnwritable(path, EISDIR);
  if (isSpecial(path))
    return writeDirectly(path, parts);
  std::string target = followLinks(path), temporary;
  struct stat replaced;
  bool replaces = ::stat(target.c_str(), &replaced) == 0;
  // Renaming would ignore the write protection of a file.
  if (replaces && ::access(target.c_str(), W_OK) != 0)
    throwUnwritable(path, errno);
  int file = createTemporary(target, temporary);
  if (file < 0)
    throwUnwritable(path, errno);
  int error = writeAll(file, parts);
  if (error == 0 && replaces && ::fchmod(file, replaced.st_mode & 07777) != 0)
    error = errno;
  // Some file systems report only here that they are full.
  if (error == 0 && ::fsync(file) != 0 && errno != EINVAL && errno != ENOSYS)
    error = errno;
  if (::close(file) != 0 && error == 0)
    error = errno;
  if (error == 0 && ::rename(temporary.c_str(), target.c_str()) != 0)
    error = errno;
  if (error) {
    ::unlink(temporary.c_str());
    throwUnwritable(path, error);
  }
}

void removeUnfinishedFiles(const std::string &path) {
  const auto [folder, prefix] = temporaryPrefix(followLinks(path));
  std::error_code ignored; // what cannot be removed does no harm
  for (const auto &entry :
       std::filesystem::directory_iterator(folder.empty() ? "." : folder, ignored)) {
    const std::string name = entry.path().filename();
    if (name.compare(0, prefix.size(), prefix) != 0 ||
        name.size() < prefix.size() + temporarySuffix.size() ||
        name.compare(name.size() - temporarySuffix.size(), std::string::npos, temporarySuffix) != 0)
      continue;
    const int file = ::open(entry.path().c_str(), O_WRONLY | O_CLOEXEC | O_NOFOLLOW);
    if (file < 0)
      continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0)
      ::unlink(entry.path().c_str());
    ::close(file);
  }
}

void refuseToOverwrite(const std::string &output, const std::vector<std::string> &inputs) {
  const bool isStandardOutput = output == standardOutput;
  struct stat written, read;
  if ((isStandardOutput ? ::fstat(STDOUT_FILENO, &written) : ::stat(output.c_str(), &written)) !=
          0 ||
      !S_ISREG(written.st_mode))
    return;
  for (const std::string &input : inputs) {
    if ((input == "-" ? ::fstat(STDIN_FILENO, &read) : ::stat(input.c_str(), &read)) != 0 ||
        read.st_dev != written.st_dev || read.st_ino != written.st_ino)
      continue;
    const std::string what = isStandardOutput ? "standard output" : fmt::format("`{}`", output);
    Error error(input == output ? message::overwritesInput(what)
                                : message::overwritesSameFile(what, input),
                Place{isStandardOutput ? "<stdout>" : output});
    error.note("write to another file");
    throw error;
  }
}

namespace {

/// A file that is open for reading; -1: it could not be opened.
class OpenFile {
public:
  explicit OpenFile(const std::string &path)
      : isStandardInput(path == "-"),
        file(isStandardInput ? STDIN_FILENO : ::open(path.c_str(), O_RDONLY | O_CLOEXEC)) {}
  ~OpenFile() {
    if (file >= 0 && !isStandardInput)
      ::close(file);
  }
  OpenFile(const OpenFile &) = delete;

  const bool isStandardInput;
  const int file;
};

} // namespace

std::string readFile(const std::string &path) {
  const OpenFile open(path);
  const std::string name = open.isStandardInput ? "<stdin>" : path;
  const auto refuse = [&](const char *why) {
    throw Error(message::cannotRead(name, why), Place{name});
  };
  if (open.file < 0 && (errno == ENOENT || errno == ENOTDIR))
    throw Error(message::fileMissing(name, std::strerror(errno)), Place{name});
  if (open.file < 0)
    refuse(std::strerror(errno));
  if (const char *why = whyNoInput(open.file))
    refuse(why);
  std::string bytes;
  struct stat status;
  if (::fstat(open.file, &status) == 0 && status.st_size > 0)
    bytes.reserve(std::size_t(status.st_size));
  char chunk[1 << 16];
  for (;;) {
    ssize_t count = ::read(open.file, chunk, sizeof chunk);
    if (count < 0 && errno == EINTR)
      continue;
    if (count < 0)
      refuse(std::strerror(errno));
    if (count == 0)
      return bytes;
    bytes.append(chunk, std::size_t(count));
  }
}

} // namespace rtsl
