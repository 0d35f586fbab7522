//===- HandOver.cpp - commands that rtslc-render runs ---------------------===//
#include "HandOver.h"

#include "codegen/driver/Stages.h"
#include "support/ProgramFolder.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/SceneArguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <new>
#include <stdexcept>
#include <unistd.h>

namespace rtsl::tool {

namespace {

constexpr Summary handedOver[] = {renderSummary, runSummary,    traceSummary,
                                  packSummary,   reportSummary, compareSummary};

} // namespace

void addHandedOverCommands(CLI::App &app) {
  for (const Summary &summary : handedOver)
    app.add_subcommand(summary.command, summary.text);
}

/// `--emit=NAME` and the NAME of `--emit NAME`. A file of that name is taken for it, which does no
/// harm: rtslc-render has these commands as a whole.
static bool namesMachineStage(std::string_view argument) {
  const std::string_view name = argument.substr(argument.find('=') + 1);
  return std::any_of(stages().begin(), stages().end(),
                     [&](const Stage &stage) { return stage.isMachine && stage.name == name; });
}

/// Arguments of a command of rtslc with which it needs the runtime, which makes the objects of a
/// scene, or code generators.
static bool needsRender(std::string_view command, char **arguments) {
  if (command != "check" && command != "compile" && command != "explain")
    return false;
  for (; *arguments; ++arguments)
    if (isScene(*arguments) || (command == "compile" && namesMachineStage(*arguments)))
      return true;
  return false;
}

/// Lets the heap of rtslc-render be in large pages, where the kernel allows it: rendering a small
/// scene takes 9 % less time. What the user has set stays.
static void chooseHeap() {
  setenv("GLIBC_TUNABLES", "glibc.malloc.hugetlb=1", /*overwrite=*/0);
}

void handOver(char **argv) {
  const std::string_view command = argv[0] && argv[1] ? argv[1] : "";
  const bool isHandedOver =
      std::any_of(std::begin(handedOver), std::end(handedOver),
                  [&](const Summary &summary) { return command == summary.command; });
  if (isHandedOver || needsRender(command, argv + 1)) {
    const std::filesystem::path program = programFolder() / "rtslc-render";
    chooseHeap();
    execv(program.c_str(), argv);
    if (errno == ENOMEM)
      throw std::bad_alloc();
    throw std::runtime_error(fmt::format("cannot start `{}`, which implements `rtslc {}`: {}",
                                         program.string(), command, std::strerror(errno)));
  }
}

} // namespace rtsl::tool
