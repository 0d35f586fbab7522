//===- DiagnosticJson.cpp - messages for scripts --------------------------===//
#include "frontend/Diagnostics.h"

#include <nlohmann/json.hpp>

namespace rtsl {

namespace {

using Json = nlohmann::ordered_json;

Json positionJson(const SourceManager &sources, FileId file, std::uint32_t offset) {
  const LineColumn at = sources.lineColumn(file, offset);
  return {{"offset", offset}, {"line", at.line}, {"column", at.column}};
}

Json rangeJson(const SourceManager &sources, SourceRange range) {
  if (!range.isValid())
    return nullptr;
  return {{"file", std::string(sources.name(range.file))},
          {"begin", positionJson(sources, range.file, range.begin)},
          {"end", positionJson(sources, range.file, range.end)}};
}

} // namespace

std::string renderJson(const Diagnostics &diagnostics) {
  const SourceManager &sources = diagnostics.sources();
  Json messages = Json::array();
  for (const Diagnostic &diagnostic : diagnostics.all()) {
    Json labels = Json::array();
    for (const Label &label : diagnostic.labels)
      labels.push_back({{"range", rangeJson(sources, label.range)}, {"message", label.text}});
    Json fixes = Json::array();
    for (const Fix &fix : diagnostic.fixes)
      fixes.push_back({{"range", rangeJson(sources, fix.range)},
                       {"replacement", fix.replacement},
                       {"sure", fix.sure}});
    messages.push_back(
        {{"code", info(diagnostic.code).number},
         {"name", info(diagnostic.code).name},
         {"warning", info(diagnostic.code).warning ? Json(info(diagnostic.code).warning) : Json()},
         {"severity", diagnostic.severity == Severity::Error ? "error" : "warning"},
         {"message", diagnostic.message},
         {"range", rangeJson(sources, diagnostic.range)},
         {"labels", std::move(labels)},
         {"notes", diagnostic.notes},
         {"fixes", std::move(fixes)}});
  }
  const Json document = {{"version", 1},
                         {"diagnostics", std::move(messages)},
                         {"hiddenErrors", diagnostics.hiddenErrors()}};
  // Source text may hold any bytes; what is not UTF-8 is replaced rather than thrown at the caller.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace rtsl
