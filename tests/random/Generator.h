//===- Generator.h - makes one random program -----------------------------===//
//
// Top down, by type: expression(T) chooses a way to make a T from what is in scope. Everything that
// the language leaves to the machine is left out (nothing reads what was never written, loops are
// counted, references have no cycles); everything else is fair: NaNs, overflow, aliasing.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "Program.h"
#include "Vocabulary.h"

#include "sema/model/ClassModel.h"

#include <random>
#include <set>

namespace rtsl::random {

struct Variable {
  std::string name;
  const Type *type = nullptr;
  bool writable = true;
  bool isConstant = false; // may stand in a constant expression
};

struct ClassPlan;

/// What is in both.
StateSet common(StateSet a, StateSet b);
bool isIn(StateSet part, StateSet all);

/// A function of the program's.
struct Function {
  std::string name;
  Signature signature;
  unsigned work = 0;                      // about how many operations a call runs
  unsigned traces = 0;                    // at most so many rays
  bool remote = false;                    // may be called on another object
  StateSet reads;                         // at most this state
  bool draws = false, looksUp = false;    // perhaps: random numbers, textures
  bool answers = false;                   // may end `anyHit`
  bool raises = false;                    // may have an index out of range, which is an exception
  bool changes = false, converts = false; // perhaps: dFdx of a class of hits, pointToWorld
  bool lights = false;                    // perhaps: illuminance
};

/// A value of class type: `refs[$]` where an index belongs.
struct Reference {
  std::string text;
  const ClassPlan *target = nullptr;
  unsigned count = 0; // of an array: its length; of a buffer: 0
  bool isBuffer = false;
  bool writable = false; // a local variable
};

struct ClassPlan {
  std::string name, root;
  const ClassPlan *base = nullptr;
  std::vector<Variable> members; // inherited ones first
  std::vector<Variable> scratch;
  std::vector<Variable> outputs; // output buffers
  std::vector<Reference> references;
  // of a primitive that is a square, and chooses points on it: its normal, x, y or z; empty: none
  std::string square;
  std::string image;               // a member of the type sampler2D; empty: none
  unsigned images = 0;             // of an array: its length
  std::vector<Function> functions; // that methods of it may call
  // that it has, inherited ones too: the name, and the payload's type after it
  std::set<std::string> methods;
};

/// What may be done where code stands.
struct Context {
  bool constantOnly = false;
  StateSet reads; // what has a value
  bool rand = false, lookup = false, illuminance = false, print = false;
  bool answers = false;             // ignoreIntersection() and terminateRay() may stand here
  bool raises = false;              // an index out of range may stand here, as an exception
  unsigned traces = 0;              // rays that may still be sent
  const ClassPlan *self = nullptr;  // null: a free function
  const Type *result = nullptr;     // of `return`; null: void
  std::string onReturn;             // what a method does before it returns
  bool returns = true;              // may return early
  bool changes = false;             // dFdx and dFdy may stand here
  bool converts = false;            // pointToWorld and the like may stand here
  unsigned loops = 0, switches = 0; // around
  bool canContinue = false;         // breaks and continues have a target
  unsigned weight = 1;              // how often the place runs, at most
};

class Generator {
public:
  explicit Generator(std::uint32_t seed);
  Program run();

private:
  // Choice
  unsigned below(unsigned bound) { return static_cast<unsigned>(random() % bound); }
  bool chance(unsigned percent) { return below(100) < percent; }
  template <typename T>
  const T &pick(const std::vector<T> &from) {
    return from[below(static_cast<unsigned>(from.size()))];
  }
  std::string fresh(const char *stem) { return stem + std::to_string(counter++); }
  std::string global(const char *stem) { return program.prefix + fresh(stem); }

  /// Most programs are small, so that there can be many.
  unsigned some(unsigned count) { return large ? count : (count + below(2)) / 2; }
  bool likely(unsigned percent) { return chance(large ? percent : percent / 2); }
  unsigned nesting() const { return large ? 3 : 2; }

  // Nodes
  template <typename... Children>
  NodePtr make(const Type *type, std::string text, Children... children) {
    NodePtr node = makeNode(Role::Expression, std::move(text), std::move(children)...);
    node->type = toString(type);
    node->simplest = simplestValue(type);
    work += context.weight;
    return node;
  }

  // Types (Types.cpp)
  const Type *numericScalar();
  const Type *smallType(); // scalar, vector, sometimes a matrix or color
  const Type *anyType();   // structs and arrays too
  const Type *withScalar(const Type *shape, const Type *scalar);
  bool hasColor(const Type *type) const;
  void makeStruct();
  const Type *structure(std::vector<typed::Field> fields,
                        unsigned more); // and `more` random fields
  void makePayload();
  /// Text after the name of a member or a parameter of a constructor: " in [0, 1)"; empty: no
  /// range. `inside`: a value of the type in it, if that is no array.
  struct RangeText {
    std::string text, inside;
  };
  RangeText someRange(const Type *type);

  // Expressions (Expressions.cpp)
  NodePtr expression(const Type *type, unsigned depth);
  NodePtr converted(const Type *type, unsigned depth, const Type **made = nullptr);
  NodePtr atom(const Type *type);
  NodePtr literal(const Type *type);
  NodePtr adapted(const Type *type); // made of a variable of some other type
  std::string number(const Type *scalar);
  std::string numbers(const Type *scalar, unsigned count); // with commas between
  NodePtr compound(const Type *type, unsigned depth);
  NodePtr constructor(const Type *type, unsigned depth);
  NodePtr partOfExpression(const Type *type, unsigned depth);
  NodePtr effect(const Type *type, unsigned depth);
  NodePtr braced(const Type *type, unsigned depth);
  NodePtr change(const Type *type, unsigned depth);
  NodePtr atomic(const Type *type, unsigned depth);
  NodePtr ofObject(const Type *type, unsigned depth);
  NodePtr ofImage(const Type *type, unsigned depth);
  NodePtr condition(unsigned depth) { return expression(types.boolType, depth); }

  // Operators (Operators.cpp)
  NodePtr operation(const Type *type, unsigned depth);
  NodePtr comparison(unsigned depth);
  NodePtr vectorOperation(const Type *type, unsigned depth);
  NodePtr matrixOperation(const Type *type, unsigned depth);
  NodePtr colorOperation(unsigned depth);
  const char *compoundOperator(const Type *type);

  // Places (Places.cpp)
  bool canReach(const Type *from, const Type *wanted, unsigned steps, bool writing) const;
  NodePtr part(const Type *wanted, bool writing);
  NodePtr descend(NodePtr base, const Type *from, const Type *wanted, bool writing);
  NodePtr index(const std::string &count);
  NodePtr target(const Type *type); // of exactly this type; declares a variable if there is none
  NodePtr referenceTo(const ClassPlan **plan, bool texture);
  bool isOwn(const ClassPlan *plan) const;
  NodePtr objectOf(const ClassPlan *plan, bool choosing = true);
  NodePtr element(const Reference &reference);

  // Calls (Calls.cpp)
  NodePtr builtinCall(const Type *result, unsigned depth);
  NodePtr userCall(const Type *result, unsigned depth);
  NodePtr methodCall(const Type *result, unsigned depth);
  NodePtr call(const std::string &callee, const Signature &signature,
               const std::vector<Signature> &overloads, std::size_t index, unsigned depth,
               NodePtr receiver = nullptr);
  bool mayCall(const Function &function) const;
  void account(const Function &function);

  // Statements (Statements.cpp)
  void add(Node &list, NodePtr statement);
  void statements(Node &list, unsigned count, unsigned depth);
  NodePtr block(unsigned count, unsigned depth);
  NodePtr statement(unsigned depth);
  NodePtr declaration(unsigned depth);
  NodePtr referenceDeclaration();
  NodePtr referenceAssignment();
  NodePtr assignment(unsigned depth);
  NodePtr ifStatement(unsigned depth);
  NodePtr loop(unsigned depth);
  NodePtr switchStatement(unsigned depth);
  NodePtr jump();
  NodePtr answer();
  NodePtr illuminance(unsigned depth);
  NodePtr direction(unsigned depth);
  NodePtr payloadRay();
  NodePtr print();
  NodePtr hashed(const Variable &variable);
  void hashAll(Node &list, std::size_t from);
  NodePtr declare(const std::string &name, const Type *type, NodePtr value,
                  const char *qualifier = "");

  // Declarations (Declarations.cpp)
  void makeConstant();
  void makeFreeFunction();
  NodePtr function(Function &made, const std::string &head, const std::vector<Variable> &around);

  // Classes (Classes.cpp, Light.cpp)
  void makeClasses();
  using Targets = std::vector<const ClassPlan *>; // of references
  ClassPlan *startClass(const char *stem, const std::string &root, const ClassPlan *base,
                        Node *&members);
  void addMembers(ClassPlan &plan, Node &members, unsigned count);
  void addReferences(ClassPlan &plan, Node &members, const Targets &targets);
  void addImage(ClassPlan &plan, Node &members);
  void addConstructor(ClassPlan &plan, Node &members);
  void addFunction(ClassPlan &plan, Node &members, bool remote, unsigned traces,
                   bool answers = false);
  StateSet someReads(const std::string &root);
  std::vector<Variable> stateOf(StateSet reads, StateSet writes);
  void overrideFunction(ClassPlan &plan, Node &members);
  void addMethod(ClassPlan &plan, Node &members, const std::string &name,
                 std::vector<Variable> more, const std::string &result, unsigned statementCount,
                 Context rules, const std::string &parameters = "");
  void componentsAroundARay(Node &body, const std::vector<Variable> &state);
  void addPayloadMethod(ClassPlan &plan, Node &members, const std::string &name,
                        const Type *payload, std::vector<Variable> state, Context rules);
  const ClassPlan *makeTexture(const ClassPlan *base, const Targets &targets);
  void makeCamera(const Targets &targets);
  const ClassPlan *makePrimitive(const ClassPlan *base, const Targets &targets);
  const ClassPlan *makeLight(const Targets &targets);
  void makeMiss(const Targets &targets);
  void makeSelector(const Targets &targets);
  void makeException(const Targets &targets);
  void makeRayGeneration(const Targets &targets);
  void makePathTracer();
  Targets someOf(const Targets &targets);
  const ClassPlan *makeMaterial(const ClassPlan *base, const Targets &targets);
  void addBsdf(ClassPlan &plan, Node &members);
  void addSamples(ClassPlan &plan, Node &members);
  static std::string meetsSquare(const std::string &normal);
  const ClassPlan *makeHelper(const ClassPlan *base);
  void addRecursion(ClassPlan &plan, Node &members, const Type *result, unsigned traces = 0);
  std::vector<Variable> around(const ClassPlan &plan);
  std::vector<Variable> around(const ClassPlan &plan, const Function &function);
  Context contextOf(const Function &function, const ClassPlan &plan) const;

  std::mt19937 random;
  Vocabulary &vocabulary;
  TypeContext &types;
  Program program;
  bool large = false;
  bool lit = false; // surfaces that shine matter to it
  unsigned counter = 0;
  unsigned work = 0, workLimit = 0, indexDepth = 0;

  std::vector<const Type *> structs;
  std::vector<const Type *> payloads; // structs; the first field is `uint h`
  std::vector<Variable> constants;
  std::vector<Function> functions;
  std::vector<std::unique_ptr<ClassPlan>> plans;
  std::vector<Variable> attributes; // scratch members of every primitive

  // Of the function in the making
  Context context;
  std::vector<Variable> scope;
  std::vector<Reference> references;
  std::vector<NodePtr> pending; // declarations that stand before the statement in the making
};

} // namespace rtsl::random
