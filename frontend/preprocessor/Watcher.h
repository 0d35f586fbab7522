//===- Watcher.h - callbacks while the preprocessor runs ------------------===//
#pragma once

#include "Session.h"

#include <clang/Lex/PPCallbacks.h>

#include <llvm/ADT/DenseMap.h>

#include <vector>

namespace rtsl {

/// Follows clang's preprocessor: enforces the limits of Preprocessor.h, rejects directives that
/// clang has and RTSL has not, and records what the output does not show: macros with empty
/// expansions, skipped parts, `#line`.
class Watcher final : public clang::PPCallbacks {
public:
  explicit Watcher(Session &session) : session(session) {}

  /// A token was output: all macros that took part in making it are done.
  void wordIsOut() { calls.clear(); }
  /// The `#else` that an `#if` already has; not valid: none.
  clang::SourceLocation elseOf(clang::SourceLocation ifLocation) const {
    return elses.lookup(ifLocation);
  }
  /// The `#if` around what is being read.
  clang::SourceLocation innermostIf() const {
    return conditions.empty() ? clang::SourceLocation() : conditions.back();
  }

  void LexedFileChanged(clang::FileID file, LexedFileChangeReason reason,
                        clang::SrcMgr::CharacteristicKind, clang::FileID,
                        clang::SourceLocation) override;
  void FileChanged(clang::SourceLocation location, FileChangeReason reason,
                   clang::SrcMgr::CharacteristicKind, clang::FileID) override;
  void InclusionDirective(clang::SourceLocation hash, const clang::Token &directive,
                          llvm::StringRef name, bool isAngled, clang::CharSourceRange nameRange,
                          clang::OptionalFileEntryRef file, llvm::StringRef, llvm::StringRef,
                          const clang::Module *, bool, clang::SrcMgr::CharacteristicKind) override;
  void EmbedDirective(clang::SourceLocation hash, llvm::StringRef name, bool isAngled,
                      clang::OptionalFileEntryRef file,
                      const clang::LexEmbedParametersResult &) override;
  void Ident(clang::SourceLocation location, llvm::StringRef) override;
  void PragmaDirective(clang::SourceLocation location, clang::PragmaIntroducerKind) override;
  void MacroExpands(const clang::Token &name, const clang::MacroDefinition &definition,
                    clang::SourceRange range, const clang::MacroArgs *arguments) override;
  void MacroUndefined(const clang::Token &name, const clang::MacroDefinition &,
                      const clang::MacroDirective *) override;
  void SourceRangeSkipped(clang::SourceRange range, clang::SourceLocation) override;

  void If(clang::SourceLocation location, clang::SourceRange, ConditionValueKind) override;
  void Elif(clang::SourceLocation, clang::SourceRange, ConditionValueKind,
            clang::SourceLocation) override {
    conditionWords = 0;
  }
  void Ifdef(clang::SourceLocation location, const clang::Token &,
             const clang::MacroDefinition &) override {
    conditions.push_back(location);
  }
  void Ifndef(clang::SourceLocation location, const clang::Token &,
              const clang::MacroDefinition &) override {
    conditions.push_back(location);
  }
  void Else(clang::SourceLocation location, clang::SourceLocation ifLocation) override {
    elses[ifLocation] = location;
  }
  void Endif(clang::SourceLocation, clang::SourceLocation) override {
    if (!conditions.empty())
      conditions.pop_back();
  }

private:
  /// A use of a macro whose arguments are being expanded, before they replace the parameters.
  struct Call {
    std::vector<clang::SourceLocation> names; // tokens of the arguments that may use macros, sorted
    std::size_t copies; // upper bound on how often a token of the arguments will be in the text
  };
  bool isArgumentOf(const Call &call, clang::SourceLocation name) const;
  std::size_t depthOf(clang::SourceLocation location);
  void checkConditions(clang::FileID file);
  std::size_t depthOfIncludes(clang::FileID file) const;

  Session &session;
  std::size_t includeCount = 0, includedBytes = 0;
  std::size_t words = 0, conditionWords = 0; // that macros produced
  std::vector<Call> calls;
  std::vector<clang::SourceLocation> conditions;
  llvm::DenseMap<clang::SourceLocation, clang::SourceLocation> elses;
  llvm::DenseMap<clang::FileID, std::size_t> depths; // of expansions
};

} // namespace rtsl
