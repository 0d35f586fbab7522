//===- Main.cpp - rtslc, the compiler of RTSL -----------------------------===//
//
// Reads the arguments and hands over to a command. Exit status: 0 fine, 1 errors in the user's files, 2 wrong
// arguments, 3 a fault of rtslc itself.
//
//===----------------------------------------------------------------------===//
#include "CommandLine.h"
#include "HandOver.h"

using namespace rtsl::tool;

int main(int argc, char **argv) {
  CLI::App app("rtslc compiles RTSL, a ray tracing shading language, and renders with it", "rtslc");
  app.set_version_flag("--version", "rtslc " RTSL_VERSION);
  app.require_subcommand(1);
  app.footer("examples:\n"
             "  rtslc render examples/glass/scene.json -o glass.png\n"
             "  rtslc check Glass.rtsl\n"
             "  rtslc compile Glass.rtsl --emit=ir\n"
             "`rtslc COMMAND --help` tells more. Exit status: 0 fine, 1 errors in the files, 2 wrong arguments,\n"
             "3 a fault of rtslc itself.");
  Action action;
  addCheckCommand(app, action);
  addCompileCommand(app, action, nullptr);
  addExplainCommand(app, action, nullptr, nullptr);
  addHandedOverCommands(app);

  return run(app, action, argc, argv, [argv] { handOver(argv); });
}
