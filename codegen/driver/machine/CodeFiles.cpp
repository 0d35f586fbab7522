#include "codegen/driver/machine/CodeFiles.h"

#include "support/AtomicFile.h"

#include "llvm/ADT/StringExtras.h"
#include "llvm/Config/llvm-config.h"
#include "llvm/Support/CachePruning.h"
#include "llvm/Support/MemoryBuffer.h"
#include "llvm/Support/SHA256.h"
#include "llvm/Support/xxhash.h"

#include <fmt/format.h>

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace rtsl {

namespace {

constexpr std::uint64_t mostBytes = 512 << 20;

/// The folder that the user names, or the usual one; empty: none.
std::string chosenFolder() {
  const auto variable = [](const char *name) {
    const char *value = std::getenv(name);
    return std::string(value ? value : "");
  };
  if (std::getenv("RTSL_CACHE")) {
    const std::string named = variable("RTSL_CACHE");
    return named == "off" ? "" : named;
  }
  if (const std::string caches = variable("XDG_CACHE_HOME"); caches.rfind('/', 0) == 0)
    return caches + "/rtslc";
  const std::string home = variable("HOME");
  return home.empty() ? "" : home + "/.cache/rtslc";
}

bool isOfUserAlone(const std::string &folder) {
  struct stat status;
  return ::stat(folder.c_str(), &status) == 0 && S_ISDIR(status.st_mode) &&
         status.st_uid == ::geteuid() && (status.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

/// Identifies the build of the compiler that runs: another one may make other code of the same
/// module.
std::string runningProgram() {
  struct stat status{};
  ::stat("/proc/self/exe", &status);
  return fmt::format("{} {} {}.{} {}", LLVM_VERSION_STRING, status.st_size, status.st_mtim.tv_sec,
                     status.st_mtim.tv_nsec, status.st_ino);
}

/// A file begins with the checksum of its rest, in this many hexadecimal digits.
constexpr std::size_t checksumDigits = 16;

std::string checksumOf(std::string_view text) {
  return fmt::format("{:016x}", llvm::xxh3_64bits(llvm::StringRef(text.data(), text.size())));
}

} // namespace

std::unique_ptr<CodeFiles> CodeFiles::open() {
  const std::string folder = chosenFolder();
  if (folder.empty())
    return nullptr;
  std::error_code failed;
  if (std::filesystem::create_directories(folder, failed))
    std::filesystem::permissions(folder, std::filesystem::perms::owner_all, failed);
  return isOfUserAlone(folder) ? std::unique_ptr<CodeFiles>(new CodeFiles(folder)) : nullptr;
}

CodeFiles::CodeFiles(std::string folder) : folder(std::move(folder)), builtFrom(runningProgram()) {}

CodeFiles::~CodeFiles() {
  llvm::CachePruningPolicy policy; // unused for a week, or
  policy.MaxSizeBytes = mostBytes;
  llvm::pruneCache(folder, policy);
}

/// LLVM removes files with this beginning only.
std::string CodeFiles::pathOf(const std::string &identity) const {
  llvm::SHA256 hash;
  hash.update(builtFrom);
  hash.update("\n");
  hash.update(identity);
  return fmt::format("{}/llvmcache-{}", folder, llvm::toHex(hash.final(), /*LowerCase=*/true));
}

std::optional<std::string> CodeFiles::read(const std::string &identity) const {
  const auto file = llvm::MemoryBuffer::getFile(pathOf(identity), /*IsText=*/false,
                                                /*RequiresNullTerminator=*/false,
                                                /*IsVolatile=*/true); // read, not mapped
  if (!file)
    return std::nullopt;
  const llvm::StringRef text = (*file)->getBuffer();
  const llvm::StringRef code = text.drop_front(std::min(checksumDigits, text.size()));
  if (text.take_front(checksumDigits) != checksumOf({code.data(), code.size()}))
    return std::nullopt;
  return code.str();
}

void CodeFiles::write(const std::string &identity, const std::string &code) const {
  const std::string checksum = checksumOf(code);
  try {
    writeFileAtomically(pathOf(identity), {checksum, code});
  } catch (const Error &) { // a full disk
  }
}

} // namespace rtsl
