//===- Graphviz.h - drawing graphs ----------------------------------------===//
#pragma once

#include <string>

namespace rtsl {

/// Draws `graph`, which is in Graphviz's language, with its program `dot`, and returns an SVG
/// document that is legible on light and dark pages. `title` is its title.
///
/// Throws Error: FileNotFound if `dot` is not on PATH, FileUnreadable if it fails.
std::string drawGraph(const std::string &graph, const std::string &title);

} // namespace rtsl
