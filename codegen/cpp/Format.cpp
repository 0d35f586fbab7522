#include "codegen/cpp/Format.h"

#include "clang/Format/Format.h"
#include "clang/Tooling/Core/Replacement.h"

#include <stdexcept>

namespace rtsl::cpp {

// The root's .clang-format, and empty lines only where the printer puts them.
static clang::format::FormatStyle style() {
  clang::format::FormatStyle style = clang::format::getLLVMStyle();
  style.ColumnLimit = 100;
  style.AllowShortFunctionsOnASingleLine = clang::format::FormatStyle::SFS_Inline;
  style.BreakTemplateDeclarations = clang::format::FormatStyle::BTDS_Yes;
  return style;
}

std::string format(const std::string &code) {
  const std::vector<clang::tooling::Range> everything = {{0, static_cast<unsigned>(code.size())}};
  const clang::tooling::Replacements changes =
      clang::format::reformat(style(), code, everything, "shaders.cpp");
  llvm::Expected<std::string> formatted = clang::tooling::applyAllReplacements(code, changes);
  if (!formatted)
    throw std::logic_error(llvm::toString(formatted.takeError()));
  return *formatted;
}

} // namespace rtsl::cpp
