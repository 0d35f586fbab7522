//===- FrontEnd.cpp - any bytes through preprocessor, parser, checker and messages ===//
//
// An input is one file, or several: a line `//@ NAME` begins the next one, which can be imported
// and included.
//
//===----------------------------------------------------------------------===//
#include "Target.h"

#include "frontend/preprocessor/Preprocessor.h"
#include "frontend/syntax/Parser.h"
#include "sema/Sema.h"

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace rtsl;
using fuzz::require;

namespace {

struct NamedText {
  std::string name, text;
};

std::vector<NamedText> splitIntoFiles(std::string_view input) {
  constexpr std::string_view mark = "//@ ";
  std::vector<NamedText> files{{"main.rtsl", ""}};
  while (!input.empty()) {
    const std::size_t end = std::min(input.find('\n'), input.size() - 1) + 1;
    const std::string_view line = input.substr(0, end);
    if (line.substr(0, mark.size()) == mark && line.back() == '\n')
      files.push_back({std::string(line.substr(mark.size(), line.size() - mark.size() - 1)), ""});
    else
      files.back().text += line;
    input.remove_prefix(end);
  }
  return files;
}

/// One run of the front end over files that are in memory.
class Run {
public:
  Run(const std::vector<NamedText> &files, std::size_t errorLimit) {
    for (const NamedText &file : files)
      sources.add(file.name, file.text);
    diagnostics.errorLimit = errorLimit;
    diagnostics.warnings.apply("all");
    const FileId first = 1;
    const ast::TranslationUnit *main = load(first);
    module = check(
        {main}, [this](const ast::ImportDecl &import, FileId) { return resolve(import); },
        diagnostics);
  }

  /// Checks all outputs that a user can request.
  void print() {
    for (const auto &[file, unit] : units)
      dump(*unit);
    if (!diagnostics.hasErrors())
      typed::dump(*module);
    for (const FileId text : preprocessed)
      printPreprocessed(text, sources);
    renderText(diagnostics, false);
    renderText(diagnostics, true);
    renderJson(diagnostics);
    for (const Diagnostic &each : diagnostics.all()) {
      checkPlaces(each);
      checkPlaces(asWritten(each, sources));
    }
  }

  /// The files with their sure fixes applied; how many messages that mended.
  std::size_t fix(std::vector<NamedText> &files) const {
    std::size_t applied = 0;
    for (const FileId file : filesToFix(diagnostics)) {
      FixedText fixed = applyFixes(diagnostics, file);
      require(fixed.applied > 0, "a file with fixes has one that can be applied");
      require(file <= files.size(), "a fix changes one of the input files");
      files[file - 1].text = std::move(fixed.text);
      applied += fixed.applied;
    }
    return applied;
  }

private:
  const ast::TranslationUnit *load(FileId file) {
    std::unique_ptr<ast::TranslationUnit> &unit = units[file];
    if (unit)
      return unit.get();
    const PreprocessedFile result = preprocess(file, sources, {}, diagnostics);
    preprocessed.push_back(result.text);
    if (result.isUsable) {
      unit = parse(result.text, diagnostics);
    } else {
      unit = std::make_unique<ast::TranslationUnit>();
      unit->file = result.text;
    }
    return unit.get();
  }

  const ast::TranslationUnit *resolve(const ast::ImportDecl &import) {
    if (const FileId file = sources.find(import.path);
        import.isFile && file != 0 && !sources.expanded(file))
      return load(file);
    diagnostics.report(Code::unknownModule, import.range, import.path);
    return nullptr;
  }

  void checkPlaces(const Diagnostic &message) const {
    checkPlace(message.range);
    for (const Label &label : message.labels)
      checkPlace(label.range);
    for (const Fix &fix : message.fixes)
      checkPlace(fix.range);
  }
  void checkPlace(SourceRange place) const {
    require(!place.isValid() || (place.file <= sources.count() && place.begin <= place.end &&
                                 place.end <= sources.text(place.file).size()),
            "a place of a message lies in a text");
  }

  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::map<FileId, std::unique_ptr<ast::TranslationUnit>> units;
  std::vector<FileId> preprocessed;
  std::unique_ptr<typed::Module> module;
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
  std::vector<NamedText> files = splitIntoFiles({reinterpret_cast<const char *>(data), size});
  constexpr std::size_t usualErrorLimit = 20;
  Run(files, usualErrorLimit).print();

  // As `rtslc check --fix` until it has nothing more to do.
  constexpr int manyRounds = 20;
  for (int round = 0;; ++round) {
    Run run(files, 0);
    if (round > 0)
      run.print();
    if (run.fix(files) == 0)
      break;
    require(round < manyRounds, "fixes come to an end");
  }
  return 0;
}
