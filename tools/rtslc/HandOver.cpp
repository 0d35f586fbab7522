//===- HandOver.cpp - commands that live in a program of their own --------===//
#include "HandOver.h"

#include "CommandLine.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <unistd.h>

namespace rtsl::tool {

namespace {

constexpr Summary handedOver[] = {renderSummary, packSummary, reportSummary, compareSummary};

} // namespace

void addHandedOverCommands(CLI::App &app) {
  for (const Summary &summary : handedOver)
    app.add_subcommand(summary.command, summary.text);
}

void handOver(char **argv) {
  const std::string_view command = argv[0] && argv[1] ? argv[1] : "";
  for (const Summary &summary : handedOver) {
    if (command != summary.command)
      continue;
    std::error_code error;
    const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
    const std::filesystem::path program = self.parent_path() / "rtslc-render";
    execv(program.c_str(), argv);
    throw std::runtime_error(fmt::format("cannot start `{}`, which knows `rtslc {}`: {}", program.string(), command,
                                         std::strerror(errno)));
  }
}

} // namespace rtsl::tool
