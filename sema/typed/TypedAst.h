//===- TypedAst.h - the program after checking ----------------------------===//
//
// Every name is resolved, every expression has a type, every implicit conversion is a node, and
// required constant expressions are folded. Lowering does not need the source; printers keep the
// author's names.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/syntax/Ast.h"
#include "language/Range.h"
#include "sema/typed/Builtin.h"
#include "sema/typed/Type.h"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace rtsl::typed {

struct Expr;
struct Stmt;
struct Function;
struct Class;
using ExprPtr = std::unique_ptr<Expr>;
using StmtPtr = std::unique_ptr<Stmt>;

/// The rt_ variables; `RayOrigin` is rt_RayOrigin.
enum class StateVariable : std::uint8_t {
#define RTSL_STATE_VARIABLE(name, type, ...) name,
#include "language/StateVariables.def"
};
const char *name(StateVariable variable); // without rt_

/// A value known at compile time: the scalars of its type in order (vectors by component, matrices
/// by column, structs and arrays by element; color one value, or three for an RGB triple).
struct Constant {
  union Scalar {
    float f;
    std::int32_t i;
    std::uint32_t u;
    bool b;
  };
  std::vector<Scalar> scalars;
};

//===----------------------------------------------------------------------===//
// Named entities
//===----------------------------------------------------------------------===//

/// A local variable, a parameter or a constant at file level.
struct Variable {
  enum class Kind : std::uint8_t { Local, Parameter, Global };
  Kind kind = Kind::Local;
  std::string name; // empty: an unnamed parameter
  const Type *type = nullptr;
  bool isConst = false;
  ast::Direction direction = ast::Direction::In; // parameters
  std::optional<Range> values; // of a constructor's parameter: which its components may have
  std::unique_ptr<Constant>
      constant; // const with a known value: uses become literals, except for arrays and structs
  ExprPtr init; // globals: always a constant expression
  SourceRange range; // of the name
  std::string comment;
};

struct Field {
  std::string name;
  const Type *type = nullptr;
  SourceRange range;
  std::string comment;
};

struct Struct {
  std::string name;
  std::vector<Field> fields;
  SourceRange range; // of the name
  std::string comment;
};

struct Member {
  ast::Access access = ast::Access::Private; // Public, Private, Scratch, or None for const
  std::string name;
  const Type *type = nullptr;
  bool isConst = false;
  bool isOptional = false; // a public reference, or references, that the scene may leave empty
  std::unique_ptr<Constant> constant; // const members
  std::optional<Range> values;        // which each of its components may have
  ExprPtr init;                       // default of a public or private member; null: none (zero)
  const Class *owner = nullptr;
  /// For a scratch member that sema/derive has added: the member whose change it is, along an axis
  /// of the footprint, 0 or 1. Null: it is the author's.
  const Member *changeOf = nullptr;
  int axis = 0;
  SourceRange range;
  std::string comment;
};

/// Rays that something may send.
struct SentRays {
  bool traced = false; // by `trace`
  bool shadow = false; // for lights, by `illuminance` or `illuminate`

  bool any() const { return traced || shadow; }
};

struct Function {
  std::string name;
  const Type *returnType = nullptr;
  std::vector<std::unique_ptr<Variable>> parameters;
  std::vector<std::unique_ptr<Variable>> locals; // all locals of the body, in order of declaration
  StmtPtr body;                                  // a CompoundStmt
  const Class *owner = nullptr;                  // methods
  bool isConstructor = false;
  bool isCalledOnSelf =
      false;                  // a method that other methods of the object call, not only the engine
  bool isRequired = false;    // declared by a default class, without a body
  bool isStateMethod = false; // overrides an engine method of its base class: intersect, shade, ...
  bool knowsNoChanges = false; // scratchChangesMethod of an `intersect` that cannot be followed
  SentRays sends;              // by itself or its callees, and by methods that override these
  SentRays callSends;          // by a call of it, which may run an overriding method
  bool mayRunInLookup = false; // reachable from a texture's `lookup`
  SourceRange range;           // of the name
  std::string comment;
};

/// A method of primitives that sema/derive adds: the changes of scratch members.
inline constexpr const char *scratchChangesMethod = "rt_computeChanges";

/// The root of a class that derives from no rt_ class.
inline constexpr const char *helperRoot = "helper class";

struct Class {
  std::string name;
  const Class *base = nullptr; // another user class; null: derives from `root` directly
  std::string root;            // "rt_Primitive", or helperRoot
  std::vector<std::unique_ptr<Member>> members;     // its own
  std::vector<std::unique_ptr<Function>> functions; // its own: methods, constructor, helpers
  SourceRange range;
  std::string comment;

  /// The definition that an object of this class uses, searched along the bases; null if there is
  /// none.
  const Function *findMethod(const std::string &name) const;
  bool derivesFrom(const Class *other) const; // or is the same class
};

//===----------------------------------------------------------------------===//
// Expressions
//===----------------------------------------------------------------------===//

enum class ExprKind : std::uint8_t {
  Literal,
  Variable,
  State,
  Member,
  Field,
  Swizzle,
  Index,
  Length,
  Unary,
  IncDec,
  Binary,
  Assign,
  Conditional,
  Comma,
  Convert,
  Construct,
  Builtin,
  Call,
  MethodCall,
  String
};

struct Expr {
  const ExprKind kind;
  const Type *type = nullptr;
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

/// A constant of any type but references. For numbers that the author wrote, `spelling` preserves
/// the text.
struct LiteralExpr : ExprOf<ExprKind::Literal> {
  Constant value;
  std::string spelling;
  // The constant that the author refers to here, if any.
  const Variable *variable = nullptr;
  const Member *member = nullptr;
};
struct VariableExpr : ExprOf<ExprKind::Variable> {
  const Variable *variable = nullptr;
};
struct StateExpr : ExprOf<ExprKind::State> {
  StateVariable variable{};
};
/// A member of the object that the method runs on.
struct MemberExpr : ExprOf<ExprKind::Member> {
  const Member *member = nullptr;
};
struct FieldExpr : ExprOf<ExprKind::Field> {
  ExprPtr base;
  std::uint32_t field = 0;
};
/// One component gives a scalar, several a vector. As an lvalue the components are distinct.
struct SwizzleExpr : ExprOf<ExprKind::Swizzle> {
  ExprPtr base;
  std::vector<std::uint8_t> components; // 0 to 3
};
/// Of an array, a vector, a matrix (a column) or a buffer (of rank 1: an element; otherwise a
/// buffer of rank - 1).
struct IndexExpr : ExprOf<ExprKind::Index> {
  ExprPtr base, index; // index: int or uint
};
/// `.length()` of a buffer; that of an array is folded.
struct LengthExpr : ExprOf<ExprKind::Length> {
  ExprPtr base;
};
enum class UnaryOp : std::uint8_t { Minus, Not, BitNot };
struct UnaryExpr : ExprOf<ExprKind::Unary> {
  UnaryOp op{};
  ExprPtr operand;
};
struct IncDecExpr : ExprOf<ExprKind::IncDec> {
  bool increment = true, prefix = true;
  ExprPtr target;
};
/// Both operands have the same scalar type (shifts excepted). Shapes: equal; scalar with vector,
/// matrix or color (broadcast); for Mul also matrix*vector, vector*matrix, matrix*matrix in the
/// sense of linear algebra. Equal and NotEqual compare whole values and give one bool. LogicalAnd
/// and LogicalOr evaluate the right side only if needed.
struct BinaryExpr : ExprOf<ExprKind::Binary> {
  ast::BinaryOp op{};
  ExprPtr left, right;
};
/// The value is that of the target after the store. Compound: target = target op value, with the
/// target's address evaluated once, and `value` converted as the right operand of a BinaryExpr.
struct AssignExpr : ExprOf<ExprKind::Assign> {
  bool compound = false;
  ast::BinaryOp op{};
  ExprPtr target, value;
};
struct ConditionalExpr : ExprOf<ExprKind::Conditional> {
  ExprPtr condition, whenTrue, whenFalse;
};
struct CommaExpr : ExprOf<ExprKind::Comma> {
  ExprPtr left, right;
};
/// Conversion of the scalar type, shape kept: int to float, bvec3 to vec3, ... ; or of a reference
/// to one of a base class, or to a bool: whether it refers to an object.
struct ConvertExpr : ExprOf<ExprKind::Convert> {
  bool isImplicit = true;
  ExprPtr operand;
};
/// Vector: one scalar (all components) or pieces whose scalars, taken in order, fill it (the last
/// piece may have more). Matrix: one scalar (diagonal), one matrix (overlap, rest identity), or
/// pieces by column. Struct: fields. Array: elements. Color: one float, or three floats that mean
/// RGB. Scalar: the first component of the argument. The scalar types of arguments already are
/// those of the result.
struct ConstructExpr : ExprOf<ExprKind::Construct> {
  std::vector<ExprPtr> args;
};
/// Arguments are converted to the overload's types; those of `out` parameters (modf, frexp,
/// uaddCarry, payloads) are lvalues. Scalar operands beside vectors (`min(v, s)`, `mix(v, w, s)`,
/// `mod(v, s)`, `step(s, v)`, ...) stay scalar.
struct BuiltinExpr : ExprOf<ExprKind::Builtin> {
  Builtin builtin{};
  std::vector<ExprPtr> args;
};
/// A free function, or a method of the object itself (`onSelf`): the most derived definition runs,
/// or, in a call of a base class's definition (`Base::shade()`), `function` itself, which may be an
/// engine method or a constructor.
struct CallExpr : ExprOf<ExprKind::Call> {
  const Function *function = nullptr;
  bool onSelf = false;
  bool isOfBase = false;
  std::vector<ExprPtr>
      args; // for out and inout parameters: lvalues of exactly the parameter's type
};
/// `reference.method(args)`, dispatched on the object's class. `lookup()` gives TextureColor (a
/// color) and `lookupFloat()` FloatTextureValue (a float): both call the texture's `lookup`.
struct MethodCallExpr : ExprOf<ExprKind::MethodCall> {
  ExprPtr receiver;
  std::string method;                 // "lookup", "lookupFloat", or a user function
  const Function *function = nullptr; // a user function in the static type; null for engine methods
  std::vector<ExprPtr> args;
};
/// Only as an argument of print.
struct StringExpr : ExprOf<ExprKind::String> {
  std::string value;
};

//===----------------------------------------------------------------------===//
// Statements
//===----------------------------------------------------------------------===//

struct Stmt {
  const ast::StmtKind kind;
  SourceRange range;
  std::string comment;
  virtual ~Stmt() = default;

protected:
  explicit Stmt(ast::StmtKind kind) : kind(kind) {}
};
template <ast::StmtKind K>
struct StmtOf : Stmt {
  static constexpr ast::StmtKind Kind = K;
  StmtOf() : Stmt(K) {}
};

struct CompoundStmt : StmtOf<ast::StmtKind::Compound> {
  std::vector<StmtPtr> body;
};
/// Variables belong to the function; `Variable::init` holds the initialiser.
struct DeclarationStmt : StmtOf<ast::StmtKind::Declaration> {
  std::vector<const Variable *> variables;
};
struct ExpressionStmt : StmtOf<ast::StmtKind::Expression> {
  ExprPtr expr;
};
struct IfStmt : StmtOf<ast::StmtKind::If> {
  ExprPtr condition;
  StmtPtr thenStmt, elseStmt;
};
struct ForStmt : StmtOf<ast::StmtKind::For> {
  StmtPtr init;            // may be null
  ExprPtr condition, step; // may be null
  StmtPtr body;
};
struct WhileStmt : StmtOf<ast::StmtKind::While> {
  ExprPtr condition;
  StmtPtr body;
};
struct DoWhileStmt : StmtOf<ast::StmtKind::DoWhile> {
  StmtPtr body;
  ExprPtr condition;
};
/// The arms in source order; control falls through into the next arm unless it breaks.
struct SwitchStmt : StmtOf<ast::StmtKind::Switch> {
  struct Arm {
    std::vector<std::int64_t> values; // labels before this arm
    bool isDefault = false;           // `default` is among them
    std::vector<StmtPtr> body;
    SourceRange range;
  };
  ExprPtr value; // int or uint
  std::vector<Arm> arms;
};
struct BreakStmt : StmtOf<ast::StmtKind::Break> {};
struct ContinueStmt : StmtOf<ast::StmtKind::Continue> {};
struct ReturnStmt : StmtOf<ast::StmtKind::Return> {
  ExprPtr value;
};
/// The body runs for each light that reaches `point`; with normal and angle only those within
/// `angle` of the normal.
struct IlluminanceStmt : StmtOf<ast::StmtKind::Illuminance> {
  ExprPtr point, normal, angle; // normal and angle may be null
  StmtPtr body;
};

//===----------------------------------------------------------------------===//
// The module
//===----------------------------------------------------------------------===//

/// All files of a compilation, checked together.
struct Module {
  TypeContext types;
  std::vector<std::unique_ptr<Struct>> structs; // a struct comes after those that it contains
  std::vector<std::unique_ptr<Variable>> constants;
  std::vector<std::unique_ptr<Function>> functions; // free functions
  std::vector<std::unique_ptr<Class>> classes;      // a class comes after its base

  const Class *findClass(const std::string &name) const;
};

} // namespace rtsl::typed
