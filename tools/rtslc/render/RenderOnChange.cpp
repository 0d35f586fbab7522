//===- RenderOnChange.cpp - rtslc render --watch --------------------------===//
#include "RenderOnChange.h"

#include "FileWatch.h"
#include "tools/common/Interruption.h"

#include <fmt/format.h>

#include <cstdio>
#include <thread>

namespace rtsl::tool {

namespace {

constexpr std::chrono::milliseconds moment(50); // to notice a signal

/// While it exists, a change of files or a signal sets the flag.
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
