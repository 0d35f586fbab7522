//===- NewCommand.cpp - rtslc new -----------------------------------------===//
//
// Writes a file to start from: a template of library/templates, in which the word NAME stands for
// the name.
//
//===----------------------------------------------------------------------===//
#include "codegen/driver/sources/StandardLibrary.h"
#include "frontend/preprocessor/Preprocessor.h"
#include "frontend/syntax/Parser.h"
#include "sema/Sema.h"
#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"
#include "tools/common/OptionValues.h"
#include "tools/common/Output.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <string_view>
#include <unistd.h>

namespace fs = std::filesystem;

namespace rtsl::tool {

namespace {

struct NewOptions {
  CommonOptions common;
  std::string kind, name, folder = ".";
};

/// What can be written, and the ending of its template and of the file.
const Choices<const char *> kinds = {{"material", ".rtsl"},  {"camera", ".rtsl"},
                                     {"primitive", ".rtsl"}, {"texture", ".rtsl"},
                                     {"light", ".rtsl"},     {"scene", ".json"}};
const char *const sceneEnding = ".json";

const char *endingOf(const std::string &kind) {
  return std::find_if(kinds.begin(), kinds.end(),
                      [&](const auto &one) { return one.first == kind; })
      ->second;
}

bool isOfName(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
}

/// A name made of the letters and digits of another text, which begins with a capital if it is
/// `ofClass`; empty if there are none.
std::string nameFrom(const std::string &text, bool ofClass = true) {
  std::string name;
  bool startsWord = ofClass;
  for (const char c : text) {
    if (!isOfName(c)) {
      startsWord = ofClass || !name.empty();
    } else {
      if (name.empty() && std::isdigit(static_cast<unsigned char>(c)))
        name = "My";
      name += startsWord ? static_cast<char>(std::toupper(static_cast<unsigned char>(c))) : c;
      startsWord = false;
    }
  }
  return name;
}

/// Rejects what is no name, and names that are taken.
void checkName(const NewOptions &options) {
  const auto refuse = [](const std::string &why) { throw CLI::ValidationError("NAME", why); };
  const std::string &name = options.name;
  const bool isName = !name.empty() && !std::isdigit(static_cast<unsigned char>(name.front())) &&
                      std::all_of(name.begin(), name.end(), isOfName);
  if (!isName) {
    const fs::path path(name);
    const std::string stem = path.has_parent_path() ? path.stem().string() : name;
    const bool hasEnding = fs::path(stem).extension() == endingOf(options.kind);
    const std::string free =
        nameFrom(hasEnding ? fs::path(stem).stem().string() : stem, options.kind != "scene");
    std::string why = fmt::format(
        "`{}` is not a name: letters, digits and `_`, not beginning with a digit", name);
    if (!free.empty())
      why += fmt::format("; did you mean `{}{}`?", free,
                         path.has_parent_path() ? " -o " + path.parent_path().string() : "");
    refuse(why);
  }
  if (name.rfind("rt_", 0) == 0)
    refuse(fmt::format("`{}` is reserved: names of your own do not begin with `rt_`", name));
  if (options.kind == "scene")
    return; // its name is only that of the file
  for (const std::string &module : findModule("std").parts)
    if (lastPart(module) == name)
      refuse(fmt::format("`{}` is a class of the standard library, `{}`; did you mean `My{}`?",
                         name, module, name));
}

/// The template with the name in place of each word NAME.
std::string textFor(const NewOptions &options) {
  const std::string text = readFile(
      fmt::format("{}/templates/{}{}", libraryFolder(), options.kind, endingOf(options.kind)));
  std::string result;
  for (auto at = text.begin(); at != text.end();) {
    const auto word = std::find_if(at, text.end(), isOfName);
    const auto end = std::find_if_not(word, text.end(), isOfName);
    result.append(at, word);
    result +=
        std::string_view("NAME") == std::string(word, end) ? options.name : std::string(word, end);
    at = end;
  }
  return result;
}

/// Rejects a name with which the file would not compile: a keyword, or a name that means something
/// else in the template.
void checkText(const NewOptions &options, const std::string &text) {
  SourceManager sources;
  Diagnostics diagnostics(sources);
  const PreprocessedFile preprocessed =
      preprocess(sources.add(options.name, text), sources, {}, diagnostics);
  const std::unique_ptr<ast::TranslationUnit> unit = parse(preprocessed.text, diagnostics);
  const auto noImports = [](const ast::ImportDecl &, FileId) { return nullptr; };
  // A class may have the name of a type, but the type is found first.
  const bool isType = TypeContext().named(options.name) != nullptr;
  if (!diagnostics.hasErrors())
    check({unit.get()}, noImports, diagnostics);
  if (isType || diagnostics.hasErrors())
    throw CLI::ValidationError(
        "NAME", fmt::format("`{}` means something else in RTSL, or in this {}; did you mean `{}`?",
                            options.name, options.kind,
                            std::islower(static_cast<unsigned char>(options.name.front()))
                                ? nameFrom(options.name)
                                : "My" + options.name));
}

/// As a word of a command for the shell.
std::string quoted(const std::string &word) {
  const bool isPlain = std::all_of(word.begin(), word.end(), [](char c) {
    return isOfName(c) || std::string_view("./-+,:@%").find(c) != std::string_view::npos;
  });
  if (isPlain)
    return word;
  std::string text = "'";
  for (const char c : word)
    text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

/// Writes a file that must not exist yet: reserves the name, so that no other program's file of
/// that name is replaced, and then fills it at once.
void writeNewFile(const fs::path &path, const std::string &text) {
  const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file < 0) {
    Error error(message::cannotWrite(path.string(), std::strerror(errno)), Place{path.string()});
    const fs::path folder = path.parent_path();
    std::error_code unknown;
    if (errno == EEXIST)
      error.note("`rtslc new` overwrites no file: choose another name, or another folder by `-o`");
    else if (errno == ENOENT && !fs::exists(folder, unknown))
      error.note(fmt::format("there is no folder `{}`: `mkdir -p {}` makes it", folder.string(),
                             quoted(folder.string())));
    throw error;
  }
  ::close(file);
  try {
    writeFileAtomically(path, text);
  } catch (...) {
    ::unlink(path.c_str());
    throw;
  }
}

int makeNew(const NewOptions &options) {
  checkName(options);
  Messages messages(options.common);
  try {
    const std::string text = textFor(options);
    const bool isScene = endingOf(options.kind) == std::string_view(sceneEnding);
    if (!isScene)
      checkText(options, text);
    const fs::path path =
        (fs::path(options.folder) / (options.name + endingOf(options.kind))).lexically_normal();
    writeNewFile(path, text);
    const std::string next =
        fmt::format("render {} -o {}", quoted(path.string()), quoted(options.name + ".png"));
    printOut(fmt::format("wrote {}\nnext: rtslc {}\n", path.string(), next));
  } catch (const Error &error) {
    messages.report(error);
  }
  return messages.status();
}

} // namespace

void addNewCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<NewOptions>();
  CLI::App *command =
      app.add_subcommand("new", "write a material, a camera, a scene ... to start from");
  const std::vector<std::string> words = wordsOf(kinds);
  addChoice(*command, "KIND", options->kind, words, "what to write")->required();
  command
      ->add_option("NAME", options->name,
                   "the name of the class, and of the file, which must not exist yet")
      ->required();
  command->add_option("-o,--output", options->folder, "the folder of the file; default: this one")
      ->type_name("FOLDER");
  addMessageOptions(*command, options->common);
  command->footer("examples:\n  rtslc new material Clay\n  rtslc new scene room -o scenes");
  command->callback([options, &action] { action = [options] { return makeNew(*options); }; });
}

} // namespace rtsl::tool
