//===- RenderOnChange.cpp - rtslc render --watch --------------------------===//
#include "RenderOnChange.h"

#include "FileWatch.h"
#include "support/AtomicFile.h"
#include "support/Clock.h"
#include "support/ProgramFolder.h"
#include "tools/common/Interruption.h"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <thread>
#include <unistd.h>

namespace rtsl::tool {

namespace {

constexpr std::chrono::milliseconds moment(50); // to notice a signal
constexpr double patience = 3;                  // seconds for a rendering to stop

/// Runs this command again in place of this process.
[[noreturn]] void startAgain() {
  fmt::print(stderr, "the last rendering does not end: starting again\n");
  std::string arguments = readFile("/proc/self/cmdline"); // each ends with a zero byte
  std::vector<char *> argv;
  for (std::size_t at = 0; at < arguments.size(); at = arguments.find('\0', at) + 1)
    argv.push_back(&arguments[at]);
  argv.push_back(nullptr);
  ::execv((programFolder() / "rtslc-render").c_str(), argv.data());
  std::perror("rtslc-render");
  std::_Exit(EXIT_FAILURE);
}

/// While it exists, a change of files or a signal sets the flag. If the rendering does not stop
/// then, a sample of it never ends, as those of a shader with an endless loop: no thread can be
/// stopped there, and the process ends with it.
class Stopper {
public:
  Stopper(FileWatch &files, std::atomic<bool> &stop)
      : files(files), stop(stop), thread([this] { run(); }) {}
  ~Stopper() {
    isOver = true;
    thread.join();
  }

private:
  void run() {
    while (!isOver && !stop)
      if (files.wait(moment) || interruption())
        stop = true;
    for (const auto begin = Clock::now(); !isOver; std::this_thread::sleep_for(moment / 10))
      if (secondsSince(begin) > patience) {
        if (interruption())
          std::_Exit(statusAfterInterruption(EXIT_SUCCESS));
        startAgain();
      }
  }

  FileWatch &files;
  std::atomic<bool> &stop;
  std::atomic<bool> isOver{false};
  std::thread thread;
};

} // namespace

void renderOnChange(const std::function<Rendering(const std::atomic<bool> &stop)> &render,
                    const std::string &output, bool isQuiet) {
  catchInterruptions();
  FileWatch watch;
  for (bool isFirst = true; !interruption(); isFirst = false) {
    const std::timespec begin = FileWatch::now();
    std::atomic<bool> stop{false};
    Rendering rendering;
    {
      Stopper stopper(watch, stop);
      rendering = render(stop);
    }
    watch.watch(rendering.files, begin, !rendering.isDone, output);
    if (stop)
      continue;
    if (!isQuiet && isFirst)
      fmt::print(stderr, "watching {} files; Ctrl-C ends\n", rendering.files.size());
    if (!isQuiet && !isFirst && !rendering.isDone)
      fmt::print(stderr, "`{}` is left as it was\n", output);
    while (!interruption() && !watch.wait(moment))
      ;
  }
}

} // namespace rtsl::tool
