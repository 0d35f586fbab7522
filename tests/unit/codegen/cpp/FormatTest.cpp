// What is printed is what clang-format leaves as it is, with the .clang-format in the root: whoever
// keeps printed C++ in a repository may run it over all files. The library is that of the program
// `clang-format`.
#include "codegen/cpp/Format.h"

#include "clang/Format/Format.h"
#include "clang/Tooling/Core/Replacement.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace {

std::string read(const std::filesystem::path &path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// Every golden of whole files.
std::vector<std::filesystem::path> printed() {
  const std::filesystem::path root = RTSL_ROOT;
  std::vector<std::filesystem::path> found;
  for (const char *folder : {"docs/cpp-output", "tests/golden/codegen/driver"})
    for (const auto &entry : std::filesystem::directory_iterator(root / folder)) {
      const std::string name = entry.path().filename().string();
      if (entry.path().extension() == ".cpp" || name.find(".cpp.expected") != std::string::npos)
        found.push_back(entry.path());
    }
  return found;
}

std::string formatted(const std::string &code) {
  llvm::Expected<clang::format::FormatStyle> style =
      clang::format::getStyle("file:" RTSL_ROOT "/.clang-format", "shaders.cpp", "none", code);
  if (!style)
    throw std::runtime_error(llvm::toString(style.takeError()));
  const clang::tooling::Range everything(0, static_cast<unsigned>(code.size()));
  const auto changes = clang::format::reformat(*style, code, everything, "shaders.cpp");
  return llvm::cantFail(clang::tooling::applyAllReplacements(code, changes));
}

TEST(Format, LeavesItsOwnTextAsItIs) {
  ASSERT_GT(printed().size(), 10u);
  for (const auto &path : printed())
    EXPECT_EQ(rtsl::cpp::format(read(path)), read(path)) << path;
}

TEST(Format, IsThatOfTheRoot) {
  for (const auto &path : printed())
    EXPECT_EQ(formatted(read(path)), read(path)) << path;
  EXPECT_EQ(formatted("int  f( ) {return 1;}\n"), "int f() {\n  return 1;\n}\n");
}

} // namespace
