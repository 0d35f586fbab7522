//===- OptionValues.cpp - checks of option values -------------------------===//
#include "OptionValues.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

namespace rtsl::tool {

std::string joined(const std::vector<std::string> &words) {
  return fmt::format("{}", fmt::join(words, "|"));
}

void refuseWord(const std::string &option, const std::string &text,
                const std::vector<std::string> &words) {
  throw CLI::ValidationError(option,
                             fmt::format("`{}` is none of {}", text, fmt::join(words, ", ")));
}

CLI::Option *addChoice(CLI::App &command, const std::string &option, std::string &target,
                       const std::vector<std::string> &words, const std::string &help) {
  Choices<std::string> choices;
  for (const std::string &word : words)
    choices.emplace_back(word, word);
  return addChoice(command, option, target, choices, help);
}

std::uint64_t parseWhole(const std::string &option, const std::string &text, std::uint64_t low,
                         std::uint64_t high) {
  std::uint64_t number = 0;
  const char *end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, number);
  if (error != std::errc() || stop != end || number < low || number > high)
    throw CLI::ValidationError(
        option, fmt::format("`{}` is not a whole number from {} to {}", text, low, high));
  return number;
}

std::string rangeText(std::uint64_t low, std::uint64_t high) {
  return fmt::format(" ({} to {})", low, high);
}

double parseDuration(const std::string &option, const std::string &text) {
  char *end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  const std::string unit = end;
  for (const auto &[name, seconds] : {std::make_pair("ms", 1e-3), std::make_pair("s", 1.0),
                                      std::make_pair("m", 60.0), std::make_pair("h", 3600.0)})
    if (end != text.c_str() && unit == name && std::isfinite(number) && number > 0)
      return number * seconds;
  throw CLI::ValidationError(
      option,
      fmt::format("`{}` is not a time; write a number and a unit: `30s`, `2m`, `500ms`", text));
}

/// Not a number, if the text is none.
static double numberOf(const std::string &text) {
  char *end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  return text.empty() || *end != 0 ? std::numeric_limits<double>::quiet_NaN() : number;
}

CLI::Option *addNumber(CLI::App &command, const std::string &option, double &target,
                       const std::string &help) {
  const auto read = [&target, option](const std::string &text) {
    target = numberOf(text);
    if (!std::isfinite(target))
      throw CLI::ValidationError(option, fmt::format("`{}` is not a number", text));
  };
  return command.add_option_function<std::string>(option, read, help)->type_name("X");
}

CLI::Option *addNotNegative(CLI::App &command, const std::string &option, double &target,
                            const std::string &help) {
  const auto read = [&target, option](const std::string &text) {
    const double number = numberOf(text);
    if (std::isnan(number) || number < 0)
      throw CLI::ValidationError(option, fmt::format("`{}` is not a number of at least 0", text));
    target = number;
  };
  return command.add_option_function<std::string>(option, read, help)->type_name("X");
}

} // namespace rtsl::tool
