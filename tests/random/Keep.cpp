//===- Keep.cpp - rtsl-random-keep ----------------------------------------===//
//
//   rtsl-random-keep --first 0 --count 300
//
// Programs that are bound to a random world, as those of scenes are: with everything left out that
// the world does not need, with everything kept (--keep=all), and one in three with one item kept.
// All must say the same, bit for bit. Beside its own classes each has those of the next seed, which
// no object uses. Exit status: 0 all agree, 1 some do not, 2 wrong arguments.
//
//===----------------------------------------------------------------------===//
#include "Program.h"
#include "world/World.h"

#include "codegen/driver/Compiler.h"
#include "frontend/syntax/Parser.h"
#include "sema/Sema.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <csignal>
#include <cstdlib>
#include <unistd.h>

using namespace rtsl;
using namespace rtsl::random;

namespace {

using Words = std::vector<std::uint32_t>;

std::uint32_t currentSeed = 0;

/// Says whose code has crashed.
void sayAndEnd(int signal) {
  char text[64];
  const auto end = fmt::format_to_n(text, sizeof text, "seed {}: signal {}\n", currentSeed, signal);
  [[maybe_unused]] const auto written = write(2, text, end.size);
  std::_Exit(1);
}

/// A random program beside classes that its world has no objects of.
class Subject {
public:
  explicit Subject(std::uint32_t seed) : program(generate(seed)), unused(generate(seed + 1)) {
    std::string text = program.text() + unused.text();
    text = prelude(text) + text;
    unit = parse(sources.add("random.rtsl", std::move(text)), diagnostics);
    module =
        check({unit.get()}, [](const ast::ImportDecl &, FileId) { return nullptr; }, diagnostics);
    if (diagnostics.hasErrors())
      return;
    request.classes = {program.camera, program.miss, program.selector, program.exception,
                       program.rayGeneration};
    for (const auto *names : {&program.helpers, &program.textures, &program.lights,
                              &program.primitives, &program.materials, &program.meshMaterials})
      request.classes.insert(request.classes.end(), names->begin(), names->end());
    if (module->findClass(program.rayGeneration))
      request.engine = runtime::Engine::Programs;
    if (module->findClass("sampler2D"))
      request.classes.push_back("sampler2D");
    request.surfaces = World::surfaces(program);
    request.features = RTSL_FEATURE_PRINT | (program.raises ? RTSL_FEATURE_EXCEPTIONS : 0);
  }

  bool isValid() const { return !diagnostics.hasErrors(); }

  /// The world's results with these items kept.
  Words run(ItemSet kept, bool isSplit) {
    LinkRequest keeping = request;
    CompileOptions options;
    options.optimization = 0; // what is left out is left out before
    options.colorComponents = program.colorComponents;
    options.trace = isSplit ? TraceMode::Split : TraceMode::Recurse;
    keep(kept, keeping, options);
    // What keeping something writes, and nothing else does, must not be read.
    options.undefined = kept.isEmpty() ? RTSL_FEATURE_UNDEFINED_NAN : RTSL_FEATURE_UNDEFINED_BYTES;
    std::shared_ptr<const runtime::Program> constructors;
    std::unique_ptr<World> made;
    Diagnostics unheard(sources);
    const auto bound = compileProgram(*module, keeping, options, unheard, [&](const auto &code) {
      constructors = code;
      made = std::make_unique<World>(*code, program);
      return made->facts();
    });
    if (!bound)
      throw std::logic_error("refused: " + renderText(unheard, false));
    World world(*bound, *made);
    Words words = world.run(/*isSampled=*/false);
    hitSomething |= world.hitSomething();
    return words;
  }

  bool hitSomething = false;

private:
  Program program, unused;
  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::unique_ptr<ast::TranslationUnit> unit;
  std::unique_ptr<typed::Module> module;
  LinkRequest request;
};

/// Whether keeping something changes a program's results: the items that are named, or all of them
/// and perhaps one.
bool differs(Subject &subject, std::uint32_t seed, const std::vector<std::string> &names) {
  const bool isSplit = seed % 2 != 0;
  const Item single = allItems[seed % std::size(allItems)];
  const Words leftOut = subject.run({}, isSplit);
  std::vector<std::pair<std::string, ItemSet>> others = {{"all", ItemSet::all()}};
  if (seed % 3 == 0)
    others.push_back({nameOf(single), ItemSet::only(single)});
  if (!names.empty())
    others.clear();
  for (const std::string &name : names) {
    ItemSet items;
    for (const Item item : allItems)
      if (("+" + name + "+").find("+" + std::string(nameOf(item)) + "+") != std::string::npos)
        items.add(item);
    others.push_back({name, items});
  }
  for (const auto &[name, kept] : others) {
    const Words words = subject.run(kept, isSplit);
    for (std::size_t i = 0; i != leftOut.size(); ++i)
      if (leftOut[i] != words[i]) {
        fmt::print("seed {}{}: word {} is {:08x}, and with --keep={} {:08x}\n", seed,
                   isSplit ? ", split" : "", i, leftOut[i], name, words[i]);
        return true;
      }
  }
  return false;
}

} // namespace

int main(int argc, char **argv) {
  CLI::App app(
      "Random programs with everything left out that is not needed, and with it kept: they agree.");
  std::uint32_t first = 0, count = 30;
  std::vector<std::string> names;
  app.add_option("--first", first, "the first seed")->capture_default_str();
  app.add_option("--count", count, "run so many seeds")->capture_default_str();
  app.add_option("--keep", names, "keep these, one at a time; `a+b`: both")->delimiter(',');
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError &error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  for (int signal : {SIGSEGV, SIGABRT, SIGFPE, SIGILL})
    std::signal(signal, sayAndEnd);

  std::uint32_t run = 0, failed = 0, hit = 0;
  for (currentSeed = first; run < count; ++currentSeed) {
    Subject subject(currentSeed);
    if (!subject.isValid())
      continue; // two programs together may be more than the language allows
    ++run;
    try {
      failed += differs(subject, currentSeed, names);
    } catch (const std::exception &fault) {
      fmt::print("seed {}: {}\n", currentSeed, fault.what());
      ++failed;
    }
    hit += subject.hitSomething;
  }
  fmt::print("{} programs, {} failed, in {} a ray met something\n", run, failed, hit);
  return failed == 0 && hit * 2 >= run ? 0 : 1;
}
