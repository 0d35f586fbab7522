#include "GpuOptions.h"

#include "OptionValues.h"

#include <fmt/format.h>

#include <string>

namespace rtsl::tool {

void addGpusOption(CLI::App &command, GpuOptions &options) {
  static constexpr std::uint64_t most = 64;
  command
      .add_option_function<std::string>(
          "--gpus",
          [&options](const std::string &text) {
            if (text == "all") {
              options.count = 0;
              return;
            }
            const bool isNumber = !text.empty() && text.size() <= 2 &&
                                  text.find_first_not_of("0123456789") == std::string::npos;
            options.count = isNumber ? std::stoul(text) : 0;
            if (options.count < 1 || options.count > most)
              throw CLI::ValidationError(
                  "--gpus",
                  fmt::format("`{}` is neither all nor a number N from 1 to {}", text, most));
          },
          "render on the first N CUDA devices, or on all of them; default: 1")
      ->type_name("N|all");
}

void addMaxRegistersOption(CLI::App &command, GpuOptions &options) {
  addWhole(command, "--max-registers", options.maxRegisters, 16, 255,
           "maximum number of registers per thread on a GPU; default: by the kind of program");
}

void rejectGpuOptions(const CLI::App &command) {
  for (const CLI::Option *const option : command.get_options())
    for (const char *const name : {"--gpus", "--max-registers"})
      if (option->check_name(name) && option->count() > 0)
        throw CLI::ValidationError(name, "no GPU renders; add `--target=gpu`");
}

} // namespace rtsl::tool
