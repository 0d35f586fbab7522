//===- Machine.cpp --------------------------------------------------------===//
#include "report/Machine.h"

#include <fmt/format.h>

#include <fstream>
#include <sys/utsname.h>
#include <thread>
#include <unistd.h>

namespace rtsl::report {

namespace {

/// The value of `key` in a file of lines "key : value" or "key=value".
std::string valueIn(const char *file, const std::string &key, char separator) {
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t place = line.find(separator);
    if (line.compare(0, key.size(), key) != 0 || place == std::string::npos)
      continue;
    std::string value = line.substr(place + 1);
    const std::size_t first = value.find_first_not_of(" \t\""),
                      last = value.find_last_not_of(" \t\"");
    return first == std::string::npos ? "" : value.substr(first, last - first + 1);
  }
  return {};
}

} // namespace

std::vector<std::pair<std::string, std::string>> machineFacts() {
  std::vector<std::pair<std::string, std::string>> facts;
  const auto add = [&](const char *name, const std::string &value) {
    if (!value.empty())
      facts.emplace_back(name, value);
  };
  add("processor", valueIn("/proc/cpuinfo", "model name", ':'));
  add("hardware threads", fmt::format("{}", std::thread::hardware_concurrency()));
  const long pages = ::sysconf(_SC_PHYS_PAGES), pageBytes = ::sysconf(_SC_PAGESIZE);
  if (pages > 0 && pageBytes > 0)
    add("memory", fmt::format("{:.1f} GiB", double(pages) * double(pageBytes) / (1 << 30)));
  add("system", valueIn("/etc/os-release", "PRETTY_NAME", '='));
  utsname kernel;
  if (::uname(&kernel) == 0)
    add("kernel", fmt::format("{} {}", kernel.sysname, kernel.release));
  return facts;
}

} // namespace rtsl::report
