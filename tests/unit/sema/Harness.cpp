//===- Harness.cpp - RTSL text in, messages and typed tree out ------------===//
#include "Harness.h"

#include "frontend/preprocessor/Preprocessor.h"
#include "frontend/syntax/Parser.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace rtsl::test {

static std::vector<std::string> splitLines(const std::string &text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);)
    lines.push_back(line);
  return lines;
}

static bool startsWith(const std::string &text, const std::string &prefix) {
  return text.compare(0, prefix.size(), prefix) == 0;
}

/// `//   ^^^ E0200 ...`
static bool isExpectation(const std::string &line) {
  return startsWith(line, "//") && line.find('^') != std::string::npos &&
         line.find_first_not_of("/ <0123456789") == line.find('^');
}

//===----------------------------------------------------------------------===//
// Checking
//===----------------------------------------------------------------------===//

std::unique_ptr<Checked> checkText(const std::string &text) {
  auto checked = std::make_unique<Checked>();
  checked->diagnostics.errorLimit = 0;
  std::map<std::string, std::string> texts;
  std::string name = "main.rtsl";
  for (const std::string &line : splitLines(text)) {
    if (startsWith(line, "//=== "))
      name = line.substr(6);
    if (startsWith(line, "//! -W"))
      checked->diagnostics.warnings.apply(line.substr(6));
    // Lines keep their numbers in the whole text, whatever file they belong to.
    for (auto &[file, content] : texts)
      if (file != name)
        content += "\n";
    if (!texts.count(name))
      texts[name] = std::string(static_cast<std::size_t>(std::count(
                                    texts["main.rtsl"].begin(), texts["main.rtsl"].end(), '\n')) -
                                    (name == "main.rtsl" ? 0 : 1),
                                '\n');
    texts[name] += line + "\n";
  }
  std::map<std::string, const ast::TranslationUnit *> parsed;
  for (const auto &[file, content] : texts)
    checked->files[file] = checked->sources.add(file, content);
  auto parseFile = [&](const std::string &file) -> const ast::TranslationUnit * {
    if (parsed.count(file))
      return parsed[file];
    const PreprocessedFile preprocessed =
        preprocess(checked->files[file], checked->sources, {}, checked->diagnostics);
    if (preprocessed.isUsable) {
      checked->trees.push_back(parse(preprocessed.text, checked->diagnostics));
    } else {
      checked->trees.push_back(std::make_unique<ast::TranslationUnit>());
      checked->trees.back()->file = preprocessed.text;
    }
    return parsed[file] = checked->trees.back().get();
  };
  const ImportResolver resolver = [&](const ast::ImportDecl &import, FileId) {
    return texts.count(import.path) ? parseFile(import.path) : nullptr;
  };
  const ast::TranslationUnit *main = parseFile("main.rtsl");
  checked->module = check({main}, resolver, checked->diagnostics);
  return checked;
}

std::string Checked::numbers() const {
  std::string text;
  for (const Diagnostic &diagnostic : diagnostics.all())
    text += (text.empty() ? "" : " ") + std::string(info(diagnostic.code).number);
  return text;
}

std::string render(const Checked &checked) {
  return checked.diagnostics.all().empty() ? "" : renderText(checked.diagnostics, false);
}

std::string withActualMessages(const std::string &text) {
  // Expectations are comments: they may stay while the text is checked.
  const std::unique_ptr<Checked> checked = checkText(text);
  // by line, then column
  std::map<std::uint32_t, std::vector<std::pair<std::uint32_t, std::string>>> said;
  for (const Diagnostic &each : checked->diagnostics.all()) {
    const Diagnostic diagnostic = asWritten(each, checked->sources);
    const LineColumn begin =
        checked->sources.lineColumn(diagnostic.range.file, diagnostic.range.begin);
    const LineColumn end = checked->sources.lineColumn(diagnostic.range.file, diagnostic.range.end);
    const auto lineLength =
        static_cast<std::uint32_t>(checked->sources.line(diagnostic.range.file, begin.line).size());
    const std::uint32_t last = end.line == begin.line ? end.column : lineLength + 1;
    const std::string carets(std::max(1u, last - begin.column), '^');
    std::string line = begin.column >= 3 ? "//" + std::string(begin.column - 3, ' ')
                                         : "//<" + std::to_string(5 - begin.column) + " ";
    line += carets + " " + info(diagnostic.code).number + " " + diagnostic.message;
    said[begin.line].emplace_back(begin.column, line);
  }
  std::string result;
  std::uint32_t number = 0;
  for (const std::string &line : splitLines(text)) {
    ++number;
    if (isExpectation(line))
      continue;
    result += line + "\n";
    std::stable_sort(said[number].begin(), said[number].end(),
                     [](const auto &a, const auto &b) { return a.first < b.first; });
    for (const auto &message : said[number])
      result += message.second + "\n";
  }
  return result;
}

//===----------------------------------------------------------------------===//
// Files
//===----------------------------------------------------------------------===//

std::vector<Case> splitCases(const std::string &fileText) {
  std::vector<Case> cases;
  for (const std::string &line : splitLines(fileText)) {
    if (startsWith(line, "//--- "))
      cases.push_back({line.substr(6), ""});
    else if (!cases.empty())
      cases.back().text += line + "\n";
  }
  return cases;
}

std::string testName(const std::string &title) {
  std::string name;
  for (char c : title)
    name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
}

std::string readFile(const std::string &path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream)
    throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeFile(const std::string &path, const std::string &text) {
  std::ofstream stream(path, std::ios::binary);
  stream << text;
}

std::vector<std::string> languageFiles(const std::string &name) {
  std::vector<std::string> paths;
  for (const auto &chapter : std::filesystem::directory_iterator(RTSL_ROOT "/tests/language"))
    if (const auto path = chapter.path() / name; std::filesystem::exists(path))
      paths.push_back(path.string());
  std::sort(paths.begin(), paths.end());
  return paths;
}

std::string chapterOf(const std::string &path) {
  return std::filesystem::path(path).parent_path().filename().string();
}

} // namespace rtsl::test
