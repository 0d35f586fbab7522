//===- KernelFigures.h - what an assembler makes of a GPU's program -------===//
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::tool {

/// What a thread of a kernel takes.
struct KernelFigures {
  int registers = 0;
  int localBytes = 0;                         // arrays, and registers that are spilled
  std::optional<int> spillStores, spillLoads; // bytes, in the code
  double occupancy = 0; // the share of the threads of a multiprocessor that run at once
};

/// PTX for `architecture` (sm_90) as machine code: by the driver of the first GPU, or by NVIDIA's
/// `ptxas` if there is none.
class AssembledKernels {
public:
  /// `maxRegisters` 0: as many as each kernel needs.
  AssembledKernels(const std::string &ptx, const std::vector<std::string> &names,
                   const std::string &architecture, unsigned maxRegisters);

  /// What assembled it, for people; empty if there is neither a GPU nor `ptxas`.
  const std::string &assembler() const { return name; }
  /// The figures of the kernels, in the order of the names; empty without an assembler.
  const std::vector<KernelFigures> &kernels() const { return figures; }

private:
  bool byDriver(const std::string &ptx, const std::vector<std::string> &names,
                unsigned maxRegisters);
  bool byPtxas(const std::string &ptx, const std::vector<std::string> &names,
               const std::string &architecture, unsigned maxRegisters);

  std::string name;
  std::vector<KernelFigures> figures;
};

/// What `ptxas -v` says of a kernel. Nothing if it does not mention it.
std::optional<KernelFigures> figuresInLog(const std::string &log, const std::string &kernel);

/// The instructions of a kernel in PTX, without the functions that it calls.
unsigned instructionsInPtx(const std::string &ptx, const std::string &kernel);

/// The share of the threads of a multiprocessor that run at once, in blocks of
/// runtime::threadsPerBlock, by the number of registers (CUDA C++ Programming Guide, "Compute
/// Capabilities").
double occupancyOf(int registers, const std::string &architecture);

} // namespace rtsl::tool
