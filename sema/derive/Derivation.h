//===- Derivation.h - the derivation of a module --------------------------===//
#pragma once

#include "sema/typed/Effects.h"
#include "sema/typed/TypedAst.h"

#include <deque>
#include <map>
#include <memory>
#include <vector>

namespace rtsl::derive {

enum class Axis : std::uint8_t { X, Y };
constexpr Axis axes[] = {Axis::X, Axis::Y};

/// A set of axes.
struct AxisSet {
  bool has[2] = {false, false};

  static AxisSet both() { return {{true, true}}; }
  static AxisSet only(Axis axis) { return {{axis == Axis::X, axis == Axis::Y}}; }
  bool contains(Axis axis) const { return has[static_cast<int>(axis)]; }
  void add(AxisSet other) {
    has[0] |= other.has[0];
    has[1] |= other.has[1];
  }
};

/// What a variant of a function returns.
enum class Result : std::uint8_t { Value, AlongX, AlongY };

/// Does the value of a member change across the footprint? A scratch member of a material that may
/// be an attribute of a mesh does.
bool changes(const typed::Member &member);

/// The state variable that is the change of another one in a function; null if that does not
/// change there. In primitives it is that of the direction of the ray (ScratchChanges.h), also for
/// its inverse.
const typed::StateVariable *changeOf(typed::StateVariable variable, const typed::Function &in,
                                     Axis axis);

class Derivation {
public:
  explicit Derivation(typed::Module &module) : module(module), effects(module) {}

  void run();

  TypeContext &types() const { return module.types; }

  /// Does it contain dFdx or dFdy, or call a function that does?
  bool asks(const typed::Function &function);
  /// May its value change although its arguments do not?
  bool readsSeeds(const typed::Function &function);
  /// Is it called in variants? Functions of lights, say, are not.
  bool hasVariants(const typed::Function &function) const;
  /// Is the change of its value known?
  bool canBeFollowed(const typed::Function &function);
  bool isPure(const typed::Expr &expr) { return effects.expression(expr).isPure(); }

  /// The variant of a function: the parameters are followed by the changes, along `axesOf`, of each
  /// that is differentiable.
  const typed::Function &variant(const typed::Function &function, Result result);
  AxisSet axesOf(const typed::Function &function, Result result);

  /// The scratch member that is the change of another one.
  const typed::Member &changeOf(const typed::Member &member, Axis axis);

private:
  using Definitions = std::vector<const typed::Function *>;

  /// The definitions that a call may run.
  Definitions definitions(const typed::Function &function) const;
  /// What a body has by itself, and the definitions that its calls may run.
  struct Facts {
    bool asks = false, readsSeeds = false;
    Definitions callees;
  };
  const Facts &factsOf(const typed::Function &function);
  /// Does a function, or one that it reaches, have this?
  bool reaches(const typed::Function &from, bool Facts::*property);
  void makeVariant(const typed::Function &from, Result result);
  std::string variantName(const typed::Function &from, Result result) const;
  void addVariants(std::vector<std::unique_ptr<typed::Function>> &functions);
  std::string memberName(const typed::Member &of, Axis axis) const;
  /// Adds the methods of ScratchChanges.h that materials need.
  void addScratchChanges();
  /// The changes of scratch members of a primitive that materials on it use.
  std::vector<const typed::Member *> changesUsedOf(const typed::Class &primitive);
  /// Places the members of changeOf in their classes.
  void addMembers();

  struct Variant {
    std::unique_ptr<typed::Function> function;
    const typed::Function *from;
    Result result;
  };

  typed::Module &module;
  typed::EffectsOf effects;
  std::map<const typed::Function *, Facts> facts;
  std::deque<Variant> variants; // in the order in which they were required
  std::map<std::pair<const typed::Function *, Result>, const typed::Function *> made;
  std::vector<std::unique_ptr<typed::Member>> members; // in the order in which they were required
  /// A method of ScratchChanges.h.
  struct Scratch {
    typed::Class *owner;
    typed::Function withDerivatives; // before dFdx and dFdy are replaced
    std::unique_ptr<typed::Function> made;
  };
  std::deque<Scratch> scratch;
};

} // namespace rtsl::derive
