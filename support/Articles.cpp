#include "support/Articles.h"

#include <string_view>

namespace rtsl {

namespace {

bool startsWith(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

bool isSpokenWithVowel(std::string_view name) {
  if (startsWith(name, "rt_"))
    return true; // "ar tee"
  for (const std::string_view you : {"uint", "uvec", "uri", "use", "uni", "Uni"})
    if (startsWith(name, you))
      return false;
  return !name.empty() && std::string_view("aeiouAEIOU").find(name[0]) != std::string_view::npos;
}

} // namespace

std::string withArticles(std::string text) {
  constexpr std::string_view article = "a `";
  for (std::size_t at = text.find(article); at != std::string::npos;
       at = text.find(article, at + 1)) {
    const bool isWord = at == 0 || text[at - 1] == ' ' || text[at - 1] == '(';
    if (isWord && isSpokenWithVowel(std::string_view(text).substr(at + article.size())))
      text.insert(at + 1, "n");
  }
  return text;
}

} // namespace rtsl
