//===- Interruption.cpp - Ctrl-C while a picture is rendered ---------------===//
#include "Interruption.h"

#include <cerrno>
#include <csignal>
#include <initializer_list>
#include <string_view>
#include <unistd.h>

namespace rtsl::tool {

namespace {

std::atomic<bool> isInterrupted{false};
std::atomic<int> caught{0};
std::atomic<bool> mayHaveProgress{false}; // on standard error

void note(int signal) {
  caught = signal;
  isInterrupted = true;
}

/// Calls nothing that a signal handler must not call.
void noteAndSay(int signal) {
  note(signal);
  if (signal != SIGINT)
    return;
  const int before = errno;
  constexpr std::string_view wipe = "\r\033[K",
                             text = "finishing the sample; press Ctrl-C again to leave\n";
  for (const std::string_view part : {mayHaveProgress ? wipe : std::string_view(), text})
    if (write(STDERR_FILENO, part.data(), part.size()) < 0)
      break;
  errno = before;
}

const std::atomic<bool> *catchBy(void (*handler)(int)) {
  struct sigaction action = {};
  action.sa_handler = handler;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM})
    sigaction(signal, &action, nullptr);
  return &isInterrupted;
}

} // namespace

const std::atomic<bool> *catchInterruptions() {
  return catchBy(note);
}

const std::atomic<bool> *catchInterruptionsOfSamples() {
  mayHaveProgress = isatty(STDERR_FILENO) != 0;
  return catchBy(noteAndSay);
}

const char *interruption() {
  return caught == SIGINT ? "SIGINT" : caught == SIGTERM ? "SIGTERM" : nullptr;
}

int statusAfterInterruption(int status) {
  constexpr int shellOffset = 128; // as shells show what a signal has ended
  return caught ? shellOffset + caught : status;
}

} // namespace rtsl::tool
