//===- Versions.cpp -------------------------------------------------------===//
#include "runtime/program/Versions.h"

#include <embree3/rtcore.h>

namespace rtsl::runtime {

std::vector<std::pair<std::string, std::string>> libraryVersions() {
  return {{"Embree", RTC_VERSION_STRING}, {"C++ compiler", __VERSION__}};
}

} // namespace rtsl::runtime
