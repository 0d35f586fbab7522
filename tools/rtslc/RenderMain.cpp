//===- RenderMain.cpp - rtslc-render, the commands that need the runtime --===//
//
// Started by rtslc (HandOver.h); it can be called as well.
//
//===----------------------------------------------------------------------===//
#include "scenefile/SceneFile.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/explain/ExplainGpu.h"
#include "tools/rtslc/explain/MeasureItems.h"

using namespace rtsl;
using namespace rtsl::tool;

int main(int argc, char **argv) {
  CLI::App app("renders RTSL scenes, compares pictures and measures error against run time",
               "rtslc");
  app.require_subcommand(1);
  Action action;
  addCheckCommand(app, action, &scene::buildScene);
  addCompileCommand(app, action, &scene::buildScene);
  addExplainCommand(app, action, &scene::buildScene, &measureItems, &explainGpu);
  addRenderCommand(app, action);
  addRunCommand(app, action);
  addTraceCommand(app, action);
  addReportCommand(app, action);
  addPackCommand(app, action);
  addCompareCommand(app, action);
  return run(app, action, argc, argv);
}
