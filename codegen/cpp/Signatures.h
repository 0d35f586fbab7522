//===- Signatures.h - how the author's functions are declared in C++ ------===//
#pragma once

#include "codegen/cpp/Names.h"
#include "codegen/cpp/ScratchMembers.h"
#include "codegen/cpp/Types.h"
#include "codegen/cpp/states/SplitMethods.h"
#include "codegen/cpp/tree/Declaration.h"
#include "sema/typed/Analysis.h"
#include "sema/typed/Effects.h"

namespace rtsl::cpp {

class Signatures {
public:
  Signatures(const typed::Module &module, const Names &names, typed::EffectsOf &effects,
             Types &types, ScratchMembers &scratch, const SplitMethods &split)
      : module(module), names(names), effects(effects), types(types), scratch(scratch),
        split(split), hitAnswers(module) {}

  /// The function without a body.
  Function of(const typed::Function &function, bool isMethod);

  /// Does the function take the ray's state, or its class's scratch members?
  bool takesState(const typed::Function &function);
  bool takesScratch(const typed::Function &function);
  /// May a call of the function, or of one that overrides it, end `anyHit`?
  bool mayAnswerHit(const typed::Function &function);
  /// `in` parameters that C++ takes by reference to const.
  bool isByReference(const typed::Variable &parameter, const typed::Function &function);
  /// An `out` parameter is zero at first if the function may leave it as it is, or read it before.
  bool beginsAsZero(const typed::Variable &parameter, const typed::Function &function) const;
  /// The parameter's name, or one for a parameter that has none.
  std::string parameterName(const typed::Function &function, std::size_t number) const;

private:
  struct Mentions;
  Mentions mentionsOf(const typed::Function &function);
  Parameter parameter(const typed::Function &function, std::size_t number,
                      const Mentions &mentions);

  const typed::Module &module;
  const Names &names;
  typed::EffectsOf &effects;
  Types &types;
  ScratchMembers &scratch;
  const SplitMethods &split;
  typed::HitAnswers hitAnswers;
};

} // namespace rtsl::cpp
