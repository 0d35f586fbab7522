//===- UsedObjects.cpp - objects that a ray can reach ---------------------===//
//
// A scene may contain materials and textures that nothing refers to, and lights that no shader
// uses. They are made, because mistakes in them should be found, and records and the random numbers
// of constructors should not change; but they are never called. A class without other objects is
// not part of dispatch, and its methods are not reached. Of a material that no surface has, rays
// run no methods; only those run that other materials call.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/steps/Steps.h"

#include "llvm/ADT/STLExtras.h"

#include <set>

namespace rtsl::linking {

namespace {

using Role = ScenePart::Role;

class Uses {
public:
  explicit Uses(const LinkContext &context)
      : context(context), parts(context.request.parts), users(parts.size(), unused) {}

  /// Marks every part of this role, and the parts that they refer to, as used.
  void add(Role role) {
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (parts[i].role == role)
        add(i, i);
  }

  bool isUsed(std::size_t part) const { return users[part] != unused; }
  const std::string &userOf(std::size_t part) const { return parts[users[part]].name; }

  /// Sets LinkedClass::isUsed.
  void mark(std::vector<LinkedClass> &classes) const {
    std::set<llvm::StringRef> used;
    for (std::size_t i = 0; i < parts.size(); ++i)
      if (isUsed(i))
        used.insert(parts[i].classes.begin(), parts[i].classes.end());
    for (LinkedClass &linked : classes)
      linked.isUsed = !context.isWithout(Item::Classes, linked.info->name) &&
                      (!linked.hasObjects || used.count(linked.info->name) != 0);
  }

private:
  static constexpr std::size_t unused = ~std::size_t(0);

  void add(std::size_t part, std::size_t user) {
    if (isUsed(part) || context.isWithout(Item::Objects, parts[part].name))
      return;
    users[part] = user;
    for (std::size_t next : parts[part].refersTo)
      add(next, part);
  }

  const LinkContext &context;
  const std::vector<ScenePart> &parts;
  std::vector<std::size_t> users; // the first part that refers to it
};

void findUsed(LinkContext &context) {
  for (LinkedClass &linked : context.classes)
    linked.isUsed = !context.isWithout(Item::Classes, linked.info->name);
  const std::vector<ScenePart> &parts = context.request.parts;
  if (parts.empty())
    return;
  Uses uses(context);
  uses.add(Role::Root);
  uses.mark(context.classes);
  const bool hasLights =
      llvm::any_of(parts, [](const ScenePart &part) { return part.role == Role::Light; });
  const bool areLightsUsed = hasLights && usesLights(context);
  if (areLightsUsed)
    uses.add(Role::Light);
  uses.mark(context.classes);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (parts[i].role == Role::Root)
      continue;
    const bool isLight = parts[i].role == Role::Light;
    const std::string reason =
        isLight ? (areLightsUsed ? "an `illuminance` that runs uses it" : "no `illuminance` runs")
        : uses.isUsed(i) ? "referred to by " + uses.userOf(i)
                         : "nothing that is used refers to it";
    context.findings.push_back(
        {Item::Objects, parts[i].name, uses.isUsed(i), reason, parts[i].place});
  }
  if (context.request.keep.has(Item::Objects))
    for (LinkedClass &linked : context.classes)
      linked.isUsed = true;
}

/// May a surface have a material of this class?
bool isOnSurface(const LinkContext &context, const LinkedClass &linked) {
  const LinkRequest &request = context.request;
  return request.surfaces.empty() || !linked.hasObjects || request.isSampled ||
         request.keep.has(Item::Objects) || request.keep.has(Item::States) ||
         llvm::is_contained(llvm::make_second_range(request.surfaces), linked.info->name);
}

} // namespace

void findUsedObjects(LinkContext &context) {
  findUsed(context);
  for (LinkedClass &linked : context.classes)
    linked.isMet =
        linked.isUsed && (linked.info->root != "rt_Material" || isOnSurface(context, linked));
}

} // namespace rtsl::linking
