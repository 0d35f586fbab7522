//===- Workers.cpp - programs in processes of their own -------------------===//
#include "Workers.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <map>
#include <stdexcept>
#include <tuple>
#include <utility>

#include <csignal>
#include <fcntl.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>

namespace rtsl::random {

namespace {

/// A process that compares programs and writes one finding each to a pipe.
struct Worker {
  pid_t process = 0;
  int pipe = -1;
  std::vector<std::uint32_t> seeds; // empty: a program that has no seed any more
  std::string text;                 // what it wrote so far
};

void write(int pipe, const std::string &text) {
  for (std::size_t done = 0; done != text.size();) {
    const ssize_t written = ::write(pipe, text.data() + done, text.size() - done);
    if (written <= 0)
      _exit(9);
    done += static_cast<std::size_t>(written);
  }
}

/// A finding is a letter for the failure, a large one if a ray met something, and two texts with a
/// zero after each: the detail, and why a path refused the program.
void report(int pipe, const std::vector<Finding> &findings) {
  std::string text;
  for (const Finding &finding : findings) {
    text += static_cast<char>((finding.hit ? 'A' : 'a') + static_cast<int>(finding.failure));
    for (const std::string &part : {finding.detail, finding.refused}) {
      text += part.substr(0, 4000);
      text += '\0';
    }
  }
  write(pipe, text);
}

Worker start(const std::function<std::vector<Finding>()> &work, unsigned seconds) {
  int ends[2];
  if (::pipe(ends) != 0)
    throw std::runtime_error(std::string("no pipe: ") + std::strerror(errno));
  std::fflush(nullptr);
  Worker worker;
  worker.process = fork();
  if (worker.process < 0)
    throw std::runtime_error(std::string("no process: ") + std::strerror(errno));
  if (worker.process == 0) {
    close(ends[0]);
    alarm(seconds);
    report(ends[1], work());
    _exit(0);
  }
  close(ends[1]);
  worker.pipe = ends[0];
  return worker;
}

/// Waits for a worker whose pipe is closed. One finding a program, or one for all.
std::vector<Finding> finish(Worker &worker, unsigned seconds) {
  close(worker.pipe);
  int status = 0;
  waitpid(worker.process, &status, 0);
  if (WIFSIGNALED(status)) {
    if (WTERMSIG(status) == SIGALRM)
      return {{Failure::Hang, "after " + std::to_string(seconds) + " s", false, ""}};
    return {{Failure::Crash, strsignal(WTERMSIG(status)), false, ""}};
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
    return {{Failure::Crash, "exit status " + std::to_string(WEXITSTATUS(status)), false, ""}};
  std::vector<Finding> findings;
  for (std::size_t at = 0; at < worker.text.size();) {
    const char *text = worker.text.c_str() + at;
    const bool hit = *text < 'a';
    const std::string detail = text + 1, refused = text + 1 + detail.size() + 1;
    findings.push_back({static_cast<Failure>(*text - (hit ? 'A' : 'a')), detail, hit, refused});
    at += 1 + detail.size() + 1 + refused.size() + 1;
  }
  return findings;
}

/// Reads what there is; false at the end.
bool read(Worker &worker) {
  char buffer[4096];
  const ssize_t got = ::read(worker.pipe, buffer, sizeof buffer);
  if (got <= 0)
    return false;
  worker.text.append(buffer, static_cast<std::size_t>(got));
  return true;
}

std::vector<Finding> compareSeeds(const std::vector<std::uint32_t> &seeds,
                                  const PathOptions &options) {
  std::vector<Program> programs;
  for (std::uint32_t seed : seeds)
    programs.push_back(generate(seed));
  std::vector<const Program *> pointers;
  for (const Program &program : programs)
    pointers.push_back(&program);
  return compare(pointers, options);
}

/// Programs of a kind share a compilation: those that run on the same paths, with the same colors
/// and features.
std::deque<std::vector<std::uint32_t>> makeBatches(std::uint32_t first, std::uint32_t count,
                                                   const RunOptions &options) {
  std::deque<std::vector<std::uint32_t>> batches;
  using Kind = std::tuple<std::vector<std::string>, unsigned, bool, bool, bool>;
  std::map<Kind, std::vector<std::uint32_t>> kinds;
  for (std::uint32_t seed = first; seed != first + count; ++seed) {
    std::vector<std::uint32_t> &batch =
        kinds[{pathsOf(seed, options.paths), colorComponents(seed), raises(seed), generates(seed),
               usesPathTracer(seed)}];
    batch.push_back(seed);
    if (batch.size() == options.batch)
      batches.push_back(std::exchange(batch, {}));
  }
  for (auto &[kind, batch] : kinds)
    if (!batch.empty())
      batches.push_back(std::move(batch));
  return batches;
}

} // namespace

Results runSeeds(std::uint32_t first, std::uint32_t count, const RunOptions &options,
                 const std::function<void(std::size_t)> &progress) {
  std::deque<std::vector<std::uint32_t>> waiting = makeBatches(first, count, options);
  std::vector<Worker> running;
  Results results;
  std::vector<FailedSeed> &failed = results.failed;
  std::size_t done = 0;
  auto settle = [&](Worker &worker) {
    const std::vector<std::uint32_t> seeds = worker.seeds;
    std::vector<Finding> findings = finish(worker, options.secondsLimit);
    if (areOfBatch(findings, seeds.size())) {
      const auto half = seeds.begin() + static_cast<std::ptrdiff_t>(seeds.size() / 2);
      waiting.emplace_front(seeds.begin(), half);
      waiting.emplace_front(half, seeds.end());
      return;
    }
    for (std::size_t i = 0; i != seeds.size(); ++i)
      if (i >= findings.size())
        failed.push_back({seeds[i], {Failure::Crash, "no answer", false, ""}});
      else if (findings[i].failure != Failure::None)
        failed.push_back({seeds[i], findings[i]});
    for (std::size_t i = 0; i != findings.size(); ++i) {
      results.hit += findings[i].hit;
      if (!findings[i].refused.empty())
        results.refused[findings[i].refused].push_back(seeds[i]);
    }
    done += seeds.size();
    progress(done);
  };
  while (!waiting.empty() || !running.empty()) {
    while (!waiting.empty() && running.size() < options.processes) {
      std::vector<std::uint32_t> seeds = std::move(waiting.front());
      waiting.pop_front();
      running.push_back(
          start([&] { return compareSeeds(seeds, options.paths); }, options.secondsLimit));
      running.back().seeds = std::move(seeds);
    }
    std::vector<pollfd> polled;
    for (const Worker &worker : running)
      polled.push_back({worker.pipe, POLLIN, 0});
    poll(polled.data(), polled.size(), -1);
    for (std::size_t i = polled.size(); i-- > 0;)
      if (polled[i].revents != 0 && !read(running[i])) {
        Worker ended = std::move(running[i]);
        running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
        settle(ended);
      }
  }
  std::sort(failed.begin(), failed.end(),
            [](const FailedSeed &a, const FailedSeed &b) { return a.seed < b.seed; });
  return results;
}

Finding runAlone(const Program &program, const RunOptions &options) {
  Worker worker = start([&] { return compare({&program}, options.paths); }, options.secondsLimit);
  while (read(worker))
    ;
  const std::vector<Finding> findings = finish(worker, options.secondsLimit);
  return findings.empty() ? Finding{Failure::Crash, "no answer", false, ""} : findings.front();
}

} // namespace rtsl::random
