//===- AtomicFileTest.cpp - files that are written as a whole, or not -----===//
#include "tests/unit/support/Files.h"

#include "support/AtomicFile.h"

#include <csignal>
#include <sys/resource.h>
#include <sys/stat.h>

namespace rtsl {

using test::errorOf;
using test::Files;
namespace fs = std::filesystem;

using AtomicFile = Files;

TEST_F(AtomicFile, WritesReplacesAndKeepsRights) {
  std::string file = put("a.txt", "old");
  ::chmod(file.c_str(), 0640);
  writeFileAtomically(file, "new");
  EXPECT_EQ(readFile(file), "new");
  struct stat status;
  ::stat(file.c_str(), &status);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(fileCount(), 1u);
}

TEST_F(AtomicFile, FollowsLinks) {
  std::string file = put("target.txt", "old");
  fs::create_symlink("target.txt", path("link.txt"));
  writeFileAtomically(path("link.txt"), "new");
  EXPECT_EQ(readFile(file), "new");
  EXPECT_TRUE(fs::is_symlink(path("link.txt")));
}

TEST_F(AtomicFile, ReportsWhyItCannotWrite) {
  EXPECT_EQ(errorOf([&] { writeFileAtomically(path("no/such/a.png"), "x"); }),
            "fileUnwritable: cannot write `" + path("no/such/a.png") +
                "`: No such file or directory");
  EXPECT_EQ(errorOf([&] { checkFileWritable(folder.string()); }),
            "fileUnwritable: cannot write `" + folder.string() + "`: Is a directory");
  EXPECT_EQ(errorOf([&] { checkFileWritable(put("file", "") + "/a.png"); }),
            "fileUnwritable: cannot write `" + path("file/a.png") + "`: Not a directory");
  EXPECT_EQ(errorOf([&] { checkFileWritable(path("fine.png")); }), "no error");
  EXPECT_FALSE(fs::exists(path("fine.png")));
  EXPECT_EQ(errorOf([&] { writeFileAtomically("/dev/full", "x"); }),
            "fileUnwritable: cannot write `/dev/full`: No space left on device");
}

// A limit on the size of files stands in for a full disk.
TEST_F(AtomicFile, AFullDiskLeavesTheOldFileAndNoOther) {
  std::string file = put("a.exr", "old");
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  auto *handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit limit = before;
  limit.rlim_cur = 10000;
  setrlimit(RLIMIT_FSIZE, &limit);
  std::string error = errorOf([&] { writeFileAtomically(file, std::string(100000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handler);
  EXPECT_EQ(error, "fileUnwritable: cannot write `" + file + "`: File too large");
  EXPECT_EQ(readFile(file), "old");
  EXPECT_EQ(fileCount(), 1u);
}

} // namespace rtsl
