#include "GpuArchitectures.h"

namespace rtsl::tool {

const std::vector<std::string> &gpuArchitectures() {
  static const std::vector<std::string> all = {"sm_75", "sm_80",  "sm_86", "sm_89",
                                               "sm_90", "sm_100", "sm_120"};
  return all;
}

const std::string &gpuArchitecture(int capability) {
  const std::string *newest = &gpuArchitectures().front();
  for (const std::string &one : gpuArchitectures())
    if (std::stoi(one.substr(3)) <= capability)
      newest = &one;
  return *newest;
}

} // namespace rtsl::tool
