//===- Watcher.h - what happens while the preprocessor runs ---------------===//
#pragma once

#include "Session.h"

#include <clang/Lex/PPCallbacks.h>

#include <llvm/ADT/DenseMap.h>

#include <vector>

namespace rtsl {

/// Follows clang's preprocessor: keeps it within the limits of Preprocessor.h, refuses directives
/// that clang has and RTSL has not, and notes what the text cannot show: empty macros, parts that
/// were left out, `#line`.
class Watcher final : public clang::PPCallbacks {
public:
  explicit Watcher(Session &session) : session(session) {}

  /// A word came out: whatever took part in making it is done.
  void wordIsOut() { calls.clear(); }
  /// Place of the `#else` that an `#if` has had already; not valid: none.
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
  /// A use of a macro whose arguments are being expanded, before they take the places of the
  /// parameters.
  struct Call {
    std::vector<clang::SourceLocation> names; // words of the arguments that may use macros, sorted
    std::size_t copies; // how often at most a word of the arguments will be in the text
  };
  bool isArgumentOf(const Call &call, clang::SourceLocation name) const;
  std::size_t depthOf(clang::SourceLocation location);
  void checkConditions(clang::FileID file);
  std::size_t depthOfIncludes(clang::FileID file) const;

  Session &session;
  std::size_t includeCount = 0, includedBytes = 0;
  std::size_t words = 0, conditionWords = 0; // that macros made
  std::vector<Call> calls;
  std::vector<clang::SourceLocation> conditions;
  llvm::DenseMap<clang::SourceLocation, clang::SourceLocation> elses;
  llvm::DenseMap<clang::FileID, std::size_t> depths; // of expansions
};

} // namespace rtsl
