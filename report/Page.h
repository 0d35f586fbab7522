//===- Page.h - a study for people and for scripts ------------------------===//
#pragma once

#include "report/Summary.h"

#include <string>
#include <utility>
#include <vector>

namespace rtsl::report {

/// The information in a report beside its figures.
struct Context {
  std::string scene;
  std::uint32_t width = 0, height = 0, runs = 0;
  double budgetSeconds = 0;
  std::string command;                                       // to reproduce it
  std::vector<std::pair<std::string, std::string>> versions; // of the compiler and its libraries
  std::vector<std::pair<std::string, std::string>> machine;
};

/// A picture for the page.
struct Exhibit {
  std::string caption;
  runtime::Image rgb; // linear
};

/// One self-contained HTML page: no scripts, nothing loaded from elsewhere, dark if the reader's
/// system is.
std::string writePage(const Context &context, const Summary &summary, const Reference &reference,
                      const std::vector<Exhibit> &exhibits);

/// The same as JSON, version 2; docs/report.md lists its keys. Values that are not finite are null.
std::string writeJson(const Context &context, const Summary &summary, const Reference &reference);

} // namespace rtsl::report
