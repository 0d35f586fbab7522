//===- Paths.cpp - the ways to run a program, which all agree -------------===//
#include "Paths.h"

#include "world/World.h"

#include "codegen/driver/Compiler.h"
#include "frontend/syntax/Parser.h"
#include "sema/Sema.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <numeric>

namespace rtsl::random {

namespace {

using Compile = std::function<std::shared_ptr<const runtime::Program>(
    const typed::Module &, const LinkRequest &, unsigned colorComponents, const PathOptions &,
    Diagnostics &)>;

/// One way from a checked module to a program that runs.
struct Path {
  const char *name;
  bool checked;    // indices out of range are defined
  bool forTracing; // redundant for programs that do not trace
  Compile compile;
  bool isAsked = false;      // only by name, for it takes long
  bool renders = false;      // whole pictures, and no single samples
  bool isPrinted = false;    // and runs only if there is a compiler
  bool mixesSamples = false; // runs many samples at a time, step by step
  bool isExact = true;       // false: it only has to end
};

Compile compileWith(const CompileOptions &options) {
  return [options](const typed::Module &module, const LinkRequest &request,
                   unsigned colorComponents, const PathOptions &, Diagnostics &diagnostics) {
    CompileOptions ofColors = options;
    ofColors.colorComponents = colorComponents;
    return compileProgram(module, request, ofColors, diagnostics);
  };
}

Compile jit(unsigned optimization, bool checked, TraceMode trace,
            FloatingPoint arithmetic = FloatingPoint::Strict) {
  CompileOptions options;
  options.floatingPoint = arithmetic;
  options.optimization = optimization;
  options.checkIndices = checked;
  options.trace = trace;
  return compileWith(options);
}

/// By way of the structured states that C++ is printed from.
Compile structuredJit() {
  CompileOptions options;
  options.optimization = 0;
  options.trace = TraceMode::Split;
  options.restructure = true;
  return compileWith(options);
}

/// The GPU's whole program, traversal included.
Compile megakernel(unsigned optimization, Organisation organisation = Organisation::Megakernel,
                   FloatingPoint arithmetic = FloatingPoint::Strict) {
  CompileOptions options;
  options.floatingPoint = arithmetic;
  options.optimization = optimization;
  options.target = Target::HostMegakernel;
  options.organisation = organisation;
  return compileWith(options);
}

Compile printedCpp(bool checked, TraceMode trace) {
  return [=](const typed::Module &module, const LinkRequest &request, unsigned colorComponents,
             const PathOptions &options, Diagnostics &diagnostics) {
    return compilePrinted(module, trace, checked, request.features, colorComponents, options.cpp,
                          diagnostics);
  };
}

/// The first is what the others are compared with; the last that can run a program and is not only
/// asked for is farthest from it, and the one that is taken when nobody asks for others.
const std::vector<Path> &allPaths() {
  constexpr TraceMode recurse = TraceMode::Recurse, split = TraceMode::Split;
  static const std::vector<Path> paths = {
      {"jit-O0", true, false, jit(0, true, recurse)},
      {"jit-O0-unchecked", false, false, jit(0, false, recurse)},
      {"jit-O0-split", true, true, jit(0, true, split)},
      {"jit-O0-structured", true, false, structuredJit()},
      {"jit-O2", true, false, jit(2, true, recurse)},
      {"jit-O2-unchecked", false, false, jit(2, false, recurse)},
      {"jit-O2-split", true, true, jit(2, true, split)},
      {"jit-O2-split-unchecked", false, true, jit(2, false, split)},
      {"megakernel-O0", true, false, megakernel(0), /*isAsked=*/true, /*renders=*/true},
      {"megakernel-O2", true, false, megakernel(2), /*isAsked=*/true, /*renders=*/true},
      {"wavefront-O1", true, false, megakernel(1, Organisation::Wavefront), /*isAsked=*/true,
       /*renders=*/true, /*isPrinted=*/false, /*mixesSamples=*/true},
      {"persistent-O1", true, false, megakernel(1, Organisation::Persistent), /*isAsked=*/true,
       /*renders=*/true, /*isPrinted=*/false, /*mixesSamples=*/true},
      {"jit-O2-fast", true, false, jit(2, true, recurse, FloatingPoint::Fast), /*isAsked=*/true,
       /*renders=*/false, /*isPrinted=*/false, /*mixesSamples=*/false, /*isExact=*/false},
      {"megakernel-O2-fast", true, false,
       megakernel(2, Organisation::Megakernel, FloatingPoint::Fast), /*isAsked=*/true,
       /*renders=*/true, /*isPrinted=*/false, /*mixesSamples=*/false, /*isExact=*/false},
      {"cpp-recurse", true, false, printedCpp(true, recurse), /*isAsked=*/true, /*renders=*/false,
       /*isPrinted=*/true},
      {"cpp-recurse-unchecked", false, false, printedCpp(false, recurse), /*isAsked=*/true,
       /*renders=*/false, /*isPrinted=*/true},
      {"cpp-split", true, true, printedCpp(true, split), /*isAsked=*/true, /*renders=*/false,
       /*isPrinted=*/true},
  };
  return paths;
}

/// The paths on which programs of this kind are run, the first one first. A ray generation of the
/// program's own reads output buffers in which other samples have written.
std::vector<const Path *> choosePaths(const PathOptions &options, bool needsChecks, bool traces,
                                      bool generates) {
  std::vector<const Path *> possible;
  for (const Path &path : allPaths())
    if ((!needsChecks || path.checked) && (traces || !path.forTracing) &&
        !(generates && path.mixesSamples))
      possible.push_back(&path);
  const Path *farthest = *std::find_if(possible.rbegin(), possible.rend(),
                                       [](const Path *path) { return !path->isAsked; });
  auto names = [](const std::vector<std::string> &list, const Path *path) {
    return std::find(list.begin(), list.end(), path->name) != list.end();
  };
  std::vector<const Path *> chosen = {possible.front()};
  for (const Path *path : possible)
    if (path != chosen.front() && ((options.wanted.empty() && path == farthest) ||
                                   names(options.wanted, path) || names(options.also, path)))
      chosen.push_back(path);
  return chosen;
}

/// Programs checked as one text.
struct Checked {
  explicit Checked(const std::vector<const Program *> &programs) {
    std::string text;
    for (const Program *program : programs)
      text += program->text();
    text = prelude(text) + text;
    diagnostics.errorLimit = 3;
    unit = parse(sources.add("random.rtsl", std::move(text)), diagnostics);
    module =
        check({unit.get()}, [](const ast::ImportDecl &, FileId) { return nullptr; }, diagnostics);
    for (const Program *program : programs)
      for (auto &[primitive, material] : World::surfaces(*program))
        if ((primitive.empty() || module->findClass(primitive)) && module->findClass(material))
          request.surfaces.emplace_back(primitive, material);
    request.isSampled = true;
    if (module->findClass(programs.front()->rayGeneration))
      request.engine = runtime::Engine::Programs;
  }
  /// The errors, without the warnings, of which there may be many.
  std::string errors() const {
    std::string text;
    for (const Diagnostic &diagnostic : diagnostics.all()) {
      if (diagnostic.severity != Severity::Error)
        continue;
      const LineColumn place = sources.lineColumn(diagnostic.range.file, diagnostic.range.begin);
      text += fmt::format("{}: {}\n  {}\n", info(diagnostic.code).number, diagnostic.message,
                          sources.line(diagnostic.range.file, place.line));
    }
    return text;
  }

  /// The first error, if all there are say that something is not supported yet.
  std::string refusal() const {
    std::string first;
    for (const Diagnostic &diagnostic : diagnostics.all())
      if (diagnostic.severity == Severity::Error) {
        if (diagnostic.code != Code::notSupportedYet)
          return {};
        first = first.empty() ? diagnostic.message : first;
      }
    return first;
  }

  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::unique_ptr<ast::TranslationUnit> unit;
  std::unique_ptr<typed::Module> module;
  LinkRequest request;
};

using Words = std::vector<std::uint32_t>;

/// The first difference, if there is one.
std::string difference(const Words &expected, const Words &got) {
  if (expected.size() != got.size())
    return fmt::format("{} words, not {}", got.size(), expected.size());
  for (std::size_t i = 0; i != expected.size(); ++i)
    if (expected[i] != got[i])
      return fmt::format("word {} of {}: {:08x}, not {:08x}", i, expected.size(), got[i],
                         expected[i]);
  return "";
}

/// Programs on their way through the paths.
class Comparison {
public:
  Comparison(const std::vector<const Program *> &programs, const PathOptions &options)
      : programs(programs), options(options), findings(programs.size()) {}

  std::vector<Finding> run();

private:
  using Numbers = std::vector<std::size_t>; // of programs
  using Code = std::shared_ptr<const runtime::Program>;

  std::uint32_t undefinedOn(const Path &path) const;
  void runReference(const std::vector<const Path *> &paths, const Numbers &all);
  void runPath(const Path &path, const Numbers &which);
  /// Null if the programs cannot be compiled together.
  Code compile(const Path &path, Checked &checked, const PathOptions &how) const;
  /// Those of the programs that the path can take; the others say why it cannot.
  Numbers takenBy(const Path &path, const Numbers &which);
  void compare(const Path &path, const runtime::Program &code, std::size_t number);
  void fail(const Numbers &which, Failure failure, const std::string &detail);
  std::vector<const Program *> select(const Numbers &which) const;

  const std::vector<const Program *> &programs;
  const PathOptions &options;
  std::vector<Finding> findings;
  std::vector<Words> samples, pictures; // of the first path, one a program
};

std::vector<const Program *> Comparison::select(const Numbers &which) const {
  std::vector<const Program *> selected;
  for (std::size_t number : which)
    selected.push_back(programs[number]);
  return selected;
}

void Comparison::fail(const Numbers &which, Failure failure, const std::string &detail) {
  for (std::size_t number : which)
    if (findings[number].failure == Failure::None) {
      findings[number].failure = failure;
      findings[number].detail = detail;
    }
}

/// No result depends on uninitialized memory: the first path has one pattern
/// there, the others have another one, or what happens to be there.
std::uint32_t Comparison::undefinedOn(const Path &path) const {
  if (&path == &allPaths().front())
    return RTSL_FEATURE_UNDEFINED_BYTES;
  return programs.front()->seed / 100 % 3 == 2 ? 0 : RTSL_FEATURE_UNDEFINED_NAN;
}

Comparison::Code Comparison::compile(const Path &path, Checked &checked,
                                     const PathOptions &how) const {
  if (checked.diagnostics.hasErrors())
    return nullptr;
  checked.request.features = RTSL_FEATURE_PRINT | undefinedOn(path) |
                             (programs.front()->raises ? RTSL_FEATURE_EXCEPTIONS : 0u);
  return path.compile(*checked.module, checked.request, programs.front()->colorComponents, how,
                      checked.diagnostics);
}

Comparison::Numbers Comparison::takenBy(const Path &path, const Numbers &which) {
  PathOptions withoutCompiler = options;
  withoutCompiler.cpp.compiler.clear();
  Numbers taken;
  for (std::size_t number : which) {
    Checked alone(select({number}));
    compile(path, alone, withoutCompiler);
    if (const std::string refusal = alone.refusal(); !refusal.empty())
      findings[number].refused = fmt::format("{}: {}", path.name, refusal);
    else
      taken.push_back(number);
  }
  return taken;
}

void Comparison::compare(const Path &path, const runtime::Program &code, std::size_t number) {
  World world(code, *programs[number]);
  world.reverseOrder();
  const Words words = path.renders ? world.render() : world.run();
  if (!path.isExact)
    return;
  if (const std::string what = difference((path.renders ? pictures : samples)[number], words);
      !what.empty())
    fail({number}, Failure::Mismatch,
         fmt::format("{} against {}: {}", path.name, allPaths().front().name, what));
}

void Comparison::runPath(const Path &path, const Numbers &which) {
  if (which.empty())
    return;
  if (path.isPrinted && options.cpp.compiler.empty()) {
    takenBy(path, which);
    return;
  }
  try {
    Checked checked(select(which));
    if (const Code code = compile(path, checked, options)) {
      for (std::size_t number : which)
        compare(path, *code, number);
      return;
    }
    const Numbers taken = checked.refusal().empty() ? which : takenBy(path, which);
    if (taken.size() != which.size())
      runPath(path, taken);
    else
      fail(which, Failure::Rejected, fmt::format("{}: {}", path.name, checked.errors()));
  } catch (const CompilerRefuses &refuses) {
    fail(which, Failure::Rejected,
         fmt::format("{} does not compile: {}", path.name, refuses.message));
  }
}

void Comparison::runReference(const std::vector<const Path *> &paths, const Numbers &all) {
  const bool renders =
      std::any_of(paths.begin(), paths.end(), [](const Path *path) { return path->renders; });
  Checked checked(select(all));
  const Code code = compile(*paths.front(), checked, options);
  if (!code)
    return fail(all, Failure::Rejected, checked.errors());
  for (std::size_t number : all) {
    World world(*code, *programs[number]);
    samples.push_back(world.run());
    findings[number].hit = world.hitSomething();
    if (renders)
      pictures.push_back(world.render());
  }
}

std::vector<Finding> Comparison::run() {
  Numbers all(programs.size());
  std::iota(all.begin(), all.end(), std::size_t(0));
  const std::vector<const Path *> paths = choosePaths(
      options,
      std::any_of(programs.begin(), programs.end(),
                  [](const Program *program) { return program->raises || !program->inRange; }),
      std::any_of(programs.begin(), programs.end(),
                  [](const Program *program) { return program->traces; }),
      generates(programs.front()->seed));
  try {
    runReference(paths, all);
    for (std::size_t i = 1; i != paths.size() && samples.size() == all.size(); ++i)
      runPath(*paths[i], all);
  } catch (const std::exception &fault) {
    fail(all, Failure::Fault, fault.what());
  }
  return std::move(findings);
}

} // namespace

std::vector<std::string> pathNames() {
  std::vector<std::string> names;
  for (const Path &path : allPaths())
    names.emplace_back(path.name);
  return names;
}

std::vector<std::string> pathsOf(std::uint32_t seed, const PathOptions &options) {
  std::vector<std::string> names;
  for (const Path *path :
       choosePaths(options, raises(seed) || !isInRange(seed), hasTraces(seed), generates(seed)))
    names.emplace_back(path->name);
  return names;
}

std::vector<Finding> compare(const std::vector<const Program *> &programs,
                             const PathOptions &options) {
  return Comparison(programs, options).run();
}

} // namespace rtsl::random
