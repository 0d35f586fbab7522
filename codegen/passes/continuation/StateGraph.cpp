//===- StateGraph.cpp - the states of a program as a picture --------------===//
#include "codegen/passes/continuation/StateGraph.h"

#include "llvm/Support/raw_ostream.h"

#include <algorithm>
#include <optional>

namespace rtsl {

namespace {

/// "Glass.shade.state1" of function "Glass.shade" is "state1".
std::string shortName(const FunctionReport &function, const std::string &state) {
  const std::string prefix = function.name + ".";
  return state.compare(0, prefix.size(), prefix) == 0 ? state.substr(prefix.size()) : state;
}

bool isOwn(const FunctionReport &function, const std::string &state) {
  return std::find(function.states.begin(), function.states.end(), state) != function.states.end();
}

/// What a box says: the state, and for one behind a trace where that is and what it took along.
std::vector<std::string> linesOf(const FunctionReport &function, const std::string &state) {
  std::vector<std::string> lines = {shortName(function, state)};
  for (const TraceReport &trace : function.traces) {
    if (trace.resumesAt != state)
      continue;
    const std::string place = trace.place.text();
    const std::string what = trace.isJoin ? "join" : trace.callee.empty() ? "trace" : "call of " + trace.callee;
    lines.push_back(place.empty() ? "behind a " + what : "behind the " + what + " at " + place);
    lines.push_back(std::to_string(trace.savedBytes) + " of " + std::to_string(trace.liveBytes) + " bytes saved" +
                    listOf(trace.saved));
    if (!trace.rematerialised.empty())
      lines.push_back("computed again" + listOf(trace.rematerialised));
    if (trace.liveBytes != 0) {
      const TraceTraffic &traffic = trace.steps.back().traffic;
      lines.push_back(toText(traffic.stored) + " stored, " + toText(traffic.restored) + " restored; cost " +
                      std::to_string(trace.extra.cost) + " of " + std::to_string(trace.plainly.cost));
    }
  }
  for (const TransitionReport &way : function.transitions) {
    if (way.from != state)
      continue;
    if (way.kind == TransitionReport::Last)
      lines.push_back("the last trace takes this ray's place");
    if (way.kind == TransitionReport::Return)
      lines.push_back("returns to the caller");
    if (!way.to.empty() && !isOwn(function, way.to))
      lines.push_back("or goes on in " + way.to);
  }
  return lines;
}

std::string titleOf(const FunctionReport &function) {
  const std::size_t count = function.states.size();
  return function.name + ": " + std::to_string(count) + (count == 1 ? " state" : " states") +
         ", frame of " + std::to_string(function.frame.size) + " bytes";
}

std::string escaped(llvm::StringRef text, llvm::StringRef special, llvm::ArrayRef<const char *> by) {
  std::string result;
  for (char c : text) {
    const std::size_t which = special.find(c);
    if (which == llvm::StringRef::npos)
      result += c;
    else
      result += by[which];
  }
  return result;
}

std::string quoted(const std::string &text) {
  return "\"" + escaped(text, "\"\\", {"\\\"", "\\\\"}) + "\"";
}

std::string xml(const std::string &text) {
  return escaped(text, "&<>\"", {"&amp;", "&lt;", "&gt;", "&quot;"});
}

} // namespace

//===----------------------------------------------------------------------===//
// Graphviz
//===----------------------------------------------------------------------===//

std::string toDot(const SplitReport &report) {
  std::string text;
  llvm::raw_string_ostream out(text);
  out << "digraph states {\n  node [shape=box, fontname=\"monospace\"];\n  edge [fontname=\"monospace\"];\n";
  for (const FunctionReport &function : report.functions) {
    out << "  subgraph " << quoted("cluster " + function.name) << " {\n";
    out << "    label=" << quoted(titleOf(function)) << ";\n";
    for (const std::string &state : function.states) {
      std::string label;
      for (const std::string &line : linesOf(function, state))
        label += escaped(line, "\"\\", {"\\\"", "\\\\"}) + "\\l";
      out << "    " << quoted(state) << " [label=\"" << label << "\"];\n";
    }
    for (const TransitionReport &way : function.transitions) {
      if (way.to.empty()) {
        const bool isLast = way.kind == TransitionReport::Last;
        const std::string end = way.from + (isLast ? " last" : " done");
        out << "    " << quoted(end) << (isLast ? " [shape=circle, label=\"\", width=0.12];\n" : " [shape=point];\n");
        out << "    " << quoted(way.from) << " -> " << quoted(end) << ";\n";
        continue;
      }
      out << "    " << quoted(way.from) << " -> " << quoted(way.to)
          << (way.kind == TransitionReport::Trace  ? " [label=\"trace\"]"
              : way.kind == TransitionReport::Call ? " [label=\"call\"]"
                                                   : " [style=dashed]")
          << ";\n";
    }
    out << "  }\n";
  }
  out << "}\n";
  return text;
}

//===----------------------------------------------------------------------===//
// SVG
//===----------------------------------------------------------------------===//

namespace {

// Pixels. The widest character of the common monospaced fonts takes 0.62 of the font's size.
constexpr int fontSize = 13, lineHeight = 18, padding = 10, gap = 34, margin = 24;
constexpr int trackWidth = 18, arrow = 7;

int widthOf(const std::string &text) {
  return static_cast<int>(text.size()) * 8 + 1;
}

/// The states of one function: boxes in a column, ways that do not lead to the next box in tracks on
/// its right.
class Column {
public:
  Column(const FunctionReport &function, int top) : function(function), top(top) {
    int y = top + lineHeight + padding;
    for (const std::string &state : function.states) {
      Box box;
      box.lines = linesOf(function, state);
      box.top = y;
      box.bottom = y + 2 * padding + lineHeight * static_cast<int>(box.lines.size()) - 4;
      for (const std::string &line : box.lines)
        boxWidth = std::max(boxWidth, widthOf(line) + 2 * padding);
      y = box.bottom + gap;
      boxes.push_back(std::move(box));
    }
    placeTracks();
  }

  int bottom() const { return boxes.empty() ? top + lineHeight : boxes.back().bottom; }
  int width() const {
    return std::max(widthOf(titleOf(function)),
                    leftSpace + boxWidth + trackWidth * (static_cast<int>(tracks.size()) + 1));
  }

  void draw(llvm::raw_ostream &out) const {
    text(out, margin, top + fontSize, titleOf(function), "title");
    for (std::size_t i = 0; i < boxes.size(); ++i)
      drawBox(out, boxes[i], i == 0);
    std::vector<int> leaving(boxes.size()), entering(boxes.size());
    for (const Way &way : ways)
      drawWay(out, way, leaving[way.from]++, way.to ? entering[*way.to]++ : 0);
  }

private:
  struct Box {
    std::vector<std::string> lines;
    int top = 0, bottom = 0;
  };
  struct Way {
    TransitionReport::Kind kind;
    std::size_t from = 0;
    std::optional<std::size_t> to; // none: the method is over
    int track = -1;                // -1: straight down
  };

  static constexpr int leftSpace = 40; // for the ends of methods

  std::size_t indexOf(const std::string &state) const {
    return static_cast<std::size_t>(std::find(function.states.begin(), function.states.end(), state) -
                                    function.states.begin());
  }

  /// Each way gets the first track in which nothing lies between its ends.
  void placeTracks() {
    for (const TransitionReport &transition : function.transitions) {
      if (!transition.to.empty() && !isOwn(function, transition.to))
        continue; // in another column: the box names it
      Way way;
      way.kind = transition.kind;
      way.from = indexOf(transition.from);
      if (!transition.to.empty()) {
        way.to = indexOf(transition.to);
        if (*way.to != way.from + 1 || isTaken(way.from))
          way.track = takeTrack(std::min(way.from, *way.to), std::max(way.from, *way.to));
      }
      ways.push_back(way);
    }
  }

  /// Is there a way straight down from this box already?
  bool isTaken(std::size_t from) const {
    return std::any_of(ways.begin(), ways.end(), [&](const Way &way) {
      return way.from == from && way.to && way.track < 0;
    });
  }

  int takeTrack(std::size_t first, std::size_t last) {
    std::size_t track = 0;
    const auto overlaps = [&](const std::pair<std::size_t, std::size_t> &other) {
      return first <= other.second && other.first <= last;
    };
    while (track < tracks.size() && std::any_of(tracks[track].begin(), tracks[track].end(), overlaps))
      ++track;
    tracks.resize(std::max(tracks.size(), track + 1));
    tracks[track].push_back({first, last});
    return static_cast<int>(track);
  }

  static void text(llvm::raw_ostream &out, int x, int y, const std::string &text, const char *kind) {
    out << "<text class=\"" << kind << "\" x=\"" << x << "\" y=\"" << y << "\">" << xml(text) << "</text>\n";
  }

  void drawBox(llvm::raw_ostream &out, const Box &box, bool isFirst) const {
    out << "<rect class=\"" << (isFirst ? "first" : "state") << "\" x=\"" << margin + leftSpace << "\" y=\""
        << box.top << "\" width=\"" << boxWidth << "\" height=\"" << box.bottom - box.top << "\" rx=\"5\"/>\n";
    int y = box.top + padding + fontSize - 2;
    for (const std::string &line : box.lines) {
      text(out, margin + leftSpace + padding, y, line, &line == &box.lines.front() ? "name" : "detail");
      y += lineHeight;
    }
  }

  static void head(llvm::raw_ostream &out, int x, int y, int dx, int dy) {
    out << "<path class=\"head\" d=\"M" << x << " " << y << "l" << -arrow * dx + arrow / 2 * dy << " "
        << -arrow * dy + arrow / 2 * dx << "l" << -arrow / 2 * 2 * dy << " " << -arrow / 2 * 2 * dx << "z\"/>\n";
  }

  /// `leaving` and `entering` count the ways that touch the same box, so that they do not meet there.
  void drawWay(llvm::raw_ostream &out, const Way &way, int leaving, int entering) const {
    const char *kind = way.kind == TransitionReport::Jump ? "jump" : "trace";
    const Box &from = boxes[way.from];
    const int left = margin + leftSpace, right = left + boxWidth;
    if (!way.to) { // to a dot on the left
      const bool isLast = way.kind == TransitionReport::Last;
      const int y = isLast ? from.bottom - 10 : (from.top + from.bottom) / 2;
      out << "<path class=\"trace\" d=\"M" << left << " " << y << "H" << margin + 13 << "\"/>\n";
      out << "<circle class=\"" << (isLast ? "ring" : "head") << "\" cx=\"" << margin + 8 << "\" cy=\"" << y << "\" r=\"5\"/>\n";
      return;
    }
    const Box &to = boxes[*way.to];
    if (way.track < 0) {
      const int x = left + boxWidth / 2;
      out << "<path class=\"" << kind << "\" d=\"M" << x << " " << from.bottom << "V" << to.top - arrow << "\"/>\n";
      head(out, x, to.top, 0, 1);
      return;
    }
    const int x = right + trackWidth * (way.track + 1);
    const int start = from.bottom - 9 - 7 * leaving, end = to.top + 9 + 7 * entering;
    out << "<path class=\"" << kind << "\" d=\"M" << right << " " << start << "H" << x << "V" << end << "H"
        << right + arrow << "\"/>\n";
    head(out, right, end, -1, 0);
  }

  const FunctionReport &function;
  const int top;
  int boxWidth = 0;
  std::vector<Box> boxes;
  std::vector<Way> ways;
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> tracks;
};

constexpr char style[] =
    "<style>\n"
    "svg{font-family:ui-monospace,'DejaVu Sans Mono',Menlo,Consolas,monospace;font-size:13px;background:#fff}\n"
    "text{fill:#222}.title{font-weight:bold}.name{font-weight:bold}.detail{fill:#555}\n"
    "rect{fill:#f4f6f8;stroke:#8896a4}.first{fill:#e3eefc}\n"
    "path{fill:none;stroke:#3b6ea8;stroke-width:1.5}.jump{stroke-dasharray:5 3}\n"
    ".head{fill:#3b6ea8;stroke:none}.ring{fill:none;stroke:#3b6ea8;stroke-width:1.5}\n"
    "@media(prefers-color-scheme:dark){svg{background:#15181c}text{fill:#e6e6e6}.detail{fill:#a8b0b8}\n"
    "rect{fill:#22272d;stroke:#5b6773}.first{fill:#22324a}path{stroke:#7fb0ea}.head{fill:#7fb0ea}.ring{stroke:#7fb0ea}}\n"
    "</style>\n";

} // namespace

std::string toSvg(const SplitReport &report) {
  std::vector<Column> columns;
  int width = widthOf("No function traces a ray."), y = margin;
  for (const FunctionReport &function : report.functions) {
    columns.emplace_back(function, y);
    width = std::max(width, columns.back().width());
    y = columns.back().bottom() + gap;
  }
  std::string text;
  llvm::raw_string_ostream out(text);
  const int height = columns.empty() ? 2 * margin + lineHeight : y - gap + margin;
  out << "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"" << width + 2 * margin << "\" height=\"" << height
      << "\" viewBox=\"0 0 " << width + 2 * margin << " " << height << "\">\n"
      << "<title>states of programs that trace</title>\n"
      << style;
  for (const Column &column : columns)
    column.draw(out);
  if (columns.empty())
    out << "<text x=\"" << margin << "\" y=\"" << margin + fontSize << "\">No function traces a ray.</text>\n";
  out << "</svg>\n";
  return text;
}

} // namespace rtsl
