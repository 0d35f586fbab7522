//===- Shared.cpp - what the targets share --------------------------------===//
#include "Target.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

namespace fs = std::filesystem;

namespace {

/// A folder of this process.
struct Folder {
  std::string path = (fs::temp_directory_path() / "rtsl-fuzz-XXXXXX").string();

  Folder() { rtsl::fuzz::require(mkdtemp(path.data()) != nullptr, "there can be a folder"); }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
};

} // namespace

void rtsl::fuzz::require(bool holds, const char *what) {
  if (holds)
    return;
  std::fprintf(stderr, "does not hold: %s\n", what);
  std::abort();
}

void rtsl::fuzz::expectAboutFile(const Error &error) {
  require(error.code != ErrorCode::Internal, "an error is the file's");
  require(error.what()[0] != '\0', "an error has a message");
}

rtsl::fuzz::File::File(std::string_view content, const std::string &name) {
  static const Folder folder;
  path = folder.path + "/" + name;
  std::ofstream stream(path, std::ios::binary);
  stream << content;
  require(bool(stream.flush()), "a file is written");
}

rtsl::fuzz::File::~File() {
  std::error_code ignored;
  fs::remove(path, ignored);
}

/// LLVM's allocators mark their memory themselves, in headers: the part of them that lies in
/// Debian's library was built without a sanitizer and would never clear the marks again.
extern "C" const char *__asan_default_options() {
  return "allow_user_poisoning=0";
}
