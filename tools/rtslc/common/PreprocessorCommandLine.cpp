//===- PreprocessorCommandLine.cpp - -I, -D, -U, -MD and what they do ------===//
#include "PreprocessorCommandLine.h"

#include "support/AtomicFile.h"

#include <algorithm>
#include <filesystem>

namespace rtsl::tool {

namespace {

/// The macro of -D or -U. Throws CLI::ValidationError if it is invalid.
MacroOption parseMacro(const char *option, const std::string &text, bool isUndefined) {
  MacroOption macro;
  macro.isUndefined = isUndefined;
  const std::size_t equals = isUndefined ? std::string::npos : text.find('=');
  macro.name = text.substr(0, equals);
  macro.value = equals == std::string::npos ? "1" : text.substr(equals + 1);
  const auto isNameCharacter = [](char c) {
    return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  const bool isName = !macro.name.empty() && !(macro.name[0] >= '0' && macro.name[0] <= '9') &&
                      std::all_of(macro.name.begin(), macro.name.end(), isNameCharacter);
  if (!isName || macro.name == "defined")
    throw CLI::ValidationError(option, "`" + macro.name + "` cannot be the name of a macro");
  if (isOfTheLanguage(macro.name))
    throw CLI::ValidationError(option, "`" + macro.name +
                                           "` is defined by the language and cannot be changed");
  if (macro.value.find_first_of("\n\r") != std::string::npos ||
      macro.value.find('\\') != std::string::npos)
    throw CLI::ValidationError(option,
                               "the value of `" + macro.name + "` is one line without backslashes");
  return macro;
}

bool hasFile(const std::string &output) {
  return !output.empty() && output != "-";
}

/// A path as make reads it.
std::string escaped(const std::string &path) {
  std::string result;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const char c = path[i];
    if (c == ' ' || c == '\t' || c == '#') {
      // Backslashes in front of these are themselves escaped, and nowhere else.
      for (std::size_t back = i; back > 0 && path[back - 1] == '\\'; --back)
        result += '\\';
      result += '\\';
    } else if (c == '$') {
      result += '$';
    }
    result += c;
  }
  return result;
}

} // namespace

void addPreprocessorOptions(CLI::App &command, PreprocessorOptions &options) {
  command
      .add_option("-I", options.includeFolders,
                  "also search this folder for included and imported files")
      ->type_name("FOLDER")
      ->allow_extra_args(false);
  const auto add = [&](const char *option, const char *help, const char *type, bool isUndefined) {
    command
        .add_option_function<std::vector<std::string>>(
            option,
            [&options, option, isUndefined](const std::vector<std::string> &texts) {
              for (const std::string &text : texts)
                options.macros.push_back(parseMacro(option, text, isUndefined));
            },
            help)
        ->type_name(type)
        ->allow_extra_args(false)
        ->trigger_on_parse(); // so that -D and -U keep their order
  };
  add("-D", "define a macro; default value 1", "NAME[=VALUE]", false);
  add("-U", "remove the definition of an earlier -D", "NAME", true);
}

void addDependencyOptions(CLI::App &command, DependencyOptions &options) {
  command.add_flag("--MD", options.isAsked,
                   "(or -MD) write a rule for make that lists the files that were read");
  command.add_option("--MF", options.file, "(or -MF) the file for that rule")->type_name("FILE");
  command.add_option("--MT", options.target, "(or -MT) the target of that rule")
      ->type_name("TARGET");
}

std::vector<std::string> withLongDashes(int argc, char **argv) {
  std::vector<std::string> arguments(argv + 1, argv + argc);
  for (std::string &argument : arguments)
    if (argument == "-MD" || argument == "-MF" || argument == "-MT")
      argument.insert(0, "-");
  return arguments;
}

std::string dependencyRule(const std::string &target, const std::vector<std::string> &files) {
  std::string rule = escaped(target) + ":";
  for (const std::string &file : files)
    rule += " \\\n  " + escaped(file);
  return rule + "\n";
}

std::string dependencyFile(const DependencyOptions &options, const std::string &output,
                           const std::vector<std::string> &sources) {
  if (!options.file.empty())
    return options.file;
  if (hasFile(output))
    return std::filesystem::path(output).replace_extension(".d").string();
  const std::string source = sources.front() == "-" ? "stdin" : sources.front();
  return std::filesystem::path(source).filename().replace_extension(".d").string();
}

void checkOutputs(const std::string &output, const DependencyOptions &dependencies,
                  const std::vector<std::string> &sources,
                  const std::vector<std::string> &filesRead) {
  std::vector<std::string> outputs;
  if (!output.empty())
    outputs.push_back(output);
  if (dependencies.isAsked)
    outputs.push_back(dependencyFile(dependencies, output, sources));
  for (const std::string &file : outputs) {
    checkFileWritable(file);
    refuseToOverwrite(file, sources);
    refuseToOverwrite(file, filesRead);
  }
}

void writeDependencies(const DependencyOptions &options, const std::string &output,
                       const std::vector<std::string> &sources,
                       const std::vector<std::string> &files) {
  if (!options.isAsked)
    return;
  const std::string file = dependencyFile(options, output, sources);
  const std::string target = !options.target.empty() ? options.target
                             : hasFile(output)       ? output
                                                     : file;
  writeFileAtomically(file, dependencyRule(target, files));
}

} // namespace rtsl::tool
