#include "codegen/cpp/Format.h"

#include "clang/Format/Format.h"
#include "clang/Tooling/Core/Replacement.h"

#include <algorithm>
#include <stdexcept>

namespace rtsl::cpp {

/// To find out whether a function is a member, clang-format reads all lines before it that are as
/// deep: in longer texts this takes time that grows with the square of their length.
constexpr std::ptrdiff_t longText = 4000;

// The root's .clang-format, and empty lines only where the printer puts them.
static clang::format::FormatStyle styleOf(const std::string &code) {
  const bool isLong = std::count(code.begin(), code.end(), '\n') > longText;
  clang::format::FormatStyle style = clang::format::getLLVMStyle();
  style.ColumnLimit = 100;
  style.AllowShortFunctionsOnASingleLine =
      isLong ? clang::format::FormatStyle::SFS_Empty : clang::format::FormatStyle::SFS_Inline;
  style.BreakTemplateDeclarations = clang::format::FormatStyle::BTDS_Yes;
  return style;
}

std::string format(const std::string &code) {
  const std::vector<clang::tooling::Range> everything = {{0, static_cast<unsigned>(code.size())}};
  const clang::tooling::Replacements changes =
      clang::format::reformat(styleOf(code), code, everything, "shaders.cpp");
  llvm::Expected<std::string> formatted = clang::tooling::applyAllReplacements(code, changes);
  if (!formatted)
    throw std::logic_error(llvm::toString(formatted.takeError()));
  return *formatted;
}

} // namespace rtsl::cpp
