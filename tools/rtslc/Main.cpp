//===- Main.cpp - rtslc, the compiler of RTSL -----------------------------===//
//
// Reads the arguments and hands over to a command. Exit status: 0 fine, 1 errors in the user's
// files, or no memory or disk for them, 2 wrong arguments, 3 a fault of rtslc itself; 130 and 143
// if SIGINT or SIGTERM stopped it.
//
//===----------------------------------------------------------------------===//
#include "HandOver.h"
#include "tools/rtslc/common/CommandLine.h"

#include <string_view>

using namespace rtsl::tool;

/// `help` and `help COMMAND` are other words for `--help` and `COMMAND --help`.
static std::vector<char *> withoutHelpCommand(int argc, char **argv) {
  static char option[] = "--help";
  std::vector<char *> arguments(argv, argv + argc);
  if (argc > 1 && std::string_view(argv[1]) == "help") {
    arguments.erase(arguments.begin() + 1);
    arguments.push_back(option);
  }
  arguments.push_back(nullptr);
  return arguments;
}

int main(int argc, char **argv) {
  CLI::App app("rtslc compiles RTSL, a ray tracing shading language, and renders with it", "rtslc");
  app.set_version_flag("-V,--version", "rtslc " RTSL_VERSION);
  app.require_subcommand(1);
  app.footer("examples:\n"
             "  rtslc new material Clay\n"
             "  rtslc render examples/glass/scene.json -o glass.png\n"
             "  rtslc check Glass.rtsl\n"
             "  rtslc compile Glass.rtsl --emit=ir\n"
             "`rtslc help COMMAND` shows its options. Exit status: 0 success, 1 errors in the "
             "files, or too little memory or disk space,\n"
             "2 wrong arguments, 3 an internal error of rtslc; 130 after SIGINT (Ctrl-C), 143 "
             "after SIGTERM.");
  Action action;
  addNewCommand(app, action);
  addCheckCommand(app, action, nullptr);
  addCompileCommand(app, action, nullptr, nullptr);
  addExplainCommand(app, action, nullptr);
  addHandedOverCommands(app);
  app.add_subcommand("help", "show the options of a command");

  std::vector<char *> arguments = withoutHelpCommand(argc, argv);
  return run(app, action, static_cast<int>(arguments.size()) - 1, arguments.data(),
             [&] { handOver(arguments.data()); });
}
