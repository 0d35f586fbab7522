//===- RenderMain.cpp - rtslc-render, the commands that need the runtime --===//
//
// Started by rtslc (HandOver.h); it can be called as well.
//
//===----------------------------------------------------------------------===//
#include "codegen/driver/MachineCode.h"
#include "tools/rtslc/compile/CheckCommand.h"
#include "tools/rtslc/compile/CompileCommand.h"
#include "tools/rtslc/explain/ExplainCommand.h"

using namespace rtsl::tool;

int main(int argc, char **argv) {
  CLI::App app("renders RTSL scenes, compares pictures and measures error against run time",
               "rtslc");
  app.require_subcommand(1);
  Action action;
  addCheckCommand(app, action, &checkScene);
  addCompileCommand(app, action, &translateScene, &rtsl::driver::machineCode());
  addExplainCommand(app, action, &explainScene);
  addRenderCommand(app, action);
  addRunCommand(app, action);
  addTraceCommand(app, action);
  addReportCommand(app, action);
  addPackCommand(app, action);
  addCompareCommand(app, action);
  return run(app, action, argc, argv);
}
