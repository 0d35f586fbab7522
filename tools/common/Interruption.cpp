//===- Interruption.cpp - Ctrl-C while a picture is rendered ---------------===//
#include "Interruption.h"

#include <csignal>
#include <initializer_list>

namespace rtsl::tool {

namespace {

std::atomic<bool> isInterrupted{false};
std::atomic<int> caught{0};

void note(int signal) {
  caught = signal;
  isInterrupted = true;
}

} // namespace

const std::atomic<bool> *catchInterruptions() {
  struct sigaction action = {};
  action.sa_handler = note;
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigemptyset(&action.sa_mask);
  for (const int signal : {SIGINT, SIGTERM})
    sigaction(signal, &action, nullptr);
  return &isInterrupted;
}

const char *interruption() {
  return caught == SIGINT ? "SIGINT" : caught == SIGTERM ? "SIGTERM" : nullptr;
}

int statusAfterInterruption(int status) {
  constexpr int shellOffset = 128; // as shells show what a signal has ended
  return caught ? shellOffset + caught : status;
}

} // namespace rtsl::tool
