//===- OptionValues.h - checks of option values ---------------------------===//
//
// An option of few words, or of numbers in a range, shows them in --help and in the message when it
// is given something else.
//
//===----------------------------------------------------------------------===//
#pragma once

#include <CLI/CLI.hpp>

#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace rtsl::tool {

/// The words of an option, each with what it stands for.
template <typename Value>
using Choices = std::vector<std::pair<std::string, Value>>;

/// "a|b|c"
std::string joined(const std::vector<std::string> &words);
/// Throws: `text` is none of the words.
[[noreturn]] void refuseWord(const std::string &option, const std::string &text,
                             const std::vector<std::string> &words);

template <typename Value>
std::vector<std::string> wordsOf(const Choices<Value> &choices) {
  std::vector<std::string> words;
  for (const auto &choice : choices)
    words.push_back(choice.first);
  return words;
}

/// Adds an option whose value is one of `choices`.
template <typename Value, typename Target>
CLI::Option *addChoice(CLI::App &command, const std::string &option, Target &target,
                       const Choices<Value> &choices, const std::string &help) {
  const auto read = [&target, option, choices](const std::string &text) {
    for (const auto &[word, value] : choices)
      if (text == word) {
        target = value;
        return;
      }
    refuseWord(option, text, wordsOf(choices));
  };
  return command.add_option_function<std::string>(option, read, help)
      ->type_name(joined(wordsOf(choices)));
}

/// The same where a word stands for itself.
CLI::Option *addChoice(CLI::App &command, const std::string &option, std::string &target,
                       const std::vector<std::string> &words, const std::string &help);

/// A whole number from `low` to `high`. Throws if it is not.
std::uint64_t parseWhole(const std::string &option, const std::string &text, std::uint64_t low,
                         std::uint64_t high);
/// " (LOW to HIGH)"
std::string rangeText(std::uint64_t low, std::uint64_t high);

/// Adds an option whose value is a whole number from `low` to `high`.
template <typename Target>
CLI::Option *addWhole(CLI::App &command, const std::string &option, Target &target,
                      std::uint64_t low, std::uint64_t high, const std::string &help) {
  const auto read = [&target, option, low, high](const std::string &text) {
    target = static_cast<std::uint32_t>(parseWhole(option, text, low, high));
  };
  return command.add_option_function<std::string>(option, read, help + rangeText(low, high))
      ->type_name("N");
}

/// "30s", "2m", "1.5h" or "500ms" in seconds, more than 0. Throws if it is something else.
double parseDuration(const std::string &option, const std::string &text);

/// Adds an option whose value is a finite number.
CLI::Option *addNumber(CLI::App &command, const std::string &option, double &target,
                       const std::string &help);

/// Adds an option whose value is a number of at least 0.
CLI::Option *addNotNegative(CLI::App &command, const std::string &option, double &target,
                            const std::string &help);

} // namespace rtsl::tool
