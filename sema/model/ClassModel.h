//===- ClassModel.h - who may define, read, write and call what -----------===//
//
// The one table of the rt_ base classes: the methods of each, the state variables that it sees,
// what each method writes and which special functions it allows. All rules of sema about classes
// come from here.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <vector>

namespace rtsl {

/// A set of state variables.
class StateSet {
public:
  constexpr StateSet() = default;
  constexpr StateSet(std::initializer_list<typed::StateVariable> variables) {
    for (typed::StateVariable variable : variables)
      bits |= bit(variable);
  }
  constexpr bool has(typed::StateVariable variable) const { return bits & bit(variable); }
  constexpr StateSet operator|(StateSet other) const { return StateSet(bits | other.bits); }

private:
  constexpr explicit StateSet(std::uint64_t bits) : bits(bits) {}
  static constexpr std::uint64_t bit(typed::StateVariable variable) {
    return std::uint64_t(1) << static_cast<unsigned>(variable);
  }
  std::uint64_t bits = 0;
};

/// Uses that only some methods allow, beside reading and writing state. Builtins.def gives the
/// ability that each built-in function requires.
enum class Ability : std::uint8_t {
  Anywhere, // every method allows it
  Trace,
  Illuminance, // the illuminance statement too
  Hit,
  AnyHit,
  VisitChild,
  Lookup, // texture.lookup(), texture.lookupFloat()
  Random,
  ReadScratch,
  WriteScratch,
  WriteMembers, // public and private members
  WriteBuffers, // elements of output buffers
  CallSampling, // BSDF and the like of the same object
  Spaces,       // conversions between object space and world space
  Derivatives,  // dFdx, dFdy
  CallColor,    // shade, or miss without payload, of the same object
};

class AbilitySet {
public:
  constexpr AbilitySet() = default;
  constexpr AbilitySet(std::initializer_list<Ability> abilities) {
    for (Ability ability : abilities)
      bits |= bit(ability);
  }
  constexpr bool has(Ability ability) const { return bits & bit(ability); }
  constexpr AbilitySet operator|(AbilitySet other) const {
    AbilitySet result;
    result.bits = static_cast<std::uint16_t>(bits | other.bits);
    return result;
  }

private:
  static constexpr std::uint16_t bit(Ability ability) {
    return static_cast<std::uint16_t>(1u << static_cast<unsigned>(ability));
  }
  std::uint16_t bits = 0;
};

/// The ability that a method must have to use the built-in function of this name; none if all
/// methods may, or if there is no such function.
std::optional<Ability> abilityNeeded(const std::string &builtin);

/// A method that the engine calls.
struct MethodModel {
  enum class Payload : std::uint8_t { None, Optional, Required }; // takes one `inout` struct
  std::string name;
  StateSet reads; // includes what it writes
  StateSet writes;
  AbilitySet abilities;
  Payload payload = Payload::None;

  /// The ability that another method of the same object needs to call this one; none if only the
  /// engine may call it.
  std::optional<Ability> calledBy() const;

  /// `void closestHit(inout P)`, for messages.
  std::string signature() const;
};

/// An rt_ base class.
struct RootModel {
  std::string name; // "rt_Primitive"
  StateSet sees;    // of all its methods
  std::vector<MethodModel> methods;
  bool hasScratch = false;

  const MethodModel *method(const std::string &methodName) const;
  /// The method whose rules apply to a function with that signature: `miss()` and `miss(inout P)`
  /// differ in what they write.
  const MethodModel *method(const std::string &methodName, bool withPayload) const;
};

const std::vector<RootModel> &rootModels();
/// Null if there is no such base class.
const RootModel *rootModel(const std::string &name);

/// The model of a class that derives from no rt_ class: its functions may do what their callers
/// may.
const RootModel &helperModel();

/// The rules of `constructor`, the same for every class.
const MethodModel &constructorModel();

/// The most that a function that no method calls may do: what any method of its class may.
MethodModel unionOfMethods(const RootModel &root);

/// "rt_Light", "rt_Camera and rt_Primitive": the classes that see a variable.
std::string classesThatSee(typed::StateVariable variable);
/// "`illumination` of an rt_Light": the methods that write a variable; empty if none does.
std::string methodsThatWrite(typed::StateVariable variable);
/// "`shade` and `closestHit` of an rt_Material ...": the methods that have an ability.
std::string methodsWith(Ability ability);
/// The classes that have a method of this name: "rt_Primitive".
std::vector<std::string> classesWithMethod(const std::string &methodName);

/// "an rt_Camera", "a Sphere".
std::string withArticle(const std::string &noun);
/// "a", "a and b", "a, b and c"; `last` is "and" or "or".
std::string joinWords(const std::vector<std::string> &words, const char *last = "and");

/// Finds a state variable by its name without rt_.
bool findStateVariable(const std::string &name, typed::StateVariable &variable);
const Type *typeOf(typed::StateVariable variable, TypeContext &types);
/// All names with rt_, for suggestions.
const std::vector<std::string> &stateVariableNames();

} // namespace rtsl
