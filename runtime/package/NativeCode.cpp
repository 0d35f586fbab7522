#include "runtime/package/NativeCode.h"

#include "support/Error.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <sys/mman.h>

namespace rtsl::runtime {

NativeCode::NativeCode(const NativeImage &image)
    : size(image.bytes.size()), laneBytes(image.laneBytes), runLane(image.runLane),
      stackBytes(image.stackBytes) {
  memory = ::mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED)
    throw Error(message::noMemoryForPackageCode());
  std::memcpy(memory, image.bytes.data(), size);
  if (::mprotect(memory, size, PROT_READ | PROT_EXEC) != 0) {
    const int error = errno;
    ::munmap(memory, size);
    throw Error(message::packageCodeRefused(std::strerror(error)));
  }
}

NativeCode::~NativeCode() {
  ::munmap(memory, size);
}

MegakernelCode NativeCode::entries() const {
  const auto at = [this](std::uint64_t offset) { return static_cast<char *>(memory) + offset; };
  MegakernelCode code;
  code.laneBytes = reinterpret_cast<decltype(code.laneBytes)>(at(laneBytes));
  code.runLane = reinterpret_cast<decltype(code.runLane)>(at(runLane));
  code.stackBytes = stackBytes;
  return code;
}

} // namespace rtsl::runtime
