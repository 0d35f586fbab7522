//===- Origins.h - from clang's locations to ours -------------------------===//
#pragma once

#include "SourceFileSystem.h"
#include "frontend/source/Expansion.h"

#include <clang/Basic/LangOptions.h>
#include <clang/Basic/SourceManager.h>

#include <llvm/ADT/DenseMap.h>

namespace rtsl {

/// Finds where the tokens that clang's preprocessor outputs were written, and records the chains of
/// expansions that produced them.
class Origins {
public:
  Origins(const clang::SourceManager &locations, const clang::LangOptions &language,
          const SourceFileSystem &files)
      : locations(locations), language(language), files(files) {}

  /// The origin of the token of `size` bytes at a location, in a file or in the expansion of a
  /// macro.
  Origin of(clang::SourceLocation location, std::uint32_t size);
  /// The origin of the token at a location.
  Origin of(clang::SourceLocation location) { return of(location, sizeAt(location)); }
  /// The range from one token to another.
  Origin of(clang::SourceLocation first, clang::SourceLocation last);

  /// The text for clang's `id`; 0: none of ours.
  FileId fileOf(clang::FileID id);
  /// The chain of includes that leads to that text.
  std::uint32_t includeOf(clang::FileID id);
  std::uint32_t sizeAt(clang::SourceLocation location) const;

  /// Registers a text that is not on disk.
  void setFile(clang::FileID id, FileId file) { fileIds[id] = file; }

  /// 0: the file that is preprocessed.
  std::vector<Expansion> expansions{1};

private:
  const clang::SourceManager &locations;
  const clang::LangOptions &language;
  const SourceFileSystem &files;
  llvm::DenseMap<clang::FileID, FileId> fileIds;
  // by clang's FileID: expansions and includes
  llvm::DenseMap<clang::FileID, std::uint32_t> known;
};

} // namespace rtsl
