//===- PrintedCpp.cpp - a module as C++ that a compiler made a program of -===//
#include "PrintedCpp.h"

#include "codegen/driver/Stages.h"

#include "rtsl/program.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <vector>

#include <csignal>
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace rtsl::random {

namespace {

/// A folder that is gone when the object is.
class TemporaryFolder {
public:
  TemporaryFolder() {
    std::string pattern = std::filesystem::temp_directory_path() / "rtsl-random-XXXXXX";
    if (!mkdtemp(pattern.data()))
      throw std::runtime_error(fmt::format("no folder {}: {}", pattern, std::strerror(errno)));
    path = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
  TemporaryFolder(const TemporaryFolder &) = delete;
  TemporaryFolder &operator=(const TemporaryFolder &) = delete;

  std::filesystem::path path;
};

std::string readFile(const std::filesystem::path &path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// Runs a command, which ends with this process at the latest; its messages go to a file. Its exit
/// status.
int run(std::vector<std::string> words, const std::filesystem::path &messages) {
  std::vector<char *> arguments;
  for (std::string &word : words)
    arguments.push_back(word.data());
  arguments.push_back(nullptr);
  const pid_t process = fork();
  if (process < 0)
    throw std::runtime_error(fmt::format("no process: {}", std::strerror(errno)));
  if (process == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const int to = open(messages.c_str(), O_WRONLY | O_CREAT, 0600);
    dup2(to, 1);
    dup2(to, 2);
    execvp(arguments[0], arguments.data());
    const std::string said = fmt::format("{}: {}\n", words[0], std::strerror(errno));
    [[maybe_unused]] const auto written = write(2, said.data(), said.size());
    _exit(127);
  }
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

/// The first error, without its place, which changes from program to program.
std::string firstError(const std::string &messages) {
  std::istringstream lines(messages);
  for (std::string line; std::getline(lines, line);)
    if (const std::size_t at = line.find("error: "); at != std::string::npos)
      return line.substr(at + std::strlen("error: "));
  return messages;
}

} // namespace

std::shared_ptr<const runtime::Program> compilePrinted(const typed::Module &module, TraceMode trace,
                                                       bool checkIndices, std::uint32_t features,
                                                       unsigned colorComponents,
                                                       const CppOptions &cpp,
                                                       Diagnostics &diagnostics) {
  CompileOptions options;
  options.colorComponents = colorComponents;
  options.checkIndices = checkIndices;
  options.undefined = features & (RTSL_FEATURE_UNDEFINED_BYTES | RTSL_FEATURE_UNDEFINED_NAN);
  CompileInput input;
  input.module = &module;
  input.cpp = {"programs", /*lineDirectives=*/false, trace, features};
  const std::optional<std::string> text = emit(stage("cpp"), input, options, diagnostics);
  if (!text)
    return nullptr;
  if (cpp.compiler.empty())
    return std::make_shared<runtime::Program>();

  const TemporaryFolder folder;
  const std::string source = folder.path / "programs.cpp", library = folder.path / "programs.so";
  std::ofstream(source) << *text;
  if (!cpp.keep.empty())
    std::ofstream(cpp.keep) << *text;
  std::vector<std::string> command;
  std::istringstream words(cpp.compiler);
  for (std::string word; words >> word;)
    command.push_back(word);
  for (const char *word : {"-std=c++17", "-fPIC", "-shared", "-I" RTSL_SOURCE_FOLDER,
                           "-I" RTSL_SOURCE_FOLDER "/include"})
    command.emplace_back(word);
  command.insert(command.end(), {source, "-o", library});
  if (run(command, folder.path / "messages") != 0)
    throw CompilerRefuses{firstError(readFile(folder.path / "messages"))};

  // Open until the process ends: the program is its code.
  void *opened = dlopen(library.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!opened)
    throw std::runtime_error(fmt::format("cannot load printed C++: {}", dlerror()));
  const auto shaders =
      reinterpret_cast<const RtslShaders *(*)()>(dlsym(opened, "programs_shaders"));
  if (!shaders)
    throw std::runtime_error(fmt::format("printed C++ has no programs_shaders: {}", dlerror()));
  return program(shaders());
}

} // namespace rtsl::random
