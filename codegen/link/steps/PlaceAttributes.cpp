//===- PlaceAttributes.cpp - offsets of the scratch members of a hit ------===//
//
// A primitive's scratch members are attributes of its hits; a material reads those that it declares
// itself, matched by name and type. On a mesh they are its named attributes (MeshAttributes.cpp).
// Two attributes may overlap if no primitive has both. The changes of an attribute across the
// footprint are attributes, too; none overlaps another one, because they are 0 where a primitive is
// hit that does not have the scratch member. An attribute that is never read has no offset, and is
// not stored.
//
// Without a scene, attributes that are never read also get offsets if there is space, and
// attributes of classes with a common base do not overlap: C++ has one struct for all of them.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/ir/Layout.h"
#include "codegen/link/Reflect.h"
#include "codegen/link/steps/Steps.h"

#include <algorithm>
#include <map>
#include <set>

namespace rtsl::linking {

ClassesByName classesOf(const LinkContext &context) {
  ClassesByName classes;
  for (const LinkedClass &linked : context.classes)
    classes[linked.info->name] = linked.info;
  return classes;
}

const typed::Class *findClass(const ClassesByName &classes, const std::string &name) {
  const auto found = classes.find(name);
  return found == classes.end() ? nullptr : found->second;
}

namespace {

/// Every scratch member that the material declares must be one of the primitive's, of the same
/// type.
void matchSurface(LinkContext &context, const typed::Class &primitive,
                  const typed::Class &material) {
  for (const typed::Member *read : allMembers(material)) {
    if (read->access != ast::Access::Scratch || read->changeOf)
      continue;
    const typed::Member *written = findScratch(primitive, read->name);
    if (!written) {
      context.diagnostics
          .report(Code::attributeMissing, read->range, material.name, read->name, primitive.name)
          .label(primitive.range,
                 fmt::format("the scene gives `{}` to this primitive", material.name));
    } else if (written->type != read->type) {
      context.diagnostics
          .report(Code::attributeTypeMismatch, read->range, material.name, read->name,
                  toString(read->type), primitive.name, toString(written->type))
          .label(written->range, fmt::format("written here as `{}`", toString(written->type)));
    }
  }
}

struct Attribute {
  std::string name;
  mlir::Type type;
  std::optional<std::uint32_t> axis;     // of the footprint: it is the change of an attribute
  const typed::Member *member = nullptr; // of the first class that uses it
  std::uint32_t words = 0;
  std::uint32_t offset = 0;
  bool isRead = false;
  std::set<std::string> primitives; // classes whose functions use it, or their root base classes
  std::vector<ir::AttributeOp> uses;
};

/// Does `user` store the whole attribute, and not use it in another way?
bool isStore(mlir::Operation *user, ir::AttributeOp op) {
  if (auto copy = mlir::dyn_cast<ir::CopyOp>(user))
    return copy.getTarget() == op && copy.getSource() != op;
  return mlir::isa<ir::StoreOp, ir::ClearOp>(user);
}

/// Attributes of classes in the same group must not overlap.
std::string groupOf(const LinkContext &context, const ClassesByName &classes,
                    const std::string &name) {
  const typed::Class *info = findClass(classes, name);
  if (context.hasScene || !info)
    return name;
  while (info->base)
    info = info->base;
  return info->name;
}

/// All attributes of the module, in the order of first use.
std::vector<Attribute> collect(const LinkContext &context, const ClassesByName &classes) {
  std::vector<Attribute> attributes;
  for (auto function : mlir::ModuleOp(context.ir).getOps<mlir::func::FuncOp>()) {
    function.walk([&](ir::AttributeOp op) {
      const mlir::Type type = mlir::cast<ir::PtrType>(op.getType()).getPointee();
      auto found = std::find_if(attributes.begin(), attributes.end(), [&](const Attribute &known) {
        return known.name == op.getName().str() && known.type == type && known.axis == op.getAxis();
      });
      if (found == attributes.end()) {
        Attribute added;
        added.name = op.getName().str();
        added.type = type;
        added.axis = op.getAxis();
        added.words = ir::sizeInBytes(type) / 4;
        found = attributes.insert(attributes.end(), std::move(added));
      }
      found->uses.push_back(op);
      found->isRead |= isRead(op);
      if (auto owner = ir::attr::className.of(function)) {
        found->primitives.insert(groupOf(context, classes, owner.str()));
        if (const typed::Class *info = findClass(classes, owner.str()); info && !found->member)
          found->member = findScratch(*info, found->name);
        if (mayBeOnMesh(context, owner.str()))
          found->primitives.insert("mesh");
      }
    });
  }
  return attributes;
}

/// Finding::subject of it.
std::string subjectOf(const Attribute &attribute) {
  return attribute.axis ? changeSubject(attribute.name, *attribute.axis) : attribute.name;
}

/// The item of --keep that it belongs to.
Item itemOf(const Attribute &attribute) {
  return attribute.primitives.count("mesh") ? Item::MeshAttributes : Item::Attributes;
}

void note(LinkContext &context, const Attribute &attribute) {
  ir::AttributeOp use =
      *std::find_if(attribute.uses.begin(), attribute.uses.end(),
                    [&](ir::AttributeOp op) { return isRead(op) == attribute.isRead; });
  const std::string function = shownName(use->getParentOfType<mlir::func::FuncOp>());
  context.findings.push_back(
      {itemOf(attribute), subjectOf(attribute), attribute.isRead,
       attribute.isRead
           ? fmt::format("{} bytes of the hit, read by `{}`", 4 * attribute.words, function)
           : fmt::format("`{}` writes it and nothing reads it", function),
       ir::placeOf(use.getLoc())});
}

/// May both be needed at one hit?
bool shareAPrimitive(const Attribute &a, const Attribute &b) {
  return a.axis || b.axis ||
         std::any_of(a.primitives.begin(), a.primitives.end(),
                     [&](const std::string &name) { return b.primitives.count(name) != 0; });
}

/// The lowest offset that no attribute of the same primitive uses.
std::uint32_t firstFit(const Attribute &attribute, const std::vector<const Attribute *> &placed) {
  std::uint32_t offset = 0;
  for (bool moved = true; moved;) {
    moved = false;
    for (const Attribute *other : placed)
      if (shareAPrimitive(attribute, *other) && offset < other->offset + other->words &&
          other->offset < offset + attribute.words) {
        offset = other->offset + other->words;
        moved = true;
      }
  }
  return offset;
}

void eraseStores(Attribute &attribute) {
  llvm::erase_if(attribute.uses, [](ir::AttributeOp op) {
    for (mlir::Operation *user : llvm::make_early_inc_range(op->getUsers()))
      if (isStore(user, op))
        user->erase();
    if (!op->use_empty())
      return false;
    op.erase();
    return true;
  });
}

} // namespace

bool isRead(ir::AttributeOp op) {
  return std::any_of(op->user_begin(), op->user_end(),
                     [&](mlir::Operation *user) { return !isStore(user, op); });
}

const typed::Member *findScratch(const typed::Class &info, const std::string &name) {
  for (const typed::Member *member : allMembers(info))
    if (member->access == ast::Access::Scratch && member->name == name)
      return member;
  return nullptr;
}

const typed::Member *scratchOf(const typed::Class &info, ir::AttributeOp place) {
  const typed::Member *value = findScratch(info, place.getName().str());
  if (!place.getAxis())
    return value;
  for (const typed::Member *member : allMembers(info))
    if (member->changeOf == value && member->axis == static_cast<int>(*place.getAxis()))
      return member;
  return nullptr;
}

void placeAttributes(LinkContext &context) {
  const ClassesByName classes = classesOf(context);
  std::set<std::pair<std::string, std::string>> seen;
  for (const auto &[primitive, material] : context.request.surfaces)
    if (const typed::Class *info = findClass(classes, material),
        *hit = findClass(classes, primitive);
        info && hit && seen.insert({primitive, material}).second)
      matchSurface(context, *hit, *info);

  std::vector<Attribute> attributes = collect(context, classes);
  for (const Attribute &attribute : attributes)
    note(context, attribute);
  // Attributes that are never read get the remaining space.
  std::stable_partition(attributes.begin(), attributes.end(),
                        [](const Attribute &attribute) { return attribute.isRead; });
  std::vector<const Attribute *> placed;
  std::uint32_t words = 0;
  const typed::Member *last = nullptr;
  for (Attribute &attribute : attributes) {
    if (attribute.isRead && context.isWithout(itemOf(attribute), subjectOf(attribute)))
      eraseStores(attribute);
    attribute.offset = firstFit(attribute, placed);
    if (!attribute.isRead) {
      // Too large only because of attributes that are never read: these are dropped.
      const bool fits = attribute.offset + attribute.words <= RTSL_MAX_ATTRIBUTE_WORDS;
      const bool isKept = context.request.keep.has(itemOf(attribute)) || !context.hasScene;
      if (!isKept || !fits) {
        eraseStores(attribute);
        continue;
      }
    }
    placed.push_back(&attribute);
    if (attribute.offset + attribute.words > words) {
      words = attribute.offset + attribute.words;
      last = attribute.member;
    }
    for (ir::AttributeOp op : attribute.uses)
      op.setOffset(attribute.offset);
  }
  if (words > RTSL_MAX_ATTRIBUTE_WORDS)
    context.diagnostics.report(Code::attributesTooLarge, last ? last->range : SourceRange(), words,
                               RTSL_MAX_ATTRIBUTE_WORDS);
  listMeshAttributes(context, classes);
}

} // namespace rtsl::linking
