//===- HandOver.cpp - commands that rtslc-render runs ---------------------===//
#include "HandOver.h"

#include "support/ProgramFolder.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/SceneArguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
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

/// A command of rtslc whose program is bound to a scene: the runtime makes its objects.
static bool bindsScene(std::string_view command, char **arguments) {
  if (command != "check" && command != "compile" && command != "explain")
    return false;
  for (; *arguments; ++arguments)
    if (isScene(*arguments))
      return true;
  return false;
}

void handOver(char **argv) {
  const std::string_view command = argv[0] && argv[1] ? argv[1] : "";
  const bool isHandedOver =
      std::any_of(std::begin(handedOver), std::end(handedOver),
                  [&](const Summary &summary) { return command == summary.command; });
  if (isHandedOver || bindsScene(command, argv + 1)) {
    const std::filesystem::path program = programFolder() / "rtslc-render";
    execv(program.c_str(), argv);
    if (errno == ENOMEM)
      throw std::bad_alloc();
    throw std::runtime_error(fmt::format("cannot start `{}`, which implements `rtslc {}`: {}",
                                         program.string(), command, std::strerror(errno)));
  }
}

} // namespace rtsl::tool
