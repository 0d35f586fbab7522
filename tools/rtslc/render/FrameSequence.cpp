#include "FrameSequence.h"

#include "tools/common/OptionValues.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <regex>

namespace rtsl::tool {

namespace {

constexpr std::uint32_t lastFrame = 1000000;
const std::regex placeOfNumber("%(0([1-9]))?d");

Frames parseFrames(const std::string &text) {
  const std::size_t dots = text.find("..");
  if (dots == std::string::npos)
    throw CLI::ValidationError("--frames",
                               fmt::format("`{}` is no range of frames; write the first "
                                           "and the last: `0..47`",
                                           text));
  const Frames frames{std::uint32_t(parseWhole("--frames", text.substr(0, dots), 0, lastFrame)),
                      std::uint32_t(parseWhole("--frames", text.substr(dots + 2), 0, lastFrame))};
  if (frames.first > frames.last)
    throw CLI::ValidationError(
        "--frames", fmt::format("frame {} comes after frame {}", frames.first, frames.last));
  return frames;
}

double parseFrame(const std::string &text) {
  double frame = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), frame);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(frame))
    throw CLI::ValidationError("--frame", fmt::format("`{}` is not a number", text));
  return frame;
}

} // namespace

void addFrameOptions(CLI::App &command, std::optional<double> &frame,
                     std::optional<Frames> &frames) {
  command
      .add_option_function<std::string>(
          "--frame", [&frame](const std::string &text) { frame = parseFrame(text); },
          "the frame of the scene's key frames; default: the scene's `frame`, or 0")
      ->type_name("N");
  command
      .add_option_function<std::string>(
          "--frames", [&frames](const std::string &text) { frames = parseFrames(text); },
          "render these frames, one after the other; `%04d` in the name of the picture is the "
          "number of the frame, in four digits")
      ->type_name("A..B");
}

void checkFrameName(const std::string &option, const std::string &name) {
  const std::sregex_iterator first(name.begin(), name.end(), placeOfNumber), none;
  if (first == none || std::next(first) != none)
    throw CLI::ValidationError(
        option, fmt::format("`{}` needs one place for the number of the frame, such as `%04d`: "
                            "`frame.%04d.png`",
                            name));
}

std::string nameOfFrame(const std::string &name, std::uint32_t frame) {
  std::smatch place;
  std::regex_search(name, place, placeOfNumber);
  const int digits = place[2].matched ? std::stoi(place[2]) : 1;
  return fmt::format("{}{:0{}}{}", place.prefix().str(), frame, digits, place.suffix().str());
}

} // namespace rtsl::tool
