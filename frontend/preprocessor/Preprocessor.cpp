//===- Preprocessor.cpp - directives and macros ---------------------------===//
#include "Preprocessor.h"

#include "Messages.h"
#include "Session.h"
#include "Watcher.h"
#include "frontend/lex/Tokenizer.h"
#include "frontend/preprocessor/FileSearch.h"

#include <clang/Basic/DiagnosticOptions.h>
#include <clang/Basic/FileManager.h>
#include <clang/Basic/TargetInfo.h>
#include <clang/Lex/HeaderSearchOptions.h>
#include <clang/Lex/ModuleLoader.h>
#include <clang/Lex/PreprocessorOptions.h>

#include <llvm/TargetParser/Triple.h>

namespace rtsl {

namespace {

/// The target that clang requires; it does not affect the text.
class NoTarget final : public clang::TargetInfo {
public:
  NoTarget() : TargetInfo(llvm::Triple("x86_64-unknown-linux")) {
    resetDataLayout("e-m:e-i64:64-n8:16:32:64");
  }
  void getTargetDefines(const clang::LangOptions &, clang::MacroBuilder &) const override {}
  llvm::SmallVector<clang::Builtin::InfosShard> getTargetBuiltins() const override { return {}; }
  BuiltinVaListKind getBuiltinVaListKind() const override { return VoidPtrBuiltinVaList; }
  bool validateAsmConstraint(const char *&, ConstraintInfo &) const override { return false; }
  std::string_view getClobbers() const override { return {}; }
  llvm::ArrayRef<const char *> getGCCRegNames() const override { return {}; }
  llvm::ArrayRef<GCCRegAlias> getGCCRegAliases() const override { return {}; }
};

/// The version of GLSL that RTSL is based on, and that of RTSL: 1.00.
constexpr const char *languageMacros = "#define __VERSION__ 460\n"
                                       "#define __RTSL__ 100\n";

/// Every directive and macro needs one of these characters; names with two underscores are
/// predefined.
bool mayNeedPreprocessing(std::string_view text) {
  return text.find('#') != std::string_view::npos || text.find("__") != std::string_view::npos ||
         text.find("\\\n") != std::string_view::npos ||
         text.find("\\\r\n") != std::string_view::npos;
}

/// Each on a line of its own, in the order of the command line.
std::string macroDefinitions(const PreprocessorOptions &options) {
  std::string text = languageMacros;
  if (!options.macros.empty())
    text += "#line 1 \"<command line>\"\n";
  for (const MacroOption &macro : options.macros) {
    if (macro.isUndefined)
      text += fmt::format("#undef {}\n", macro.name);
    else // the last one counts
      text += fmt::format("#undef {0}\n#define {0} {1}\n", macro.name, macro.value);
  }
  return text;
}

clang::LangOptions languageOptions() {
  clang::LangOptions language;
  language.C99 = true; // variadic macros
  language.LineComment = true;
  language.DollarIdents = false;
  language.Trigraphs = false;
  language.Digraphs = false;
  return language;
}

void addFolders(const std::vector<std::string> &folders, clang::FileManager &files,
                clang::HeaderSearch &search) {
  for (const std::string &folder : folders)
    if (const clang::OptionalDirectoryEntryRef directory = files.getOptionalDirectoryRef(folder))
      search.AddSearchPath(
          clang::DirectoryLookup(*directory, clang::SrcMgr::C_User, /*isFramework=*/false),
          /*isAngled=*/true);
}

/// Adds the tokens of the file to the expanded text, up to its end or the first error that stops.
void addTokens(Session &session, Watcher &events) {
  clang::Token token;
  while (!session.isStopped) {
    session.preprocessor.Lex(token);
    if (token.is(clang::tok::eof))
      break;
    events.wordIsOut();
    if (!session.isStopped)
      session.builder.add(token);
  }
}

} // namespace

bool isOfTheLanguage(std::string_view macro) {
  return macro == "__LINE__" || macro == "__FILE__" || macro == "__VERSION__" ||
         macro == "__RTSL__";
}

PreprocessedFile preprocess(FileId file, SourceManager &sources, const PreprocessorOptions &options,
                            Diagnostics &diagnostics) {
  PreprocessedFile result;
  result.text = file;
  const std::size_t errorsBefore = diagnostics.errorCount();
  if (options.macros.empty() && !mayNeedPreprocessing(sources.text(file)))
    return result;
  if (reportIfNotText(file, diagnostics)) {
    result.isUsable = false;
    return result;
  }

  Messages messages;
  clang::DiagnosticOptions diagnosticOptions;
  clang::DiagnosticsEngine engine(llvm::makeIntrusiveRefCnt<clang::DiagnosticIDs>(),
                                  diagnosticOptions, &messages,
                                  /*ShouldOwnClient=*/false);
  engine.setEnableAllWarnings(true); // Messages.cpp selects
  engine.setFatalsAsError(true);

  const auto files = llvm::makeIntrusiveRefCnt<SourceFileSystem>(sources, file);
  const clang::FileSystemOptions fileOptions;
  clang::FileManager fileManager(fileOptions, files);
  clang::SourceManager locations(engine, fileManager);
  const clang::LangOptions language = languageOptions();
  const NoTarget target;
  const clang::HeaderSearchOptions searchOptions;
  clang::HeaderSearch search(searchOptions, locations, engine, language, &target);
  addFolders(options.includeFolders, fileManager, search);
  const clang::PreprocessorOptions preprocessorOptions;
  clang::TrivialModuleLoader modules;
  clang::Preprocessor preprocessor(preprocessorOptions, engine, language, locations, search,
                                   modules);
  preprocessor.Initialize(target);
  preprocessor.SetCommentRetentionState(/*KeepComments=*/true, /*KeepMacroComments=*/false);

  const std::string_view name = sources.name(file);
  const clang::OptionalFileEntryRef entry =
      fileManager.getOptionalFileRef(llvm::StringRef(name.data(), name.size()));
  if (!entry) { // the file was removed after it was read
    diagnostics.report(Code::cannotReadSource, SourceRange{}, name, "it has changed");
    result.isUsable = false;
    return result;
  }
  const clang::FileID mainFile =
      locations.createFileID(*entry, clang::SourceLocation(), clang::SrcMgr::C_User);
  locations.setMainFileID(mainFile);
  const std::string definitions = macroDefinitions(options);
  preprocessor.setPredefines(definitions);

  Origins origins(locations, language, *files);
  origins.setFile(mainFile, file);
  TextBuilder builder(preprocessor, origins, sources, file);
  Session session{locations, preprocessor, origins, sources, options, diagnostics, builder};
  // Clang has more predefined macros. An image must not depend on the time of day.
  session.undefineMacros({"__LINE__", "__FILE__"});
  auto watcher = std::make_unique<Watcher>(session);
  Watcher &events = *watcher;
  preprocessor.addPPCallbacks(std::move(watcher));
  messages.start(session, events);
  messages.BeginSourceFile(language, &preprocessor);

  preprocessor.EnterMainSourceFile();
  origins.setFile(preprocessor.getPredefinesFileID(), sources.add("<language>", definitions));
  addTokens(session, events);
  messages.EndSourceFile();

  result.includes = std::move(session.includes);
  result.text = sources.addExpanded(builder.finish(mainFile));
  // An empty text is not reported if an earlier mistake explains it.
  const bool isBlank =
      sources.text(result.text).find_first_not_of(" \t\r\n") == std::string_view::npos;
  result.isUsable = session.isUsable && !(isBlank && diagnostics.errorCount() > errorsBefore);
  return result;
}

} // namespace rtsl
