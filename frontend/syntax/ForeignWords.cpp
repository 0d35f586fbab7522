//===- ForeignWords.cpp - constructs of other languages, before parsing ---===//
#include "frontend/syntax/ForeignWords.h"

#include "grammar/RtslLexer.h"

#include <algorithm>

namespace rtsl {

namespace {

using generated::RtslLexer;

/// Qualifiers of GLSL, HLSL, CUDA and C++, and the type of the RTSL qualifier to use
/// instead (0: none).
struct ForeignQualifier {
  std::string_view name;
  std::uint16_t replacement = 0;
};
constexpr ForeignQualifier foreignQualifiers[] = {
    {"uniform", RtslLexer::PUBLIC},
    {"varying", RtslLexer::SCRATCH},
    {"attribute", RtslLexer::SCRATCH},
    {"constexpr", RtslLexer::CONST},
    {"static"},
    {"inline"},
    {"extern"},
    {"volatile"},
    {"flat"},
    {"smooth"},
    {"noperspective"},
    {"nointerpolation"},
    {"centroid"},
    {"invariant"},
    {"precise"},
    {"coherent"},
    {"restrict"},
    {"readonly"},
    {"writeonly"},
    {"row_major"},
    {"column_major"},
    {"groupshared"},
    {"virtual"},
    {"override"},
    {"register"},
    {"mutable"},
    {"explicit"},
    {"friend"},
    {"__host__"},
    {"__device__"},
    {"__global__"},
    {"__constant__"},
    {"__shared__"},
    {"__forceinline__"},
    {"__noinline__"},
    {"__inline__"},
    {"__restrict__"},
    {"RT_PROGRAM"},
    {"RT_CALLABLE_PROGRAM"},
    {"rayPayloadEXT"},
    {"rayPayloadInEXT"},
    {"hitAttributeEXT", RtslLexer::SCRATCH},
};

/// Tokens of which C forms the names of its types, such as `unsigned int`.
bool isWordOfType(std::string_view word) {
  return word == "unsigned" || word == "signed" || word == "long" || word == "short" ||
         word == "int" || word == "char" || word == "double";
}

/// A scalar, vector or matrix type, in RTSL or elsewhere.
bool isTypeOfNumbers(std::string_view word) {
  if (isWordOfType(word))
    return true;
  for (std::string_view scalar : {"void", "bool", "float", "uint", "half", "color"})
    if (word == scalar)
      return true;
  const std::size_t digit = word.find_first_of("234");
  if (digit == std::string_view::npos ||
      word.find_first_not_of("234x", digit) != std::string_view::npos)
    return false;
  for (std::string_view vector :
       {"vec", "ivec", "uvec", "bvec", "mat", "float", "int", "uint", "half"})
    if (word.substr(0, digit) == vector)
      return true;
  return false;
}

bool isQualifier(unsigned type) {
  return type >= RtslLexer::PUBLIC && type <= RtslLexer::INOUT;
}

bool isLiteral(unsigned type) {
  return type == RtslLexer::TRUE || type == RtslLexer::FALSE || type == RtslLexer::INT_LITERAL ||
         type == RtslLexer::FLOAT_LITERAL;
}

/// The first token of an expression, other than signs and brackets.
bool isPlainOperand(unsigned type) {
  return type == RtslLexer::IDENTIFIER || isLiteral(type);
}

/// Rewriting the operand of a cast must be fast even if casts are nested.
constexpr std::size_t longestOperand = 200;

} // namespace

bool isOpening(unsigned type) {
  return type == RtslLexer::LEFT_PAREN || type == RtslLexer::LEFT_BRACKET ||
         type == RtslLexer::LEFT_BRACE;
}

bool isClosing(unsigned type) {
  return type == RtslLexer::RIGHT_PAREN || type == RtslLexer::RIGHT_BRACKET ||
         type == RtslLexer::RIGHT_BRACE;
}

//===----------------------------------------------------------------------===//
// Positions of tokens
//===----------------------------------------------------------------------===//

/// The tokens and the space after them.
SourceRange ForeignWords::removal(std::size_t index, std::size_t count) const {
  const Token &next = at(index + count);
  const std::uint32_t lastEnd = at(index + count - 1).end;
  const bool isLast = next.startsLine || next.type == Token::endOfFile;
  return {file, at(index).begin, isLast ? lastEnd : next.begin};
}

bool ForeignWords::isDeclarationStart() const {
  const unsigned previous = before();
  return isStatementStart() || previous == RtslLexer::LEFT_PAREN ||
         previous == RtslLexer::RIGHT_PAREN || previous == RtslLexer::COMMA ||
         previous == RtslLexer::COLON || isQualifier(previous);
}

bool ForeignWords::isStatementStart() const {
  const unsigned previous = before();
  return previous == Token::endOfFile || previous == RtslLexer::SEMICOLON ||
         previous == RtslLexer::LEFT_BRACE || previous == RtslLexer::RIGHT_BRACE;
}

/// True if the previous token cannot be the end of an expression.
bool ForeignWords::expectsOperand() const {
  const unsigned previous = before();
  return !isPlainOperand(previous) && previous != RtslLexer::RIGHT_PAREN &&
         previous != RtslLexer::RIGHT_BRACKET && previous != RtslLexer::PLUS_PLUS &&
         previous != RtslLexer::MINUS_MINUS && previous != RtslLexer::STRING_LITERAL;
}

/// Are there two tokens of these types at `index`, without a space between them?
bool ForeignWords::touches(std::size_t index, unsigned first, unsigned second) const {
  return typeAt(index) == first && typeAt(index + 1) == second &&
         at(index).end == at(index + 1).begin;
}

/// Index of the token after the brackets that open at `index`, or of the end of the file.
std::size_t ForeignWords::afterBrackets(std::size_t index) const {
  std::size_t depth = 0;
  for (; typeAt(index) != Token::endOfFile; ++index) {
    depth += isOpening(typeAt(index));
    if (isClosing(typeAt(index)) && --depth == 0)
      return index + 1;
  }
  return index;
}

/// Index of the token after the statement or declaration that contains `index`: after its semicolon
/// or block.
std::size_t ForeignWords::afterStatement(std::size_t index) const {
  while (typeAt(index) != Token::endOfFile && !isClosing(typeAt(index))) {
    if (typeAt(index) == RtslLexer::SEMICOLON)
      return index + 1;
    const bool isBlock = typeAt(index) == RtslLexer::LEFT_BRACE;
    index = isOpening(typeAt(index)) ? afterBrackets(index) : index + 1;
    if (isBlock)
      return typeAt(index) == RtslLexer::SEMICOLON ? index + 1 : index;
  }
  return index;
}

/// Index of the token after `p.x`, `f(a)[i]` and the like.
std::size_t ForeignWords::afterOperand(std::size_t index) const {
  for (std::size_t begin = index; isCast(index); index += 3)
    if (index - begin > longestOperand)
      return in.size();
  index = typeAt(index) == RtslLexer::LEFT_PAREN ? afterBrackets(index) : index + 1;
  for (;;) {
    if (typeAt(index) == RtslLexer::LEFT_PAREN || typeAt(index) == RtslLexer::LEFT_BRACKET)
      index = afterBrackets(index);
    else if (typeAt(index) == RtslLexer::DOT && typeAt(index + 1) == RtslLexer::IDENTIFIER)
      index += 2;
    else
      return index;
  }
}

std::size_t ForeignWords::wordsOfType(std::size_t index) const {
  const auto isPart = [&](std::size_t word) {
    return typeAt(word) == RtslLexer::IDENTIFIER && isWordOfType(textOf(at(word)));
  };
  std::size_t count = 1;
  while (isPart(index) && isPart(index + count) &&
         at(index + count).begin == at(index + count - 1).end + 1)
    ++count;
  return count;
}

//===----------------------------------------------------------------------===//
// Qualifiers and attributes
//===----------------------------------------------------------------------===//

/// `highp vec3 n`, `precision mediump float;`. Elsewhere these are ordinary names.
std::size_t ForeignWords::skipPrecision(std::size_t index) {
  const auto isQualifier = [&](std::size_t word) {
    const std::string_view text = textOf(at(word));
    return text == "highp" || text == "mediump" || text == "lowp";
  };
  if (isQualifier(index) && isDeclarationStart() && typeAt(index + 1) == RtslLexer::IDENTIFIER &&
      typeAt(index + 2) == RtslLexer::IDENTIFIER) {
    diagnostics.report(Code::precisionQualifier, rangeOf(at(index)))
        .fix(removal(index, 1), "", true);
    return 1;
  }
  if (textOf(at(index)) != "precision" || !isStatementStart() || !isQualifier(index + 1))
    return 0;
  std::size_t count = 2;
  if (typeAt(index + count) == RtslLexer::IDENTIFIER)
    ++count;
  if (typeAt(index + count) == RtslLexer::SEMICOLON)
    ++count;
  diagnostics
      .report(Code::precisionQualifier, rangeOf(at(index)).to(rangeOf(at(index + count - 1))))
      .fix(removal(index, count), "", true);
  return count;
}

std::size_t ForeignWords::skipAccess(std::size_t index) {
  const Token &token = at(index);
  const bool isAccess = token.type == RtslLexer::PUBLIC || token.type == RtslLexer::PRIVATE;
  if (isAccess && before() == RtslLexer::COLON && before(3) == RtslLexer::CLASS) {
    diagnostics
        .report(Code::misplacedQualifier, rangeOf(token), textOf(token),
                "RTSL has only one kind of inheritance")
        .fix(removal(index, 1), "", true);
    return 1;
  }
  if ((isAccess || token.type == RtslLexer::SCRATCH) && typeAt(index + 1) == RtslLexer::COLON) {
    diagnostics.report(Code::misplacedQualifier, rangeOf(token).to(rangeOf(at(index + 1))),
                       fmt::format("{}:", textOf(token)),
                       fmt::format("write `{}` before each member", textOf(token)));
    return 2;
  }
  return 0;
}

std::size_t ForeignWords::skipQualifier(std::size_t index) {
  const Token &token = at(index);
  const std::string_view word = textOf(token);
  // `[unroll]`, `[[nodiscard]]`: no statement begins with a bracket.
  if (token.type == RtslLexer::LEFT_BRACKET && isStatementStart()) {
    const std::size_t count = afterBrackets(index) - index;
    diagnostics
        .report(Code::foreignConstruct, rangeOf(token).to(rangeOf(at(index + count - 1))),
                "attributes")
        .fix(removal(index, count), "", true);
    return count;
  }
  // `const T &x`: parameters are passed by value.
  if (token.type == RtslLexer::AMPERSAND && before() == RtslLexer::IDENTIFIER &&
      before(2) == RtslLexer::CONST && typeAt(index + 1) == RtslLexer::IDENTIFIER) {
    Diagnostic &diagnostic = diagnostics.report(Code::foreignQualifier, rangeOf(token), "&");
    const bool isBetween = out.back().end < token.begin && token.end < at(index + 1).begin;
    if (out.back().end == token.begin && token.end == at(index + 1).begin)
      diagnostic.fix(rangeOf(token), " ", true);
    else
      diagnostic.fix(isBetween ? removal(index, 1) : rangeOf(token), "", true);
    diagnostic.note("parameters are copies; `inout` copies the value back to the caller");
    return 1;
  }
  // After the parameters of a method.
  const auto isSuffix = [&](std::size_t at) {
    const std::string_view suffix = textOf(this->at(at));
    return typeAt(at) == RtslLexer::CONST || suffix == "override" || suffix == "final" ||
           suffix == "noexcept";
  };
  if (isSuffix(index) && before() == RtslLexer::RIGHT_PAREN &&
      (typeAt(index + 1) == RtslLexer::LEFT_BRACE || typeAt(index + 1) == RtslLexer::SEMICOLON ||
       isSuffix(index + 1))) {
    diagnostics.report(Code::foreignQualifier, rangeOf(token), word)
        .fix(removal(index, 1), "", true);
    return 1;
  }
  if (token.type != RtslLexer::IDENTIFIER || !isDeclarationStart())
    return 0;
  const unsigned next = typeAt(index + 1);
  if (word == "extern" && next == RtslLexer::STRING_LITERAL) {
    diagnostics
        .report(Code::foreignQualifier, rangeOf(token).to(rangeOf(at(index + 1))), "extern \"C\"")
        .fix(removal(index, 2), "", true);
    return 2;
  }
  if (word == "layout" && next == RtslLexer::LEFT_PAREN) {
    const std::size_t after = afterBrackets(index + 1);
    if (typeAt(after) != RtslLexer::IDENTIFIER && !isQualifier(typeAt(after)))
      return 0; // a call
    diagnostics.report(Code::foreignQualifier, rangeOf(token), word)
        .fix(removal(index, after - index), "", true);
    return after - index;
  }
  // Two names in a row are a type and what it declares; the first of three is a qualifier.
  if ((next != RtslLexer::IDENTIFIER && !isQualifier(next)) ||
      typeAt(index + 2) != RtslLexer::IDENTIFIER)
    return 0;
  for (const ForeignQualifier &foreign : foreignQualifiers) {
    if (word != foreign.name)
      continue;
    if (foreign.replacement != 0) { // which is right in some places, and reported there
      in[index].type = foreign.replacement;
      in[index].isForeign = true;
      return 0;
    }
    diagnostics.report(Code::foreignQualifier, rangeOf(token), word)
        .fix(removal(index, 1), "", true);
    return 1;
  }
  return 0;
}

//===----------------------------------------------------------------------===//
// Constructs
//===----------------------------------------------------------------------===//

/// `std::`. Another name before a function is that of a base class.
std::size_t ForeignWords::skipNamespace(std::size_t index) {
  const bool isNamed = typeAt(index) == RtslLexer::IDENTIFIER;
  const std::size_t colons = index + (isNamed ? 1 : 0);
  if (typeAt(colons) != RtslLexer::COLON_COLON || typeAt(colons + 1) != RtslLexer::IDENTIFIER ||
      (!isNamed && before() == RtslLexer::IDENTIFIER)) // the previous token has been checked
    return 0;
  const std::string_view word = isNamed ? textOf(at(index)) : std::string_view();
  bool isKnown = false;
  for (std::string_view name : {"std", "glm", "optix", "optixu", "rtsl", "metal", "hlsl", "vk"})
    isKnown |= word == name;
  if (isNamed && !isKnown && typeAt(colons + 2) != RtslLexer::COLON_COLON)
    return 0;
  diagnostics
      .report(Code::foreignConstruct, rangeOf(at(index)).to(rangeOf(at(colons))), "namespaces")
      .fix({file, at(index).begin, at(colons + 1).begin}, "", isKnown);
  return colons + 1 - index;
}

/// True if the previous token, which may be a type, begins a declaration. Variables may have such
/// names, too: `f(x, double * y)`.
bool ForeignWords::isBehindType() const {
  const unsigned previous = before(2);
  if (previous != RtslLexer::LEFT_PAREN && previous != RtslLexer::COMMA)
    return previous == Token::endOfFile || previous == RtslLexer::SEMICOLON ||
           previous == RtslLexer::LEFT_BRACE || previous == RtslLexer::RIGHT_BRACE ||
           isQualifier(previous);
  // For parameters: preceded by a type, a name and a parenthesis.
  std::size_t open = 2, depth = 0;
  for (; open < longestOperand && open < out.size() &&
         (depth != 0 || before(open) != RtslLexer::LEFT_PAREN);
       ++open)
    depth += isClosing(before(open)) ? 1u : isOpening(before(open)) ? -1u : 0u;
  return before(open) == RtslLexer::LEFT_PAREN && before(open + 1) == RtslLexer::IDENTIFIER &&
         before(open + 2) == RtslLexer::IDENTIFIER;
}

/// `float *p`, `&x` and `*p`
std::size_t ForeignWords::skipPointer(std::size_t index) {
  const unsigned type = typeAt(index);
  if (type != RtslLexer::STAR && type != RtslLexer::AMPERSAND)
    return 0;
  const unsigned next = typeAt(index + 1);
  if (type == RtslLexer::STAR && before() == RtslLexer::STAR && out.back().end == at(index).begin) {
    diagnostics
        .report(Code::foreignConstruct, rangeOf(out.back()).to(rangeOf(at(index))), "operator `**`")
        .note("write `pow(x, y)`");
    return 1;
  }
  if (type == RtslLexer::STAR && touches(index, RtslLexer::STAR, RtslLexer::STAR) &&
      !expectsOperand())
    return 0; // the second `*` is reported
  const bool isDeclared = before() == RtslLexer::IDENTIFIER && next == RtslLexer::IDENTIFIER &&
                          isTypeOfNumbers(textOf(out.back())) && isBehindType();
  const bool isPrefix = expectsOperand() && !isDeclarationStart() && next == RtslLexer::IDENTIFIER;
  const bool isArgument = expectsOperand() &&
                          (before() == RtslLexer::LEFT_PAREN || before() == RtslLexer::COMMA) &&
                          next == RtslLexer::IDENTIFIER;
  const bool isStatement =
      type == RtslLexer::STAR && isStatementStart() && next == RtslLexer::IDENTIFIER;
  if (!isDeclared && !isPrefix && !isArgument && !isStatement)
    return 0;
  const bool isReference = isDeclared && type == RtslLexer::AMPERSAND;
  diagnostics
      .report(Code::foreignConstruct, rangeOf(at(index)),
              isReference ? "references to values" : "pointers")
      .fix(rangeOf(at(index)), "")
      .note("parameters are copies; `inout` copies the value back to the caller");
  return 1;
}

/// The beginning of a statement or declaration of another language.
std::size_t ForeignWords::skipConstruct(std::size_t index) {
  const Token &token = at(index);
  const unsigned next = typeAt(index + 1);
  // `float4 main() : SV_Target {`
  if (token.type == RtslLexer::COLON && before() == RtslLexer::RIGHT_PAREN &&
      next == RtslLexer::IDENTIFIER && typeAt(index + 2) == RtslLexer::LEFT_BRACE) {
    diagnostics
        .report(Code::foreignConstruct, rangeOf(token).to(rangeOf(at(index + 1))), "semantics")
        .fix(removal(index, 2), "", true);
    return 2;
  }
  const std::string_view word = textOf(token);
  if (word == "new" && expectsOperand() && !isDeclarationStart() && next == RtslLexer::IDENTIFIER) {
    diagnostics.report(Code::foreignConstruct, rangeOf(token), "`new`")
        .fix(removal(index, 1), "", true);
    return 1;
  }
  if (token.type != RtslLexer::IDENTIFIER || !isStatementStart())
    return 0;
  const bool opensBlock =
      next == RtslLexer::LEFT_BRACE ||
      (next == RtslLexer::IDENTIFIER &&
       (typeAt(index + 2) == RtslLexer::LEFT_BRACE || typeAt(index + 2) == RtslLexer::COLON));
  const auto report = [&](const char *what, const char *instead, bool sure = false) {
    const std::size_t after = afterStatement(index + 1);
    Diagnostic &diagnostic = diagnostics.report(Code::foreignConstruct, rangeOf(token), what);
    if (sure)
      diagnostic.fix(removal(index, after - index), "", true);
    if (*instead)
      diagnostic.note(instead);
    return after - index;
  };
  if (word == "using" && next == RtslLexer::IDENTIFIER && textOf(at(index + 1)) == "namespace")
    return report("namespaces", "", true);
  if (word == "namespace" && opensBlock)
    return report("namespaces", "all files share one namespace");
  if (word == "typedef" && next == RtslLexer::IDENTIFIER &&
      typeAt(index + 2) == RtslLexer::IDENTIFIER)
    return report("type aliases", "");
  if (word == "typedef" && next == RtslLexer::STRUCT) { // struct S { ... } T;
    const std::size_t count = report("type aliases", "write `struct Name { ... };`");
    return typeAt(index + count) == RtslLexer::IDENTIFIER ? afterStatement(index + count) - index
                                                          : count;
  }
  if (word == "enum" && (opensBlock || next == RtslLexer::CLASS))
    return report("enumerations", "write constants: `const int A = 0, B = 1;`");
  if (word == "union" && opensBlock)
    return report("unions",
                  "`floatBitsToInt` and similar functions reinterpret the bits of a number");
  if ((word == "cbuffer" || word == "tbuffer") && opensBlock)
    return report("constant buffers", "what a scene sets is a member: `public float roughness;`");
  if (word == "template" && next == RtslLexer::LESS)
    return report("templates", "overload a function for each type");
  if (word == "try" && next == RtslLexer::LEFT_BRACE) {
    diagnostics.report(Code::foreignConstruct, rangeOf(token), "`try`");
    return 1;
  }
  if (word == "catch" && next == RtslLexer::LEFT_PAREN &&
      typeAt(afterBrackets(index + 1)) == RtslLexer::LEFT_BRACE)
    return afterStatement(index + 1) - index; // after a `try`, which is reported
  if (word == "throw" && isLiteral(next))
    return report("`throw`", "");
  for (std::string_view buffer :
       {"rtBuffer", "StructuredBuffer", "RWStructuredBuffer", "Buffer", "RWBuffer", "vector"})
    if (word == buffer && next == RtslLexer::LESS && typeAt(index + 2) == RtslLexer::IDENTIFIER)
      return report("templates", "a buffer is an unsized array member: `public vec3 vertices[];`");
  return 0;
}

//===----------------------------------------------------------------------===//
// Operators and casts, which are rewritten
//===----------------------------------------------------------------------===//

void ForeignWords::rewriteOperator(std::size_t index) {
  Token &token = in[index];
  const auto report = [&](const char *expected, SourceRange replaced) {
    diagnostics
        .report(Code::unexpectedToken, rangeOf(token), fmt::format("`{}`", expected),
                fmt::format("`{}`", textOf(token)))
        .fix(replaced, expected, true);
  };
  if (token.type != RtslLexer::IDENTIFIER || !isPlainOperand(typeAt(index + 1)))
    return;
  const std::string_view word = textOf(token);
  const bool isBehindOperand =
      isLiteral(before()) || before() == RtslLexer::RIGHT_PAREN ||
      (before() == RtslLexer::IDENTIFIER && typeAt(index + 1) != Token::endOfFile);
  if ((word == "and" || word == "or") && isBehindOperand) {
    report(word == "and" ? "&&" : "||", rangeOf(token));
    token.type = word == "and" ? RtslLexer::AND_AND : RtslLexer::OR_OR;
    return;
  }
  const unsigned previous = before();
  const bool isInExpression = previous == RtslLexer::ASSIGN || previous == RtslLexer::AND_AND ||
                              previous == RtslLexer::OR_OR || previous == RtslLexer::RETURN ||
                              (previous == RtslLexer::LEFT_PAREN &&
                               (before(2) == RtslLexer::IF || before(2) == RtslLexer::WHILE));
  if (word == "not" && isInExpression) {
    report("!", removal(index, 1));
    token.type = RtslLexer::NOT;
  }
}

/// Is it `(float)`, followed by an operand?
bool ForeignWords::isCast(std::size_t index) const {
  return typeAt(index) == RtslLexer::LEFT_PAREN && typeAt(index + 1) == RtslLexer::IDENTIFIER &&
         typeAt(index + 2) == RtslLexer::RIGHT_PAREN && isTypeOfNumbers(textOf(at(index + 1))) &&
         (isPlainOperand(typeAt(index + 3)) || typeAt(index + 3) == RtslLexer::LEFT_PAREN);
}

/// Rewrites `(float) x` as `float(x)`.
void ForeignWords::rewriteCast(std::size_t index) {
  if (!isCast(index) || !expectsOperand() || before() == Token::endOfFile)
    return;
  const std::size_t after = afterOperand(index + 3);
  if (typeAt(after) == Token::endOfFile || after - index > longestOperand)
    return;
  const Token opening = at(index), type = at(index + 1), closing = at(index + 2);
  const std::uint32_t end = at(after - 1).end;
  diagnostics.report(Code::foreignConstruct, rangeOf(opening).to(rangeOf(closing)), "casts")
      .fix({file, opening.begin, at(index + 3).begin}, fmt::format("{}(", textOf(type)), true)
      .fix({file, end, end}, ")", true);
  in[index] = type;
  in[index].startsLine = opening.startsLine;
  in[index + 1] = opening;
  in[index + 1].begin = closing.begin;
  in[index + 1].end = closing.end;
  in[index + 1].startsLine = false;
  std::copy(in.begin() + static_cast<std::ptrdiff_t>(index) + 3,
            in.begin() + static_cast<std::ptrdiff_t>(after),
            in.begin() + static_cast<std::ptrdiff_t>(index) + 2);
  in[after - 1] = closing;
  in[after - 1].begin = in[after - 1].end = end;
  in[after - 1].startsLine = false;
}

std::size_t ForeignWords::skip(std::size_t index) {
  if (touches(index, RtslLexer::MINUS, RtslLexer::GREATER) && !expectsOperand() &&
      typeAt(index + 2) == RtslLexer::IDENTIFIER) {
    const SourceRange arrow = rangeOf(at(index)).to(rangeOf(at(index + 1)));
    diagnostics.report(Code::unexpectedToken, arrow, "`.`", "`->`").fix(arrow, ".", true);
    in[index + 1].type = RtslLexer::DOT;
    return 1;
  }
  rewriteCast(index);
  rewriteOperator(index);
  for (auto part :
       {&ForeignWords::skipPrecision, &ForeignWords::skipAccess, &ForeignWords::skipConstruct,
        &ForeignWords::skipQualifier, &ForeignWords::skipNamespace, &ForeignWords::skipPointer})
    if (const std::size_t count = (this->*part)(index))
      return count;
  return 0;
}

} // namespace rtsl
