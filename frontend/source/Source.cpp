//===- Source.cpp - source texts and positions in them --------------------===//
#include "frontend/source/Source.h"
#include "frontend/source/Expansion.h"
#include "support/EndlessInput.h"

#include <algorithm>
#include <cassert>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <limits>

namespace rtsl {

FileId SourceManager::add(std::string name, std::string text) {
  // Offsets have 32 bits; addFile refuses such files with a message.
  assert(text.size() < std::numeric_limits<std::uint32_t>::max());
  files.push_back({std::move(name), std::move(text), nullptr, {}, {}});
  return static_cast<FileId>(files.size());
}

FileId SourceManager::addExpanded(ExpandedText text) {
  assert(text.text.size() < std::numeric_limits<std::uint32_t>::max());
  std::string name = get(text.file).name;
  files.push_back({std::move(name), {}, std::make_shared<ExpandedText>(std::move(text)), {}, {}});
  return static_cast<FileId>(files.size());
}

WrittenRange SourceManager::written(SourceRange range) const {
  if (const ExpandedText *text = expanded(range.file))
    return rtsl::written(*text, range.begin, range.end);
  WrittenRange result;
  result.range = range;
  return result;
}

void SourceManager::setLine(FileId file, std::uint32_t offset, std::uint32_t line,
                            std::string name) {
  assert(file != 0 && file <= files.size());
  std::vector<LineMark> &marks = files[file - 1].lineMarks;
  const auto at =
      std::lower_bound(marks.begin(), marks.end(), offset,
                       [](const LineMark &mark, std::uint32_t o) { return mark.offset < o; });
  if (at == marks.end() ||
      at->offset != offset) // a file that is included twice gives the same mark twice
    marks.insert(at, {offset, line, std::move(name)});
}

std::optional<FileId> SourceManager::addFile(const std::string &path, std::string &whyNot) {
  const bool isStandardInput = path == "-";
  errno = 0;
  std::FILE *stream = isStandardInput ? stdin : std::fopen(path.c_str(), "rb");
  if (!stream) {
    whyNot = std::strerror(errno);
    return std::nullopt;
  }
  if (const char *reason = whyNoInput(fileno(stream))) {
    whyNot = reason;
    if (!isStandardInput)
      std::fclose(stream);
    return std::nullopt;
  }
  std::string text;
  whyNot.clear();
  constexpr std::size_t chunk = std::size_t{1} << 16;
  while (true) {
    const std::size_t size = text.size();
    text.resize(size + std::max(chunk, size)); // doubling: linear in the file's size
    errno = 0;
    const std::size_t got = std::fread(text.data() + size, 1, text.size() - size, stream);
    const int error = errno;
    const bool isLast = got < text.size() - size;
    text.resize(size + got);
    if (std::ferror(stream)) { // opening a directory succeeds; reading it fails here
      whyNot = std::strerror(error ? error : EIO);
      break;
    }
    if (text.size() >= std::numeric_limits<std::uint32_t>::max() / 2) {
      whyNot = std::strerror(EFBIG);
      break;
    }
    if (isLast)
      break;
  }
  if (!isStandardInput)
    std::fclose(stream);
  if (!whyNot.empty())
    return std::nullopt;
  text.shrink_to_fit();
  return add(isStandardInput ? "<stdin>" : path, std::move(text));
}

const SourceManager::File &SourceManager::get(FileId file) const {
  static const File none{};
  assert(file <= files.size());
  return file == 0 || file > files.size() ? none : files[file - 1];
}

std::string_view SourceManager::name(FileId file) const {
  return get(file).name;
}

std::string_view SourceManager::text(FileId file) const {
  const File &source = get(file);
  return source.expanded ? source.expanded->text : source.text;
}

std::string_view SourceManager::text(SourceRange range) const {
  const std::string_view all = text(range.file);
  const std::size_t begin = std::min<std::size_t>(range.begin, all.size());
  const std::size_t end = std::clamp<std::size_t>(range.end, begin, all.size());
  return all.substr(begin, end - begin);
}

const std::vector<std::uint32_t> &SourceManager::lineStarts(FileId file) const {
  const File &source = get(file);
  if (source.lineStarts.empty()) {
    source.lineStarts.push_back(0);
    const std::string_view all = text(file);
    const char *const begin = all.data();
    const char *const end = begin + all.size();
    for (const char *at = begin; at != end;) {
      at = static_cast<const char *>(std::memchr(at, '\n', static_cast<std::size_t>(end - at)));
      if (!at)
        break;
      ++at;
      source.lineStarts.push_back(static_cast<std::uint32_t>(at - begin));
    }
  }
  return source.lineStarts;
}

LineColumn SourceManager::lineColumn(FileId file, std::uint32_t offset) const {
  const std::vector<std::uint32_t> &starts = lineStarts(file);
  offset = std::min(offset, static_cast<std::uint32_t>(text(file).size()));
  const auto next = std::upper_bound(starts.begin(), starts.end(), offset);
  const auto line = static_cast<std::uint32_t>(next - starts.begin());
  return {line, offset - starts[line - 1] + 1};
}

ShownPlace SourceManager::shown(FileId file, std::uint32_t offset) const {
  const File &source = get(file);
  const LineColumn at = lineColumn(file, offset);
  const auto next =
      std::upper_bound(source.lineMarks.begin(), source.lineMarks.end(), offset,
                       [](std::uint32_t o, const LineMark &mark) { return o < mark.offset; });
  if (next == source.lineMarks.begin())
    return {source.name, at};
  const LineMark &mark = *std::prev(next);
  return {mark.name, {at.line - lineColumn(file, mark.offset).line + mark.line, at.column}};
}

std::uint32_t SourceManager::offset(FileId file, LineColumn place) const {
  const std::vector<std::uint32_t> &starts = lineStarts(file);
  if (place.line == 0 || place.line > starts.size())
    return static_cast<std::uint32_t>(text(file).size());
  const std::size_t column = std::min<std::size_t>(place.column - 1, line(file, place.line).size());
  return starts[place.line - 1] + static_cast<std::uint32_t>(column);
}

FileId SourceManager::find(std::string_view name) const {
  for (FileId file = 1; file <= files.size(); ++file)
    if (get(file).name == name && !get(file).expanded)
      return file;
  return 0;
}

std::string_view SourceManager::line(FileId file, std::uint32_t line) const {
  const std::vector<std::uint32_t> &starts = lineStarts(file);
  if (line == 0 || line > starts.size())
    return {};
  std::string_view result = text(file).substr(starts[line - 1]);
  if (line < starts.size())
    result = result.substr(0, starts[line] - starts[line - 1] - 1);
  if (!result.empty() && result.back() == '\r')
    result.remove_suffix(1);
  return result;
}

} // namespace rtsl
