// The few calls of the CUDA driver that the device test needs, from libcuda.so.1 opened at run
// time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace rtsl::elementary {

/// No driver, or no device.
struct NoDevice : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The first CUDA device with one module of PTX loaded.
class CudaModule {
public:
  explicit CudaModule(const std::string &ptx);
  CudaModule(const CudaModule &) = delete;
  CudaModule &operator=(const CudaModule &) = delete;

  using Address = std::uint64_t;
  Address allocate(std::size_t bytes);
  void upload(Address to, const void *from, std::size_t bytes);
  void download(void *to, Address from, std::size_t bytes);

  /// Runs a kernel of one argument of 32 or 64 bits and one address, and waits for it.
  void launch(const std::string &kernel, void *firstArgument, Address results, unsigned blocks,
              unsigned threadsPerBlock);

private:
  template <typename Function>
  Function symbol(const char *name);
  void check(int status, const char *call);

  void *library = nullptr, *module = nullptr;
};

} // namespace rtsl::elementary
