//===- Overload.cpp - which of several functions a call means -------------===//
#include "sema/model/Overload.h"

#include "sema/model/Conversion.h"

namespace rtsl {

static Conversion conversionTo(const Signature::Parameter &parameter, const Type *argument) {
  const Conversion conversion = implicitConversion(argument, parameter.type);
  if (parameter.direction != ast::Direction::In && conversion == Conversion::Implicit)
    return Conversion::None;
  return conversion;
}

static bool isViable(const Signature &candidate, const std::vector<const Type *> &arguments) {
  if (candidate.parameters.size() != arguments.size())
    return false;
  for (std::size_t i = 0; i != arguments.size(); ++i)
    if (conversionTo(candidate.parameters[i], arguments[i]) == Conversion::None)
      return false;
  return true;
}

static bool isBetter(const Signature &a, const Signature &b,
                     const std::vector<const Type *> &arguments) {
  bool better = false;
  for (std::size_t i = 0; i != arguments.size(); ++i) {
    const bool exactInA = conversionTo(a.parameters[i], arguments[i]) == Conversion::Exact;
    const bool exactInB = conversionTo(b.parameters[i], arguments[i]) == Conversion::Exact;
    if (exactInB && !exactInA)
      return false;
    better |= exactInA && !exactInB;
  }
  return better;
}

Resolution resolveOverload(const std::vector<Signature> &candidates,
                           const std::vector<const Type *> &arguments) {
  std::vector<int> viable;
  for (std::size_t i = 0; i != candidates.size(); ++i)
    if (isViable(candidates[i], arguments))
      viable.push_back(static_cast<int>(i));
  Resolution resolution;
  for (int candidate : viable) {
    bool beaten = false;
    for (int other : viable)
      beaten |= other != candidate &&
                isBetter(candidates[static_cast<std::size_t>(other)],
                         candidates[static_cast<std::size_t>(candidate)], arguments);
    if (!beaten)
      resolution.ties.push_back(candidate);
  }
  if (resolution.ties.size() == 1)
    resolution.chosen = resolution.ties[0];
  return resolution;
}

std::string describe(const std::vector<const Type *> &types) {
  std::string text;
  for (const Type *type : types)
    text += (text.empty() ? "" : ", ") + toString(type);
  return text;
}

std::string describe(const std::string &name, const Signature &signature) {
  std::string text = toString(signature.result) + " " + name + "(";
  for (std::size_t i = 0; i != signature.parameters.size(); ++i) {
    const Signature::Parameter &parameter = signature.parameters[i];
    text += i == 0 ? "" : ", ";
    text += parameter.direction == ast::Direction::Out     ? "out "
            : parameter.direction == ast::Direction::InOut ? "inout "
                                                           : "";
    text += toString(parameter.type);
  }
  return text + ")";
}

} // namespace rtsl
