//===- AstBuilder.h - parse tree to syntax tree ---------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "frontend/lex/Token.h"
#include "frontend/syntax/Ast.h"

#include "grammar/RtslParser.h"

#include <string_view>
#include <vector>

namespace rtsl {

/// Qualifiers before a declaration.
struct Qualifiers {
  ast::Access access = ast::Access::None;
  bool isConst = false;
  ast::Direction direction = ast::Direction::In;
  SourceRange accessRange, constRange, optionalRange, directionRange; // not valid: absent
};

/// Turns the items of a parsed file into the syntax tree, one after the other, and reports what the
/// grammar accepts but the tree cannot express. Broken parts (those with an exception) are left out
/// or become `ErrorExpr`.
class AstBuilder {
public:
  using Parser = generated::RtslParser;

  /// `tokens` are the tokens that the parser read; `comments` those between them.
  AstBuilder(FileId file, const std::vector<Token> &tokens, const std::vector<Comment> &comments,
             Diagnostics &diagnostics);

  void addItem(Parser::FileItemContext *item);
  std::unique_ptr<ast::TranslationUnit> finish();

private:
  enum class Place { File, Member, MemberOfDefault, Field, Local, Parameter };

  static Place placeIn(const ast::ClassDecl &owner) {
    return owner.defaultRange.isValid() ? Place::MemberOfDefault : Place::Member;
  }

  // Ranges (AstBuilder.cpp).
  SourceRange range(const antlr4::ParserRuleContext *context) const;
  SourceRange range(const antlr4::Token *token) const;
  SourceRange range(antlr4::tree::TerminalNode *node) const { return range(node->getSymbol()); }
  std::string text(SourceRange range) const { return std::string(sources.text(range)); }
  ast::Name name(antlr4::tree::TerminalNode *node) const;
  std::string commentAbove(const antlr4::ParserRuleContext *context) const;
  std::string commentText(std::size_t first, std::size_t last) const;

  // Declarations (AstDeclarations.cpp).
  void addImport(Parser::ImportDeclarationContext *context);
  void addStruct(Parser::StructDeclarationContext *context);
  void addClass(Parser::ClassDeclarationContext *context);
  bool addDeclaration(Parser::DeclarationContext *context, Place place,
                      std::vector<ast::VariableDecl> &variables,
                      std::vector<ast::FunctionDecl> *functions);
  void addFunction(Parser::DeclarationContext *context, Place place,
                   std::vector<ast::FunctionDecl> &functions);
  void addVariables(const antlr4::ParserRuleContext *context,
                    const std::vector<Parser::QualifierContext *> &qualifiers,
                    Parser::TypeNameContext *typeName,
                    const std::vector<Parser::DeclaratorContext *> &declarators, Place place,
                    std::vector<ast::VariableDecl> &variables);
  Qualifiers buildQualifiers(const std::vector<Parser::QualifierContext *> &contexts, Place place);
  SourceRange removal(SourceRange where) const;
  void refuseQualifier(SourceRange where, const std::string &reason);
  void refuseVariable(SourceRange where, const std::string &reason);
  void refuseForeign(SourceRange where, const char *replacement);
  ast::TypeName buildType(Parser::TypeNameContext *context,
                          const std::vector<Parser::DimensionContext *> &outer = {});
  void addDimensions(const std::vector<Parser::DimensionContext *> &contexts,
                     std::vector<ast::ArrayDimension> &dimensions);
  ast::ValueRange buildRange(Parser::RangeContext *context, Place place);
  ast::VariableDecl buildParameter(Parser::ParameterContext *context);
  void checkFollowsFileClass(SourceRange where, const char *what);

  // Statements (AstStatements.cpp).
  ast::StmtPtr buildStatement(Parser::StatementContext *context);
  ast::StmtPtr buildStatementBody(Parser::StatementContext *context);
  ast::StmtPtr buildSimple(Parser::SimpleStatementContext *context);
  ast::StmtPtr orEmpty(Parser::StatementContext *context);
  std::unique_ptr<ast::CompoundStmt> buildBlock(Parser::BlockContext *context);
  std::vector<ast::StmtPtr> buildBody(const std::vector<Parser::StatementContext *> &contexts);
  template <typename T>
  std::unique_ptr<T> make(const antlr4::ParserRuleContext *context) const {
    auto node = std::make_unique<T>();
    node->range = range(context);
    return node;
  }

  // Expressions (AstExpressions.cpp).
  ast::ExprPtr buildExpression(Parser::ExpressionContext *context);
  ast::ExprPtr buildCondition(Parser::ConditionContext *context, SourceRange owner);
  ast::ExprPtr buildExpr(Parser::ExprContext *context);
  ast::ExprPtr buildLiteral(Parser::LiteralContext *context);
  ast::ExprPtr buildCall(Parser::CallContext *context);
  ast::ExprPtr buildConstruct(Parser::CallContext *context);
  ast::ExprPtr buildIndex(Parser::IndexContext *context);
  ast::ExprPtr buildConditionalOrAssignment(Parser::ConditionalOrAssignmentContext *context);
  ast::ExprPtr buildInitializer(Parser::InitializerContext *context);
  std::vector<ast::ExprPtr> buildArguments(Parser::ArgumentsContext *context);
  ast::ExprPtr error(SourceRange where) const;

  const FileId file;
  const std::vector<Token> &tokens;
  const std::vector<Comment> &comments;
  Diagnostics &diagnostics;
  const SourceManager &sources;
  std::unique_ptr<ast::TranslationUnit> unit;
  bool hasFileClass = false;  // `class Name : Base;`, the last class of the unit
  bool hasBrokenItem = false; // at file level
};

} // namespace rtsl
