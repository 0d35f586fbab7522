//===- MachineMemory.cpp - how much memory there is -----------------------===//
#include "support/MachineMemory.h"

#include <algorithm>
#include <atomic>
#include <fstream>
#include <limits>
#include <new>
#include <string>
#include <unistd.h>

namespace rtsl {

namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t unlimited = std::numeric_limits<std::uint64_t>::max();

/// The number at the start of a file; unlimited if there is none, such as for "max".
std::uint64_t numberIn(const fs::path &file) {
  std::uint64_t number = 0;
  return std::ifstream(file) >> number ? number : unlimited;
}

/// The number after this key in a file of lines `KEY NUMBER`; `otherwise` if it is missing.
std::uint64_t numberOf(const std::string &key, const fs::path &file, std::uint64_t otherwise) {
  std::ifstream lines(file);
  std::string word;
  while (lines >> word) {
    std::uint64_t number = 0;
    if (word == key && lines >> number)
      return number;
    std::getline(lines, word);
  }
  return otherwise;
}

/// The names of what a group says of its memory, in the two versions of control groups.
struct GroupFiles {
  const char *mount, *limit, *usage, *inactiveFiles, *activeFiles;
};
constexpr GroupFiles firstVersion = {"sys/fs/cgroup/memory", "memory.limit_in_bytes",
                                     "memory.usage_in_bytes", "total_inactive_file",
                                     "total_active_file"};
constexpr GroupFiles secondVersion = {"sys/fs/cgroup", "memory.max", "memory.current",
                                      "inactive_file", "active_file"};

/// What the limit of one group leaves. Cached files are in its usage, and can be freed.
std::uint64_t leftIn(const fs::path &group, const GroupFiles &files) {
  const std::uint64_t limit = numberIn(group / files.limit), usage = numberIn(group / files.usage);
  if (limit == unlimited || usage == unlimited)
    return unlimited;
  const fs::path details = group / "memory.stat";
  const std::uint64_t cached =
      numberOf(files.inactiveFiles, details, 0) + numberOf(files.activeFiles, details, 0);
  const std::uint64_t taken = usage - std::min(usage, cached);
  return limit - std::min(limit, taken);
}

/// What a group and all above it leave. In a container the mount may begin at a group within.
std::uint64_t leftInHierarchy(const fs::path &root, fs::path group, const GroupFiles &files) {
  std::uint64_t left = leftIn(root / files.mount, files);
  for (group = group.relative_path(); !group.empty(); group = group.parent_path())
    left = std::min(left, leftIn(root / files.mount / group, files));
  return left;
}

/// What the groups of the process leave, by its lines `NUMBER:CONTROLLERS:GROUP`; the second
/// version has no controllers.
std::uint64_t leftInGroups(const fs::path &root) {
  std::uint64_t left = unlimited;
  std::ifstream lines(root / "proc/self/cgroup");
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (second == std::string::npos)
      continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const bool isSecondVersion = controllers == ",,";
    if (isSecondVersion || controllers.find(",memory,") != std::string::npos)
      left = std::min(left, leftInHierarchy(root, line.substr(second + 1),
                                            isSecondVersion ? secondVersion : firstVersion));
  }
  return left;
}

/// Bytes of memory of this process that no file backs.
std::uint64_t ownMemory() {
  std::ifstream numbers("/proc/self/statm");
  std::uint64_t pages = 0, resident = 0, shared = 0;
  numbers >> pages >> resident >> shared;
  return (resident - std::min(resident, shared)) * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

std::atomic<std::uint64_t> reserved{0};

/// Smaller allocations are only counted: looking takes longer than they do.
constexpr std::uint64_t leastChecked = std::uint64_t(1) << 20;

} // namespace

std::uint64_t availableMemory(const fs::path &root) {
  const std::uint64_t kibibytes = numberOf("MemAvailable:", root / "proc/meminfo", unlimited);
  const std::uint64_t machine = kibibytes > unlimited / 1024 ? unlimited : 1024 * kibibytes;
  return std::min(machine, leftInGroups(root));
}

MemoryReservation::MemoryReservation(std::uint64_t bytes) : MemoryReservation() {
  this->bytes = bytes; // which the destructor gives back, also where this throws
  const std::uint64_t before = reserved.fetch_add(bytes);
  if (bytes < leastChecked)
    return;
  // What the process has may be a part of earlier reservations, which is then no longer available.
  const std::uint64_t available = availableMemory(), own = ownMemory();
  const std::uint64_t most = available > unlimited - own ? unlimited : available + own;
  if (before > most || bytes > most - before)
    throw std::bad_alloc();
}

MemoryReservation::~MemoryReservation() {
  reserved -= bytes;
}

std::uint64_t MemoryReservation::all() {
  return reserved;
}

} // namespace rtsl
