//===- Main.cpp - rtsl-random ---------------------------------------------===//
//
//   rtsl-random 17                                  prints the program of a seed
//   rtsl-random --first 0 --count 500 --threads 8   runs programs on every usual path and compares
//   rtsl-random ... --shrink                        and makes those that fail as small as they go
//
// Exit status: 0 all agree, 1 some do not (or of 25 programs and more less than half sent a ray
// that met something: then hardly a material ran), 2 wrong arguments.
//
//===----------------------------------------------------------------------===//
#include "Shrink.h"
#include "Workers.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <fstream>

#include <unistd.h>

using namespace rtsl::random;

namespace {

/// What a smaller program has to share with the one that failed.
std::string kindOf(const Finding &finding) {
  std::string kind = name(finding.failure);
  if (finding.failure == Failure::Rejected || finding.failure == Failure::Fault ||
      finding.failure == Failure::Crash)
    kind +=
        finding.detail.substr(0, std::min<std::size_t>(finding.detail.find_first_of(":\n`"), 60));
  return kind;
}

void shrinkAndWrite(const FailedSeed &failed, const RunOptions &options,
                    const std::string &folder) {
  Program program = generate(failed.seed);
  RunOptions alone = options;
  alone.secondsLimit = std::min(options.secondsLimit, 60u); // a compiler of C++ takes its time
  const std::string kind = kindOf(failed.finding);
  if (kindOf(runAlone(program, alone)) != kind) {
    fmt::print("seed {} fails only beside others\n", failed.seed);
    return;
  }
  const std::size_t before = sizeOf(*program.tree);
  shrink(program, [&](const Program &smaller) { return kindOf(runAlone(smaller, alone)) == kind; });
  const std::string body = program.text();
  const std::string text = fmt::format("// seed {}: {}\n{}{}", failed.seed,
                                       name(failed.finding.failure), prelude(body), body);
  const std::string path = fmt::format("{}/seed-{}.rtsl", folder, failed.seed);
  std::ofstream(path) << text;
  fmt::print("seed {}, shrunk from {} to {} nodes, {}: {}\n{}\n", failed.seed, before,
             sizeOf(*program.tree), path, runAlone(program, alone).detail, text);
  std::fflush(stdout);
}

} // namespace

int main(int argc, char **argv) {
  CLI::App app("Random RTSL programs: prints them, runs them every way there is, and compares.");
  std::uint32_t seed = 0, first = 0, count = 0;
  unsigned shrinkAtMost = 5;
  bool makeSmaller = false;
  std::string folder = ".";
  RunOptions options;
  CLI::Option *printed = app.add_option("SEED", seed, "print the program of this seed");
  app.add_option("--first", first, "the first seed")->capture_default_str();
  CLI::Option *ranged = app.add_option("--count", count, "run so many seeds");
  app.add_option("--threads", options.processes, "programs run in so many processes")
      ->check(CLI::Range(1u, 1024u))
      ->capture_default_str();
  app.add_option("--batch", options.batch, "programs in one compilation")
      ->check(CLI::Range(1u, 1000u))
      ->capture_default_str();
  std::vector<std::string> &wanted = options.paths.wanted;
  app.add_option("--paths", wanted,
                 "compare the first path with these: " +
                     fmt::format("{}", fmt::join(pathNames(), ", ")))
      ->delimiter(',');
  app.add_option("--also", options.paths.also, "and with these, in addition to the defaults")
      ->delimiter(',');
  app.add_option("--compiler", options.paths.cpp.compiler,
                 "what makes programs of C++, with its options; empty: they are only printed")
      ->type_name("COMMAND")
      ->capture_default_str();
  app.add_option("--keep-cpp", options.paths.cpp.keep,
                 "where to leave the last file of C++ that was compiled");
  app.add_option("--seconds", options.secondsLimit, "a batch that takes longer hangs")
      ->capture_default_str();
  app.add_flag("--shrink", makeSmaller, "make programs that fail smaller, print and write them");
  app.add_option("--shrink-at-most", shrinkAtMost, "so many of them")->capture_default_str();
  app.add_option("--out", folder, "where these are written")->capture_default_str();
  try {
    app.parse(argc, argv);
    if (printed->count() + ranged->count() != 1)
      throw CLI::ValidationError("give a SEED to print, or --count to run programs");
    const std::vector<std::string> known = pathNames();
    if (wanted.size() == 1 && wanted[0] == "all")
      wanted = known;
    for (const std::vector<std::string> *names : {&wanted, &options.paths.also})
      for (const std::string &path : *names)
        if (std::find(known.begin(), known.end(), path) == known.end())
          throw CLI::ValidationError("no path is named `" + path + "`");
  } catch (const CLI::ParseError &error) {
    return app.exit(error) == 0 ? 0 : 2;
  }

  if (printed->count()) {
    const std::string text = generate(seed).text();
    std::fputs((prelude(text) + text).c_str(), stdout);
    return 0;
  }
  const bool isTerminal = isatty(2);
  const Results results = runSeeds(first, count, options, [&](std::size_t done) {
    if (isTerminal)
      fmt::print(stderr, "\r{} of {}", done, count);
  });
  if (isTerminal)
    fmt::print(stderr, "\n");
  const std::vector<FailedSeed> &failed = results.failed;
  for (const FailedSeed &one : failed)
    fmt::print("seed {}: {}: {}\n", one.seed, name(one.finding.failure), one.finding.detail);
  for (const auto &[reason, seeds] : results.refused)
    fmt::print("{} programs not run, such as seed {}, {}\n", seeds.size(), seeds.front(), reason);
  fmt::print("{} programs, {} failed, in {} a ray met something\n", count, failed.size(),
             results.hit);
  std::fflush(stdout);
  if (makeSmaller)
    for (std::size_t i = 0; i != failed.size() && i != shrinkAtMost; ++i)
      shrinkAndWrite(failed[i], options, folder);
  const bool saysLittle = count >= 25 && results.hit < count / 2;
  return failed.empty() && !saysLittle ? 0 : 1;
}
