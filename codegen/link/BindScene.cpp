//===- BindScene.cpp - facts about the objects of a scene -----------------===//
//
// A program that renders is made after the constructors of its scene have run. From then on members
// do not change, and a member that has the same value in all objects of a class is a constant:
// computations on it fold. A reference to a class may refer to objects of the class and of all
// classes derived from it.
//
//===----------------------------------------------------------------------===//
#include "codegen/link/BindScene.h"

#include "codegen/ir/Attributes.h"
#include "codegen/ir/ClassTable.h"
#include "codegen/ir/Layout.h"
#include "codegen/ir/Rtsl.h"
#include "codegen/ir/Slots.h"
#include "codegen/link/BindTables.h"
#include "codegen/link/Members.h"
#include "codegen/link/UnrollRecursion.h"
#include "codegen/passes/BindMembers.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"

#include "codegen/link/steps/Steps.h"
#include "llvm/ADT/STLExtras.h"
#include "llvm/ADT/SetVector.h"
#include "llvm/ADT/StringSwitch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace rtsl {

namespace {

/// Whether the runtime calls the function only while a scene is built.
bool isForBuilding(mlir::func::FuncOp function) {
  return ir::attr::constructor.isOn(function) || ir::slotOf(function) == ir::slot::computeBounds;
}

/// Does rtsl_emitted_power call it?
bool isOfEmission(mlir::func::FuncOp function) {
  return llvm::StringSwitch<bool>(ir::slotOf(function))
      .Cases({"rt_Material.emission", "rt_Primitive.generateSample"}, true)
      .Cases({"rt_Primitive.computeNormal", "rt_Primitive.computeTextureCoordinates",
              "rt_Primitive.computeDerivatives"},
             true)
      .Default(false);
}

/// Makes an entry point private that is no longer called from outside.
void hide(mlir::func::FuncOp function) {
  ir::attr::exported.removeFrom(function);
  function.setPrivate();
}

using Objects = std::vector<const runtime::SceneFacts::Object *>;

/// The objects of each class and of the classes derived from it.
std::map<mlir::Operation *, Objects> objectsByClass(const mlir::SymbolTable &symbols,
                                                    const runtime::SceneFacts &scene) {
  std::map<mlir::Operation *, Objects> byClass;
  for (const runtime::SceneFacts::Object &object : scene.objects) {
    auto at = symbols.lookup<ir::ClassOp>(object.className);
    while (at) {
      byClass[at].push_back(&object);
      at = at.getBase() ? symbols.lookup<ir::ClassOp>(*at.getBase()) : ir::ClassOp();
    }
  }
  return byClass;
}

/// The words of a member if they are the same in all objects; nothing otherwise.
std::vector<std::int32_t> commonWords(const ir::ClassTable &classes, ir::MemberDeclOp member,
                                      llvm::ArrayRef<Objects::value_type> objects) {
  std::vector<std::int32_t> common;
  for (const runtime::SceneFacts::Object *object : objects) {
    std::vector<std::int32_t> words(ir::sizeInBytes(member.getType()) / 4);
    std::memcpy(words.data(),
                object->record + *classes.find(object->className, member.getSymName())->offset,
                words.size() * 4);
    if (!common.empty() && common != words)
      return {};
    common = std::move(words);
  }
  return common;
}

/// Whether the scene names the member, or its class or one derived from it, as editable.
bool isEditable(const LinkRequest &request, ir::ClassOp record, ir::MemberDeclOp member,
                const Objects &objects) {
  const auto names = [&](llvm::StringRef className) {
    return request.editable.count(className.str()) ||
           request.editable.count((className + "." + member.getSymName()).str());
  };
  return names(record.getSymName()) ||
         llvm::any_of(objects, [&](const auto *object) { return names(object->className); });
}

/// The first location that reads a member, by class and name.
using Readers =
    std::map<std::pair<std::string, std::string>, std::pair<std::string, ir::SourcePlace>>;

/// The functions that the runtime calls, and their callees: members that only constructors and
/// bounds read are not read while rendering.
std::vector<mlir::func::FuncOp> reachedFunctions(mlir::ModuleOp ir,
                                                 const mlir::SymbolTable &symbols) {
  llvm::SetVector<mlir::Operation *> reached;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (!function.isPrivate())
      reached.insert(function);
  for (std::size_t i = 0; i < reached.size(); ++i)
    if (const auto uses = mlir::SymbolTable::getSymbolUses(reached[i]))
      for (const mlir::SymbolTable::SymbolUse &use : *uses)
        if (auto callee = symbols.lookup<mlir::func::FuncOp>(use.getSymbolRef().getRootReference()))
          reached.insert(callee);
  std::vector<mlir::func::FuncOp> inOrder;
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (reached.contains(function))
      inOrder.push_back(function);
  return inOrder;
}

Readers findReaders(mlir::ModuleOp ir, const mlir::SymbolTable &symbols) {
  Readers readers;
  for (mlir::func::FuncOp function : reachedFunctions(ir, symbols))
    function.walk([&](ir::MemberOp op) {
      const auto object = llvm::cast<ir::RefType>(op.getObject().getType()).getClassName();
      readers.try_emplace({object.str(), op.getMember().str()},
                          std::pair(linking::shownName(function), ir::placeOf(op.getLoc())));
    });
  return readers;
}

/// "1.5" or "(0, 1, 0)"; empty if it is long or not meaningful to readers.
std::string valueText(mlir::Type type, const std::vector<std::int32_t> &words) {
  const mlir::Type scalar = mlir::getElementTypeOrSelf(type);
  if (words.size() > 4 || !(scalar.isF32() || scalar.isInteger(32) || scalar.isInteger(1)))
    return {};
  std::string text;
  for (const std::int32_t word : words) {
    float number;
    std::memcpy(&number, &word, sizeof number);
    text += text.empty() ? "" : ", ";
    text += scalar.isF32()        ? fmt::format("{:.6g}", number)
            : scalar.isInteger(1) ? (word ? "true" : "false")
                                  : fmt::format("{}", word);
  }
  return words.size() == 1 ? text : "(" + text + ")";
}

/// The item of --keep that a member belongs to.
Item itemOf(const std::string &className, mlir::Type type) {
  if (isSampler(className))
    return Item::Images;
  mlir::Type element = type;
  if (const auto buffer = llvm::dyn_cast<ir::BufferType>(element))
    element = buffer.getElement();
  while (const auto array = llvm::dyn_cast<ir::ArrayType>(element))
    element = array.getElement();
  if (element != type && llvm::isa<ir::RefType>(element))
    return Item::Bindless;
  return llvm::isa<ir::BufferType>(type) ? Item::Buffers : Item::Parameters;
}

Finding describe(ir::ClassOp record, ir::MemberDeclOp member, std::size_t objects,
                 const std::vector<std::int32_t> &words, const Readers &readers) {
  const std::string className = record.getSymName().str();
  Finding finding = {itemOf(className, member.getType()),
                     className + "." + member.getSymName().str(),
                     false,
                     {},
                     {}};
  const auto reader = readers.find({className, member.getSymName().str()});
  if (reader == readers.end()) {
    const bool isEmpty =
        llvm::isa<ir::RefType>(member.getType()) && !words.empty() && words.front() == 0;
    finding.reason = isEmpty ? "it is empty in all objects" : "no code that renders reads it";
    return finding;
  }
  finding.place = reader->second.second;
  if (const mlir::Type type = member.getType(); llvm::isa<ir::RefType, ir::BufferType>(type)) {
    finding.isNeeded = true;
    finding.reason = llvm::isa<ir::BufferType>(type) ? "read from the record: a buffer"
                                                     : "read from the record: a reference";
    return finding;
  }
  if (ir::attr::editable.isOn(member)) {
    finding.isNeeded = true;
    finding.reason = "read from the record: editable";
    return finding;
  }
  const std::string value = words.empty() ? std::string() : valueText(member.getType(), words);
  if (words.empty())
    finding.reason =
        fmt::format("read from the record: {} differ",
                    objects == 2 ? "both objects" : fmt::format("the {} objects", objects));
  else if (objects == 1)
    finding.reason =
        fmt::format("in the code{}: one object has it", value.empty() ? "" : " as " + value);
  else
    finding.reason =
        fmt::format("in the code{}: the same in {}", value.empty() ? "" : " as " + value,
                    objects == 2 ? "both objects" : fmt::format("all {} objects", objects));
  finding.isNeeded = words.empty();
  return finding;
}

void describeLights(mlir::ModuleOp ir, const runtime::SceneFacts &scene, Findings &findings) {
  Finding loops = {Item::Lights, "illuminance", false, "no shader uses lights", {}};
  Finding ambient = {Item::Lights, "ambient light", false, "no shader reads it", {}};
  ir.walk([&](mlir::Operation *op) {
    if (linking::isLitByLights(op) && !loops.place.isKnown()) {
      loops.isNeeded = scene.lightCount != 0;
      loops.reason = scene.lightCount == 0
                         ? "the scene has no lights: the loop is removed"
                         : fmt::format("{} light{}, a number in the code", scene.lightCount,
                                       scene.lightCount == 1 ? "" : "s");
      loops.place = ir::placeOf(op->getLoc());
    } else if (llvm::isa<ir::AmbientOp>(op) && !ambient.place.isKnown()) {
      ambient.reason = fmt::format("in the code as ({:.6g})", fmt::join(scene.ambient, ", "));
      ambient.place = ir::placeOf(op->getLoc());
    }
  });
  findings.push_back(loops);
  findings.push_back(ambient);
}

/// A feature that a scene may have.
struct GraphPart {
  Item item;
  std::uint32_t need; // RTSL_HAS_*
  const char *subject, *present, *absent;
  std::uint32_t beside = 0; // it matters only beside one of these; 0: in any case
};
constexpr GraphPart graphParts[] = {
    {Item::Transforms, RTSL_HAS_TRANSFORMS, "transforms", "some instance has one",
     "no instance has one: rays stay in world space"},
    {Item::Transforms, RTSL_HAS_LINEAR, "linear parts of transforms",
     "some transform turns, scales or shears", "every transform is a translation"},
    {Item::Transforms, RTSL_HAS_TURNS, "rotations and shears of transforms",
     "some transform turns or shears", "linear parts are scales along the axes, or nothing"},
    {Item::Transforms, RTSL_HAS_SCALE | RTSL_HAS_STRETCH, "scales of transforms",
     "some transform scales", "transforms are rigid: inverses are transposes, to within 2^-40"},
    {Item::Transforms, RTSL_HAS_STRETCH, "uneven scales and shears of transforms",
     "some transform scales one direction more than another, mirrors or shears",
     "scales are uniform: inverses are transposes divided by their squares, to within 2^-40; or "
     "they are along the axes and at rest",
     RTSL_HAS_TURNS | RTSL_HAS_MOTION},
    {Item::Roots, RTSL_HAS_ROOTS, "roots", "the scene has several",
     "all instances are below root 0"},
    {Item::Counts, RTSL_HAS_COUNTS, "counts", "some object holds several primitives",
     "each object is one primitive"},
    {Item::Selectors, RTSL_HAS_SELECTORS, "selectors", "some instance is below one",
     "the scene has none"},
    {Item::Motion, RTSL_HAS_MOTION, "motion", "some transform has keys", "no transform has keys"},
    {Item::Motion, RTSL_HAS_MESH_KEYS, "mesh keys", "some mesh has several", "no mesh has several"},
    {Item::Motion, RTSL_HAS_SHUTTER, "shutter", "each sample has a time of its own",
     "nothing moves: the time of all rays is 0"},
    {Item::Masks, RTSL_HAS_MASKS, "masks", "some instance has one",
     "all instances are seen by rays of all masks"},
    {Item::BackFaces, RTSL_HAS_NO_BACKS, "back faces",
     "some mesh leaves them out: the side of a hit is tested",
     "no mesh leaves them out: both sides of triangles are hit"},
    {Item::Lights, RTSL_HAS_SAMPLED_BACKGROUND, "directions of the background",
     "it has `sampleDirection` and `directionPDF`", "the background cannot choose any"},
    {Item::Lights, RTSL_HAS_LIGHT_TREE, "light tree", "many surfaces shine",
     "few surfaces shine, or none: they are chosen by their power"},
};

} // namespace

std::uint32_t graphNeeds(const runtime::SceneFacts &scene, const LinkRequest &request,
                         Findings *findings) {
  std::uint32_t needs = scene.needs;
  for (const GraphPart &part : graphParts) {
    const bool isNeeded =
        scene.needs & part.need && (part.beside == 0 || scene.needs & part.beside);
    if (findings)
      findings->push_back(
          {part.item, part.subject, isNeeded, isNeeded ? part.present : part.absent, {}});
    if (request.keep.has(part.item))
      needs |= part.need;
    if (request.without.count({part.item, part.subject}))
      needs &= ~part.need;
  }
  return needs;
}

void keepConstructors(mlir::ModuleOp ir, bool withEmission) {
  for (auto function : ir.getOps<mlir::func::FuncOp>())
    if (ir::attr::exported.isOn(function) && !isForBuilding(function) &&
        !(withEmission && isOfEmission(function)) && ir::slotOf(function) != ir::slot::features)
      hide(function);
}

void bindScene(mlir::ModuleOp ir, const runtime::SceneFacts &scene, const LinkRequest &request,
               Findings *findings) {
  const ItemSet keep = request.keep;
  for (auto function : llvm::make_early_inc_range(ir.getOps<mlir::func::FuncOp>()))
    if (isForBuilding(function))
      function.erase(); // only the runtime calls them

  if (scene.referenceChain != ~0u)
    unrollRecursion(ir, scene.referenceChain);
  mlir::Builder builder(ir.getContext());
  const mlir::SymbolTable symbols(ir);
  const ir::ClassTable classes(ir);
  const Readers readers = findReaders(ir, symbols);
  const std::map<mlir::Operation *, Objects> byClass = objectsByClass(symbols, scene);
  for (auto record : ir.getOps<ir::ClassOp>()) {
    const auto objects = byClass.find(record);
    if (objects == byClass.end())
      continue;
    for (auto member : record.getBody().getOps<ir::MemberDeclOp>()) {
      if (member.isScratch())
        continue;
      std::vector<std::int32_t> words = commonWords(classes, member, objects->second);
      if (isEditable(request, record, member, objects->second))
        ir::attr::editable.set(member);
      if (findings)
        findings->push_back(describe(record, member, objects->second.size(), words, readers));
      const Item item = itemOf(record.getSymName().str(), member.getType());
      if (request.without.count({item, (record.getSymName() + "." + member.getSymName()).str()}))
        words = commonWords(classes, member, llvm::ArrayRef(objects->second).take_front());
      if (!words.empty() && !keep.has(item) && !ir::attr::editable.isOn(member))
        ir::attr::bound.set(member, builder.getDenseI32ArrayAttr(words));
    }
  }
  if (findings)
    describeLights(ir, scene, *findings);
  if (!keep.has(Item::Lights)) {
    const std::uint32_t lights =
        request.without.count({Item::Lights, "illuminance"}) ? 0 : scene.lightCount;
    ir::attr::lightCount.set(ir, builder.getI32IntegerAttr(static_cast<std::int32_t>(lights)));
    ir::attr::ambient.set(ir, builder.getDenseF32ArrayAttr(scene.ambient));
  }
  bindTables(ir, scene, request, findings);
}

} // namespace rtsl
