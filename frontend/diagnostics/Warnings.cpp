//===- Warnings.cpp - which warnings are shown: -W ------------------------===//
#include "frontend/diagnostics/Diagnostics.h"
#include "support/ClosestName.h"

namespace rtsl {

namespace {

/// Takes `prefix` off `text` if it begins with it.
bool skip(std::string_view &text, std::string_view prefix) {
  if (text.substr(0, prefix.size()) != prefix)
    return false;
  text.remove_prefix(prefix.size());
  return true;
}

/// Does NAME of `-WNAME` mean this warning?
bool isMeant(const CodeInfo &row, std::string_view name) {
  return name == "all" || (name == "perf" && row.group == WarningGroup::Perf) ||
         name == row.warning;
}

std::string complainAbout(std::string_view name) {
  std::vector<std::string> known = {"all", "perf", "error"};
  for (const CodeInfo &row : codeTable)
    if (row.warning)
      known.push_back(row.warning);
  const std::string meant = closestName(std::string(name), known);
  return fmt::format("there is no warning `{}`{}", name,
                     meant.empty() ? "; `-Whelp` lists them"
                                   : fmt::format("; did you mean `{}`?", meant));
}

} // namespace

std::string WarningOptions::apply(std::string_view text) {
  std::string_view name = text;
  const bool isOff = skip(name, "no-");
  bool concernsError = false;
  if (name == "error") {
    allAreErrors = !isOff;
    return {};
  }
  if (skip(name, "error="))
    concernsError = true;

  bool isKnown = false;
  states.resize(codeTable.size());
  for (std::size_t code = 0; code != codeTable.size(); ++code) {
    if (!codeTable[code].warning || !isMeant(codeTable[code], name))
      continue;
    isKnown = true;
    State &state = states[code];
    if (concernsError) {
      state.isErrorSet = true;
      state.isError = !isOff;
    }
    if (!concernsError || !isOff) { // `error=` turns it on, too
      state.isSet = true;
      state.isOn = concernsError || !isOff;
    }
  }
  return isKnown ? std::string() : complainAbout(name);
}

bool WarningOptions::isOn(Code code) const {
  const auto index = static_cast<std::size_t>(code);
  if (!states.empty() && states[index].isSet)
    return states[index].isOn;
  return info(code).group == WarningGroup::Usual;
}

bool WarningOptions::isError(Code code) const {
  const auto index = static_cast<std::size_t>(code);
  return !states.empty() && states[index].isErrorSet ? states[index].isError : allAreErrors;
}

} // namespace rtsl
