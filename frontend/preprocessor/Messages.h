//===- Messages.h - clang's preprocessor messages as ours -----------------===//
#pragma once

#include "Session.h"
#include "Watcher.h"

#include <clang/Basic/Diagnostic.h>

namespace rtsl {

/// Turns clang's diagnostics into messages of DiagnosticCodes.def. Those about tokens that our own
/// lexer reads again (numbers, strings, characters) are left to that lexer.
class Messages final : public clang::DiagnosticConsumer {
public:
  void start(Session &session, const Watcher &watcher) {
    this->session = &session;
    this->watcher = &watcher;
  }
  void HandleDiagnostic(clang::DiagnosticsEngine::Level level,
                        const clang::Diagnostic &info) override;

private:
  struct Place; // that clang's diagnostic refers to
  void addNote(const clang::Diagnostic &info);
  // Each handles some of clang's diagnostics, and returns whether this was one of them.
  bool reportFile(const clang::Diagnostic &info, const Place &at);
  bool reportConditional(const clang::Diagnostic &info, const Place &at);
  bool reportCondition(const clang::Diagnostic &info, const Place &at);
  bool reportDefinition(const clang::Diagnostic &info, const Place &at);
  bool reportUse(const clang::Diagnostic &info, const Place &at);
  bool reportDirective(const clang::Diagnostic &info, const Place &at);
  void reportUnknownDirective(const Origin &word);
  Origin directiveAround(const Origin &place) const;

  Session *session = nullptr;
  const Watcher *watcher = nullptr;
  Diagnostic *last = nullptr; // the redefinition that a note may belong to
  unsigned misuse = 0;        // clang's diagnostic about the use of a macro; 0: none
  Origin misused;
  SourceRange unreadable; // the last `#include` of a file that cannot be read
  SourceRange undefined;  // the last name in a condition that is no macro
};

} // namespace rtsl
