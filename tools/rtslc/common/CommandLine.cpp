//===- CommandLine.cpp - what the commands of rtslc share -----------------===//
#include "CommandLine.h"

#include "GpuArchitectures.h"
#include "codegen/driver/LlvmErrors.h"
#include "runtime/device/ray/Abi.h"
#include "runtime/scene/SceneData.h"
#include "support/ClosestName.h"
#include "support/Error.h"
#include "tools/common/OptionValues.h"
#include "tools/common/OutOfMemory.h"
#include "tools/common/Output.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <sstream>
#include <unistd.h>

namespace rtsl::tool {

namespace {

/// `rgb`, `mono`, `spectral:N` or a bare number of components.
std::string parseColor(const std::string &text, CompileOptions &options) {
  if (text == "rgb" || text == "mono") {
    options.colorComponents = text == "rgb" ? 3 : 1;
    return {};
  }
  const std::string prefix = "spectral:";
  const std::string digits = text.rfind(prefix, 0) == 0 ? text.substr(prefix.size()) : text;
  const bool isNumber = !digits.empty() && digits.size() <= 2 &&
                        digits.find_first_not_of("0123456789") == std::string::npos;
  const unsigned long count = isNumber ? std::stoul(digits) : 0;
  if (count < 1 || count > RTSL_MAX_COLOR)
    return "give rgb, mono, spectral:N or N, with N from 1 to " + std::to_string(RTSL_MAX_COLOR);
  options.colorComponents = static_cast<std::uint32_t>(count);
  return {};
}

Choices<std::uint32_t> samplerChoices() {
  Choices<std::uint32_t> choices;
  for (const auto &[name, sampler] : runtime::samplerNames)
    choices.emplace_back(name, featuresOf(sampler));
  return choices;
}

/// The output of -Whelp: the table of warnings, a line each.
std::string warningList() {
  std::string text;
  for (const CodeInfo &row : codeTable)
    if (row.warning)
      text += fmt::format("{:<26} {}  {}\n", row.warning, row.number,
                          row.group == WarningGroup::Perf ? "with -Wperf" : "on");
  return text;
}

/// Takes the number of `live-state=BYTES` off.
std::string withoutLimit(const std::string &text, std::uint32_t &largeLiveState) {
  const std::string name = "live-state";
  if (text.rfind(name + "=", 0) != 0)
    return text;
  const std::string digits = text.substr(name.size() + 1);
  if (digits.empty() || digits.size() > 9 ||
      digits.find_first_not_of("0123456789") != std::string::npos)
    throw CLI::ValidationError("-W" + text, "give a number of bytes");
  largeLiveState = static_cast<std::uint32_t>(std::stoul(digits));
  return name;
}

void applyWarning(const std::string &text, WarningOptions &warnings) {
  if (text == "help") {
    printOut(warningList());
    throw CLI::Success();
  }
  if (const std::string complaint = warnings.apply(text); !complaint.empty())
    throw CLI::ValidationError("-W" + text, complaint);
}

bool hasCommand(const CLI::App &app, const std::string &name) {
  const std::vector<const CLI::App *> commands =
      app.get_subcommands([](const CLI::App *) { return true; });
  return std::any_of(commands.begin(), commands.end(),
                     [&](const CLI::App *command) { return command->get_name() == name; });
}

} // namespace

void addMessageOptions(CLI::App &command, CommonOptions &options) {
  addChoice(command, "--diagnostics", options.jsonDiagnostics,
            Choices<bool>{{"text", false}, {"json", true}}, "format of messages on standard error");
  addChoice(command, "--ansi", options.ansi, {"auto", "always", "never"}, "colour in messages");
  addWhole(command, "--error-limit", options.errorLimit, 0, 1000000,
           "maximum number of errors to show; 0 shows all");
  command
      .add_option_function<std::vector<std::string>>(
          "-W",
          [&options](const std::vector<std::string> &texts) {
            for (const std::string &text : texts)
              applyWarning(withoutLimit(text, options.compile.largeLiveState), options.warnings);
          },
          "turn a warning on, or off with no-NAME; NAME can be all or perf; error[=NAME] treats "
          "warnings as errors; live-state=BYTES turns that warning on with this limit; -Whelp "
          "lists the warnings")
      ->type_name("NAME")
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void addKeepOption(CLI::App &command, CommonOptions &options) {
  std::string names = "all";
  for (Item item : allItems)
    names += std::string("|") + nameOf(item);
  command
      .add_option_function<std::vector<std::string>>(
          "--keep",
          [&options, names](const std::vector<std::string> &texts) {
            for (const std::string &text : texts) {
              const std::optional<Item> item = itemNamed(text);
              if (text != "all" && !item)
                throw CLI::ValidationError("--keep", "`" + text + "` is none of " + names);
              options.keep.add(item ? ItemSet::only(*item) : ItemSet::all());
            }
          },
          "keep this in the program even if the scene does not need it; the picture is the same")
      ->type_name(names)
      ->delimiter(',')
      ->allow_extra_args(false)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void addCompileOptions(CLI::App &command, CommonOptions &options) {
  command
      .add_option_function<std::string>(
          "--color",
          [&options](const std::string &text) {
            if (const std::string complaint = parseColor(text, options.compile); !complaint.empty())
              throw CLI::ValidationError("--color", complaint);
          },
          "the components of a color")
      ->type_name("rgb|mono|spectral:N|N");
  addChoice(command, "--fp", options.compile.floatingPoint,
            Choices<FloatingPoint>{{"strict", FloatingPoint::Strict},
                                   {"fast", FloatingPoint::Fast},
                                   {"double", FloatingPoint::Double}},
            "floating point: strict, IEEE single with the same bits everywhere; fast, "
            "approximations and reassociation; double, shaders compute in double on this machine");
  command.add_flag_callback(
      "--unchecked", [&options] { options.compile.checkIndices = false; },
      "do not check array and buffer indices: an index out of range is undefined behaviour");
  addChoice(command, "--trace", options.compile.trace,
            Choices<TraceMode>{{"recurse", TraceMode::Recurse}, {"split", TraceMode::Split}},
            "how `trace` is compiled: recurse, a call; split, the end of a state, as on a GPU. "
            "Default: recurse; for C++ split, if it can be printed as states");
  addChoice(command, "--save", options.compile.savesAllThatIsLive,
            Choices<bool>{{"needed", false}, {"live", true}},
            "what states save across a `trace`: needed, rematerialise cheap values; live, spill "
            "everything, for comparison");
  addChoice(command, "--gpu-arch", options.compile.gpu, gpuArchitectures(),
            "the oldest NVIDIA GPU that the PTX supports; default sm_75");
  addChoice(
      command, "--schedule", options.compile.schedule,
      Choices<std::optional<Schedule>>{{"auto", std::nullopt},
                                       {"majority", Schedule::Majority},
                                       {"prioritized", Schedule::Prioritized},
                                       {"least-waste", Schedule::LeastWaste},
                                       {"round-robin", Schedule::RoundRobin},
                                       {"naive", Schedule::Naive}},
      "how a GPU's warp chooses the next step of its lanes: majority, the step that most lanes "
      "wait for; prioritized, states before traversal, and new samples last; least-waste, the step "
      "that wastes the least time of waiting lanes; round-robin, each step in turn; naive, the "
      "step of the first lane; auto: by the rays of the program. The picture is the same");
  addChoice(
      command, "--organisation", options.compile.organisation,
      Choices<std::optional<Organisation>>{{"auto", std::nullopt},
                                           {"megakernel", Organisation::Megakernel},
                                           {"wavefront", Organisation::Wavefront},
                                           {"persistent", Organisation::Persistent}},
      "how the steps of samples are organised on a GPU: megakernel, in one kernel; wavefront, in "
      "a kernel for each step, with queues of samples between them; persistent, in one kernel "
      "whose blocks have queues of their own; auto: megakernel or wavefront, by the rays and "
      "the size of the program. The picture is the same");
  addChoice(command, "--light-kernels", options.compile.lightKernels,
            Choices<LightKernels>{{"auto", LightKernels::Auto},
                                  {"always", LightKernels::Always},
                                  {"never", LightKernels::Never}},
            "whether the states of a wavefront look for lights in a kernel of their own, before "
            "the one that shades: auto, large states. The picture is the same");
  addWhole(command, "-O", options.compile.optimization, 0, 3, "optimisation level of machine code")
      ->type_name("LEVEL");
  addChoice(command, "--sampler", options.compile.sampler, samplerChoices(),
            "the random numbers of samples: independent of each other, or spread evenly among the "
            "samples of a pixel by the sequence R2, or by Sobol's with Owen's scrambling. Default: "
            "the scene's");
  addChoice(command, "--undefined", options.compile.undefined,
            Choices<std::uint32_t>{{"leave", 0},
                                   {"bytes", RTSL_FEATURE_UNDEFINED_BYTES},
                                   {"nan", RTSL_FEATURE_UNDEFINED_NAN}},
            "uninitialised state: leave it, or fill it with a pattern; no picture depends on it. "
            "For tests");
}

void addProgramOptions(CLI::App &command, CommonOptions &options) {
  addPreprocessorOptions(command, options.preprocessor);
  addDependencyOptions(command, options.dependencies);
  addCompileOptions(command, options);
  addKeepOption(command, options);
  addMessageOptions(command, options);
}

std::uint32_t features(bool prints, bool exceptions) {
  return (prints ? RTSL_FEATURE_PRINT : 0) | (exceptions ? RTSL_FEATURE_EXCEPTIONS : 0);
}

namespace {

/// A first argument that is no command.
int refuseCommand(const CLI::App &app, const std::string &given) {
  std::string text = fmt::format("rtslc: unknown command `{}`", given);
  std::error_code error;
  const std::string ending = std::filesystem::path(given).extension();
  std::vector<std::string> commands;
  for (const CLI::App *command : app.get_subcommands([](const CLI::App *) { return true; }))
    commands.push_back(command->get_name());
  const std::string closest = closestName(given, commands);
  if (std::filesystem::exists(given, error) && ending == ".json")
    text += fmt::format("; did you mean `rtslc render {} -o picture.png`?", given);
  else if (std::filesystem::exists(given, error) && ending == ".rtsl")
    text += fmt::format("; did you mean `rtslc check {}`?", given);
  else if (!closest.empty())
    text += fmt::format("; did you mean `{}`?", closest);
  fmt::print(stderr, "{}\n`rtslc --help` lists the commands\n", text);
  return Usage;
}

/// What the arguments say to do.
int runCommand(CLI::App &app, Action &action, int argc, char **argv) {
  if (argc > 1 && argv[1][0] != '-' && !hasCommand(app, argv[1]))
    return refuseCommand(app, argv[1]);
  std::vector<std::string> arguments = withLongDashes(argc, argv);
  std::reverse(arguments.begin(), arguments.end()); // the order of CLI11
  try {
    app.parse(std::move(arguments));
    return action();
  } catch (const CLI::ParseError &error) {
    std::ostringstream help;
    const int status = app.exit(error, help, std::cerr) == 0 ? Fine : Usage;
    printOut(help.str());
    return status;
  }
}

} // namespace

int run(CLI::App &app, Action &action, int argc, char **argv, const std::function<void()> &first) {
  reportFileSizeLimit();
  nameOutOfMemory("rtslc");
  onLlvmOutOfMemory([] {
    sayOutOfMemory("rtslc");
    ::_exit(Diagnosed);
  });
  try {
    first();
    const int status = runCommand(app, action, argc, argv);
    return finishOutput("rtslc") || status != Fine ? status : Diagnosed;
  } catch (const Error &error) { // what no command has reported
    fmt::print(stderr, "rtslc: {}\n", error.what());
    if (error.code != ErrorCode::Internal)
      return Diagnosed;
  } catch (const std::exception &error) {
    if (isOutOfMemory(error)) {
      sayOutOfMemory("rtslc");
      return Diagnosed;
    }
    fmt::print(stderr, "rtslc: internal error: {}\n", error.what());
  }
  fmt::print(stderr, "This is a bug in rtslc; please report it with files that reproduce it.\n");
  return InternalError;
}

} // namespace rtsl::tool
