//===- SourceFileSystem.h - the files of clang's preprocessor -------------===//
#pragma once

#include "frontend/source/Source.h"

#include <llvm/Support/VirtualFileSystem.h>

#include <map>
#include <string>
#include <utility>

namespace rtsl {

/// The disk, overlaid with the texts of a `SourceManager`: a file that is read is added to the
/// manager, and never read again. So messages show exactly the bytes that were preprocessed.
class SourceFileSystem final : public llvm::vfs::FileSystem {
public:
  /// `main` may be a text without a file, such as standard input.
  SourceFileSystem(SourceManager &sources, FileId main);

  /// The text of a file that was opened; 0 if there is none.
  FileId fileOf(llvm::sys::fs::UniqueID id) const;

  llvm::ErrorOr<llvm::vfs::Status> status(const llvm::Twine &path) override;
  llvm::ErrorOr<std::unique_ptr<llvm::vfs::File>> openFileForRead(const llvm::Twine &path) override;
  llvm::vfs::directory_iterator dir_begin(const llvm::Twine &path,
                                          std::error_code &error) override {
    return disk->dir_begin(path, error);
  }
  std::error_code setCurrentWorkingDirectory(const llvm::Twine &path) override {
    return disk->setCurrentWorkingDirectory(path);
  }
  llvm::ErrorOr<std::string> getCurrentWorkingDirectory() const override {
    return disk->getCurrentWorkingDirectory();
  }

private:
  FileId find(const llvm::Twine &path) const;

  SourceManager &sources;
  llvm::IntrusiveRefCntPtr<llvm::vfs::FileSystem> disk = llvm::vfs::getRealFileSystem();
  std::map<std::pair<std::uint64_t, std::uint64_t>, FileId> opened;
};

} // namespace rtsl
