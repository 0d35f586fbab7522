//===- Output.cpp - what goes to standard output ---------------------------===//
#include "Output.h"

#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <iostream>

namespace rtsl::tool {

void printOut(std::string_view text) {
  writeFileAtomically("-", text);
}

bool finishOutput(const char *program) {
  errno = 0;
  std::cout.flush();
  const bool isWritten = std::fflush(stdout) == 0 && !std::ferror(stdout) && std::cout.good();
  if (!isWritten)
    fmt::print(stderr, "{}: {}\n", program,
               message::cannotWriteStandardOutput(std::strerror(errno ? errno : EIO)).text);
  return isWritten;
}

void reportFileSizeLimit() {
  std::signal(SIGXFSZ, SIG_IGN);
}

} // namespace rtsl::tool
