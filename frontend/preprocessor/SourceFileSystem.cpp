//===- SourceFileSystem.cpp - the files of clang's preprocessor -----------===//
#include "SourceFileSystem.h"

#include <llvm/ADT/SmallString.h>
#include <llvm/Support/MemoryBuffer.h>
#include <llvm/Support/Path.h>

#include <cerrno>

namespace rtsl {

namespace {

/// A text that is owned by the source manager.
class SourceText final : public llvm::vfs::File {
public:
  SourceText(llvm::vfs::Status info, llvm::StringRef text) : info(std::move(info)), text(text) {}

  llvm::ErrorOr<llvm::vfs::Status> status() override { return info; }
  llvm::ErrorOr<std::unique_ptr<llvm::MemoryBuffer>> getBuffer(const llvm::Twine &name,
                                                               std::int64_t, bool, bool) override {
    return llvm::MemoryBuffer::getMemBuffer(text, name.str());
  }
  std::error_code close() override { return {}; }

private:
  llvm::vfs::Status info;
  llvm::StringRef text;
};

/// A path as messages show it: without the leading `./` that a search adds.
std::string shownPath(const llvm::Twine &path) {
  llvm::SmallString<256> result;
  path.toVector(result);
  llvm::sys::path::remove_dots(result, /*remove_dot_dot=*/false);
  return result.str().str();
}

} // namespace

SourceFileSystem::SourceFileSystem(SourceManager &sources, FileId main) : sources(sources) {
  const std::string_view name = sources.name(main);
  if (llvm::ErrorOr<llvm::vfs::Status> info = status(llvm::StringRef(name.data(), name.size())))
    opened[{info->getUniqueID().getDevice(), info->getUniqueID().getFile()}] = main;
}

FileId SourceFileSystem::find(const llvm::Twine &path) const {
  const FileId file = sources.find(path.str());
  return file ? file : sources.find(shownPath(path));
}

FileId SourceFileSystem::fileOf(llvm::sys::fs::UniqueID id) const {
  const auto found = opened.find({id.getDevice(), id.getFile()});
  return found == opened.end() ? 0 : found->second;
}

llvm::ErrorOr<llvm::vfs::Status> SourceFileSystem::status(const llvm::Twine &path) {
  const FileId file = find(path);
  llvm::ErrorOr<llvm::vfs::Status> info = disk->status(path);
  if (!file || (info && info->getType() == llvm::sys::fs::file_type::regular_file &&
                info->getSize() == sources.text(file).size()))
    return info;
  // Standard input, and texts that were never on disk or have changed there since they were read.
  const llvm::sys::fs::UniqueID id =
      info ? info->getUniqueID() : llvm::sys::fs::UniqueID(~std::uint64_t{0}, file);
  return llvm::vfs::Status(path, id, {}, 0, 0, sources.text(file).size(),
                           llvm::sys::fs::file_type::regular_file, llvm::sys::fs::perms::all_read);
}

llvm::ErrorOr<std::unique_ptr<llvm::vfs::File>>
SourceFileSystem::openFileForRead(const llvm::Twine &path) {
  llvm::ErrorOr<llvm::vfs::Status> info = status(path);
  if (!info)
    return info.getError();
  if (info->getType() != llvm::sys::fs::file_type::regular_file) // a pipe may never end
    return std::make_error_code(std::errc::invalid_argument);
  FileId file = fileOf(info->getUniqueID());
  if (!file)
    file = find(path);
  if (!file) {
    std::string whyNot;
    errno = 0;
    file = sources.addFile(shownPath(path), whyNot).value_or(0);
    if (!file)
      return std::error_code(errno ? errno : EIO, std::generic_category());
  }
  opened[{info->getUniqueID().getDevice(), info->getUniqueID().getFile()}] = file;
  const std::string_view text = sources.text(file);
  llvm::vfs::Status known(info->getName(), info->getUniqueID(), info->getLastModificationTime(), 0,
                          0, text.size(), info->getType(), info->getPermissions());
  return std::make_unique<SourceText>(std::move(known), llvm::StringRef(text.data(), text.size()));
}

} // namespace rtsl
