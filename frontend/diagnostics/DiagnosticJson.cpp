//===- DiagnosticJson.cpp - messages for scripts --------------------------===//
#include "frontend/diagnostics/Diagnostics.h"

#include <nlohmann/json.hpp>

namespace rtsl {

namespace {

using Json = nlohmann::ordered_json;

Json positionJson(LineColumn at, std::uint32_t offset) {
  return {{"offset", offset}, {"line", at.line}, {"column", at.column}};
}

Json rangeJson(const SourceManager &sources, SourceRange range) {
  if (!range.isValid())
    return nullptr;
  const auto shown = [&](std::uint32_t offset) {
    return positionJson(sources.shown(range.file, offset).at, offset);
  };
  const auto real = [&](std::uint32_t offset) {
    return positionJson(sources.lineColumn(range.file, offset), offset);
  };
  const std::string_view file = sources.shown(range.file, range.begin).file;
  Json result = {
      {"file", std::string(file)}, {"begin", shown(range.begin)}, {"end", shown(range.end)}};
  // `#line` changed what is reported; an editor also needs the file that contains the text.
  if (const Json begin = real(range.begin);
      file != sources.name(range.file) || begin != result["begin"])
    result["written"] = {{"file", std::string(sources.name(range.file))},
                         {"begin", begin},
                         {"end", real(range.end)}};
  return result;
}

} // namespace

std::string renderJson(const Diagnostics &diagnostics) {
  const SourceManager &sources = diagnostics.sources();
  Json messages = Json::array();
  for (const Diagnostic &each : diagnostics.all()) {
    const Diagnostic diagnostic = asWritten(each, sources);
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
         {"severity", nameOf(diagnostic.severity)},
         {"message", diagnostic.message},
         {"range", rangeJson(sources, diagnostic.range)},
         {"labels", std::move(labels)},
         {"notes", diagnostic.notes},
         {"fixes", std::move(fixes)}});
  }
  const Json document = {{"version", 1},
                         {"diagnostics", std::move(messages)},
                         {"hiddenErrors", diagnostics.hiddenErrors()}};
  // Source text may hold any bytes; what is not UTF-8 is replaced instead of throwing an exception.
  return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace rtsl
