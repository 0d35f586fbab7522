//===- Paths.cpp - the ways to run a program, which all agree -------------===//
#include "Paths.h"

#include "World.h"

#include "codegen/driver/Compiler.h"
#include "frontend/Parser.h"
#include "sema/Sema.h"

#include <algorithm>
#include <exception>
#include <functional>

namespace rtsl::random {

const char *name(Failure failure) {
  static const char *const names[] = {"fine", "rejected", "fault", "crash", "hang", "mismatch"};
  return names[static_cast<std::size_t>(failure)];
}

namespace {

using Compile = std::function<std::shared_ptr<const runtime::Program>(
    const typed::Module &, const LinkRequest &, unsigned colorComponents, Diagnostics &)>;

/// One way from a checked module to a program that runs.
struct Path {
  const char *name;
  bool checked;    // indices out of range are defined
  bool forTracing; // says nothing new of programs that do not trace
  Compile compile;
};

Compile compileWith(const CompileOptions &options) {
  return [options](const typed::Module &module, const LinkRequest &request, unsigned colorComponents,
                   Diagnostics &diagnostics) {
    CompileOptions ofColors = options;
    ofColors.colorComponents = colorComponents;
    return compileProgram(module, request, ofColors, diagnostics);
  };
}

Compile jit(unsigned optimization, bool checked, TraceMode trace) {
  CompileOptions options;
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

/// The first is what the others are compared with; the last that can run a program is farthest from
/// it, and the one that is taken when nobody asks for others.
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
  };
  return paths;
}

/// The paths on which programs of this kind are run, the first one first.
std::vector<const Path *> choosePaths(const std::vector<std::string> &wanted, bool inRange,
                                      bool traces) {
  std::vector<const Path *> possible;
  for (const Path &path : allPaths())
    if ((inRange || path.checked) && (traces || !path.forTracing))
      possible.push_back(&path);
  if (wanted.empty())
    return {possible.front(), possible.back()};
  std::vector<const Path *> chosen = {possible.front()};
  for (const Path *path : possible)
    if (path != chosen.front() &&
        std::find(wanted.begin(), wanted.end(), path->name) != wanted.end())
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
    module = check({unit.get()}, [](const ast::ImportDecl &, FileId) { return nullptr; }, diagnostics);
    for (const Program *program : programs)
      for (auto &[primitive, material] : World::surfaces(*program))
        if ((primitive.empty() || module->findClass(primitive)) && module->findClass(material))
          request.surfaces.emplace_back(primitive, material);
    request.features = RTSL_FEATURE_PRINT;
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

  SourceManager sources;
  Diagnostics diagnostics{sources};
  std::unique_ptr<ast::TranslationUnit> unit;
  std::unique_ptr<typed::Module> module;
  LinkRequest request;
};

using Words = std::vector<std::uint32_t>;

/// The first difference, if there is one.
std::string difference(const Words &expected, const Words &got) {
  for (std::size_t i = 0; i != expected.size(); ++i)
    if (expected[i] != got[i])
      return fmt::format("word {} of {}: {:08x}, not {:08x}", i, expected.size(), got[i], expected[i]);
  return "";
}

} // namespace

std::vector<std::string> pathNames() {
  std::vector<std::string> names;
  for (const Path &path : allPaths())
    names.emplace_back(path.name);
  return names;
}

std::vector<Finding> compare(const std::vector<const Program *> &programs,
                             const std::vector<std::string> &wanted) {
  std::vector<Finding> findings(programs.size());
  auto failAll = [&](Failure failure, const std::string &detail) {
    for (Finding &finding : findings)
      finding = {failure, detail, finding.hit};
    return findings;
  };
  try {
    Checked checked(programs);
    if (checked.diagnostics.hasErrors())
      return failAll(Failure::Rejected, checked.errors());
    const bool inRange =
        std::all_of(programs.begin(), programs.end(), [](const Program *p) { return p->inRange; });
    const bool traces =
        std::any_of(programs.begin(), programs.end(), [](const Program *p) { return p->traces; });

    std::vector<Words> expected;
    for (const Path *chosen : choosePaths(wanted, inRange, traces)) {
      const Path &path = *chosen;
      const bool isReference = expected.empty();
      const auto code = path.compile(*checked.module, checked.request, programs.front()->colorComponents,
                                     checked.diagnostics);
      if (!code)
        return failAll(Failure::Rejected, std::string(path.name) + ": " + checked.errors());
      for (std::size_t i = 0; i != programs.size(); ++i) {
        World world(*code, *programs[i]);
        const Words words = world.run();
        findings[i].hit |= world.hitSomething();
        if (isReference)
          expected.push_back(words);
        else if (std::string what = difference(expected[i], words);
                 !what.empty() && findings[i].failure == Failure::None)
          findings[i] = {Failure::Mismatch,
                         fmt::format("{} against {}: {}", path.name, allPaths().front().name, what),
                         findings[i].hit};
      }
    }
  } catch (const std::exception &fault) {
    return failAll(Failure::Fault, fault.what());
  }
  return findings;
}

} // namespace rtsl::random
