//===- Watcher.cpp - callbacks while the preprocessor runs ----------------===//
#include "Watcher.h"

#include "frontend/lex/Tokenizer.h"
#include "frontend/preprocessor/FileSearch.h"

#include <clang/Lex/Lexer.h>
#include <clang/Lex/MacroArgs.h>
#include <clang/Lex/MacroInfo.h>

#include <algorithm>
#include <cctype>

namespace rtsl {

//===----------------------------------------------------------------------===//
// Files
//===----------------------------------------------------------------------===//

std::size_t Watcher::depthOfIncludes(clang::FileID file) const {
  std::size_t depth = 0;
  for (clang::SourceLocation from = session.locations.getIncludeLoc(file); from.isValid();
       from = session.locations.getIncludeLoc(
           session.locations.getFileID(session.locations.getExpansionLoc(from))))
    ++depth;
  return depth;
}

/// Clang recurses for each parenthesis and sign of a condition.
void Watcher::checkConditions(clang::FileID id) {
  const FileId file = session.origins.fileOf(id);
  const std::string_view text = session.sources.text(file);
  for (std::size_t hash = text.find('#'); hash != std::string_view::npos;
       hash = text.find('#', hash + 1)) {
    const std::size_t word = std::min(text.find_first_not_of(" \t", hash + 1), text.size());
    if (text.substr(word, 2) != "if" && text.substr(word, 4) != "elif")
      continue;
    std::size_t operators = 0;
    for (std::size_t at = word; at < text.size() && text[at] != '\n'; ++at) {
      if (text[at] == '\\' && at + 1 < text.size())
        at += text[at + 1] == '\r' ? 2 : 1;
      else
        operators += std::string_view("(!~-+").find(text[at]) != std::string_view::npos;
      if (operators > maxConditionOperators) {
        const auto begin = static_cast<std::uint32_t>(word);
        session.report(
            Code::badCondition,
            {{file, begin, begin + (text[word] == 'i' ? 2 : 4)}, session.origins.includeOf(id)},
            fmt::format("it has more than {} parentheses and signs", maxConditionOperators));
        session.stop();
        return;
      }
    }
  }
}

void Watcher::LexedFileChanged(clang::FileID id, LexedFileChangeReason reason,
                               clang::SrcMgr::CharacteristicKind, clang::FileID,
                               clang::SourceLocation) {
  if (reason != LexedFileChangeReason::EnterFile)
    return;
  const FileId file = session.origins.fileOf(id);
  const clang::SourceLocation from = session.locations.getIncludeLoc(id);
  if (file != 0 && !session.isStopped) {
    const std::size_t size = session.sources.text(file).size();
    if (from.isInvalid()) {
      checkConditions(id);
    } else if (depthOfIncludes(id) > maxIncludeDepth) {
      // The whole chain would be a hundred notes: only its beginning and the file that repeats.
      Diagnostic &diagnostic =
          session.report(Code::includesTooDeep, session.origins.of(from), maxIncludeDepth);
      std::vector<std::string> &notes = diagnostic.notes;
      constexpr std::size_t shown = 4;
      if (notes.size() > 2 * shown)
        notes.erase(notes.begin() + shown, notes.end() - 2);
      diagnostic.note("`#pragma once` in an included file keeps it from being included again");
      session.stop();
    } else if (++includeCount > maxIncludes || (includedBytes += size) > maxIncludedBytes) {
      session.report(Code::includesTooMuch, session.origins.of(from),
                     includeCount > maxIncludes ? fmt::format("{} files", maxIncludes)
                                                : fmt::format("{} MB", maxIncludedBytes >> 20));
      session.stop();
    } else if (Diagnostic *diagnostic = reportIfNotText(file, session.diagnostics)) {
      if (diagnostic->notes.empty())
        explainOrigin(
            *diagnostic,
            written(session.origins.expansions, {{file, 0, 0}, session.origins.includeOf(id)}),
            session.sources);
      session.stop();
    } else {
      const std::string name(session.sources.name(file));
      if (std::find(session.includes.begin(), session.includes.end(), name) ==
          session.includes.end())
        session.includes.push_back(name);
      checkConditions(id);
    }
  }
  if (session.isStopped && from.isValid()) {
    auto *lexer = static_cast<clang::Lexer *>(session.preprocessor.getCurrentFileLexer());
    lexer->seek(static_cast<unsigned>(lexer->getBuffer().size()), /*IsAtStartOfLine=*/true);
  }
}

void Watcher::FileChanged(clang::SourceLocation location, FileChangeReason reason,
                          clang::SrcMgr::CharacteristicKind, clang::FileID) {
  if (reason != RenameFile || session.isStopped)
    return;
  // `#line` refers to the next line.
  const clang::FileIDAndOffset place =
      session.locations.getDecomposedLoc(session.locations.getFileLoc(location));
  const FileId file = session.origins.fileOf(place.first);
  const std::size_t end =
      session.sources.text(file).find('\n', place.second > 0 ? place.second - 1 : 0);
  if (file == 0 || end == std::string_view::npos)
    return;
  const auto next = static_cast<std::uint32_t>(end + 1);
  const clang::PresumedLoc shown =
      session.locations.getPresumedLoc(session.locations.getComposedLoc(place.first, next));
  if (shown.isValid())
    session.sources.setLine(file, next, shown.getLine(), shown.getFilename());
}

void Watcher::InclusionDirective(clang::SourceLocation, const clang::Token &directive,
                                 llvm::StringRef, bool, clang::CharSourceRange,
                                 clang::OptionalFileEntryRef file, llvm::StringRef, llvm::StringRef,
                                 const clang::Module *, bool, clang::SrcMgr::CharacteristicKind) {
  if (session.isStopped)
    return;
  const std::string name = session.preprocessor.getSpelling(directive);
  if (name != "include") {
    Diagnostic &diagnostic =
        session.report(Code::unknownDirective, session.origins.of(directive.getLocation()), name);
    if (name == "import")
      diagnostic.note("write `import \"file.rtsl\";`, without `#`");
    session.stop();
  }
}

void Watcher::EmbedDirective(clang::SourceLocation hash, llvm::StringRef, bool,
                             clang::OptionalFileEntryRef, const clang::LexEmbedParametersResult &) {
  if (session.isStopped)
    return;
  session.report(Code::unknownDirective, session.origins.of(hash), "embed");
  session.stop();
}

void Watcher::MacroUndefined(const clang::Token &name, const clang::MacroDefinition &,
                             const clang::MacroDirective *) {
  const Origin word = session.origins.of(name.getLocation());
  if (word.range.file != 0 && isOfTheLanguage(session.sources.text(word.range)) &&
      !session.isStopped && name.getIdentifierInfo()->getName() != "__LINE__" &&
      name.getIdentifierInfo()->getName() != "__FILE__")
    session.report(Code::predefinedMacro, word, session.sources.text(word.range));
}

void Watcher::Ident(clang::SourceLocation location, llvm::StringRef) {
  session.report(Code::unknownDirective, session.origins.of(location), "ident");
}

/// RTSL has `#pragma once` only. Clang has others that would change the meaning of a text: the rest
/// of the line is skipped.
void Watcher::PragmaDirective(clang::SourceLocation location, clang::PragmaIntroducerKind) {
  auto *lexer = static_cast<clang::Lexer *>(session.preprocessor.getCurrentFileLexer());
  if (!lexer || session.isStopped)
    return;
  const clang::FileIDAndOffset place =
      session.locations.getDecomposedLoc(session.locations.getFileLoc(location));
  const FileId file = session.origins.fileOf(place.first);
  const std::string_view text = session.sources.text(file);
  const std::size_t lineEnd = std::min(text.find('\n', place.second), text.size());
  const std::size_t keyword = text.find("pragma", place.second);
  if (keyword >= lineEnd)
    return;
  const std::size_t begin = std::min(text.find_first_not_of(" \t\r", keyword + 6), lineEnd);
  if (begin == lineEnd)
    return;
  std::size_t end = begin;
  while (end < lineEnd && (std::isalnum(static_cast<unsigned char>(text[end])) || text[end] == '_'))
    ++end;
  const std::string_view name = text.substr(begin, end - begin);
  if (name == "once")
    return;
  session.report(
      Code::unknownPragma,
      {{file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(std::max(end, begin))},
       session.origins.includeOf(place.first)},
      name);
  lexer->seek(static_cast<unsigned>(lineEnd), /*IsAtStartOfLine=*/false);
}

void Watcher::SourceRangeSkipped(clang::SourceRange range, clang::SourceLocation) {
  session.builder.addGap(range.getBegin(), range.getEnd(), /*isDirective=*/true);
}

void Watcher::If(clang::SourceLocation location, clang::SourceRange, ConditionValueKind) {
  conditions.push_back(location);
  conditionWords = 0;
}

//===----------------------------------------------------------------------===//
// Macros
//
// The size of an expansion cannot be seen from the tokens that come out: the arguments of a macro
// are expanded before they replace its parameters, and F(F(F(x))) doubles its argument with each
// level before the first token is output. So each use is counted where it begins, times the copies
// that the uses around it will make of it.
//===----------------------------------------------------------------------===//

/// The number of macros around a location: a use in a body in a body ...
std::size_t Watcher::depthOf(clang::SourceLocation location) {
  if (location.isFileID())
    return 0;
  const clang::FileID id = session.locations.getFileID(location);
  if (const auto found = depths.find(id); found != depths.end())
    return found->second;
  const std::size_t depth = 1 + depthOf(session.locations.getImmediateMacroCallerLoc(location));
  depths[id] = depth;
  return depth;
}

bool Watcher::isArgumentOf(const Call &call, clang::SourceLocation name) const {
  while (true) {
    if (std::binary_search(call.names.begin(), call.names.end(), name))
      return true;
    if (name.isFileID())
      return false;
    name = session.locations.getImmediateMacroCallerLoc(name);
  }
}

void Watcher::MacroExpands(const clang::Token &name, const clang::MacroDefinition &definition,
                           clang::SourceRange range, const clang::MacroArgs *arguments) {
  const clang::MacroInfo *macro = definition.getMacroInfo();
  const clang::SourceLocation location = name.getLocation();
  if (location.isFileID())
    session.builder.addGap(
        location,
        session.locations.getFileLoc(range.getEnd())
            .getLocWithOffset(static_cast<int>(session.origins.sizeAt(range.getEnd()))),
        /*isDirective=*/false);
  if (session.isStopped || !macro || macro->isBuiltinMacro())
    return;

  while (!calls.empty() && !isArgumentOf(calls.back(), location))
    calls.pop_back();
  const std::size_t copies = calls.empty() ? 1 : calls.back().copies;
  std::size_t made = macro->getNumTokens();
  Call call{{}, copies};
  if (arguments) {
    std::size_t mostUses = 0;
    for (unsigned i = 0; i < macro->getNumParams(); ++i) {
      const clang::IdentifierInfo *parameter = macro->params()[i];
      const auto uses = static_cast<std::size_t>(
          std::count_if(macro->tokens_begin(), macro->tokens_end(), [&](const clang::Token &word) {
            return word.getIdentifierInfo() == parameter;
          }));
      const clang::Token *word = arguments->getUnexpArgument(i);
      std::size_t size = 0;
      for (; word->isNot(clang::tok::eof); ++word, ++size)
        if (word->getIdentifierInfo() && word->getIdentifierInfo()->hasMacroDefinition())
          call.names.push_back(word->getLocation());
      made += uses * size;
      mostUses = std::max(mostUses, uses);
    }
    call.copies = copies * std::max<std::size_t>(mostUses, 1);
    std::sort(call.names.begin(), call.names.end());
  }

  const auto stop = [&](Code code, std::size_t limit) {
    session.report(code, session.origins.of(location), limit);
    session.stop();
  };
  words += made * copies;
  if (session.preprocessor.isParsingIfOrElifDirective())
    conditionWords += made * copies;
  if (words > maxMacroWords)
    stop(Code::macrosMakeTooMuch, maxMacroWords);
  else if (conditionWords > maxConditionWords)
    stop(Code::macrosMakeTooMuch, maxConditionWords);
  else if (calls.size() >= maxArgumentDepth)
    stop(Code::macrosTooDeep, maxArgumentDepth);
  else if (depthOf(location) >= maxMacroDepth)
    stop(Code::macrosTooDeep, maxMacroDepth);
  else if (!call.names.empty())
    calls.push_back(std::move(call));
}

} // namespace rtsl
