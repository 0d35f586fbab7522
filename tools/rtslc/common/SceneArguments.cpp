#include "SceneArguments.h"

#include "scenefile/gltf/File.h"

#include <filesystem>

namespace rtsl::tool {

bool isScene(const std::string &file) {
  return std::filesystem::path(file).extension() == ".json" || scene::gltf::isModel(file);
}

void addSetOption(CLI::App &command, std::vector<std::string> &overrides) {
  const auto check = [](const std::string &text) {
    const std::size_t equals = text.find('=');
    const bool isOverride = equals != std::string::npos && equals != 0;
    return isOverride ? std::string() : "write `path.to.key=value`, not `" + text + "`";
  };
  command
      .add_option("--set", overrides,
                  "override a value of the scene file, such as objects.3.mesh=bunny.obj")
      ->check(CLI::Validator(check, ""))
      ->type_name("PATH=VALUE")
      ->allow_extra_args(false);
}

} // namespace rtsl::tool
