//===- Ast.h - the syntax tree of an RTSL file ----------------------------===//
//
// What the author wrote, and nothing that is derived from it: names are text, types are as spelled,
// parentheses and comments above declarations are kept (the C++ printer outputs them again). `sema`
// turns it into the typed tree of sema/typed/TypedAst.h.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/source/Source.h"

#include <memory>
#include <string>
#include <vector>

namespace rtsl::ast {

struct Expr;
struct Stmt;
using ExprPtr = std::unique_ptr<Expr>;
using StmtPtr = std::unique_ptr<Stmt>;

struct Name {
  std::string text;
  SourceRange range;
};

/// One `[n]` or `[]` after a type or a name.
struct ArrayDimension {
  ExprPtr size; // null: `[]`, a buffer
  SourceRange range;
};

/// A type as spelled: `vec3`, `Sphere`, `float[3][2]`. The outermost dimension comes first.
struct TypeName {
  Name name;
  std::vector<ArrayDimension> dimensions;
  SourceRange range;
};

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

enum class ExprKind {
  IntLiteral,
  FloatLiteral,
  BoolLiteral,
  StringLiteral, // only as an argument of print
  Name,
  Paren,
  Unary,
  Binary,
  Assign,
  Conditional,
  Comma,
  Call,
  Construct,
  Member,
  Index,
  InitializerList,
  Error, // where the text could not be parsed; sema reports nothing about it
};

struct Expr {
  const ExprKind kind;
  SourceRange range;
  virtual ~Expr() = default;

protected:
  explicit Expr(ExprKind kind) : kind(kind) {}
};

template <ExprKind K>
struct ExprOf : Expr {
  static constexpr ExprKind Kind = K;
  ExprOf() : Expr(K) {}
};

struct IntLiteral : ExprOf<ExprKind::IntLiteral> {
  std::uint64_t value = 0; // saturated at 2^64-1; sema checks the range
  bool isUnsigned = false; // suffix u
  std::string spelling;
};
struct FloatLiteral : ExprOf<ExprKind::FloatLiteral> {
  std::string spelling; // without suffix
  std::string suffix;   // "", "f", "lf"
};
struct BoolLiteral : ExprOf<ExprKind::BoolLiteral> {
  bool value = false;
};
struct StringLiteral : ExprOf<ExprKind::StringLiteral> {
  std::string value; // escapes resolved
};
struct NameExpr : ExprOf<ExprKind::Name> {
  std::string name;
};
struct ParenExpr : ExprOf<ExprKind::Paren> {
  ExprPtr inner;
};

enum class UnaryOp {
  Plus,
  Minus,
  Not,
  BitNot,
  PreIncrement,
  PreDecrement,
  PostIncrement,
  PostDecrement
};
struct UnaryExpr : ExprOf<ExprKind::Unary> {
  UnaryOp op{};
  SourceRange opRange;
  ExprPtr operand;
};

enum class BinaryOp {
  Mul,
  Div,
  Mod,
  Add,
  Sub,
  Shl,
  Shr,
  Less,
  Greater,
  LessEqual,
  GreaterEqual,
  Equal,
  NotEqual,
  BitAnd,
  BitXor,
  BitOr,
  LogicalAnd,
  LogicalXor,
  LogicalOr
};
struct BinaryExpr : ExprOf<ExprKind::Binary> {
  BinaryOp op{};
  SourceRange opRange;
  ExprPtr left, right;
};

/// `target = value`, or `target op= value` when `compound`.
struct AssignExpr : ExprOf<ExprKind::Assign> {
  bool compound = false;
  BinaryOp op{}; // meaningful when compound
  SourceRange opRange;
  ExprPtr target, value;
};
struct ConditionalExpr : ExprOf<ExprKind::Conditional> {
  ExprPtr condition, whenTrue, whenFalse;
};
struct CommaExpr : ExprOf<ExprKind::Comma> {
  ExprPtr left, right;
};

/// `callee(args)`, `receiver.callee(args)` or `Base::callee(args)`. The callee may also
/// be a type (`vec3(...)`, `Ray(...)`).
struct CallExpr : ExprOf<ExprKind::Call> {
  ExprPtr receiver; // null: a plain call
  Name base;        // class whose definition is called; empty text: that of the object's own class
  Name callee;
  std::vector<ExprPtr> args;
};
/// A constructor whose type has dimensions: `float[3](1, 2, 3)`.
struct ConstructExpr : ExprOf<ExprKind::Construct> {
  TypeName type;
  std::vector<ExprPtr> args;
};
/// `base.name`: a field, a swizzle, or a member of a referenced object.
struct MemberExpr : ExprOf<ExprKind::Member> {
  ExprPtr base;
  Name member;
};
struct IndexExpr : ExprOf<ExprKind::Index> {
  ExprPtr base, index;
};
/// `{a, b, c}` after `=` in a declaration.
struct InitializerListExpr : ExprOf<ExprKind::InitializerList> {
  std::vector<ExprPtr> elements;
};
struct ErrorExpr : ExprOf<ExprKind::Error> {};

//===----------------------------------------------------------------------===//
// Declarations of variables
//===----------------------------------------------------------------------===//

enum class Access { None, Public, Private, Scratch }; // of members
enum class Direction { In, Out, InOut };              // of parameters

/// `in [low, high)`, the values that a member or a parameter of a constructor may have.
struct ValueRange {
  ExprPtr low, high; // null: there is no range
  bool includesLow = false, includesHigh = false;
  SourceRange lowBracket, highBracket;
  SourceRange range; // from `in` on

  bool isGiven() const { return low != nullptr; }
};

/// One declarator: a local, a member, a field of a struct or a parameter. `float a = 1, b[3];`
/// gives two.
struct VariableDecl {
  std::string comment; // the comment directly above, with its markers; empty: none
  Access access = Access::None;
  SourceRange accessRange;
  bool isConst = false;
  SourceRange optionalRange;           // of `optional` on a member; not valid: absent
  Direction direction = Direction::In; // parameters, and members that are output buffers
  SourceRange directionRange;          // of a member's; not valid: absent
  TypeName type; // dimensions after the name are the outer ones: `vec4[2] a[3]` is `vec4[3][2]`
  Name name;     // empty text: an unnamed parameter
  ValueRange values;
  ExprPtr init; // null: none
  SourceRange range;
};

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

enum class StmtKind {
  Compound,
  Declaration,
  Expression,
  If,
  For,
  While,
  DoWhile,
  Switch,
  Case,
  Break,
  Continue,
  Return,
  Illuminance,
  Empty
};

struct Stmt {
  const StmtKind kind;
  SourceRange range;
  std::string comment; // the comment lines directly above the statement
  virtual ~Stmt() = default;

protected:
  explicit Stmt(StmtKind kind) : kind(kind) {}
};

template <StmtKind K>
struct StmtOf : Stmt {
  static constexpr StmtKind Kind = K;
  StmtOf() : Stmt(K) {}
};

struct CompoundStmt : StmtOf<StmtKind::Compound> {
  std::vector<StmtPtr> body;
};
struct DeclarationStmt : StmtOf<StmtKind::Declaration> {
  std::vector<VariableDecl> variables;
};
struct ExpressionStmt : StmtOf<StmtKind::Expression> {
  ExprPtr expr;
};
struct IfStmt : StmtOf<StmtKind::If> {
  ExprPtr condition;
  StmtPtr thenStmt, elseStmt; // else may be null
};
struct ForStmt : StmtOf<StmtKind::For> {
  StmtPtr init;            // declaration, expression or empty
  ExprPtr condition, step; // may be null
  StmtPtr body;
};
struct WhileStmt : StmtOf<StmtKind::While> {
  ExprPtr condition;
  StmtPtr body;
};
struct DoWhileStmt : StmtOf<StmtKind::DoWhile> {
  StmtPtr body;
  ExprPtr condition;
};
/// The body holds `CaseStmt`s as labels between the other statements, as in C.
struct SwitchStmt : StmtOf<StmtKind::Switch> {
  ExprPtr value;
  std::vector<StmtPtr> body;
};
struct CaseStmt : StmtOf<StmtKind::Case> {
  ExprPtr value; // null: default
};
struct BreakStmt : StmtOf<StmtKind::Break> {};
struct ContinueStmt : StmtOf<StmtKind::Continue> {};
struct ReturnStmt : StmtOf<StmtKind::Return> {
  ExprPtr value; // null: none
};
/// `illuminance (P [, N, angle]) statement`.
struct IlluminanceStmt : StmtOf<StmtKind::Illuminance> {
  std::vector<ExprPtr> args;
  StmtPtr body;
};
struct EmptyStmt : StmtOf<StmtKind::Empty> {};

//===----------------------------------------------------------------------===//
// Declarations of a file
//===----------------------------------------------------------------------===//

/// A function or method. `constructor` is an ordinary void function of that name.
struct FunctionDecl {
  std::string comment;
  TypeName returnType;
  Name name;
  std::vector<VariableDecl> parameters;
  std::unique_ptr<CompoundStmt> body; // null: a prototype
  SourceRange range;
};

struct StructDecl {
  std::string comment;
  Name name;
  std::vector<VariableDecl> fields;
  SourceRange range;
};

struct ClassDecl {
  std::string comment;
  Name name;
  Name base;             // empty text: a helper class
  bool fileForm = false; // `class Name : Base;`, members follow to the end of the file
  // of `default`; not valid: absent. Functions of a default class without a body are those that it
  // requires.
  SourceRange defaultRange;
  std::vector<VariableDecl> members;
  std::vector<FunctionDecl> functions;
  SourceRange range;
};

/// `import std.cameras;` (dotted) or `import "glass.rtsl";`.
struct ImportDecl {
  std::string path; // "std.cameras" or "glass.rtsl"
  bool isFile = false;
  SourceRange range;
};

/// One file. Each list is in source order; the ranges give the order between them.
struct TranslationUnit {
  FileId file = 0;
  bool isOfLibrary = false; // the standard library; set by whoever reads the file
  std::string comment;      // at the beginning of the file
  std::vector<ImportDecl> imports;
  std::vector<StructDecl> structs;
  std::vector<VariableDecl> constants; // `const` at file level
  std::vector<FunctionDecl> functions;
  std::vector<ClassDecl> classes;
};

} // namespace rtsl::ast
