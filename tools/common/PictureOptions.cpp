//===- PictureOptions.cpp - options of the picture that is rendered --------===//
#include "PictureOptions.h"

#include "OptionValues.h"

#include <cstdio>
#include <string>

namespace rtsl::tool {

namespace {

PictureSize parseSize(const std::string &text) {
  unsigned width = 0, height = 0;
  int used = 0;
  const bool isSize = text.size() < 32 &&
                      std::sscanf(text.c_str(), "%5ux%5u%n", &width, &height, &used) == 2 &&
                      static_cast<std::size_t>(used) == text.size();
  if (!isSize || width < 1 || height < 1 || width > 65536 || height > 65536)
    throw CLI::ValidationError(
        "--size", "give WIDTHxHEIGHT in pixels, each from 1 to 65536, such as 960x540");
  return {width, height};
}

} // namespace

void addSizeOption(CLI::App &command, std::optional<PictureSize> &size) {
  command
      .add_option_function<std::string>(
          "--size", [&size](const std::string &text) { size = parseSize(text); }, "size in pixels")
      ->type_name("WxH");
}

void addPictureOption(CLI::App &command, std::string &output, runtime::PictureFormat &format) {
  command.add_option("-o,--output", output, "the picture: .png or .exr; - is standard output")
      ->required()
      ->type_name("IMAGE");
  addChoice(command, "--format", format,
            Choices<runtime::PictureFormat>{{"png", runtime::PictureFormat::Png},
                                            {"exr", runtime::PictureFormat::Exr}},
            "the format of the picture; default: by its name, png for -");
}

void checkPictureName(const std::string &output, runtime::PictureFormat format) {
  const std::size_t dot = output.find_last_of("./");
  const bool hasEnding = dot != std::string::npos && output[dot] == '.';
  const std::string ending =
      hasEnding ? CLI::detail::to_lower(output.substr(dot + 1)) : std::string();
  if (format == runtime::PictureFormat::ByName && output != "-" && ending != "png" &&
      ending != "exr")
    throw CLI::ValidationError(
        "--output", "a picture's name ends in .png or .exr, unless --format selects that of `" +
                        output + "` is to be");
}

} // namespace rtsl::tool
