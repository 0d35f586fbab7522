//===- ExplainGpu.cpp - what a scene's program costs a GPU ----------------===//
#include "ExplainGpu.h"

#include "KernelFigures.h"
#include "runtime/gpu/GpuThreads.h"
#include "runtime/gpu/GpuWaves.h"
#include "runtime/package/NativeCode.h"
#include "tools/rtslc/common/ScenePackage.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace rtsl::tool {

namespace {

/// A row of the table: a kernel.
struct Row {
  std::string name;
  unsigned instructions = 0; // of PTX
  std::optional<KernelFigures> figures;
};

struct GpuExplanation {
  std::string scene, architecture, assembler;
  unsigned maxRegisters = 0;
  Row megakernel;
  std::vector<Row> steps;
  std::uint64_t laneBytes = 0;
  std::uint32_t frameBytes = 0, maxDepth = 0;
  runtime::WaveFacts wave;
  std::uint32_t lightBytes = 0; // of a sample in flight, if states look for lights first
};

std::vector<Row> rowsOf(const runtime::Package &package, unsigned maxRegisters,
                        const std::string &architecture,
                        const std::vector<std::pair<std::string, std::string>> &kernels,
                        std::string &assembler) {
  std::vector<std::string> names;
  for (const auto &[kernel, name] : kernels)
    names.push_back(kernel);
  const AssembledKernels assembled(package.ptx, names, architecture, maxRegisters);
  assembler = assembled.assembler();
  std::vector<Row> rows;
  for (std::size_t i = 0; i < kernels.size(); ++i) {
    rows.push_back({kernels[i].second, instructionsInPtx(package.ptx, kernels[i].first), {}});
    if (!assembler.empty())
      rows.back().figures = assembled.kernels()[i];
  }
  return rows;
}

nlohmann::ordered_json toJson(const Row &row) {
  nlohmann::ordered_json json = {{"name", row.name}, {"ptxInstructions", row.instructions}};
  if (!row.figures)
    return json;
  json["registers"] = row.figures->registers;
  json["localBytes"] = row.figures->localBytes;
  if (row.figures->spillStores) {
    json["spillStores"] = *row.figures->spillStores;
    json["spillLoads"] = *row.figures->spillLoads;
  }
  json["occupancy"] = row.figures->occupancy;
  return json;
}

std::string jsonOf(const GpuExplanation &of) {
  nlohmann::ordered_json json = {{"scene", of.scene}, {"architecture", of.architecture}};
  if (!of.assembler.empty())
    json["assembler"] = of.assembler;
  if (of.maxRegisters)
    json["maxRegisters"] = of.maxRegisters;
  json["megakernel"] = toJson(of.megakernel);
  for (const Row &step : of.steps)
    json["steps"].push_back(toJson(step));
  json["laneBytes"] = of.laneBytes;
  json["depth"] = of.maxDepth;
  json["frameBytes"] = of.frameBytes;
  json["recordBytes"] = 16 * of.wave.groups;
  if (of.lightBytes)
    json["lightBytes"] = of.lightBytes;
  json["hasStacks"] = of.wave.hasStacks;
  return json.dump(2) + "\n";
}

std::string textOf(const Row &row, std::size_t width) {
  if (!row.figures)
    return fmt::format("  {:{}}  {:>6}\n", row.name, width, row.instructions);
  const KernelFigures &figures = *row.figures;
  const std::string spilled =
      figures.spillStores ? fmt::format("{}", *figures.spillStores) : std::string("?");
  return fmt::format("  {:{}}  {:>6}  {:>9}  {:>7}  {:>11}  {:>7.0f} %\n", row.name, width,
                     row.instructions, figures.registers, spilled, figures.localBytes,
                     100 * figures.occupancy);
}

std::string textOf(const GpuExplanation &of) {
  std::size_t width = of.megakernel.name.size();
  for (const Row &step : of.steps)
    width = std::max(width, step.name.size());
  std::string text = fmt::format("{} on a GPU ({}{}{})\n\n", of.scene, of.architecture,
                                 of.assembler.empty() ? "" : ", assembled by ", of.assembler);
  text += fmt::format("  {:{}}  {:>6}", "a thread", width, "PTX");
  if (!of.assembler.empty())
    text += fmt::format("  {:>9}  {:>7}  {:>11}  {:>9}", "registers", "spilled", "local bytes",
                        "occupancy");
  text += "\n" + textOf(of.megakernel, width);
  text += "each step alone, as in a wavefront:\n";
  for (const Row &step : of.steps)
    text += textOf(step, width);
  text += fmt::format("\nRays that wait for others take {} bytes a lane, for a depth of {}; the "
                      "largest frame has {} bytes.\nA sample in flight of a wavefront takes {} "
                      "bytes{}{}.\n",
                      of.laneBytes, of.maxDepth, of.frameBytes, 16 * of.wave.groups,
                      of.lightBytes ? fmt::format(", and {} for its lights", of.lightBytes) : "",
                      of.wave.hasStacks ? ", and a stack of its own" : "");
  if (of.maxRegisters)
    text +=
        fmt::format("The megakernel may have {} registers (--max-registers).\n", of.maxRegisters);
  if (of.assembler.empty())
    text += "Registers are known where there is a GPU, or NVIDIA's `ptxas`.\n";
  return text;
}

} // namespace

std::optional<std::string> explainGpu(const GpuRequest &what, Diagnostics &diagnostics) {
  CompileOptions options = what.compile;
  options.organisation = Organisation::Megakernel;
  runtime::Package package;
  const std::optional<runtime::Scene> scene = compileScenePackage(
      what.module, what.request, options, diagnostics, what.buildScene, package);
  if (!scene)
    return std::nullopt;
  GpuExplanation whole;
  whole.scene = what.scene;
  whole.architecture = options.gpu;
  whole.maxDepth = what.maxDepth;
  whole.maxRegisters = what.maxRegisters ? what.maxRegisters : package.registers;
  whole.frameBytes = package.frameBytes;
  const runtime::NativeCode host(package.host);
  whole.laneBytes = host.entries().laneBytes(what.maxDepth, scene->launch().referenceChain);
  whole.megakernel =
      rowsOf(package, whole.maxRegisters, options.gpu,
             {{runtime::renderKernelOf(package.ptx).name, "megakernel"}}, whole.assembler)
          .front();

  options.organisation = Organisation::Wavefront;
  runtime::Package waves;
  Diagnostics said(diagnostics.sources()); // once is enough
  if (!compileScenePackage(what.module, what.request, options, said, what.buildScene, waves))
    return std::nullopt;
  whole.wave = waves.wave;
  std::vector<std::pair<std::string, std::string>> kernels = {
      {"rtsl_wave_trace", "traversal"}, {"rtsl_wave_sample", "begin samples"}};
  for (std::size_t state = 1; state <= waves.stateNames.size(); ++state) {
    const std::string &name = waves.stateNames[state - 1];
    if (runtime::GpuWaves::hasLightKernel(waves.ptx, state)) {
      kernels.push_back(
          {runtime::GpuWaves::lightKernel(state), fmt::format("{}: its lights", name)});
      whole.lightBytes = runtime::GpuWaves::lightBytes(options.colorComponents);
    }
    kernels.push_back({fmt::format("rtsl_wave_state_{}", state), name});
  }
  whole.steps = rowsOf(waves, 0, options.gpu, kernels, whole.assembler);
  return what.isJson ? jsonOf(whole) : textOf(whole);
}

} // namespace rtsl::tool
