//===- TokenStream.h - tokens as the parser reads them --------------------===//
#pragma once

#include "frontend/lex/Token.h"
#include "frontend/source/Source.h"

#include <Token.h>
#include <TokenStream.h>

#include <string_view>

namespace rtsl {

/// A token in the parse tree.
class ParserToken final : public antlr4::Token {
public:
  ParserToken(const rtsl::Token &token, std::size_t index) : token(token), index(index) {}

  const rtsl::Token token;

  std::size_t getType() const override {
    return token.type == rtsl::Token::endOfFile ? antlr4::Token::EOF : token.type;
  }
  std::size_t getTokenIndex() const override { return index; }
  std::size_t getStartIndex() const override { return token.begin; }
  std::size_t getStopIndex() const override { return token.end - std::size_t{1}; }
  std::size_t getChannel() const override { return DEFAULT_CHANNEL; }
  // Messages are written from offsets; the parser library's own texts and lines are never used.
  std::string getText() const override { return {}; }
  std::size_t getLine() const override { return 0; }
  std::size_t getCharPositionInLine() const override { return 0; }
  antlr4::TokenSource *getTokenSource() const override { return nullptr; }
  antlr4::CharStream *getInputStream() const override { return nullptr; }
  std::string toString() const override { return {}; }

private:
  const std::size_t index;
};

/// The tokens of a text, all in memory. The last one is the end of the file; reading never goes
/// beyond it.
class TokenStream final : public antlr4::TokenStream {
public:
  explicit TokenStream(const std::vector<rtsl::Token> &all) {
    tokens.reserve(all.size());
    for (const rtsl::Token &token : all)
      tokens.emplace_back(token, tokens.size());
  }

  ParserToken *at(std::size_t index) {
    return &tokens[index < tokens.size() ? index : tokens.size() - 1];
  }

  void consume() override { position += position + 1 < tokens.size(); }
  std::size_t LA(ssize_t i) override {
    const antlr4::Token *token = LT(i);
    return token ? token->getType() : 0;
  }
  antlr4::Token *LT(ssize_t k) override {
    if (k > 0)
      return at(position + static_cast<std::size_t>(k) - 1);
    const auto back = static_cast<std::size_t>(-k);
    return k == 0 || back > position ? nullptr : at(position - back);
  }
  antlr4::Token *get(std::size_t index) const override {
    return const_cast<TokenStream *>(this)->at(index);
  }
  ssize_t mark() override { return 0; }
  void release(ssize_t) override {}
  std::size_t index() override { return position; }
  void seek(std::size_t index) override { position = at(index)->getTokenIndex(); }
  std::size_t size() override { return tokens.size(); }
  std::string getSourceName() const override { return "text"; }
  antlr4::TokenSource *getTokenSource() const override { return nullptr; }
  std::string getText(const antlr4::misc::Interval &) override { return {}; }
  std::string getText() override { return {}; }
  std::string getText(antlr4::RuleContext *) override { return {}; }
  std::string getText(antlr4::Token *, antlr4::Token *) override { return {}; }

private:
  std::vector<ParserToken> tokens;
  std::size_t position = 0;
};

} // namespace rtsl
