#include "runtime/DeviceBitcode.h"

#include <cstddef>

// Defined by the generated file that embeds the bitcode.
extern "C" const char rtslDeviceBitcodeBegin[];
extern "C" const char rtslDeviceBitcodeEnd[];

std::string_view rtsl::runtime::deviceBitcode() {
  return {rtslDeviceBitcodeBegin, std::size_t(rtslDeviceBitcodeEnd - rtslDeviceBitcodeBegin)};
}
