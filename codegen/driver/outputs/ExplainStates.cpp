//===- ExplainStates.cpp - rtslc explain --states -------------------------===//
#include "codegen/driver/Compilation.h"
#include "codegen/explain/Graphviz.h"
#include "codegen/explain/ReportJson.h"
#include "codegen/explain/ReportText.h"
#include "codegen/explain/StateGraph.h"

namespace rtsl {

static std::string write(const SplitReport &report, ReportFormat format) {
  switch (format) {
  case ReportFormat::Json:
    return toJson(report);
  case ReportFormat::Dot:
    return toDot(report);
  case ReportFormat::Svg:
    return drawGraph(toDot(report), "states of functions that trace");
  case ReportFormat::Text:
    break;
  }
  return toText(report);
}

/// `maxDepth`: the depth limit of the scene, if there is one.
static std::optional<std::string> explain(const CompileInput &input,
                                          std::optional<std::uint32_t> maxDepth,
                                          const CompileOptions &options, ReportFormat format,
                                          Diagnostics &diagnostics) {
  driver::Compilation compilation(input, options, diagnostics);
  compilation.explains = true;
  if (!driver::reachStates(compilation))
    return std::nullopt;
  if (maxDepth)
    compilation.report.maxDepth = *maxDepth;
  return write(compilation.report, format);
}

std::optional<std::string> explainStates(const typed::Module &module, const CompileOptions &options,
                                         ReportFormat format, Diagnostics &diagnostics) {
  CompileInput input;
  input.module = &module;
  return explain(input, std::nullopt, options, format, diagnostics);
}

std::optional<std::string> explainSceneStates(const typed::Module &module,
                                              const LinkRequest &request, std::uint32_t maxDepth,
                                              const CompileOptions &options, ReportFormat format,
                                              Diagnostics &diagnostics) {
  CompileInput input;
  input.module = &module;
  input.scene = &request;
  return explain(input, maxDepth, options, format, diagnostics);
}

} // namespace rtsl
