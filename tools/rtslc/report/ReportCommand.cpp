//===- ReportCommand.cpp - rtslc report -----------------------------------===//
//
// Error against run time of one scene, in every configuration that renders it.
//
//===----------------------------------------------------------------------===//
#include "codegen/driver/SceneProgram.h"
#include "codegen/driver/Versions.h"
#include "report/Machine.h"
#include "report/Page.h"
#include "report/measures/ErrorMap.h"
#include "report/measures/ErrorMetrics.h"
#include "report/measures/Exposure.h"
#include "report/measures/Flip.h"
#include "runtime/program/Versions.h"
#include "runtime/render/MachineStack.h"
#include "runtime/render/Renderer.h"
#include "scenefile/SceneFile.h"
#include "support/AtomicFile.h"
#include "support/Clock.h"
#include "support/ErrorMessages.h"
#include "tools/common/Interruption.h"
#include "tools/common/OptionValues.h"
#include "tools/common/Output.h"
#include "tools/common/PictureOptions.h"
#include "tools/common/Progress.h"
#include "tools/rtslc/common/CommandLine.h"
#include "tools/rtslc/common/Messages.h"
#include "tools/rtslc/common/SceneArguments.h"
#include "tools/rtslc/common/SceneShaders.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>

namespace rtsl::tool {

namespace {

struct ReportOptions {
  CommonOptions common;
  std::string scene, folder, reference;
  std::vector<std::string> overrides, only;
  std::optional<std::uint32_t> depth;
  std::optional<PictureSize> size;
  std::uint32_t threads = 0, runs = 8;
  double budget = 10; // seconds
  bool fresh = false, json = false, quiet = false;
};

double parseSeconds(const std::string &text) {
  const std::map<std::string, double> units = {{"", 1},   {"s", 1},    {"ms", 1e-3},
                                               {"m", 60}, {"min", 60}, {"h", 3600}};
  char *end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const auto unit = units.find(end);
  if (end == text.c_str() || unit == units.end() ||
      !(number * unit->second >= 1e-3 && number * unit->second <= 1e6))
    throw CLI::ValidationError("--budget",
                               "give a time of at least 1 ms, such as 10s, 500ms or 2m");
  return number * unit->second;
}

/// A scene that is ready to be rendered.
struct LoadedScene {
  scene::SceneDescription description;
  std::unique_ptr<typed::Module> module;
  std::vector<std::string> filesRead; // meshes and the reference too
  runtime::RenderOptions render;
};

/// One scene for each program, which the subjects that differ in traversal share.
struct Build {
  std::shared_ptr<const runtime::Scene> scene;
  double compileSeconds = 0;
};

/// Compiles the scene's shaders; nothing if there were errors.
std::optional<Build> build(const LoadedScene &loaded, const CompileOptions &options,
                           Messages &messages) {
  Build result;
  const Clock::time_point start = Clock::now();
  Clock::duration building{};
  std::optional<runtime::Scene> scene =
      compileScene(*loaded.module, linkRequest(loaded.description), options, messages.diagnostics,
                   [&](const auto &program) {
                     const Clock::time_point begin = Clock::now();
                     runtime::Scene made = scene::buildScene(loaded.description, program);
                     building = Clock::now() - begin;
                     return made;
                   });
  if (!scene)
    return std::nullopt;
  result.compileSeconds = std::chrono::duration<double>(Clock::now() - start - building).count();
  result.scene = std::make_shared<const runtime::Scene>(std::move(*scene));
  return result;
}

report::Picture renderOnce(const runtime::Scene &scene, runtime::RenderOptions options,
                           std::uint32_t samples, std::uint32_t seed) {
  options.samplesPerPixel = samples;
  options.seed = seed;
  options.withoutSample = std::numeric_limits<float>::quiet_NaN(); // no error is measured there
  report::Picture picture;
  picture.image = runtime::render(scene, options, &picture.statistics);
  if (runtime::failedMachineStacks(nullptr))
    throw Error(message::noMemoryForRaysOfReport());
  return picture;
}

std::function<report::Picture(std::uint32_t, std::uint32_t)>
rendererOf(const Build &build, runtime::RenderOptions options, runtime::Traversal traversal) {
  options.traversal = traversal;
  return [scene = build.scene, options](std::uint32_t samples, std::uint32_t seed) {
    return renderOnce(*scene, options, samples, seed);
  };
}

/// The configuration that renders a reference, and the one that is compared with it to find the
/// effect of single precision: both are those that compile and render in the least time.
constexpr const char *referenceName = "double embree recurse",
                     *singleName = "strict embree recurse";

std::optional<report::Subject> compileShortest(const char *name, FloatingPoint precision,
                                               const LoadedScene &loaded,
                                               const ReportOptions &options, Messages &messages) {
  CompileOptions compile = options.common.compile;
  compile.floatingPoint = precision;
  compile.trace = TraceMode::Recurse;
  const std::optional<Build> built = build(loaded, compile, messages);
  if (!built)
    return std::nullopt;
  report::Subject subject;
  subject.name = name;
  subject.compileSeconds = built->compileSeconds;
  subject.render = rendererOf(*built, loaded.render, runtime::Traversal::Embree);
  return subject;
}

/// The one that was given, that the folder has, or that is rendered now; nothing if there were
/// errors.
std::optional<report::Reference>
referenceFor(const LoadedScene &loaded, const ReportOptions &options,
             const std::vector<report::Subject> &subjects, double seconds,
             const report::ProgressFunction &progress, Messages &messages) {
  if (!options.reference.empty())
    return report::readReference(options.reference, loaded.render.width, loaded.render.height,
                                 options.common.compile.colorComponents);
  if (std::optional<report::Reference> earlier =
          report::findReference(referenceName, options.folder))
    return earlier;
  const std::optional<report::Subject> exact =
      compileShortest(referenceName, FloatingPoint::Double, loaded, options, messages);
  const auto measured =
      std::find_if(subjects.begin(), subjects.end(),
                   [](const report::Subject &subject) { return subject.name == singleName; });
  const std::optional<report::Subject> single =
      measured != subjects.end()
          ? *measured
          : compileShortest(singleName, FloatingPoint::Strict, loaded, options, messages);
  if (!exact || !single)
    return std::nullopt;
  constexpr std::uint32_t referenceRuns = 32; // enough to tell heavy tails
  return report::makeReference(*exact, *single, options.folder,
                               std::max(options.runs, referenceRuns), seconds, progress);
}

/// A way to render.
struct Configuration {
  FloatingPoint precision;
  TraceMode trace;
  runtime::Traversal traversal;
  std::vector<std::pair<std::string, std::string>> settings; // "fp", "traversal" and "trace"

  std::string name() const {
    return fmt::format("{} {} {}", settings[0].second, settings[1].second, settings[2].second);
  }
};

/// The configurations that --only leaves, the usual one first; throws if it leaves none.
std::vector<Configuration> configurationsFor(const ReportOptions &options) {
  const std::pair<FloatingPoint, const char *> precisions[] = {{FloatingPoint::Strict, "strict"},
                                                               {FloatingPoint::Fast, "fast"}};
  const std::pair<TraceMode, const char *> traceModes[] = {{TraceMode::Recurse, "recurse"},
                                                           {TraceMode::Split, "split"}};
  const std::pair<runtime::Traversal, const char *> traversals[] = {
      {runtime::Traversal::Embree, "embree"}, {runtime::Traversal::Device, "device"}};
  std::vector<Configuration> configurations;
  for (const auto &[precision, precisionName] : precisions)
    for (const auto &[trace, traceName] : traceModes)
      for (const auto &[traversal, traversalName] : traversals) {
        const Configuration one = {
            precision,
            trace,
            traversal,
            {{"fp", precisionName}, {"traversal", traversalName}, {"trace", traceName}}};
        const auto isPart = [&](const std::string &part) {
          return one.name().find(part) != std::string::npos;
        };
        if (options.only.empty() || std::any_of(options.only.begin(), options.only.end(), isPart))
          configurations.push_back(one);
      }
  if (configurations.empty())
    throw Error(message::noSuchConfiguration());
  return configurations;
}

/// Compiles them; configurations that differ in traversal alone share a program. Nothing if there
/// were errors.
std::vector<report::Subject> subjectsFor(const std::vector<Configuration> &configurations,
                                         const LoadedScene &loaded, const ReportOptions &options,
                                         Messages &messages) {
  std::map<std::pair<FloatingPoint, TraceMode>, Build> builds;
  std::vector<report::Subject> subjects;
  for (const Configuration &one : configurations) {
    const auto [shared, isNew] = builds.try_emplace({one.precision, one.trace});
    if (isNew) {
      CompileOptions compile = options.common.compile;
      compile.floatingPoint = one.precision;
      compile.trace = one.trace;
      const std::optional<Build> built = build(loaded, compile, messages);
      if (!built)
        return {};
      shared->second = *built;
    }
    report::Subject subject;
    subject.name = one.name();
    subject.settings = one.settings;
    subject.compileSeconds = shared->second.compileSeconds;
    subject.render = rendererOf(shared->second, loaded.render, one.traversal);
    subjects.push_back(std::move(subject));
  }
  return subjects;
}

/// What a study must have in common with the one that it goes on with: everything that changes a
/// picture or a time.
std::string fingerprint(const LoadedScene &loaded, const ReportOptions &options,
                        const Messages &messages) {
  std::string all =
      fmt::format("study 2, {} {}x{} depth {} threads {} runs {} colors {} checked {} O{}",
                  RTSL_VERSION, loaded.render.width, loaded.render.height, loaded.render.maxDepth,
                  options.threads, options.runs, options.common.compile.colorComponents,
                  options.common.compile.checkIndices, options.common.compile.optimization);
  for (FileId file = 1; file <= messages.sources.count(); ++file)
    all += std::string(messages.sources.name(file)) + '\0' +
           std::string(messages.sources.text(file)) + '\0';
  if (options.scene != "-") // the text of standard input is among the sources
    all += readFile(loaded.description.file);
  for (const std::string &value : options.overrides)
    all += '\0' + value;
  for (const std::string &file : scene::filesOf(loaded.description))
    all += readFile(file);
  if (!options.reference.empty())
    all += readFile(options.reference);
  return fmt::format("{:016x}", report::hashOf(all));
}

namespace fs = std::filesystem;

/// What a report writes into its folder.
constexpr const char *parts[] = {"study.json",     "measurements.csv", "levels.csv",
                                 "report.json",    "index.html",       "reference.exr",
                                 "reference.json", "partial",          "pictures"};

std::string identityOf(const ReportOptions &options) {
  return options.folder + "/study.json";
}

/// Throws if the folder holds another study, or if something that is read lies where the report
/// writes.
void checkFolder(const ReportOptions &options, const std::string &fingerprint,
                 const std::vector<std::string> &inputs) {
  for (const char *part : parts) {
    const fs::path path = fs::path(options.folder) / part;
    std::error_code error;
    refuseToOverwrite(path.string(), inputs);
    for (const fs::directory_entry &entry :
         fs::directory_iterator(path, error)) // of folders: they are emptied
      refuseToOverwrite(entry.path().string(), inputs);
  }
  if (options.fresh || !fs::exists(identityOf(options)))
    return;
  const nlohmann::json earlier =
      nlohmann::json::parse(readFile(identityOf(options)), nullptr, false);
  if (earlier.is_discarded() || earlier.value("fingerprint", "") != fingerprint)
    throw Error(message::otherReport(options.folder), Place{options.folder});
}

/// Makes the folder, or finds the same study in it.
void openFolder(const ReportOptions &options, const std::string &fingerprint) {
  std::error_code error;
  fs::create_directories(options.folder, error);
  if (error || !fs::is_directory(options.folder))
    throw Error(message::cannotMakeFolder(options.folder,
                                          error ? error.message() : "there is a file of that name"),
                Place{options.folder});
  if (options.fresh)
    for (const char *part : parts)
      fs::remove_all(fs::path(options.folder) / part, error);
  if (fs::exists(identityOf(options)))
    return;
  const nlohmann::ordered_json document = {
      {"version", 1}, {"scene", options.scene}, {"fingerprint", fingerprint}};
  writeFileAtomically(identityOf(options), document.dump(2) + "\n");
}

/// The pictures of the page: the reference, and each different picture with its two maps. All have
/// the exposure of the first.
std::vector<report::Exhibit> exhibitsFor(const std::vector<report::Subject> &subjects,
                                         const report::Reference &reference,
                                         const std::string &folder) {
  std::vector<report::Exhibit> exhibits;
  std::optional<double> stops;
  const auto show = [&](const std::string &caption, const runtime::Image &image) {
    runtime::Image rgb = runtime::toRgb(image);
    if (!stops)
      stops = report::stopsFor(rgb);
    const std::string exposure =
        *stops == 0 ? "" : fmt::format(", at an exposure of {:+g} stops", *stops);
    exhibits.push_back({caption + exposure, report::exposed(std::move(rgb), *stops)});
  };
  if (reference.problem.empty())
    show("the reference", reference.image);
  std::map<std::uint64_t, std::string> shown;
  for (const report::Subject &subject : subjects) {
    const std::string path = report::lastPicturePath(folder, subject);
    if (!std::filesystem::exists(path))
      continue;
    const runtime::Image image = runtime::readImage(path);
    if (!shown.try_emplace(report::hashOf(image.pixels), subject.name).second)
      continue;
    show(subject.name + ": one picture with the most samples", image);
    if (!reference.problem.empty())
      continue;
    const report::FlipMap map =
        report::flip(runtime::toRgb(reference.image), runtime::toRgb(image));
    exhibits.push_back(
        {fmt::format("{}: FLIP, mean {:.3g}; black 0, pale yellow 1", subject.name, map.mean()),
         report::colorFlipMap(map)});
    exhibits.push_back(
        {fmt::format("{}: relative squared error, logarithmic from 1e-6 (black) to 1 (pale yellow)",
                     subject.name),
         report::colorLogMap(report::relativeSquaredErrorMap(reference.image, image), 1e-6, 1)});
  }
  return exhibits;
}

std::string commandLine(const ReportOptions &options, const runtime::RenderOptions &render) {
  std::string line =
      fmt::format("rtslc report {} --out {} --size {}x{} --budget {:g}s --runs {}", options.scene,
                  options.folder, render.width, render.height, options.budget, options.runs);
  if (!options.reference.empty())
    line += " --reference " + options.reference;
  for (const std::string &value : options.overrides)
    line += " --set " + value;
  for (const std::string &part : options.only)
    line += " --only " + part;
  return line;
}

/// "-1.02 [-1.05, -0.99]".
std::string withInterval(const report::Estimate &estimate, int digits) {
  return fmt::format("{:.{}g} [{:.{}g}, {:.{}g}]", estimate.value, digits, estimate.low, digits,
                     estimate.high, digits);
}

void printSummary(const ReportOptions &options, const report::Summary &summary,
                  const std::string &json) {
  if (options.json)
    return printOut(json);
  std::string text =
      fmt::format("{:<24} {:>9} {:>24} {:>24}\n", "configuration", "compile", "slope over seconds",
                  fmt::format("s to {:.2g}", summary.commonRelMse));
  for (const report::SubjectSummary &subject : summary.subjects) {
    const report::LineFit &line = subject.relMseOverSeconds;
    const auto &time = subject.toCommonRelMse;
    text += fmt::format(
        "{:<24} {:>7.0f}ms {:>24} {:>24}\n", subject.name, subject.compileSeconds * 1e3,
        line.points != 0 ? withInterval(line.slope, 3) + (line.bends() ? "*" : "") : "-",
        time ? (time->isBound ? "<= " : "") + withInterval(time->seconds, 3) : "-");
  }
  for (const std::string &problem : summary.problems)
    text += fmt::format("note: {}\n", problem);
  printOut(text + fmt::format("the report is {}/index.html\n", options.folder));
}

std::optional<LoadedScene> load(const ReportOptions &options, Messages &messages) {
  LoadedScene loaded;
  loaded.description = readScene(options.scene, options.overrides, messages, "report");
  loaded.module = loadShaders(loaded.description, options.common, messages, &loaded.filesRead);
  if (!loaded.module)
    return std::nullopt;
  loaded.filesRead = withFiles(loaded.description, loaded.filesRead);
  if (!options.reference.empty())
    loaded.filesRead.push_back(options.reference);
  loaded.render = scene::renderOptions(loaded.description.render);
  if (options.size) {
    options.size->apply(loaded.render);
  } else if (!options.reference.empty()) { // the size that can be compared
    const runtime::Image reference = runtime::readImage(options.reference);
    loaded.render.width = reference.width;
    loaded.render.height = reference.height;
  }
  loaded.render.maxDepth = options.depth.value_or(loaded.render.maxDepth);
  loaded.render.threads = options.threads;
  loaded.render.cancel = catchInterruptions();
  return loaded;
}

void makeReport(const ReportOptions &options, Messages &messages) {
  const std::vector<Configuration> configurations = configurationsFor(options);
  std::optional<LoadedScene> loaded = load(options, messages);
  if (!loaded)
    return;
  const std::string study = fingerprint(*loaded, options, messages);
  checkFolder(options, study, loaded->filesRead);
  const std::vector<report::Subject> subjects =
      subjectsFor(configurations, *loaded, options, messages);
  if (subjects.empty())
    return;
  openFolder(options, study); // when nothing is wrong any more

  Progress progress("measuring");
  const auto show = [&](double share) {
    if (!options.quiet)
      progress.update(share);
  };
  constexpr double referenceShare = 4; // its time, in budgets
  const double total = referenceShare + double(subjects.size());
  const std::optional<report::Reference> found = referenceFor(
      *loaded, options, subjects, referenceShare * options.budget,
      [&](double share, const std::string &) { show(share * referenceShare / total); }, messages);
  if (!found)
    return;
  const report::Reference &reference = *found;
  report::StudyOptions how;
  how.folder = options.folder;
  how.runs = options.runs;
  how.budgetSeconds = options.budget;
  how.progress = [&](double share, const std::string &) {
    show((referenceShare + share * double(subjects.size())) / total);
  };
  const report::Summary summary =
      report::summarise(subjects, report::runStudy(subjects, reference, how), reference);
  progress.finish();

  report::Context context;
  context.scene = options.scene;
  context.width = loaded->render.width;
  context.height = loaded->render.height;
  context.runs = options.runs;
  context.budgetSeconds = options.budget;
  context.command = commandLine(options, loaded->render);
  context.versions = runtime::libraryVersions();
  context.versions.insert(context.versions.begin(),
                          {{"rtslc", RTSL_VERSION}, {"LLVM", llvmVersion()}});
  context.machine = report::machineFacts();
  const std::string json = report::writeJson(context, summary, reference);
  writeFileAtomically(options.folder + "/report.json", json);
  writeFileAtomically(options.folder + "/index.html",
                      report::writePage(context, summary, reference,
                                        exhibitsFor(subjects, reference, options.folder)));
  printSummary(options, summary, json);
}

int report(const ReportOptions &options) {
  Messages messages(options.common);
  try {
    makeReport(options, messages);
  } catch (Error &error) {
    if (error.code == ErrorCode::Cancelled)
      error.note("the same command goes on from here");
    messages.report(error);
  }
  return statusAfterInterruption(messages.status());
}

} // namespace

void addReportCommand(CLI::App &app, Action &action) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App *command = app.add_subcommand(reportSummary.command, reportSummary.text);
  command->add_option("SCENE", options->scene, "a scene file (JSON); - is standard input")
      ->required();
  command
      ->add_option("--out", options->folder,
                   "the folder of the report; an interrupted report is continued")
      ->required()
      ->type_name("DIR");
  command
      ->add_option("--reference", options->reference,
                   "the reference picture; rendered if not given")
      ->type_name("IMAGE");
  command
      ->add_option_function<std::string>(
          "--budget", [options](const std::string &text) { options->budget = parseSeconds(text); },
          "rendering time for each configuration; the reference gets four times as much; default "
          "10s")
      ->type_name("TIME");
  addWhole(*command, "--runs", options->runs, 2, 1000,
           "independent runs with each number of samples; default 8");
  addSizeOption(*command, options->size);
  addWhole(*command, "--threads", options->threads, 1, runtime::mostThreads,
           "threads; default: all cores");
  addWhole(*command, "--depth", options->depth, 0, runtime::maxRayDepth,
           "limit of nested `trace` calls");
  addSetOption(*command, options->overrides);
  command
      ->add_option(
          "--only", options->only,
          "only configurations whose names contain this text, such as embree; may be repeated")
      ->type_name("TEXT")
      ->allow_extra_args(false);
  command->add_flag("--fresh", options->fresh, "delete the contents of the folder first");
  command->add_flag("--json", options->json, "write the report's JSON to standard output as well");
  command->add_flag("-q,--quiet", options->quiet, "no progress");
  addPreprocessorOptions(*command, options->common.preprocessor);
  addCompileOptions(*command, options->common);
  for (const char *measured : {"--fp", "--trace"}) // each of their values is
    command->remove_option(command->get_option(measured));
  addMessageOptions(*command, options->common);
  command->footer("example:\n  rtslc report examples/glass/scene.json --out report --size 320x180 "
                  "--budget 20s");
  command->callback([options, &action] { action = [options] { return report(*options); }; });
}

} // namespace rtsl::tool
