//===- LargeFileTest.cpp --------------------------------------------------===//
#include "tests/unit/support/Files.h"

#include "support/AtomicFile.h"
#include "support/LargeFile.h"

namespace rtsl {

using test::errorOf;
using test::Files;

using LargeFiles = Files;

TEST_F(LargeFiles, AreReadAsAWhole) {
  std::string bytes(9'000'001, '\0'); // three parts
  for (std::size_t i = 0; i < bytes.size(); ++i)
    bytes[i] = char(i * i >> 8);
  for (const std::size_t size : {std::size_t(0), std::size_t(1), bytes.size()}) {
    const std::string file = put("large", bytes.substr(0, size));
    EXPECT_TRUE(LargeFile(file).bytes() == bytes.substr(0, size)) << size;
  }
}

TEST_F(LargeFiles, HaveTheErrorsOfOthers) {
  EXPECT_EQ(errorOf([&] { LargeFile(path("none")); }), errorOf([&] { readFile(path("none")); }));
  EXPECT_EQ(errorOf([&] { LargeFile(folder.string()); }),
            errorOf([&] { readFile(folder.string()); }));
  EXPECT_NE(errorOf([&] { LargeFile("/dev/zero"); }), "no error");
}

} // namespace rtsl
