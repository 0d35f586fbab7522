//===- MeshAttributes.cpp - scratch members that are read of meshes -------===//
//
// A material that is on a mesh reads the mesh's named attributes as scratch members. Whether the
// mesh has them is known when its file is read; the runtime checks it by the list that is made
// here. Attributes of meshes do not overlap each other, because a mesh may have any of them.
//
//===----------------------------------------------------------------------===//
#include "codegen/ir/Attributes.h"
#include "codegen/link/Reflect.h"
#include "codegen/link/steps/Steps.h"

#include <algorithm>

namespace rtsl::linking {

namespace {

/// Numbers, vectors and colors.
bool isOfMesh(const Type *type) {
  return type->isScalar() || type->isVector() || type->is(TypeKind::Color);
}

/// The class that a member, or an element of it, refers to; null: it is no reference.
const Type *referredBy(const Type *type) {
  while (type->is(TypeKind::Array) || type->is(TypeKind::Buffer))
    type = type->element;
  return type->is(TypeKind::Class) ? type : nullptr;
}

/// Adds a class, and those whose objects its own may refer to, directly or indirectly: a wrapper
/// calls methods of the materials in it.
void addWithReferred(LinkContext &context, const typed::Class &info,
                     std::set<const typed::Class *> &seen) {
  if (!seen.insert(&info).second)
    return;
  if (info.root == "rt_Material")
    context.meshMaterials.insert(info.name);
  for (const typed::Member *member : allMembers(info))
    if (const Type *reference = referredBy(member->type)) {
      const std::string base =
          reference->classType ? reference->classType->name : reference->builtinClass;
      for (const LinkedClass &other : context.classes)
        if (derivesFrom(*other.info, base))
          addWithReferred(context, *other.info, seen);
    }
}

/// Without a scene, any material may be on a mesh.
void addAllMaterials(LinkContext &context) {
  for (const LinkedClass &linked : context.classes)
    if (linked.info->root == "rt_Material")
      context.meshMaterials.insert(linked.info->name);
}

void checkTypes(LinkContext &context, const typed::Class &material) {
  for (const typed::Member *member : allMembers(material))
    if (member->access == ast::Access::Scratch && !member->changeOf && !isOfMesh(member->type))
      context.diagnostics.report(Code::meshAttributeType, member->range, material.name,
                                 member->name, toString(member->type));
}

} // namespace

void findMeshMaterials(LinkContext &context) {
  const ClassesByName classes = classesOf(context);
  if (!context.hasScene)
    return addAllMaterials(context);
  std::set<const typed::Class *> seen;
  for (const auto &[primitive, material] : context.request.surfaces)
    if (const typed::Class *info = findClass(classes, material); info && primitive.empty()) {
      if (!seen.count(info))
        checkTypes(context, *info);
      addWithReferred(context, *info, seen);
    }
}

bool mayBeOnMesh(const LinkContext &context, const std::string &className) {
  return context.meshMaterials.count(className) != 0;
}

namespace {

/// A change, by name, axis and type.
using Change = std::tuple<llvm::StringRef, std::uint32_t, mlir::Type>;

Change changeOf(ir::AttributeOp op) {
  return {op.getName(), *op.getAxis(), op.getType()};
}

} // namespace

void dropUnknownChanges(LinkContext &context) {
  std::vector<Change> ofPrimitives;
  for (const LinkedClass &linked : context.classes)
    if (mlir::func::FuncOp method = findMethod(context, linked, typed::scratchChangesMethod);
        method && linked.isUsed)
      method.walk([&](ir::AttributeOp op) {
        if (op.getAxis())
          ofPrimitives.push_back(changeOf(op));
      });
  std::vector<ir::AttributeOp> changes;
  context.ir.walk([&](ir::AttributeOp op) {
    if (!op.getAxis())
      return;
    const auto owner = ir::attr::className.of(op->getParentOfType<mlir::func::FuncOp>());
    const std::string subject = changeSubject(op.getName().str(), *op.getAxis());
    const bool isKnown = (owner && mayBeOnMesh(context, owner.str())) ||
                         llvm::is_contained(ofPrimitives, changeOf(op));
    if (!isKnown || context.isWithout(Item::MeshAttributes, subject) ||
        context.isWithout(Item::Attributes, subject))
      changes.push_back(op);
  });
  for (ir::AttributeOp op : changes)
    for (mlir::Operation *user : llvm::make_early_inc_range(op->getUsers()))
      if (auto load = mlir::dyn_cast<ir::LoadOp>(user)) {
        mlir::OpBuilder builder(load);
        load.replaceAllUsesWith(mlir::Value(mlir::arith::ConstantOp::create(
            builder, load.getLoc(), builder.getZeroAttr(load.getType()))));
        load.erase();
      }
}

void listMeshAttributes(LinkContext &context, const ClassesByName &classes) {
  const bool areKept = context.request.keep.has(Item::MeshAttributes);
  for (auto function : mlir::ModuleOp(context.ir).getOps<mlir::func::FuncOp>()) {
    const auto owner = ir::attr::className.of(function);
    if (!owner || !mayBeOnMesh(context, owner.str()))
      continue;
    function.walk([&](ir::AttributeOp op) {
      const std::string name = op.getName().str();
      const typed::Class *info = findClass(classes, owner.str());
      const typed::Member *member = info ? findScratch(*info, name) : nullptr;
      if (!op.getOffset() || !member || !isOfMesh(member->type) || !(isRead(op) || areKept))
        return;
      auto found = std::find_if(
          context.meshAttributes.begin(), context.meshAttributes.end(),
          [&](const MeshAttribute &one) { return one.name == name && one.type == member->type; });
      if (found == context.meshAttributes.end())
        found = context.meshAttributes.insert(
            found, {name, member->type, mlir::cast<ir::PtrType>(op.getType()).getPointee()});
      (op.getAxis() ? found->changes[*op.getAxis()] : found->offset) = *op.getOffset();
      found->readers.insert(owner.str());
    });
  }
}

std::vector<runtime::AttributeInfo> describeMeshAttributes(const LinkContext &context) {
  std::vector<runtime::AttributeInfo> described;
  for (const MeshAttribute &attribute : context.meshAttributes)
    described.push_back({attribute.name,
                         reflect(attribute.type, attribute.irType),
                         attribute.offset,
                         {attribute.changes[0], attribute.changes[1]}});
  return described;
}

std::uint32_t meshAttributesOf(const LinkContext &context, const std::string &className) {
  std::uint32_t bits = 0;
  for (std::size_t i = 0; i < context.meshAttributes.size(); ++i)
    if (context.meshAttributes[i].readers.count(className))
      bits |= 1u << i;
  return bits;
}

} // namespace rtsl::linking
