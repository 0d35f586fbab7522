//===- FileWatch.cpp - notices when files change --------------------------===//
#include "FileWatch.h"

#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <poll.h>
#include <sys/inotify.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace fs = std::filesystem;

namespace rtsl::tool {

namespace {

using Milliseconds = std::chrono::milliseconds;

/// One save can be several events; this long without any, it is complete.
constexpr Milliseconds pause(15);
/// A file that is written without end is read all the same.
constexpr Milliseconds longestSave(150);

[[noreturn]] void throwUnwatchable(const char *limit) {
  Error error(message::cannotWatch(std::strerror(errno)));
  if (errno == EMFILE || errno == ENOSPC)
    error.note(fmt::format("the limit is in /proc/sys/fs/inotify/{}", limit));
  throw error;
}

bool isBefore(const std::timespec &left, const std::timespec &right) {
  return left.tv_sec != right.tv_sec ? left.tv_sec < right.tv_sec : left.tv_nsec < right.tv_nsec;
}

} // namespace

FileWatch::FileWatch() : queue(::inotify_init1(IN_CLOEXEC | IN_NONBLOCK)) {
  if (queue < 0)
    throwUnwatchable("max_user_instances");
}

FileWatch::~FileWatch() {
  ::close(queue);
}

std::timespec FileWatch::now() {
  std::timespec time = {};
  ::clock_gettime(CLOCK_REALTIME_COARSE, &time);
  return time;
}

void FileWatch::watch(const std::vector<std::string> &watched, std::timespec since, bool newOnes,
                      const std::string &ignored) {
  const std::set<Entry> before = std::exchange(files, {});
  noticesNew = newOnes;
  for (const std::string &file : watched) {
    std::error_code error;
    const Entry entry = entryOf(file);
    files.insert(entry);
    if (const fs::path target = fs::canonical(file, error); !error)
      files.insert(entryOf(target));
    // Its changes before this moment are not in the queue if it was not watched yet.
    struct stat status;
    if (!before.count(entry) && ::stat(file.c_str(), &status) == 0 &&
        !isBefore(status.st_ctim, since))
      hasChanged = true;
  }
  ignoredFile = entryOf(ignored);
}

/// Watches the folder, which may be missing. (Watched again, it has the number that it had.)
FileWatch::Entry FileWatch::entryOf(const fs::path &file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  const int watch =
      ::inotify_add_watch(queue, folder.c_str(), IN_CLOSE_WRITE | IN_MOVED_TO | IN_ONLYDIR);
  if (watch < 0 && (errno == ENOSPC || errno == ENOMEM))
    throwUnwatchable("max_user_watches");
  return {watch, file.filename().string()};
}

bool FileWatch::isNoticed(int folder, const std::string &name) const {
  if (files.count({folder, name}))
    return true;
  const bool isTemporary = name.empty() || name.front() == '.' || name.back() == '~' ||
                           name.find('.') == std::string::npos;
  return noticesNew && !isTemporary && Entry(folder, name) != ignoredFile;
}

bool FileWatch::readEvents(Milliseconds time) {
  struct pollfd poll = {queue, POLLIN, 0};
  if (::poll(&poll, 1, static_cast<int>(time.count())) <= 0)
    return false; // nothing, or a signal
  bool isNoticedOne = false;
  alignas(struct inotify_event) char bytes[1 << 14];
  for (ssize_t length; (length = ::read(queue, bytes, sizeof bytes)) > 0;)
    for (const char *at = bytes; at < bytes + length;) {
      const auto *event = reinterpret_cast<const struct inotify_event *>(at);
      isNoticedOne = isNoticedOne || (event->mask & IN_Q_OVERFLOW) ||
                     (event->len && isNoticed(event->wd, event->name));
      at += sizeof *event + event->len;
    }
  return isNoticedOne;
}

bool FileWatch::wait(Milliseconds time) {
  const bool changedBefore = std::exchange(hasChanged, false);
  if (!readEvents(changedBefore ? Milliseconds(0) : time) && !changedBefore)
    return false;
  for (Milliseconds waited(0); waited < longestSave; waited += pause)
    if (!readEvents(pause))
      break;
  return true;
}

} // namespace rtsl::tool
