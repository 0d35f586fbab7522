//===- NotFinite.cpp - samples that are infinite or not a number -----------===//
#include "NotFinite.h"

#include "runtime/program/NumberCheck.h"
#include "runtime/program/PrintLog.h"

#include <algorithm>
#include <cmath>

namespace rtsl::tool {

namespace {

/// A sample of the program with checks.
SampleNotFinite explain(const runtime::SampleId &sample, const RtslLaunch &launch,
                        const runtime::Program &program) {
  SampleNotFinite result{sample, std::vector<float>(RTSL_MAX_COLOR), std::nullopt};
  const auto isFinite = [&] {
    program.sample(&launch, sample.x, sample.y, sample.sample, result.color.data());
    return std::all_of(result.color.begin(), result.color.begin() + program.colorComponents,
                       [](float value) { return std::isfinite(value); });
  };
  const std::optional<std::uint32_t> origin = runtime::findOrigin(isFinite);
  isFinite(); // the color again, as it is
  result.color.resize(program.colorComponents);
  if (origin && program.numberPlaces.at(*origin).line != 0)
    result.place = program.numberPlaces[*origin];
  return result;
}

} // namespace

std::vector<SampleNotFinite> explainNotFinite(const runtime::RenderStatistics &statistics,
                                              const typed::Module &module, LinkRequest request,
                                              CompileOptions compile, runtime::Scene &scene,
                                              runtime::RenderOptions render,
                                              Diagnostics &diagnostics) {
  request.keep.add(ItemSet::ofMembers()); // members that are constants would have no source line
  // With traces as calls compiling takes the least time, and all targets give the same bits.
  if (compile.target == Target::HostMegakernel)
    render.traversal = runtime::Traversal::Device;
  compile.target = Target::Host;
  compile.trace = TraceMode::Recurse;
  compile.checksNumbers = true;
  std::vector<SampleNotFinite> result;
  const auto program = compileProgram(module, request, compile, diagnostics,
                                      [&](const auto &) { return scene.facts(); });
  if (!program)
    return result;
  scene.useProgram(program);
  runtime::Renderer renderer(scene, render);
  std::vector<runtime::SampleId> samples = statistics.notFinite;
  if (!render.isAdaptive && // there the samples depend on the others
      samples.size() < std::min<std::uint64_t>(statistics.samplesNotFinite, render.mostNotFinite)) {
    runtime::RenderStatistics again; // the same samples: every path has the same bits
    renderer.render(&again);
    samples = again.notFinite;
  }
  renderer.onThread([&] {
    for (const runtime::SampleId &sample : samples)
      result.push_back(explain(sample, renderer.launch(), *program));
  });
  runtime::takePrintLog(); // they have printed again
  return result;
}

} // namespace rtsl::tool
