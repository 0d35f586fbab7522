//===- Diagnostics.h - messages to the author of a shader or scene --------===//
//
// All messages are declared in one table, DiagnosticCodes.def. A message has a range (shown with a
// caret), labels at related places, notes, and fixes as data that a tool can apply. Messages are
// lower case, active, without a full stop, with `backticks` round code.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/source/Source.h"

#include <fmt/format.h>

#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace rtsl {

/// A note points out something that may well be intended: it is never an error.
enum class Severity : std::uint8_t { Note, Warning, Error };

/// "note", "warning" or "error".
const char *nameOf(Severity severity);

/// One enumerator for each row of DiagnosticCodes.def.
enum class Code : std::uint16_t {
#define RTSL_DIAGNOSTIC(id, number, severity, message) id,
#include "frontend/diagnostics/DiagnosticCodes.def"
};

/// What turns a warning on: `Usual` ones are on by default, `Perf` ones need `-Wperf`.
enum class WarningGroup : std::uint8_t { Usual, Perf };

/// The row of the table for a code.
struct CodeInfo {
  const char *name;   // "unknownName"
  const char *number; // "E0201"
  Severity severity;
  const char *message; // fmt format string; of the runtime's: what the messages have in common
  const char *warning = nullptr;            // "unused-variable", as in `-W`; null for errors
  WarningGroup group = WarningGroup::Usual; // of a warning
};
const CodeInfo &info(Code code);
/// The table, one row for each code.
extern const std::vector<CodeInfo> codeTable;

/// Which warnings are shown, and which of them are errors.
class WarningOptions {
public:
  /// Applies the text after `-W`: `NAME`, `no-NAME`, `error`, `error=NAME`, `no-error`,
  /// `no-error=NAME`, where NAME is a warning, `perf` or `all`. Later options override earlier
  /// ones. Returns an error text, or an empty one.
  std::string apply(std::string_view text);

  bool isOn(Code code) const;
  /// Is a warning, which must be on, an error?
  bool isError(Code code) const;

private:
  struct State {
    bool isSet = false, isOn = false;         // if not set, the default of the group
    bool isErrorSet = false, isError = false; // if not set, `allAreErrors`
  };
  std::vector<State> states; // by code; empty: no option was given
  bool allAreErrors = false;
};

/// A second range that helps to understand the message.
struct Label {
  SourceRange range;
  std::string text;
};

/// An edit that corrects the mistake. `sure` fixes are applied by `rtslc check --fix`: all sure
/// fixes of a message, or none. The others are alternatives for the reader.
struct Fix {
  SourceRange range; // empty range: insertion
  std::string replacement;
  bool sure = false;
};

struct Diagnostic {
  Code code;
  Severity severity;
  std::string message;
  SourceRange range;
  std::vector<Label> labels;
  std::vector<std::string> notes;
  std::vector<Fix> fixes;

  Diagnostic &label(SourceRange where, std::string text) {
    labels.push_back({where, std::move(text)});
    return *this;
  }
  Diagnostic &note(std::string text) {
    notes.push_back(std::move(text));
    return *this;
  }
  Diagnostic &fix(SourceRange where, std::string replacement, bool sure = false) {
    fixes.push_back({where, std::move(replacement), sure});
    return *this;
  }
};

/// Collects the messages of a run in the order in which they were found.
class Diagnostics {
public:
  explicit Diagnostics(const SourceManager &sources) : sourceManager(sources) {}

  /// Formats the message of `code` with `args` and records it at `range`. The returned message may
  /// be extended until the next report. The same code at the same range is recorded once (without a
  /// range, or in the same use of a macro, the message is compared, too).
  template <typename... Args>
  Diagnostic &report(Code code, SourceRange range, const Args &...args) {
    return add(code, range, fmt::format(fmt::runtime(info(code).message), args...));
  }

  /// Records an error or warning of the runtime, which has formatted its message.
  Diagnostic &reportText(Code code, SourceRange range, std::string message) {
    return add(code, range, std::move(message));
  }

  /// Takes the messages of `other`, sorted by position: those of several steps over the same text.
  void addSorted(Diagnostics &&other);

  bool hasErrors() const { return numErrors != 0; }
  std::size_t errorCount() const { return numErrors; }
  /// Errors beyond the limit: counted in `errorCount`, not held in `all`.
  std::size_t hiddenErrors() const { return numHidden; }
  /// True once `errorLimit` errors were recorded: later errors are counted but not shown.
  bool limitReached() const { return errorLimit != 0 && numErrors >= errorLimit; }

  const std::vector<Diagnostic> &all() const { return diagnostics; }
  const SourceManager &sources() const { return sourceManager; }

  std::size_t errorLimit = 20; // 0: no limit
  WarningOptions warnings;

private:
  Diagnostic &add(Diagnostic diagnostic);
  Diagnostic &add(Code code, SourceRange range, std::string message);

  const SourceManager &sourceManager;
  std::vector<Diagnostic> diagnostics;
  std::unordered_set<std::string> seen; // code and range of all reported messages
  Diagnostic dropped{};                 // absorbs messages beyond the limit and duplicates
  std::size_t numErrors = 0;
  std::size_t numHidden = 0;
};

/// The message in terms of what the author wrote: all ranges are in files. A range from a macro is
/// shown where the macro is used, with labels in the definitions that it was expanded through; a
/// range in an included file gets notes with the chain of includes. A fix stays sure only if its
/// text is used once: outside of macros and includes.
Diagnostic asWritten(const Diagnostic &diagnostic, const SourceManager &sources);

/// Adds to a message at `place.range` the labels and notes that say how the text was expanded.
void explainOrigin(Diagnostic &diagnostic, const WrittenRange &place, const SourceManager &sources);

/// Text for people: file:line:column, the source line, a caret, labels, notes and fixes. With ANSI
/// colours if `colour`.
std::string renderText(const Diagnostics &diagnostics, bool colour);

/// One JSON document for scripts: {"version": 1, "diagnostics": [...], "hiddenErrors": 0}. Each
/// position has a byte offset (from 0), a line and a column (from 1, in bytes); bytes that are not
/// UTF-8 become U+FFFD.
std::string renderJson(const Diagnostics &diagnostics);

/// A text with the sure fixes of its messages applied.
struct FixedText {
  std::string text;
  std::size_t applied = 0; // messages whose fixes were applied
  std::size_t skipped =
      0; // messages whose fixes overlap with one that was applied: run again after it
};

/// The files that some sure fix changes, in the order of their messages.
std::vector<FileId> filesToFix(const Diagnostics &diagnostics);

/// Applies the sure fixes for one text, in the order of the messages. All fixes of a message are
/// applied, or none.
FixedText applyFixes(const Diagnostics &diagnostics, FileId file);

} // namespace rtsl
