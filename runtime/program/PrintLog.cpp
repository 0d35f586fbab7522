#include "runtime/program/PrintLog.h"

#include "runtime/device/engines/PrintedLines.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <mutex>
#include <tuple>
#include <utility>

namespace rtsl::runtime {

namespace {

auto key(const PrintedLine &line) {
  // Lines that no sample printed come first.
  std::uint64_t row = line.sample == PrintedLine::noSample ? 0 : std::uint64_t(line.y) + 1;
  return std::make_tuple(row, line.x, line.sample, line.order);
}

std::string scalarText(ValueType::Kind kind, std::uint32_t word) {
  switch (kind) {
  case ValueType::Kind::Bool:
    return word ? "true" : "false";
  case ValueType::Kind::Int:
    return fmt::format("{}", std::int32_t(word));
  case ValueType::Kind::UInt:
    return fmt::format("{}", word);
  default: {
    float value;
    std::memcpy(&value, &word, sizeof value);
    return value != value ? "nan" : fmt::format("{}", value);
  }
  }
}

/// "3", "vec3(1, 2, 3)", "mat2(1, 0, 0, 1)".
std::string valueText(const PrintItem &item, const std::uint32_t *words) {
  if (item.text == "float" || item.text == "int" || item.text == "uint" || item.text == "bool")
    return scalarText(item.kind, words[0]);
  std::string text = item.text + "(";
  for (std::uint32_t i = 0; i < item.words; ++i)
    text += (i ? ", " : "") + scalarText(item.kind, words[i]);
  return text + ")";
}

} // namespace

std::string itemsText(const PrintFormat &format, const std::uint32_t *words) {
  std::string text;
  for (const PrintItem &item : format) {
    text += " " + (item.words == 0 ? item.text : valueText(item, words));
    words += item.words;
  }
  return text;
}

namespace {

std::string lineText(const PrintedLine &line, const std::vector<PrintFormat> &formats) {
  const std::string where =
      line.sample == PrintedLine::noSample
          ? "scene:"
          : fmt::format("pixel {},{} sample {}:", line.x, line.y, line.sample);
  return where +
         (line.text.empty() ? itemsText(formats.at(line.format), line.words.data()) : line.text);
}

} // namespace

bool PrintLog::ComesFirst::operator()(const PrintedLine &a, const PrintedLine &b) const {
  return key(a) < key(b);
}

void PrintLog::add(PrintedLine line) {
  lines.add(std::move(line));
}

void PrintLog::add(const RtslPrintedLines &printed, const std::uint32_t *words) {
  const std::uint32_t *const end = words + std::min(printed.reserved, printed.capacity);
  while (words != end && *words != 0) {
    device::LineHeader header;
    std::memcpy(&header, words, sizeof header);
    const std::uint32_t *const next = words + header.words;
    add({header.x,
         header.y,
         header.sample,
         header.order,
         header.format,
         {words + device::headerWords, next}});
    words = next;
  }
  lost += printed.lost;
}

std::vector<std::string> PrintLog::texts(const std::vector<PrintFormat> &formats) {
  std::vector<std::string> texts;
  for (const PrintedLine &line : lines.take())
    texts.push_back(lineText(line, formats));
  if (lines.total() > texts.size())
    texts.push_back(fmt::format("... and {} more lines", lines.total() - texts.size()));
  if (lost > 0)
    texts.push_back(fmt::format("... and {} lines anywhere between these, which did not fit in the "
                                "memory of the device: print less in each sample",
                                lost));
  return texts;
}

namespace {

struct SharedLog {
  std::mutex mutex;
  PrintLog log;
};

SharedLog &sharedLog() {
  static SharedLog shared;
  return shared;
}

} // namespace

PrintLog takePrintLog() {
  SharedLog &shared = sharedLog();
  std::lock_guard<std::mutex> lock(shared.mutex);
  return std::exchange(shared.log, PrintLog());
}

void addPrinted(const RtslPrintedLines &printed, const std::uint32_t *words) {
  SharedLog &shared = sharedLog();
  std::lock_guard<std::mutex> lock(shared.mutex);
  shared.log.add(printed, words);
}

void addPrinted(PrintedLine line) {
  SharedLog &shared = sharedLog();
  std::lock_guard<std::mutex> lock(shared.mutex);
  shared.log.add(std::move(line));
}

} // namespace rtsl::runtime
