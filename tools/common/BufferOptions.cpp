#include "tools/common/BufferOptions.h"

#include <fmt/format.h>

#include <set>

namespace rtsl::tool {

void addBufferOption(CLI::App &command, const char *name, std::vector<BufferFile> &files,
                     const char *text) {
  command
      .add_option_function<std::vector<std::string>>(
          name,
          [&files, name](const std::vector<std::string> &values) {
            for (const std::string &value : values) {
              const std::size_t equals = value.find('=');
              if (equals == 0 || equals == std::string::npos || equals + 1 == value.size())
                throw CLI::ValidationError(
                    name, fmt::format("`{}` is not NAME=FILE: a buffer and its file", value));
              files.push_back({value.substr(0, equals), value.substr(equals + 1)});
            }
          },
          text)
      ->type_name("NAME=FILE")
      ->allow_extra_args(false);
}

void checkOutputFiles(const std::vector<BufferFile> &outputs, const std::string &picture) {
  std::set<std::string> files, names;
  if (!picture.empty())
    files.insert(picture);
  for (const BufferFile &output : outputs)
    if (!files.insert(output.file).second)
      throw CLI::ValidationError("--out", fmt::format("`{}` is given twice", output.file));
    else if (!names.insert(output.name).second)
      throw CLI::ValidationError("--out", fmt::format("`{}` is given twice", output.name));
}

} // namespace rtsl::tool
