#include "runtime/scene/ObjectValues.h"

#include "runtime/scene/MemberRanges.h"
#include "support/ClosestName.h"
#include "support/ErrorCollector.h"
#include "support/ErrorMessages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstring>
#include <optional>

namespace rtsl::runtime {

namespace {

std::string listParameters(const ClassInfo &info) {
  std::string text = info.name + "(";
  for (std::size_t i = 0; i < info.parameters.size(); ++i)
    text += fmt::format(
        "{}{} {}{}", i ? ", " : "", info.parameters[i].type.name, info.parameters[i].name,
        info.parameters[i].values ? " in " + toString(*info.parameters[i].values) : "");
  return text + ")";
}

/// As messages name it.
std::string ownerOf(const ClassInfo &info) {
  return fmt::format("class `{}`", info.name);
}

bool isGiven(const MemberInfo &member, const ObjectValues &values) {
  return std::any_of(values.members.begin(), values.members.end(),
                     [&](const NamedValue &one) { return one.name == member.name; });
}

bool hasName(const std::vector<MemberInfo> &all, const std::string &name) {
  return std::any_of(all.begin(), all.end(),
                     [&](const MemberInfo &member) { return member.name == name; });
}

/// Whether it is the name of a parameter of the constructor, and of no member.
bool isOnlyParameter(const ClassInfo &classInfo, const std::string &name) {
  return hasName(classInfo.parameters, name) && !hasName(classInfo.members, name);
}

/// The value of each parameter, in their order.
std::vector<const Value *> matchArguments(const ClassInfo &classInfo, const ObjectValues &values) {
  if (!classInfo.hasConstructor)
    throw Error(message::noConstructor(classInfo.name), values.place);
  const std::vector<MemberInfo> &parameters = classInfo.parameters;
  std::vector<const Value *> arguments(parameters.size(), nullptr);
  if (auto *list = std::get_if<std::vector<Value>>(&values.constructor)) {
    if (list->size() != parameters.size())
      throw Error(message::argumentCount(classInfo.name, parameters.size(),
                                         parameters.size() == 1 ? "" : "s", list->size()),
                  values.place)
          .note(fmt::format("it is declared as `{}`", listParameters(classInfo)));
    for (std::size_t i = 0; i < parameters.size(); ++i)
      arguments[i] = &(*list)[i];
  } else if (auto *named = std::get_if<std::vector<NamedValue>>(&values.constructor)) {
    for (const NamedValue &one : *named) {
      auto found =
          std::find_if(parameters.begin(), parameters.end(),
                       [&](const MemberInfo &parameter) { return parameter.name == one.name; });
      if (found == parameters.end()) {
        Error error(message::noSuchParameter(classInfo.name, one.name),
                    one.place ? one.place : values.place);
        std::vector<std::string> names;
        for (const MemberInfo &parameter : parameters)
          names.push_back(parameter.name);
        if (const std::string near = closestName(one.name, names); !near.empty())
          error.fix(near);
        throw error.note(fmt::format("it is declared as `{}`", listParameters(classInfo)));
      }
      const Value *&argument = arguments[std::size_t(found - parameters.begin())];
      if (argument)
        throw Error(message::parameterTwice(one.name), one.place ? one.place : values.place);
      argument = &one.value;
    }
  }
  std::string missing;
  bool isBeside = false; // the constructor
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (!arguments[i]) {
      missing += fmt::format("{}`{}`", missing.empty() ? "" : ", ", parameters[i].name);
      isBeside |= isGiven(parameters[i], values);
    }
  if (!missing.empty()) {
    Error error(message::argumentMissing(classInfo.name, missing), values.place);
    error.note(fmt::format("it is declared as `{}`", listParameters(classInfo)));
    if (isBeside)
      error.note("arguments are in `constructor`, not beside it: `\"constructor\": "
                 "{\"PARAMETER\": VALUE, ...}`");
    throw error;
  }
  return arguments;
}

/// Writes one member.
void setMember(const ClassInfo &classInfo, const std::string &name, const NamedValue &one,
               const std::optional<Place> &place, std::uint8_t *record,
               const StoreContext &context) {
  auto found = std::find_if(classInfo.members.begin(), classInfo.members.end(),
                            [&](const MemberInfo &member) { return member.name == one.name; });
  if (found == classInfo.members.end()) {
    Error error(message::noSuchMember(classInfo.name, one.name), one.place ? one.place : place);
    std::vector<std::string> names;
    for (const MemberInfo &member : classInfo.members)
      if (member.isPublic)
        names.push_back(member.name);
    if (const std::string near = closestName(one.name, names); !near.empty())
      error.fix(near);
    else if (isOnlyParameter(classInfo, one.name))
      error.note("it is a parameter of the constructor: its value is in `constructor`");
    throw error;
  }
  if (!found->isPublic)
    throw Error(message::memberNotPublic(one.name, classInfo.name), one.place ? one.place : place);
  if (one.value.kind == Value::Kind::Refused)
    return;
  const std::string what = fmt::format("member `{}` of `{}`", one.name, name);
  storeValue(found->type, one.value, record + found->offset, context, what, place);
  checkRange(*found, record + found->offset, context.colorComponents, ownerOf(classInfo), what,
             &one.value, place);
}

} // namespace

std::vector<std::uint32_t> packArguments(const ClassInfo &classInfo, const ObjectValues &values,
                                         const StoreContext &context) {
  const std::vector<MemberInfo> &parameters = classInfo.parameters;
  const std::vector<const Value *> arguments = matchArguments(classInfo, values);
  // Words, for the packed arguments are read as such.
  std::vector<std::uint32_t> packed(classInfo.parameterSize / 4 + 1, 0);
  bool isRefused = false;
  ErrorCollector errors;
  const auto pack = [&](const MemberInfo &parameter, const Value &argument) {
    auto *start = reinterpret_cast<std::uint8_t *>(packed.data()) + parameter.offset;
    const std::string what = fmt::format("parameter `{}` of `{}`", parameter.name, classInfo.name);
    storeValue(parameter.type, argument, start, context, what, values.place);
    checkRange(parameter, start, context.colorComponents, ownerOf(classInfo), what, &argument,
               values.place);
  };
  for (std::size_t i = 0; i < parameters.size(); ++i)
    if (arguments[i]->kind == Value::Kind::Refused)
      isRefused = true;
    else
      errors.attempt([&] { pack(parameters[i], *arguments[i]); });
  errors.throwIfAny();
  return isRefused ? std::vector<std::uint32_t>() : packed;
}

void storeMembers(const ClassInfo &classInfo, const std::string &name, const ObjectValues &values,
                  std::uint8_t *record, const StoreContext &context, bool lacksArguments) {
  ErrorCollector errors;
  for (const NamedValue &one : values.members)
    if (!lacksArguments || !isOnlyParameter(classInfo, one.name))
      errors.attempt([&] { setMember(classInfo, name, one, values.place, record, context); });
  errors.throwIfAny();
}

void checkOwnValues(const ClassInfo &classInfo, const std::string &name, const ObjectValues &values,
                    const std::uint8_t *record, std::uint32_t colorComponents) {
  ErrorCollector errors;
  for (const MemberInfo &member : classInfo.members)
    if (member.values && (member.hasDefault || classInfo.hasConstructor) &&
        !isGiven(member, values))
      errors.attempt([&] {
        checkRange(member, record + member.offset, colorComponents, ownerOf(classInfo),
                   fmt::format("member `{}` of `{}`", member.name, name), nullptr, values.place);
      });
  errors.throwIfAny();
}

/// Where a member could be set besides its object, as the end of a message.
static std::string elsewhere(const char *before, const ObjectValues &values) {
  return values.variablePlaces.empty()
             ? ""
             : fmt::format("{} a variable of this name in {}", before, values.variablePlaces);
}

void checkUnset(const ClassInfo &classInfo, const std::string &name, const ObjectValues &values,
                const std::uint8_t *record) {
  std::vector<std::string> missing;
  for (const MemberInfo &member : classInfo.members) {
    if (!member.isPublic || member.hasDefault)
      continue;
    if (isGiven(member, values))
      continue;
    if (member.isRequired)
      missing.push_back(fmt::format("`{}`", member.name));
    if (member.type.kind == ValueType::Kind::Reference && member.type.bufferRank == 0 &&
        member.type.arraySizes.empty()) {
      RtslRef reference;
      std::memcpy(&reference, record + member.offset, 4);
      if (reference == 0)
        throw Error(message::referenceMissing(name, member.name, classInfo.name,
                                              member.type.className, elsewhere(", or", values)),
                    values.place);
    }
  }
  if (missing.empty())
    return;
  const bool isOne = missing.size() == 1;
  throw Error(message::membersMissing(isOne ? "member" : "members", fmt::join(missing, ", "), name,
                                      isOne ? "is" : "are", isOne ? "it" : "them",
                                      elsewhere(", or", values)),
              values.place);
}

} // namespace rtsl::runtime
