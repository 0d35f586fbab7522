//===- CommandLine.cpp - what the commands of rtslc share -----------------===//
#include "CommandLine.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <map>
#include <new>

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

/// What -Whelp says: the table of warnings, a line each.
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
  if (digits.empty() || digits.size() > 9 || digits.find_first_not_of("0123456789") != std::string::npos)
    throw CLI::ValidationError("-W" + text, "give a number of bytes");
  largeLiveState = static_cast<std::uint32_t>(std::stoul(digits));
  return name;
}

void applyWarning(const std::string &text, WarningOptions &warnings) {
  if (text == "help") {
    fmt::print("{}", warningList());
    throw CLI::Success();
  }
  if (const std::string complaint = warnings.apply(text); !complaint.empty())
    throw CLI::ValidationError("-W" + text, complaint);
}

bool hasCommand(const CLI::App &app, const std::string &name) {
  const std::vector<const CLI::App *> commands = app.get_subcommands([](const CLI::App *) { return true; });
  return std::any_of(commands.begin(), commands.end(),
                     [&](const CLI::App *command) { return command->get_name() == name; });
}

} // namespace

void addMessageOptions(CLI::App &command, CommonOptions &options) {
  command
      .add_option_function<std::string>(
          "--diagnostics", [&options](const std::string &form) { options.jsonDiagnostics = form == "json"; },
          "how messages are written to standard error")
      ->check(CLI::IsMember({"text", "json"}))
      ->type_name("text|json");
  command.add_option("--ansi", options.ansi, "colour in messages")
      ->check(CLI::IsMember({"auto", "always", "never"}))
      ->type_name("auto|always|never");
  command.add_option("--error-limit", options.errorLimit, "stop showing errors after this many; 0 shows all")
      ->type_name("N");
  command
      .add_option_function<std::vector<std::string>>(
          "-W",
          [&options](const std::vector<std::string> &texts) {
            for (const std::string &text : texts)
              applyWarning(withoutLimit(text, options.compile.largeLiveState), options.warnings);
          },
          "turn a warning on, or off with no-NAME; NAME can be all or perf; error[=NAME] makes them errors; "
          "live-state=BYTES says how much is much; -Whelp lists them")
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
          "leave this in the program although the scene does not need it; the picture is the same")
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
          "what a color is made of")
      ->type_name("rgb|mono|spectral:N|N");
  command
      .add_option("--fp", options.compile.floatingPoint,
                  "numbers: strict, IEEE single with the same bits everywhere; fast, approximations and reassociation; double, "
                  "shaders compute in double on this machine")
      ->transform(CLI::CheckedTransformer(std::map<std::string, FloatingPoint>{{"strict", FloatingPoint::Strict},
                                                                               {"fast", FloatingPoint::Fast},
                                                                               {"double", FloatingPoint::Double}})
                      .description(""))
      ->type_name("strict|fast|double");
  command.add_flag_callback(
      "--unchecked", [&options] { options.compile.checkIndices = false; },
      "trust array and buffer indices: one out of range is then undefined");
  command
      .add_option("--trace", options.compile.trace,
                  "what becomes of `trace`: recurse, a call; split, the end of a state, as on a GPU. If not given: recurse; of "
                  "C++ split, if it can be printed so")
      ->transform(CLI::CheckedTransformer(std::map<std::string, TraceMode>{{"recurse", TraceMode::Recurse},
                                                                           {"split", TraceMode::Split}})
                      .description(""))
      ->type_name("recurse|split");
  command
      .add_option("--save", options.compile.savesAllThatIsLive,
                  "what states keep over a `trace`: needed, what cannot be had again for less; live, all that is alive there, to "
                  "compare with")
      ->transform(CLI::CheckedTransformer(std::map<std::string, bool>{{"needed", false}, {"live", true}}).description(""))
      ->type_name("needed|live");
  command.add_option("--gpu-arch", options.compile.gpu, "the oldest NVIDIA GPU that PTX is for; sm_75 if not given")
      ->check(CLI::IsMember({"sm_75", "sm_80", "sm_86", "sm_89", "sm_90", "sm_100", "sm_120"}))
      ->type_name("sm_75|sm_80|sm_86|sm_89|sm_90|sm_100|sm_120");
  command.add_option("-O", options.compile.optimization, "optimisation of machine code, 0 to 3")
      ->check(CLI::Range(0, 3))
      ->type_name("LEVEL");
}

int run(CLI::App &app, Action &action, int argc, char **argv, const std::function<void()> &first) {
  try {
    first();
    if (argc > 1 && argv[1][0] != '-' && !hasCommand(app, argv[1])) {
      fmt::print(stderr, "rtslc: unknown command `{}`; `rtslc --help` lists them\n", argv[1]);
      return Usage;
    }
    std::vector<std::string> arguments = withLongDashes(argc, argv);
    std::reverse(arguments.begin(), arguments.end()); // as CLI11 wants them
    app.parse(std::move(arguments));
    return action();
  } catch (const CLI::ParseError &error) {
    return app.exit(error) == 0 ? Fine : Usage;
  } catch (const std::bad_alloc &) {
    fmt::print(stderr, "rtslc: out of memory\n");
  } catch (const std::exception &error) {
    fmt::print(stderr, "rtslc: internal error: {}\nThis is a fault of rtslc; please report it with the files that "
                       "show it.\n",
               error.what());
  }
  return InternalError;
}

} // namespace rtsl::tool
