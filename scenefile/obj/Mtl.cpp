#include "scenefile/obj/Mtl.h"

#include "support/AtomicFile.h"
#include "support/ByteOrderMark.h"
#include "support/ErrorMessages.h"

#include <algorithm>

namespace rtsl::scene::obj {

std::vector<Line> linesOf(std::string_view text) {
  std::vector<Line> lines;
  Line line;
  std::uint32_t number = 1;
  std::size_t start = byteOrderMarkLength(text); // of the line
  const auto isBlank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
  for (std::size_t at = start; at <= text.size();) {
    if (at == text.size() || text[at] == '\n') {
      if (!line.empty())
        lines.push_back(std::move(line));
      line.clear();
      ++number;
      start = ++at;
    } else if (isBlank(text[at])) {
      ++at;
    } else if (text[at] == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (text[at] == '\\' &&
               (text.compare(at + 1, 1, "\n") == 0 || text.compare(at + 1, 2, "\r\n") == 0)) {
      at = text.find('\n', at) + 1;
      ++number;
      start = at;
    } else {
      std::size_t end = at;
      while (end < text.size() && text[end] != '\n' && !isBlank(text[end]))
        ++end;
      if (end - at > 1 && text[end - 1] == '\\' &&
          (end == text.size() || !isBlank(text[end]) ||
           text[end] == '\r')) // at the end of the line
        --end;
      line.push_back(
          {text.substr(at, end - at), number, static_cast<std::uint32_t>(at - start + 1)});
      at = end;
    }
  }
  return lines;
}

JsonValue sourceAt(const std::shared_ptr<const std::string> &file, const Word &word) {
  JsonValue source;
  source.file = file;
  source.line = word.line;
  source.column = word.column;
  source.length = static_cast<std::uint32_t>(word.text.size());
  return source;
}

const Statement *Material::find(std::string_view keyword) const {
  const auto found =
      std::find_if(statements.rbegin(), statements.rend(),
                   [&](const Statement &statement) { return statement.keyword == keyword; });
  return found == statements.rend() ? nullptr : &*found;
}

std::vector<Material> readMaterials(const std::string &path) {
  const std::string text = readFile(path);
  const auto file = std::make_shared<const std::string>(path);
  std::vector<Material> materials;
  for (const Line &line : linesOf(text)) {
    const Word &first = line.front();
    if (first.text == "newmtl") {
      std::string name; // which may contain blanks
      for (std::size_t i = 1; i < line.size(); ++i)
        name.append(i == 1 ? "" : " ").append(line[i].text);
      if (name.empty())
        throw Error(message::materialWithoutName(), sourceAt(file, first).place());
      materials.push_back({std::move(name), sourceAt(file, line[1]), {}, {}});
      continue;
    }
    if (materials.empty())
      throw Error(message::statementOutsideMaterial(first.text), sourceAt(file, first).place());
    Statement statement{std::string(first.text), {}, sourceAt(file, first)};
    for (std::size_t i = 1; i < line.size(); ++i)
      statement.arguments.emplace_back(line[i].text);
    materials.back().statements.push_back(std::move(statement));
  }
  return materials;
}

} // namespace rtsl::scene::obj
