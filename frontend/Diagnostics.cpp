//===- Diagnostics.cpp - recording messages and applying their fixes ------===//
#include "frontend/Diagnostics.h"

#include <algorithm>
#include <iterator>

namespace rtsl {

const std::vector<CodeInfo> codeTable = {
#define RTSL_DIAGNOSTIC(id, number, severity, message) {#id, #number, Severity::severity, message},
#define RTSL_WARNING(id, number, group, name, message)                                             \
  {#id, #number, Severity::Warning, message, name, WarningGroup::group},
#include "frontend/DiagnosticCodes.def"
};

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
  const bool isError = !isWarning || warnings.isError(diagnostic.code);
  diagnostic.severity = isError ? Severity::Error : Severity::Warning;
  const SourceRange range = diagnostic.range;
  const auto code = static_cast<int>(diagnostic.code);
  const bool isNew = seen.insert(range.isValid() ? fmt::format("{} {} {} {}", code, range.file,
                                                               range.begin, range.end)
                                                 : fmt::format("{} {}", code, diagnostic.message))
                         .second;
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

FixedText applyFixes(const Diagnostics &diagnostics, FileId file) {
  FixedText result;
  std::vector<const Fix *> accepted; // sorted by begin, disjoint
  const auto begin = [](const Fix *fix) { return fix->range.begin; };
  const auto before = [&](const Fix *a, const Fix *b) { return begin(a) < begin(b); };

  for (const Diagnostic &diagnostic : diagnostics.all()) {
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
