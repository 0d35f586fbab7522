//===- Measurement.cpp - tables of measurements as CSV --------------------===//
#include "report/Measurement.h"

#include "support/AtomicFile.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>

#include <charconv>
#include <cstdlib>
#include <functional>
#include <unistd.h>

namespace rtsl::report {

namespace {

/// A column: its name, and how it is written and read. Reading returns false for text that is not a
/// valid value.
template <typename Row>
struct Column {
  const char *name;
  std::function<std::string(const Row &)> write;
  std::function<bool(Row &, const std::string &)> read;
};

bool parse(const std::string &text, double &value) {
  char *end = nullptr;
  value = std::strtod(text.c_str(), &end);
  return !text.empty() && *end == 0;
}

template <typename Integer>
bool parse(const std::string &text, Integer &value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

bool parse(const std::string &text, std::string &value) {
  value = text;
  return !text.empty();
}

template <typename Row, typename Value>
Column<Row> column(const char *name, Value Row::*member) {
  return {name,
          [member](const Row &row) {
            return fmt::format("{}", row.*member);
          }, // the shortest that reads back to the same value
          [member](Row &row, const std::string &text) { return parse(text, row.*member); }};
}

const std::vector<Column<Measurement>> &columnsOf(const Measurement *) {
  static const std::vector<Column<Measurement>> columns = {
      column("configuration", &Measurement::configuration),
      column("spp", &Measurement::samplesPerPixel),
      column("run", &Measurement::run),
      column("seed", &Measurement::seed),
      column("build_seconds", &Measurement::buildSeconds),
      column("render_seconds", &Measurement::renderSeconds),
      column("rmse", &Measurement::rmse),
      column("rel_mse", &Measurement::relMse),
      column("bias", &Measurement::bias),
      column("flip", &Measurement::flip),
      column("flip_hdr", &Measurement::flipHdr),
      column("nan_pixels", &Measurement::nanPixels),
      column("infinite_pixels", &Measurement::infinitePixels),
      column("samples_not_finite", &Measurement::samplesNotFinite),
      column("rays_too_deep", &Measurement::raysTooDeep),
      column("picture_hash", &Measurement::pictureHash),
      column("pair_variance", &Measurement::pairVariance)};
  return columns;
}

const std::vector<Column<LevelVariance>> &columnsOf(const LevelVariance *) {
  static const std::vector<Column<LevelVariance>> columns = {
      column("configuration", &LevelVariance::configuration),
      column("spp", &LevelVariance::samplesPerPixel), column("variance", &LevelVariance::variance),
      column("mean_seconds", &LevelVariance::meanSeconds),
      column("efficiency", &LevelVariance::efficiency)};
  return columns;
}

template <typename Row>
std::string headerOf() {
  std::string header;
  for (const auto &column : columnsOf(static_cast<const Row *>(nullptr)))
    header += (header.empty() ? "" : ",") + std::string(column.name);
  return header + "\n";
}

template <typename Row>
std::string lineOf(const Row &row) {
  std::string line;
  for (const auto &column : columnsOf(&row))
    line += (line.empty() ? "" : ",") + column.write(row);
  return line + "\n";
}

std::vector<std::string> split(const std::string &text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t start = 0;;) {
    const std::size_t end = text.find(separator, start);
    parts.push_back(text.substr(start, end - start));
    if (end == std::string::npos)
      return parts;
    start = end + 1;
  }
}

template <typename Row>
std::vector<Row> readTable(const std::string &path) {
  if (::access(path.c_str(), F_OK) != 0)
    return {};
  std::vector<std::string> lines = split(readFile(path), '\n');
  lines.pop_back(); // after the last line end: nothing, or a truncated line
  if (lines.empty())
    return {};
  const auto refuse = [&](std::size_t line, const Message &why) {
    throw Error(why, Place{path, std::uint32_t(line + 1), 1, 1});
  };
  if (lines.front() + "\n" != headerOf<Row>())
    refuse(0, message::reportTableOfOtherVersion());
  std::vector<Row> rows;
  for (std::size_t line = 1; line < lines.size(); ++line) {
    const std::vector<std::string> cells = split(lines[line], ',');
    const auto &columns = columnsOf(static_cast<const Row *>(nullptr));
    if (cells.size() != columns.size())
      refuse(line, message::reportColumnCount());
    Row row;
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (!columns[i].read(row, cells[i]))
        refuse(line, message::reportBadValue());
    rows.push_back(std::move(row));
  }
  return rows;
}

/// Appends `line`, after the header if the file is new. A line that an earlier run has left
/// incomplete is removed.
void appendLine(const std::string &path, const std::string &header, const std::string &line) {
  std::string bytes = ::access(path.c_str(), F_OK) == 0 ? readFile(path) : std::string();
  bytes.resize(bytes.rfind('\n') == std::string::npos ? 0 : bytes.rfind('\n') + 1);
  writeFileAtomically(path, (bytes.empty() ? header : bytes) + line);
}

} // namespace

std::vector<Measurement> readMeasurements(const std::string &path) {
  return readTable<Measurement>(path);
}
void appendMeasurement(const std::string &path, const Measurement &measurement) {
  appendLine(path, headerOf<Measurement>(), lineOf(measurement));
}
void writeLevels(const std::string &path, const std::vector<LevelVariance> &levels) {
  std::string table = headerOf<LevelVariance>();
  for (const LevelVariance &level : levels)
    table += lineOf(level);
  writeFileAtomically(path, table);
}

std::uint64_t hashOf(std::string_view bytes) {
  std::uint64_t hash = 14695981039346656037ull;
  for (char byte : bytes)
    hash = (hash ^ std::uint8_t(byte)) * 1099511628211ull;
  return hash;
}

std::uint64_t hashOf(const std::vector<float> &pixels) {
  return hashOf({reinterpret_cast<const char *>(pixels.data()), pixels.size() * sizeof(float)});
}

} // namespace rtsl::report
