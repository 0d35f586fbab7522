//===- KernelFigures.cpp - what an assembler makes of a GPU's program -----===//
#include "KernelFigures.h"

#include "runtime/gpu/CudaDevice.h"
#include "runtime/gpu/GpuWaves.h"
#include "runtime/gpu/PtxKernels.h"
#include "support/Error.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

extern char **environ;

namespace rtsl::tool {

namespace {

/// A folder for the time of a run.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "rtslc-XXXXXX").string();
    if (mkdtemp(pattern.data()))
      folder = pattern;
  }
  ~TemporaryFolder() {
    std::error_code error;
    if (!folder.empty())
      std::filesystem::remove_all(folder, error);
  }
  TemporaryFolder(const TemporaryFolder &) = delete;
  bool exists() const { return !folder.empty(); }
  std::string operator/(const char *file) const { return (folder / file).string(); }

private:
  std::filesystem::path folder;
};

/// Runs a program and gives what it wrote to standard output and error. Nothing if it is not there
/// or fails.
std::optional<std::string> outputOf(const std::vector<std::string> &command,
                                    const std::string &file) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, file.c_str(),
                                   O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::vector<char *> arguments;
  for (const std::string &argument : command)
    arguments.push_back(const_cast<char *>(argument.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  int status = 0;
  if (error != 0 || waitpid(child, &status, 0) != child || status != 0)
    return std::nullopt;
  std::ifstream stream(file);
  return std::string(std::istreambuf_iterator<char>(stream), {});
}

} // namespace

AssembledKernels::AssembledKernels(const std::string &ptx, const std::vector<std::string> &names,
                                   const std::string &architecture, unsigned maxRegisters) {
  if (!byDriver(ptx, names, maxRegisters))
    byPtxas(ptx, names, architecture, maxRegisters);
}

bool AssembledKernels::byDriver(const std::string &ptx, const std::vector<std::string> &names,
                                unsigned maxRegisters) {
  try {
    runtime::CudaDevice device;
    const runtime::CudaDevice::Module code = device.compile(ptx, maxRegisters);
    for (const std::string &one : names) {
      const runtime::CudaDevice::Kernel kernel = device.kernel(one.c_str(), code);
      const unsigned running = unsigned(device.blocksAtOnce(kernel, runtime::threadsPerBlock)) *
                               runtime::threadsPerBlock;
      figures.push_back({kernel.registers, kernel.localBytes, kernel.spillStores, kernel.spillLoads,
                         double(running) / device.mostThreads()});
    }
    device.unload(code);
    name = fmt::format("the driver of {}", device.name());
    return true;
  } catch (const Error &) { // no driver, no device, or one that the code is not for
    figures.clear();
    return false;
  }
}

bool AssembledKernels::byPtxas(const std::string &ptx, const std::vector<std::string> &names,
                               const std::string &architecture, unsigned maxRegisters) {
  const TemporaryFolder folder;
  if (!folder.exists() || !(std::ofstream(folder / "scene.ptx") << ptx))
    return false;
  for (const char *assembler : {"ptxas", "/usr/local/cuda/bin/ptxas"}) {
    std::vector<std::string> command = {assembler,
                                        "-v",
                                        "-arch=" + architecture,
                                        folder / "scene.ptx",
                                        "-o",
                                        folder / "scene.cubin"};
    if (maxRegisters)
      command.push_back(fmt::format("-maxrregcount={}", maxRegisters));
    const std::optional<std::string> log = outputOf(command, folder / "log");
    if (!log)
      continue;
    for (const std::string &one : names) {
      figures.push_back(figuresInLog(*log, one).value_or(KernelFigures()));
      figures.back().occupancy = occupancyOf(figures.back().registers, architecture);
    }
    name = "ptxas";
    return true;
  }
  return false;
}

std::optional<KernelFigures> figuresInLog(const std::string &log, const std::string &kernel) {
  // "... properties for KERNEL", then the frame and spills, and later "Used 72 registers".
  const std::size_t begin = log.find(fmt::format("properties for {}\n", kernel));
  const std::size_t used = log.find("Used ", begin);
  if (begin == std::string::npos || used == std::string::npos)
    return std::nullopt;
  KernelFigures figures;
  int stores = 0, loads = 0;
  if (std::sscanf(log.c_str() + log.find('\n', begin),
                  " %d bytes stack frame, %d bytes spill stores, %d bytes spill loads",
                  &figures.localBytes, &stores, &loads) != 3 ||
      std::sscanf(log.c_str() + used, "Used %d registers", &figures.registers) != 1)
    return std::nullopt;
  figures.spillStores = stores;
  figures.spillLoads = loads;
  return figures;
}

unsigned instructionsInPtx(const std::string &ptx, const std::string &kernel) {
  const std::size_t entry = runtime::findKernel(ptx, kernel);
  const std::size_t begin = ptx.find("\n{", entry), end = ptx.find("\n}", begin);
  if (entry == std::string::npos || end == std::string::npos)
    return 0;
  unsigned count = 0;
  for (std::size_t line = ptx.find('\n', begin + 1); line < end; line = ptx.find('\n', line + 1)) {
    const char first = ptx[line + 1], second = ptx[line + 2];
    count += first == '\t' && second != '.' && second != '/' && second != '{' && second != '}';
  }
  return count;
}

double occupancyOf(int registers, const std::string &architecture) {
  constexpr int registersOfMultiprocessor = 65536, registersAtOnce = 256, warpSize = 32,
                warpsOfBlock = int(runtime::threadsPerBlock) / warpSize;
  const int number = std::atoi(architecture.c_str() + 3); // sm_90
  const int threads = number == 75                                    ? 1024
                      : number == 86 || number == 89 || number >= 120 ? 1536
                                                                      : 2048;
  const int ofWarp =
      (std::max(registers, 1) * warpSize + registersAtOnce - 1) / registersAtOnce * registersAtOnce;
  const int warps = registersOfMultiprocessor / ofWarp / warpsOfBlock * warpsOfBlock;
  return double(std::min(warps * warpSize, threads)) / threads;
}

} // namespace rtsl::tool
