//===- PictureOptions.cpp - options of the picture that is rendered --------===//
#include "PictureOptions.h"

#include "OptionValues.h"
#include "runtime/image/Layers.h"
#include "support/Error.h"

#include <cstdio>
#include <string>

namespace rtsl::tool {

namespace {

PictureSize parseSize(const std::string &text) {
  PictureSize size{0, 0};
  int used = 0;
  const char *const given = text.c_str();
  const auto isComplete = [&] { return static_cast<std::size_t>(used) == text.size(); };
  const bool isSize =
      text.size() < 32 && text.find_first_not_of("0123456789x") == text.npos &&
      ((std::sscanf(given, "%5ux%5u%n", &size.width, &size.height, &used) == 2 && isComplete()) ||
       (std::sscanf(given, "%5ux%5ux%5u%n", &size.width, &size.height, &size.slices, &used) == 3 &&
        isComplete()));
  for (const std::uint32_t side : {size.width, size.height, size.slices})
    if (!isSize || side < 1 || side > 65536)
      throw CLI::ValidationError("--size",
                                 "give WIDTHxHEIGHT in pixels, each from 1 to 65536, such as "
                                 "960x540; and x the slices of a launch of three dimensions");
  if (std::uint64_t(size.height) * size.slices > runtime::mostLaunchRows)
    throw CLI::ValidationError("--size", "a launch has at most " +
                                             std::to_string(runtime::mostLaunchRows) +
                                             " rows in all of its slices");
  return size;
}

runtime::Window parseCrop(const std::string &text) {
  runtime::Window crop;
  int used = 0;
  const bool isCrop = text.size() < 32 && text.find_first_not_of("0123456789,") == text.npos &&
                      std::sscanf(text.c_str(), "%5u,%5u,%5u,%5u%n", &crop.x0, &crop.y0, &crop.x1,
                                  &crop.y1, &used) == 4 &&
                      static_cast<std::size_t>(used) == text.size();
  if (!isCrop || crop.x0 >= crop.x1 || crop.y0 >= crop.y1)
    throw CLI::ValidationError("--crop", "give x0,y0,x1,y1 in pixels from the top left, such as "
                                         "0,0,64,48: columns x0 to x1 - 1, rows y0 to y1 - 1");
  return crop;
}

} // namespace

void addCropOption(CLI::App &command, std::optional<runtime::Window> &crop) {
  command
      .add_option_function<std::string>(
          "--crop", [&crop](const std::string &text) { crop = parseCrop(text); },
          "render only these pixels: columns x0 to x1 - 1, rows y0 to y1 - 1 from the top left")
      ->type_name("x0,y0,x1,y1");
}

void addSizeOption(CLI::App &command, std::optional<PictureSize> &size) {
  command
      .add_option_function<std::string>(
          "--size", [&size](const std::string &text) { size = parseSize(text); },
          "size in pixels; a third number: slices")
      ->type_name("WxH[xS]");
}

CLI::Option *addPictureOption(CLI::App &command, std::string &output,
                              runtime::PictureFormat &format) {
  CLI::Option *picture =
      command.add_option("-o,--output", output, "the picture: .png or .exr; - is standard output")
          ->required()
          ->type_name("IMAGE");
  addChoice(command, "--format", format,
            Choices<runtime::PictureFormat>{{"png", runtime::PictureFormat::Png},
                                            {"exr", runtime::PictureFormat::Exr}},
            "the format of the picture; default: by its name, png for -");
  return picture;
}

void checkPictureName(const std::string &output, runtime::PictureFormat format) {
  const std::size_t dot = output.find_last_of("./");
  const bool hasEnding = dot != std::string::npos && output[dot] == '.';
  const std::string ending =
      hasEnding ? CLI::detail::to_lower(output.substr(dot + 1)) : std::string();
  if (format == runtime::PictureFormat::ByName && output != "-" && ending != "png" &&
      ending != "exr")
    throw CLI::ValidationError("--output",
                               "`" + output +
                                   "` ends neither in .png nor in .exr: choose another name, or a "
                                   "format with --format");
}

void addToneOptions(CLI::App &command, runtime::ToneMapping &tones) {
  addNumber(command, "--exposure", tones.stops,
            "make a PNG picture brighter by so many photographic stops, or darker")
      ->type_name("STOPS");
  addChoice(command, "--tone", tones.curve,
            Choices<runtime::ToneCurve>{{"linear", runtime::ToneCurve::Linear},
                                        {"reinhard", runtime::ToneCurve::Reinhard},
                                        {"filmic", runtime::ToneCurve::Filmic}},
            "the curve by which a PNG picture shows bright light; linear: what is above 1 is 1");
}

void checkToneOptions(const CLI::App &command, const std::string &output,
                      runtime::PictureFormat format) {
  for (const char *name : {"--exposure", "--tone"}) {
    if (!command.count(name))
      continue;
    if (output.empty())
      throw CLI::ValidationError(name, "there is no picture to show; give a file to `-o`");
    if (runtime::isExr(output, format))
      throw CLI::ValidationError(name, "an EXR file has the light itself; give a name that ends in "
                                       ".png, or `--format=png`");
  }
}

void writePicture(const std::string &output, const runtime::Image &image,
                  runtime::PictureFormat format, const runtime::ToneMapping &tones) {
  if (tones.changesNothing())
    runtime::writeImage(output, image, format);
  else
    runtime::writeImage(output, runtime::toneMapped(image, tones), format);
}

void writePictureSoFar(const std::string &output, const runtime::Image &image,
                       runtime::PictureFormat format, const runtime::ToneMapping &tones) {
  try {
    writePicture(output, image, format, tones);
  } catch (const Error &) {
  }
}

void addTreeOption(CLI::App &command, std::optional<runtime::TreeKind> &tree) {
  using Tree = std::optional<runtime::TreeKind>;
  addChoice(command, "--tree", tree,
            Choices<Tree>{{"auto", std::nullopt},
                          {"fast", runtime::TreeKind::Fast},
                          {"good", runtime::TreeKind::Good}},
            "the tree that GPUs traverse: good, for the fastest traversal; fast, for the fastest "
            "construction, on the GPU if there is one; auto: by the number of triangles. The "
            "picture is the same");
}

} // namespace rtsl::tool
