//===- Program.h - the state of sema for a whole compilation --------------===//
//
// The names at file level, the classes with their members, and the facts about each function that
// are checked after all bodies. Shared by the steps of `check`.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "frontend/diagnostics/Diagnostics.h"
#include "sema/check/ImportResolver.h"
#include "sema/model/Builtins.h"
#include "sema/model/ClassModel.h"

#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace rtsl {

class FunctionChecker;

/// Depth to which the checker itself recurses: brackets, unary operators, right-hand sides, nested
/// statements.
constexpr unsigned maxRecursion = 1000;
/// Depth of an expression tree. Chains of binary operators are deep on the left and are walked
/// without recursion here, but all later stages may recurse over the tree.
constexpr unsigned maxTreeDepth = 2000;
/// Bases of a class, including indirect ones. A class inherits all their functions, and each
/// function is lowered again for each class.
constexpr unsigned maxInheritanceDepth = 256;

/// A use in a function that not every method allows.
struct Use {
  enum class Kind : std::uint8_t { ReadState, WriteState, Special };
  Kind kind = Kind::Special;
  typed::StateVariable variable{}; // of ReadState and WriteState
  Ability ability{};               // of Special
  const typed::Member *member =
      nullptr;      // that is read or written, for the abilities that concern one
  std::string what; // as the author wrote it: "trace", "hit"
  SourceRange range;
};

/// A call of a user function.
struct CallEdge {
  const typed::Function *callee = nullptr;
  bool dispatched = false;       // a method: definitions that override the callee may run
  bool throughReference = false; // on another object
  bool throughMember = false;    // through a reference in a member of the caller
  SourceRange range;             // of the callee's name
};

struct FunctionFacts {
  // those that depend on the callers; uses in engine methods are checked immediately
  std::vector<Use> uses;
  std::vector<CallEdge> calls;
  typed::SentRays sends; // by the body itself
};

/// A class with its names. `own` functions and members are declared in the class itself.
struct ClassScope {
  const ast::ClassDecl *declaration = nullptr;
  std::unique_ptr<typed::Class> owned; // until the module takes it
  typed::Class *definition = nullptr;
  const ClassScope *base = nullptr;
  const RootModel *root = nullptr; // null: its base is broken, and few errors are reported
  std::unordered_map<std::string, typed::Member *> members;
  std::unordered_map<std::string, std::vector<typed::Function *>> functions;
};

/// What a name at file level denotes.
struct Symbol {
  enum class Kind : std::uint8_t { Struct, Class, Constant, Function };
  Kind kind{};
  SourceRange range; // of the name
};

/// A `const` at file level: checked when it is first needed.
struct GlobalConstant {
  enum class State : std::uint8_t { Unchecked, InProgress, Checked };
  const ast::VariableDecl *declaration = nullptr;
  std::unique_ptr<typed::Variable> owned; // until the module takes it
  typed::Variable *variable = nullptr;
  State state = State::Unchecked;
};

struct StructEntry {
  enum class State : std::uint8_t { Unchecked, InProgress, Checked };
  const ast::StructDecl *declaration = nullptr;
  std::unique_ptr<typed::Struct> owned; // until the module takes it
  typed::Struct *definition = nullptr;
  State state = State::Unchecked;
};

class Program {
public:
  Program(typed::Module &module, Diagnostics &diagnostics, const ModuleFinder &finder)
      : module(module), types(module.types), diagnostics(diagnostics), builtins(module.types),
        finder(finder) {}

  typed::Module &module;
  TypeContext &types;
  Diagnostics &diagnostics;
  BuiltinTable builtins;

  std::unordered_map<std::string, Symbol> symbols;
  std::unordered_map<std::string, StructEntry> structs;
  std::unordered_map<std::string, GlobalConstant> constants;
  std::unordered_map<std::string, std::unique_ptr<ClassScope>> classes;
  std::unordered_map<std::string, std::vector<typed::Function *>> functions;
  std::vector<std::string> structOrder, constantOrder, classOrder; // in source order
  std::unordered_map<const typed::Function *, FunctionFacts> facts;
  std::unordered_map<const RootModel *, std::vector<ClassScope *>>
      defaults; // the default classes of an rt_ class
  std::unordered_map<const typed::Class *, ClassScope *> scopeOf;
  /// Methods of another class than the one that defines them, which is reported. What they use is
  /// not: it follows from the class that they belong to.
  std::unordered_set<const typed::Function *> foreignMethods;

  /// What a name at file level denotes where it is used; null: nothing. Names in the author's files
  /// are not visible in the library: an author's function may have the name of a built-in function
  /// that the library calls.
  const Symbol *findSymbol(const std::string &name, SourceRange usedAt) const;
  /// The functions at file level of that name, seen from there.
  std::vector<const typed::Function *> findFunctions(const std::string &name,
                                                     SourceRange usedAt) const;
  /// Adds to a message about an unknown name which module of the library defines it, if one does.
  bool suggestImport(Diagnostic &diagnostic, const std::string &name) const;
  /// Does a file of the program import that module of the library, "std.noise"?
  bool imports(const std::string &libraryModule) const;
  /// The member in the class or one of its bases.
  const typed::Member *findMember(const ClassScope *scope, const std::string &name) const;
  /// All functions of that name that an object of the class has: own ones, and inherited ones that
  /// are not overridden.
  std::vector<const typed::Function *> findMethods(const ClassScope *scope,
                                                   const std::string &name) const;

  /// Does the name denote a user function, seen from a class or (null) from a file? Also valid
  /// before functions are declared, which happens after constants and members.
  bool namesFunction(const ClassScope *scope, const std::string &name, SourceRange usedAt) const;

  /// The checked constant, or null if it is broken or depends on itself (reported).
  const typed::Variable *constant(const std::string &name, SourceRange usedAt);
  /// The struct with its fields resolved, or null if it contains itself (reported).
  const typed::Struct *structure(const std::string &name, SourceRange usedAt);

  // The steps of `check`, in order.
  void collect(const std::vector<const ast::TranslationUnit *> &units,
               const ImportResolver &resolver);
  void resolveStructs();
  void resolveConstants();
  void resolveClasses();
  void declareFunctions();
  void checkBodies();
  void judgeCalls(); // CallGraph.cpp
  /// Warns of what is slow (-Wperf). For a program without errors.
  void checkPerformance();

private:
  struct PendingBody {
    const ast::FunctionDecl *declaration;
    typed::Function *function;
    const ClassScope *scope;
  };

  // Collect.cpp
  void collectUnit(const ast::TranslationUnit &unit);
  bool declareSymbol(const ast::Name &name, Symbol::Kind kind);
  // Structs.cpp
  void resolveFields(StructEntry &entry);
  void checkConstant(GlobalConstant &entry);
  // Classes.cpp
  std::vector<const ClassScope *> defaultChain(const ClassScope &scope) const;
  void findDefaults();
  ClassScope *defaultOf(const ClassScope &scope) const;
  void linkBase(ClassScope &scope);
  bool breakCycles();
  void limitInheritance();
  std::vector<ClassScope *> classesBaseFirst();
  void declareMembers(ClassScope &scope);
  void declareMember(ClassScope &scope, const ast::VariableDecl &declaration);
  // MemberRange.cpp
  std::optional<Range> rangeOf(FunctionChecker &checker, const ast::ValueRange &written,
                               const Type *type);
  void checkRange(FunctionChecker &checker, const ast::VariableDecl &declaration,
                  typed::Member &member);
  void checkMemberQualifiers(const ClassScope &scope, const ast::VariableDecl &declaration,
                             const Type *type);
  // Functions.cpp
  void declareMethods(ClassScope &scope);
  std::unique_ptr<typed::Function> declareFunction(const ast::FunctionDecl &declaration,
                                                   const ClassScope *scope);
  void checkTableMethod(const ClassScope &scope, const ast::FunctionDecl &declaration,
                        typed::Function &function);
  void checkOverride(const ClassScope &scope, const typed::Function &function);
  void declareFreeFunction(const ast::FunctionDecl &declaration);
  bool isOfLibrary(SourceRange range) const { return libraryFiles.count(range.file) != 0; }

  const ModuleFinder &finder;
  std::vector<const ast::TranslationUnit *> units;
  std::vector<ClassScope *> baseFirst;
  std::vector<PendingBody> bodies;
  std::unordered_map<std::string, unsigned> memberNames,
      methodNames; // number of classes that have it
  std::unordered_set<FileId> libraryFiles;
  // at file level: all, and those of the library
  std::unordered_set<std::string> functionNames, libraryFunctionNames;
  std::unordered_set<const typed::Function *> prototypes; // those without a body so far
  unsigned constantDepth = 0, structDepth = 0;
};

/// The same parameter types, in order.
bool sameParameters(const typed::Function &a, const typed::Function &b);

/// Reports if `method` of `root` does not allow `use`. `through` (if not null) is the method from
/// which the function with the use is reached. Returns whether it is allowed.
bool judgeUse(Diagnostics &diagnostics, const Use &use, const RootModel &root,
              const MethodModel &method, const typed::Function *through);

/// Control flow of a checked body: missing returns, unreachable statements, variables that are read
/// before they are written or never read (FlowCheck.cpp).
void checkFlow(const typed::Function &function, Diagnostics &diagnostics);

/// What is slow on a GPU and visible in the source: `-Wperf` (PerformanceCheck.cpp).
void checkPerformance(const typed::Function &function, Diagnostics &diagnostics);

} // namespace rtsl
