//===- Tokenizer.cpp - text to tokens -------------------------------------===//
#include "frontend/lex/Tokenizer.h"
#include "frontend/lex/ByteStream.h"
#include "frontend/source/Utf8.h"
#include "support/ByteOrderMark.h"

#include "grammar/RtslLexer.h"

namespace rtsl {

namespace {

using generated::RtslLexer;

bool isDigit(char c) {
  return c >= '0' && c <= '9';
}

class Tokenizer {
public:
  Tokenizer(FileId file, Diagnostics &diagnostics)
      : file(file), diagnostics(diagnostics), text(diagnostics.sources().text(file)), stream(text),
        lexer(&stream) {}

  TokenList run();

private:
  SourceRange range(std::size_t begin, std::size_t end) const {
    return {file, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
  }
  void add(std::size_t type, std::uint32_t begin, std::uint32_t end);
  void addString(std::uint32_t begin, std::uint32_t end);
  void addNumber(std::uint32_t begin, std::uint32_t end);
  void refuseCharacters(std::uint32_t begin, std::uint32_t end);

  const FileId file;
  Diagnostics &diagnostics;
  const std::string_view text;
  ByteStream stream;
  RtslLexer lexer;
  TokenList list;
  std::uint32_t previousEnd = 0; // of the last token or comment
  bool startsLine = true;
  bool isStartCarried = false; // by a comment, to the next token
  bool followsMistake = false;
};

void Tokenizer::add(std::size_t type, std::uint32_t begin, std::uint32_t end) {
  Token token;
  token.begin = begin;
  token.end = end;
  token.type = static_cast<std::uint16_t>(type);
  token.startsLine = startsLine;
  token.followsMistake = followsMistake;
  list.tokens.push_back(token);
  followsMistake = false;
}

/// A string without an end extends to the end of its line, except for the brackets and semicolons
/// there.
void Tokenizer::addString(std::uint32_t begin, std::uint32_t end) {
  const std::string_view code = text.substr(begin, end - begin);
  const std::size_t last = code.find_last_not_of(" \t),;");
  const auto stringEnd = static_cast<std::uint32_t>(
      begin + 1 + (last == std::string_view::npos || last == 0 ? 0 : last));
  diagnostics.report(Code::unterminatedString, range(begin, begin + 1))
      .fix(range(stringEnd, stringEnd), "\"");
  add(RtslLexer::STRING_LITERAL, begin, stringEnd);
  list.tokens.back().isBroken = true;
  stream.seek(stringEnd);
  lexer.hitEOF = false;
  previousEnd = stringEnd;
}

void Tokenizer::addNumber(std::uint32_t begin, std::uint32_t end) {
  const std::string_view number = text.substr(begin, end - begin);
  Diagnostic &diagnostic = diagnostics.report(Code::malformedNumber, range(begin, end), number);
  const std::size_t digits = number.find_first_not_of("0123456789");
  const bool isFloat = number.find('.') != std::string_view::npos;
  const std::string_view rest = digits == std::string_view::npos ? "" : number.substr(digits);
  if (rest == "f" || rest == "F" || rest == "lf" || rest == "LF")
    diagnostic.fix(range(begin + digits, begin + digits), ".0", true);
  else if (rest == "L" || rest == "l" || rest == "ul" || rest == "UL" || number.back() == 'h' ||
           number.back() == 'H')
    diagnostic.note("the suffixes are `u` for `uint`, and `f` and `lf` for `float`");
  else if (number.substr(0, 2) == "0b" || number.substr(0, 2) == "0B")
    diagnostic.note("numbers are decimal, octal with a `0` in front, or hexadecimal with `0x`");
  else if (number.find('_') != std::string_view::npos)
    diagnostic.note("digits cannot be separated");
  else if (number.substr(0, 2) == "0x" || number.substr(0, 2) == "0X")
    diagnostic.note("the digits after `0x` are 0-9 and a-f");
  else if (number.size() > 1 && number[0] == '0' && rest.empty())
    diagnostic.note("a number that begins with 0 is octal, with the digits 0-7");
  else if (!isFloat && !isDigit(number.back()) && (rest.front() == 'e' || rest.front() == 'E'))
    diagnostic.note("the exponent has no digits");
  add(isFloat ? RtslLexer::FLOAT_LITERAL : RtslLexer::INT_LITERAL, begin, end);
  list.tokens.back().isBroken = true;
}

/// The RTSL character that a character resembles, such as those that editors and web pages insert.
std::string_view lookAlike(char32_t codePoint) {
  switch (codePoint) {
  case 0x00A0: // no-break space
    return " ";
  case 0x037E: // Greek question mark
  case 0xFF1B:
    return ";";
  case 0x2010:
  case 0x2011:
  case 0x2013:
  case 0x2014:
  case 0x2212: // hyphens, dashes and the minus sign
    return "-";
  case 0x00D7: // multiplication sign
  case 0x22C5:
    return "*";
  case 0x201C:
  case 0x201D:
    return "\"";
  case 0xFF08:
    return "(";
  case 0xFF09:
    return ")";
  case 0xFF0C:
    return ",";
  default:
    return {};
  }
}

/// Length of a character literal, with its apostrophes: `'\x7f'`.
constexpr std::size_t longestCharacter = 6;

/// Reports each character in a run of characters that begin no token.
void Tokenizer::refuseCharacters(std::uint32_t begin, std::uint32_t end) {
  // `'c'` is one mistake, not two with a name between them.
  if (text[begin] == '\'')
    if (const std::size_t close = text.find_first_of("'\n", begin + 1);
        close != std::string_view::npos && text[close] == '\'' && close - begin <= longestCharacter)
      end = static_cast<std::uint32_t>(close + 1);
  const Utf8Character first = decodeUtf8(text.substr(begin, end - begin));
  const std::string_view replacement = lookAlike(first.codePoint);
  const std::size_t size = replacement.empty() ? end - begin : first.size;
  Diagnostic &diagnostic = diagnostics.report(Code::unknownCharacter, range(begin, begin + size),
                                              text.substr(begin, size));
  if (!replacement.empty())
    diagnostic.fix(range(begin, begin + size), std::string(replacement), true);
  stream.seek(begin + size);
  lexer.hitEOF = false;
  previousEnd = static_cast<std::uint32_t>(begin + size);
  followsMistake = true;
}

TokenList Tokenizer::run() {
  lexer.removeErrorListeners(); // there are no errors: the grammar has a rule for every input
  if (reportIfNotText(file, diagnostics)) {
    list.isUsable = false;
  } else {
    list.tokens.reserve(text.size() / 4);
    stream.seek(byteOrderMarkLength(text));
    for (bool isDone = false; !isDone;) {
      const std::unique_ptr<antlr4::Token> word = lexer.nextToken();
      const std::size_t type = word->getType();
      if (type == antlr4::Token::EOF)
        break;
      const auto begin = static_cast<std::uint32_t>(word->getStartIndex());
      const auto end = static_cast<std::uint32_t>(word->getStopIndex() + 1);
      startsLine = isStartCarried || (list.tokens.empty() && list.comments.empty());
      isStartCarried = false;
      startsLine |=
          text.substr(previousEnd, begin - previousEnd).find('\n') != std::string_view::npos;
      previousEnd = end;
      switch (type) {
      case RtslLexer::LINE_COMMENT:
      case RtslLexer::BLOCK_COMMENT:
        list.comments.push_back({begin, end, startsLine});
        // The token after a comment begins the line if the comment did, or if the comment contains
        // a line break.
        isStartCarried =
            startsLine || text.substr(begin, end - begin).find('\n') != std::string_view::npos;
        break;
      case RtslLexer::UNTERMINATED_COMMENT:
        diagnostics.report(Code::unterminatedComment, range(begin, begin + 2));
        list.isUsable = false;
        isDone = true;
        break;
      case RtslLexer::UNTERMINATED_STRING:
        addString(begin, end);
        break;
      case RtslLexer::MALFORMED_NUMBER:
        addNumber(begin, end);
        break;
      case RtslLexer::DIRECTIVE: {
        // Directives have been processed: this `#` is not at the start of a line, or comes from a
        // macro.
        diagnostics.report(Code::misplacedDirective, range(begin, begin + 1));
        followsMistake = true;
        break;
      }
      case RtslLexer::UNKNOWN_CHARACTERS:
      case RtslLexer::UNKNOWN_CHARACTER:
        refuseCharacters(begin, end);
        break;
      default:
        add(type, begin, end);
      }
    }
  }
  const std::uint32_t end = list.tokens.empty() ? 0 : list.tokens.back().end;
  startsLine = true;
  add(Token::endOfFile, std::max(end, static_cast<std::uint32_t>(text.size())),
      static_cast<std::uint32_t>(text.size()));
  return std::move(list);
}

} // namespace

Diagnostic *reportIfNotText(FileId file, Diagnostics &diagnostics) {
  const std::string_view text = diagnostics.sources().text(file);
  const auto report = [&](std::size_t begin, std::size_t size, const std::string &why) {
    const auto at = static_cast<std::uint32_t>(begin);
    return &diagnostics.report(Code::notText,
                               SourceRange{file, at, at + static_cast<std::uint32_t>(size)}, why);
  };
  if (text.substr(0, 2) == "\xFF\xFE" || text.substr(0, 2) == "\xFE\xFF")
    return &report(0, 2, "it is encoded in UTF-16")->note("save it as UTF-8");
  const std::size_t nul = text.find('\0');
  const std::size_t invalid = findInvalidUtf8(text);
  if (nul < invalid)
    return report(nul, 1, "it holds a NUL byte");
  if (invalid != std::string_view::npos)
    return report(
        invalid, 1,
        fmt::format("the byte \\x{:02X} is not UTF-8", static_cast<unsigned char>(text[invalid])));
  return nullptr;
}

TokenList tokenize(FileId file, Diagnostics &diagnostics) {
  return Tokenizer(file, diagnostics).run();
}

} // namespace rtsl
