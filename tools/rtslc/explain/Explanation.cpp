#include "Explanation.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <map>

namespace rtsl::tool {

namespace {

std::string placeText(const ir::SourcePlace &place) {
  return place.isKnown() ? fmt::format("{}:{}", place.file, place.line) : std::string();
}

/// 12345 as "12 345".
std::string grouped(std::int64_t number) {
  std::string digits = fmt::format("{}", number < 0 ? -number : number), text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i != 0 && (digits.size() - i) % 3 == 0)
      text += ' ';
    text += digits[i];
  }
  return (number < 0 ? "-" : "") + text;
}

std::string count(std::size_t number) {
  return number == 0 ? "-" : fmt::format("{}", number);
}

std::int64_t difference(std::uint64_t kept, std::uint64_t now) {
  return static_cast<std::int64_t>(kept) - static_cast<std::int64_t>(now);
}

} // namespace

Item itemOf(const runtime::Scene::MeshAttribute &attribute) {
  return attribute.isNamed ? Item::MeshAttributes : Item::Meshes;
}

Explanation::Explanation(std::string scene, const SceneExplanation &program,
                         const std::vector<runtime::Scene::MeshAttribute> &meshes)
    : scene(std::move(scene)), size(program.size), hasSavings(program.hasSavings),
      findings(program.findings) {
  std::map<Item, std::int64_t> meshBytes; // that are left out
  for (const runtime::Scene::MeshAttribute &attribute : meshes) {
    const Item item = itemOf(attribute);
    findings.push_back(
        {item,
         fmt::format("{} of {}", attribute.name, attribute.mesh),
         attribute.isNeeded,
         fmt::format("{} bytes, {}", grouped(static_cast<std::int64_t>(attribute.bytes)),
                     attribute.isNeeded ? "read by its material" : "not read by its materials"),
         {}});
    if (!attribute.isNeeded)
      meshBytes[item] += static_cast<std::int64_t>(attribute.bytes);
  }
  for (Item item : allItems) {
    Entries entries;
    entries.item = item;
    for (const Finding &finding : findings)
      if (finding.item == item)
        (finding.isNeeded ? entries.needed : entries.leftOut).push_back(&finding);
    const auto keeping = program.sizeKeeping.find(item);
    entries.isKept = keeping == program.sizeKeeping.end();
    if (!entries.isKept) {
      const ProgramSize &kept = keeping->second;
      entries.saved = {difference(kept.instructions, size.instructions),
                       difference(kept.constantBytes, size.constantBytes),
                       difference(kept.frameBytes, size.frameBytes),
                       difference(kept.states, size.states), meshBytes[item]};
    }
    items.push_back(std::move(entries));
  }
}

std::string Explanation::table() const {
  std::string text = fmt::format("{:<38}{:>7}{:>9}", "", "needed", "left out");
  text += hasSavings ? fmt::format("   {:>12}{:>11}{:>8}{:>8}{:>9}\n", "instructions", "constants",
                                   "frame", "states", "memory")
                     : "\n";
  for (const Entries &entries : items) {
    const auto number = [](std::int64_t saved) {
      return saved == 0 ? std::string("-") : grouped(saved);
    };
    const Saved &saved = entries.saved;
    text += fmt::format("{:<38}{:>7}{:>9}", titleOf(entries.item), count(entries.needed.size()),
                        count(entries.leftOut.size()));
    if (entries.isKept)
      text += "   kept";
    else if (hasSavings)
      text += fmt::format("   {:>12}{:>11}{:>8}{:>8}{:>9}", number(saved.instructions),
                          number(saved.constantBytes), number(saved.frameBytes),
                          number(saved.states), number(saved.memoryBytes));
    text += "\n";
  }
  return text;
}

std::string Explanation::entriesText(const Entries &entries) const {
  if (entries.leftOut.empty() && entries.needed.empty())
    return {};
  std::size_t subjectWidth = 0, placeWidth = 0;
  for (const auto *list : {&entries.leftOut, &entries.needed})
    for (const Finding *finding : *list) {
      subjectWidth = std::max(subjectWidth, finding->subject.size());
      placeWidth = std::max(placeWidth, placeText(finding->place).size());
    }
  std::string text = fmt::format("\n{} (--keep={})\n", titleOf(entries.item), nameOf(entries.item));
  for (const auto *list : {&entries.leftOut, &entries.needed})
    for (const Finding *finding : *list) {
      const std::string line = fmt::format(
          "  {:<9} {:<{}}  {:<{}}  {}", finding->isNeeded ? "needed" : "left out", finding->subject,
          subjectWidth, placeText(finding->place), placeWidth, finding->reason);
      text += line + "\n";
    }
  return text;
}

std::string Explanation::measurementsText() const {
  if (measurements.empty())
    return {};
  std::string text =
      fmt::format("\nMeasured in {} pairs of alternate renderings, on one thread, in processor "
                  "time: how much longer rendering takes with the item kept\n(median with a 95 % "
                  "confidence interval), and how many more instructions it runs.\n\n",
                  measurements.front().pairs);
  text += fmt::format("  {:<12}{:>10}{:>12}{:>24}{:>16}   {}\n", "", "seconds", "longer", "95 %",
                      "instructions", "picture");
  for (const ItemMeasurement &one : measurements) {
    const std::string interval =
        fmt::format("{:+.2f} to {:+.2f} %", 100 * one.slowerLow, 100 * one.slowerHigh);
    const std::string instructions =
        one.instructions && one.instructionsKept
            ? fmt::format("{:+.2f} %", 100 * (static_cast<double>(*one.instructionsKept) /
                                                  static_cast<double>(*one.instructions) -
                                              1))
            : "not counted";
    text += fmt::format("  {:<12}{:>10.4f}{:>10.2f} %{:>24}{:>16}   {}\n", one.kept, one.seconds,
                        100 * one.slower, interval, instructions,
                        one.isSameImage ? "the same" : "ANOTHER");
  }
  return text;
}

std::string Explanation::text() const {
  std::string text = fmt::format(
      "{}: {} instructions, {} bytes of constants, {} states with frames of up to {} bytes\n\n",
      scene, grouped(static_cast<std::int64_t>(size.instructions)),
      grouped(static_cast<std::int64_t>(size.constantBytes)), size.states, size.frameBytes);
  text += hasSavings ? "What its program needs, and the savings of leaving out the rest (in bytes, "
                       "except instructions and states):\n\n"
                     : "What its program needs:\n\n";
  text += table();
  text += measurementsText();
  for (const Entries &entries : items)
    text += entriesText(entries);
  return text;
}

std::string Explanation::json() const {
  nlohmann::ordered_json document = {{"version", 1},
                                     {"scene", scene},
                                     {"program",
                                      {{"instructions", size.instructions},
                                       {"constantBytes", size.constantBytes},
                                       {"frameBytes", size.frameBytes},
                                       {"states", size.states}}}};
  document["items"] = nlohmann::ordered_json::array();
  for (const Entries &entries : items) {
    nlohmann::ordered_json item = {
        {"item", nameOf(entries.item)}, {"title", titleOf(entries.item)}, {"kept", entries.isKept}};
    if (!entries.isKept && hasSavings)
      item["saved"] = {{"instructions", entries.saved.instructions},
                       {"constantBytes", entries.saved.constantBytes},
                       {"frameBytes", entries.saved.frameBytes},
                       {"states", entries.saved.states},
                       {"memoryBytes", entries.saved.memoryBytes}};
    item["entries"] = nlohmann::ordered_json::array();
    for (const auto *list : {&entries.leftOut, &entries.needed})
      for (const Finding *finding : *list) {
        nlohmann::ordered_json entry = {{"subject", finding->subject},
                                        {"needed", finding->isNeeded},
                                        {"reason", finding->reason}};
        if (finding->place.isKnown())
          entry["place"] = {{"file", finding->place.file},
                            {"line", finding->place.line},
                            {"column", finding->place.column}};
        item["entries"].push_back(std::move(entry));
      }
    document["items"].push_back(std::move(item));
  }
  for (const ItemMeasurement &one : measurements) {
    nlohmann::ordered_json measurement = {
        {"kept", one.kept},
        {"pairs", one.pairs},
        {"seconds", one.seconds},
        {"slower", {{"median", one.slower}, {"low", one.slowerLow}, {"high", one.slowerHigh}}},
        {"sameImage", one.isSameImage}};
    if (one.instructions && one.instructionsKept) {
      measurement["instructions"] = *one.instructions;
      measurement["instructionsKept"] = *one.instructionsKept;
    }
    document["measurements"].push_back(std::move(measurement));
  }
  return document.dump(2) + "\n";
}

} // namespace rtsl::tool
