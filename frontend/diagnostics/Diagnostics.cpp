//===- Diagnostics.cpp - recording messages and applying their fixes ------===//
#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/source/Expansion.h"

#include <algorithm>
#include <deque>
#include <iterator>

namespace rtsl {

/// Compiles only if each row of the table has a number of its own.
enum class Number : std::uint16_t {
#define RTSL_DIAGNOSTIC(id, number, severity, message) number,
#include "frontend/diagnostics/DiagnosticCodes.def"
};

const std::vector<CodeInfo> codeTable = {
#define RTSL_DIAGNOSTIC(id, number, severity, message) {#id, #number, Severity::severity, message},
#define RTSL_WARNING(id, number, group, name, message)                                             \
  {#id, #number, Severity::Warning, message, name, WarningGroup::group},
#include "frontend/diagnostics/DiagnosticCodes.def"
};

const char *nameOf(Severity severity) {
  switch (severity) {
  case Severity::Note:
    return "note";
  case Severity::Warning:
    return "warning";
  case Severity::Error:
    break;
  }
  return "error";
}

const CodeInfo &info(Code code) {
  return codeTable[static_cast<std::size_t>(code)];
}

Diagnostic &Diagnostics::add(Code code, SourceRange range, std::string message) {
  return add(Diagnostic{code, info(code).severity, std::move(message), range, {}, {}, {}});
}

Diagnostic &Diagnostics::add(Diagnostic diagnostic) {
  const bool isWarning = info(diagnostic.code).severity == Severity::Warning;
  if (isWarning && !warnings.isOn(diagnostic.code)) {
    dropped = std::move(diagnostic);
    return dropped;
  }
  if (isWarning && warnings.isError(diagnostic.code))
    diagnostic.severity = Severity::Error;
  const bool isError = diagnostic.severity == Severity::Error;
  const auto code = static_cast<int>(diagnostic.code);
  // A mistake in a macro argument that is expanded twice, or in a file that is included twice, is
  // reported once.
  const WrittenRange place = sourceManager.written(diagnostic.range);
  std::string key = diagnostic.range.isValid() ? fmt::format("{} {} {} {}", code, place.range.file,
                                                             place.range.begin, place.range.end)
                                               : fmt::format("{} {}", code, diagnostic.message);
  if (!place.macros.empty())
    key += diagnostic.message;
  const bool isNew = seen.insert(std::move(key)).second;
  const bool isHidden = isError && limitReached();
  if (isNew && isError) {
    ++numErrors;
    numHidden += isHidden;
  }
  if (!isNew || isHidden) {
    dropped = std::move(diagnostic);
    return dropped;
  }
  diagnostics.push_back(std::move(diagnostic));
  return diagnostics.back();
}

void Diagnostics::addSorted(Diagnostics &&other) {
  const auto before = [](const Diagnostic &a, const Diagnostic &b) {
    return a.range.file != b.range.file ? a.range.file < b.range.file
                                        : a.range.begin < b.range.begin;
  };
  std::stable_sort(other.diagnostics.begin(), other.diagnostics.end(), before);
  for (Diagnostic &diagnostic : other.diagnostics)
    add(std::move(diagnostic));
  numErrors += other.numHidden;
  numHidden += other.numHidden;
}

namespace {

/// True if both edits cannot be made: they share bytes, insert at the same place, or one inserts
/// inside of the other.
bool overlap(const Fix &a, const Fix &b) {
  if (a.range.begin == b.range.begin)
    return true;
  return a.range.begin < b.range.begin ? a.range.end > b.range.begin : b.range.end > a.range.begin;
}

} // namespace

void explainOrigin(Diagnostic &diagnostic, const WrittenRange &place,
                   const SourceManager &sources) {
  if (!place.macros.empty())
    diagnostic.label(place.range,
                     fmt::format("in this use of macro `{}`", place.macros.front().macro));
  // Of a long chain, only its beginning and its end.
  constexpr std::size_t shown = 4;
  const std::size_t size = place.macros.size();
  for (std::size_t i = 0; i < size; ++i)
    if (i < shown || i + shown >= size)
      diagnostic.label(place.macros[i].range,
                       fmt::format("expanded from macro `{}`", place.macros[i].macro));
  if (size > 2 * shown)
    diagnostic.note(fmt::format("{} macros in between are not shown", size - 2 * shown));
  for (const SourceRange &include : place.includes) {
    const ShownPlace from = sources.shown(include.file, include.begin);
    diagnostic.note(fmt::format("included from {}:{}", from.file, from.at.line));
  }
}

Diagnostic asWritten(const Diagnostic &diagnostic, const SourceManager &sources) {
  Diagnostic result = diagnostic;
  const WrittenRange place = sources.written(diagnostic.range);
  result.range = place.range;
  for (Label &label : result.labels) {
    const WrittenRange labelled = sources.written(label.range);
    // Two tokens of the same macro: point to where their expansions differ, in its body.
    const auto differs = [&](std::size_t i) {
      return i >= place.macros.size() || !(place.macros[i].range == labelled.macros[i].range);
    };
    const bool isSamePlace = labelled.range == place.range && !(label.range == diagnostic.range);
    label.range = labelled.range;
    for (std::size_t i = 0; isSamePlace && i < labelled.macros.size(); ++i)
      if (differs(i)) {
        label.range = labelled.macros[i].range;
        break;
      }
  }
  explainOrigin(result, place, sources);

  std::vector<Fix> fixes;
  for (Fix &fix : result.fixes) {
    const WrittenRange fixed = sources.written(fix.range);
    if (!fixed.isVerbatim)
      continue; // there is no single text to change
    fix.range = fixed.range;
    fix.sure &= fixed.macros.empty() && fixed.includes.empty();
    fixes.push_back(std::move(fix));
  }
  // All fixes of a message are applied, or none.
  const bool isComplete = fixes.size() == diagnostic.fixes.size();
  for (Fix &fix : fixes)
    fix.sure &= isComplete;
  result.fixes = std::move(fixes);
  return result;
}

std::vector<FileId> filesToFix(const Diagnostics &diagnostics) {
  std::vector<FileId> files;
  for (const Diagnostic &diagnostic : diagnostics.all())
    for (const Fix &fix : asWritten(diagnostic, diagnostics.sources()).fixes)
      if (fix.sure && std::find(files.begin(), files.end(), fix.range.file) == files.end())
        files.push_back(fix.range.file);
  return files;
}

FixedText applyFixes(const Diagnostics &diagnostics, FileId file) {
  FixedText result;
  std::deque<Diagnostic> messages; // as written

  std::vector<const Fix *> accepted; // sorted by begin, disjoint
  const auto begin = [](const Fix *fix) { return fix->range.begin; };
  const auto before = [&](const Fix *a, const Fix *b) { return begin(a) < begin(b); };

  for (const Diagnostic &each : diagnostics.all()) {
    const Diagnostic &diagnostic = messages.emplace_back(asWritten(each, diagnostics.sources()));
    std::vector<const Fix *> edits;
    bool fits = true;
    for (const Fix &fix : diagnostic.fixes)
      if (fix.sure && fix.range.file == file)
        edits.push_back(&fix);
    if (edits.empty())
      continue;
    std::sort(edits.begin(), edits.end(), before);
    for (std::size_t i = 0; i < edits.size() && fits; ++i) {
      fits = i == 0 || !overlap(*edits[i - 1], *edits[i]);
      const auto next = std::lower_bound(accepted.begin(), accepted.end(), edits[i], before);
      fits = fits && (next == accepted.end() || !overlap(**next, *edits[i])) &&
             (next == accepted.begin() || !overlap(**std::prev(next), *edits[i]));
    }
    if (!fits) {
      ++result.skipped;
      continue;
    }
    for (const Fix *edit : edits)
      accepted.insert(std::lower_bound(accepted.begin(), accepted.end(), edit, before), edit);
    ++result.applied;
  }

  const std::string_view text = diagnostics.sources().text(file);
  std::size_t at = 0;
  for (const Fix *fix : accepted) {
    result.text += text.substr(at, fix->range.begin - at);
    result.text += fix->replacement;
    at = fix->range.end;
  }
  result.text += text.substr(at);
  return result;
}

} // namespace rtsl
