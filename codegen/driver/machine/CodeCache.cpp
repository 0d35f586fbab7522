#include "codegen/driver/machine/CodeCache.h"

#include "codegen/driver/Compiler.h"
#include "codegen/driver/machine/CodeFiles.h"

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <utility>

namespace rtsl {

namespace {

/// The most programs for one picture: five views, the picture itself, and a check of its materials.
constexpr std::uint64_t programsOfPicture = 7;

} // namespace

struct CodeCache::Implementation {
  struct Entry {
    std::string code;
    std::uint64_t program; // the last that used it
  };

  std::unique_ptr<const CodeFiles> files; // or null
  std::mutex mutex;                       // for the next two
  std::map<std::string, Entry> entries;
  std::uint64_t program = 0;
  std::atomic<std::uint64_t> reused{0}, read{0}; // by this program
};

CodeCache::CodeCache(std::unique_ptr<const CodeFiles> files)
    : self(std::make_unique<Implementation>()) {
  self->files = std::move(files);
}
CodeCache::~CodeCache() = default;

std::shared_ptr<CodeCache> keptCode() {
  return std::make_shared<CodeCache>(CodeFiles::open());
}

void CodeCache::beginProgram() {
  const std::lock_guard<std::mutex> lock(self->mutex);
  for (auto entry = self->entries.begin(); entry != self->entries.end();)
    entry = entry->second.program + programsOfPicture <= self->program ? self->entries.erase(entry)
                                                                       : std::next(entry);
  ++self->program;
  self->reused = self->read = 0;
}

std::string CodeCache::codeOf(const std::string &identity,
                              const std::function<std::string()> &make) {
  {
    const std::lock_guard<std::mutex> lock(self->mutex);
    if (const auto found = self->entries.find(identity); found != self->entries.end()) {
      found->second.program = self->program;
      ++self->reused;
      return found->second.code;
    }
  }
  std::optional<std::string> known = self->files ? self->files->read(identity) : std::nullopt;
  self->read += known.has_value();
  std::string code = known ? std::move(*known) : make();
  if (self->files && !known)
    self->files->write(identity, code);
  const std::lock_guard<std::mutex> lock(self->mutex);
  self->entries.try_emplace(identity, Implementation::Entry{code, self->program});
  return code;
}

std::uint64_t CodeCache::reused() const {
  return self->reused;
}

std::uint64_t CodeCache::read() const {
  return self->read;
}

} // namespace rtsl
