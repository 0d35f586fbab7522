//===- Steps.h - the steps of linking, for Link.cpp -----------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"
#include "codegen/ir/SourcePlace.h"
#include "codegen/link/Items.h"
#include "codegen/link/Link.h"
#include "codegen/passes/errors/ElementaryErrors.h"
#include "language/SlotTable.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/SymbolTable.h"
#include "llvm/ADT/DenseMap.h"

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

namespace rtsl::linking {

/// A class of the linked program.
struct LinkedClass {
  const typed::Class *info = nullptr;
  bool hasObjects = true; // if not, it is kept only on request
  // a ray can reach an object of it; otherwise only its constructor is used
  bool isUsed = true;
  // and the engine may call its methods: of a material if a surface has it, and not only others
  // that refer to it
  bool isMet = true;
  ir::ClassOp record;
  std::uint32_t id = 0;      // from 1, in the order of the module
  ir::StructType parameters; // packed arguments of the constructor; null: it has none
};

/// A payload type that some function of the program traces.
struct RayType {
  ir::StructType payload;
  std::uint32_t number = 0; // from 1, in the order of first use
  // how hits are searched for: RTSL_FIRST_HIT, RTSL_INVOKE_ANY_HIT, RTSL_IN_ORDER
  std::uint32_t search = 0;

  std::string name() const { return payload.getName().str(); }
};

/// A scratch member that materials read of meshes.
struct MeshAttribute {
  std::string name;
  const Type *type = nullptr;
  mlir::Type irType;
  std::uint32_t offset = RTSL_NOT_READ, changes[2] = {RTSL_NOT_READ, RTSL_NOT_READ}; // in words
  std::set<std::string> readers = {}; // classes of materials
};

struct LinkContext {
  mlir::ModuleOp ir;
  const typed::Module &module;
  const LinkRequest &request;
  Diagnostics &diagnostics;
  Findings &findings; // what the steps omit and what they keep
  ElementaryErrors elementaryErrors;
  bool hasScene = true; // otherwise every class may have objects (LinkModule.h)
  std::vector<LinkedClass> classes = {};
  // for the functions of this name, recorded if they are reached
  std::map<std::string, Finding> dispatches = {};
  std::vector<RayType> rayTypes = {};
  std::set<std::string> meshMaterials = {}; // classes of materials that may be on a mesh
  std::vector<MeshAttribute> meshAttributes = {};
  // of materials, by the name of the slot of passingSlots: those that let light of the scene's
  // lights pass surfaces
  std::map<std::string, std::vector<mlir::func::FuncOp>> methodsThatPassLight = {};
  /// The symbols of `ir`. Functions are added and erased through this table, so that lookups remain
  /// fast.
  mlir::SymbolTable symbols = mlir::SymbolTable(ir);

  mlir::func::FuncOp function(llvm::StringRef name) const {
    return symbols.lookup<mlir::func::FuncOp>(name);
  }

  /// LinkRequest::without.
  bool isWithout(Item item, const std::string &subject) const {
    return request.without.count({item, subject}) != 0;
  }
};

/// Keeps the requested classes: fills in `context.classes` and erases the functions of the others.
void dropUnusedClasses(LinkContext &context);

/// UsedObjects.cpp: finds the objects of the scene that something refers to, and the materials of
/// surfaces: LinkedClass::isUsed and isMet.
void findUsedObjects(LinkContext &context);

/// Whether an operation lights a point with lights of the scene, and not with a surface that
/// shines.
bool isLitByLights(mlir::Operation *op);
/// Whether it lights a point with such a surface: `illuminate(P)`.
bool isLitBySurface(mlir::Operation *op);

/// Whether a method that rendering runs loops over lights. Runs before slots are resolved.
bool usesLights(const LinkContext &context);
/// Whether one lights a point with a surface that shines.
bool usesSurfacesAsLights(const LinkContext &context);

/// Records which classes the program has, once it is known which methods run.
void noteClasses(LinkContext &context);

/// A member as a method sees it: the class that the method was lowered for, and the member's name.
using MemberKey = std::pair<std::string, std::string>;
MemberKey keyOf(ir::MemberOp member);

/// Treats optional members that no object of the scene sets as empty, and removes code that depends
/// on their being set.
void emptyReferences(LinkContext &context);
/// Removes what is run only under conditions that are known to be false.
void dropBranches(mlir::func::FuncOp function);

/// The errors of the elementary functions of a program.
ElementaryErrors elementaryErrorsOf(FloatingPoint floatingPoint);

/// HitErrors.cpp: error bounds of t for the primitives that rays leave. Whether all of these are
/// planes.
bool deriveHitErrors(LinkContext &context);

/// Erases the methods that are never run. Runs after slots are resolved.
void dropUnreached(LinkContext &context);

/// The name of a function in the source: "Painted.closestHit(Radiance)"; of the definition of a
/// base class that is called on an object, "Coated.Glass::shade".
std::string shownName(mlir::func::FuncOp function);

/// Erases stores of outputs that are never read, and records which outputs of hits and samples are
/// computed, and for which function.
void dropUnreadOutputs(LinkContext &context);

/// RTSL_NEEDS_* of the items in LinkRequest::without.
std::uint32_t needsLeftOut(const LinkContext &context);

/// Sets the offset of every `rtsl.attribute`, and erases stores of attributes that are never read
/// in the scene.
void placeAttributes(LinkContext &context);

/// The classes of the program.
using ClassesByName = std::map<std::string, const typed::Class *>;
ClassesByName classesOf(const LinkContext &context);
/// The class of this name; null if there is none.
const typed::Class *findClass(const ClassesByName &classes, const std::string &name);

/// MeshAttributes.cpp: finds the materials that may be on a mesh, and reports their scratch members
/// whose types the attributes of a mesh cannot have.
void findMeshMaterials(LinkContext &context);
/// Replaces by 0 the changes of attributes that materials read which are on no mesh, and that no
/// primitive computes, and those in LinkRequest::without.
void dropUnknownChanges(LinkContext &context);
/// Whether a class is one of the materials that may be on a mesh.
bool mayBeOnMesh(const LinkContext &context, const std::string &className);
/// Lists the attributes that these materials read and that have offsets:
/// LinkContext::meshAttributes.
void listMeshAttributes(LinkContext &context, const ClassesByName &classes);
/// Program::meshAttributes and ClassInfo::attributes.
std::vector<runtime::AttributeInfo> describeMeshAttributes(const LinkContext &context);
std::uint32_t meshAttributesOf(const LinkContext &context, const std::string &className);

/// Is the attribute used other than by stores of all of it?
bool isRead(ir::AttributeOp op);
/// The scratch member of this name of a class; null if there is none.
const typed::Member *findScratch(const typed::Class &info, const std::string &name);
/// The scratch member that an attribute stands for: for its value, or for its change along an axis.
const typed::Member *scratchOf(const typed::Class &info, ir::AttributeOp place);

/// A method that is called through a reference.
struct SlotCall {
  std::string base; // the class of the reference: "rt_Texture" or one of the source
  std::string method;

  std::string name() const { return base + "." + method; }
  bool operator<(const SlotCall &other) const {
    return std::tie(base, method) < std::tie(other.base, other.method);
  }
};
SlotCall slotOf(ir::CallMethodOp call);

/// The objects that a call through a reference may reach.
struct Referred {
  std::string member;            // that refers to them, "Painted.pattern"; empty: any object may
  std::set<std::string> classes; // of these objects
  bool mayBeNone = true;

  bool isKnown() const { return !member.empty(); }
};

/// Those of each `rtsl.call_method`, as far as they follow from the members of the scene's objects.
llvm::DenseMap<mlir::Operation *, Referred> referredClasses(const LinkContext &context);

/// Replaces every `rtsl.call_method` by a call of the function `@dispatch.<nameOf(call)>`, which
/// has attr::dispatch. Calls `define` once for each such function, which has no body.
void replaceSlots(mlir::ModuleOp ir, mlir::SymbolTable &symbols,
                  llvm::function_ref<std::string(ir::CallMethodOp)> nameOf,
                  llvm::function_ref<void(ir::CallMethodOp, mlir::func::FuncOp)> define);

/// Whether a reference to `base` (an rt_ class or one of the source) may refer to objects of the
/// class.
bool derivesFrom(const typed::Class &info, llvm::StringRef base);

/// Whether shaders send rays from hits, and how they choose them. Runs after slots are resolved.
runtime::Paths findPaths(const LinkContext &context);
/// Whether any method but `generate` sends rays, also to lamps. Runs after slots are resolved.
bool raysLeaveHits(const LinkContext &context);
/// Whether rays are sent in loops, or end at any hit. Runs after ray types are resolved.
bool samplesDiffer(const LinkContext &context);
/// Whether any class of primitives is used. Runs after unreached methods are dropped.
bool hasPrimitives(const LinkContext &context);
/// Whether any method but `generate` and those of cameras reads LaunchIndex or LaunchSize. Runs
/// after slots are resolved.
bool raysReadLaunch(const LinkContext &context);

/// Defines the dispatch function of every slot.
void resolveSlots(LinkContext &context);

/// Numbers the payload types that the module traces. Each trace may search for hits in any order.
std::vector<RayType> numberRayTypes(mlir::ModuleOp ir);

/// The same for a program; also determines how to search for hits. Warns of types without methods
/// in the scene. Without a scene, the types that have methods are included.
void resolveRayTypes(LinkContext &context);

/// The struct in the source; null if there is none.
const typed::Struct *structOf(const LinkContext &context, const RayType &type);

/// EndlessRays.cpp: warns if every material that handles a kind of rays sends another one on every
/// path.
void warnOfEndlessRays(LinkContext &context);

/// Adds the entries of language/PayloadSlots.def.
void makePayloadSlots(LinkContext &context);

/// RtslInstance::anyHit of a material.
std::uint32_t anyHitTypes(const LinkContext &context, const LinkedClass &material);

/// Adds @rtsl_features.
void makeFeatures(LinkContext &context);

/// Numbers the prints of the module and returns their formats.
std::vector<runtime::PrintFormat> numberPrints(mlir::ModuleOp ir);

/// Adds the entries of language/Slots.def and those that make objects; everything else becomes
/// private.
void makeEntries(LinkContext &context);

/// A function, and the rt_ class that its class derives from: empty for a free function.
struct Reader {
  mlir::func::FuncOp function;
  llvm::StringRef root;
};
Reader readerOf(const mlir::SymbolTable &symbols, mlir::func::FuncOp function);
/// RTSL_NEEDS_*: the outputs that an operation of this function reads.
std::uint32_t needsOf(const Reader &reader, mlir::Operation *op);
/// Are these of reading the change of a scratch member, which primitives may have to compute?
bool isOfScratchChanges(std::uint32_t needs);
/// Whether an operation uses the address other than to store to it.
bool isRead(mlir::Value address);
/// Whether an operation sends rays to the scene's lights, or to surfaces that shine.
bool sendsRaysToLights(mlir::Operation *op);
/// Fills in LinkContext::methodsThatPassLight. Runs after resolveSlots.
void findMethodsThatPassLight(LinkContext &context);
/// ClassInfo::opaqueIfZero.
std::optional<std::vector<runtime::MemberName>> opaqueIfZero(const LinkContext &context,
                                                             const LinkedClass &material);
/// Replaces LightMayPassOp by what is known of the scene, and removes what then never runs. Runs
/// after findMethodsThatPassLight.
void replaceLightMayPass(LinkContext &context);
/// Whether any rays to lights may pass surfaces. Runs after unreached methods have been dropped.
bool lightPasses(const LinkContext &context);
/// The outputs that functions of the program read; the runtime computes no others.
std::uint32_t findNeeds(const LinkContext &context);
/// ClassInfo::needs of each of the context's classes. `ofProgram`: findNeeds.
std::vector<std::uint32_t> findNeedsOfClasses(const LinkContext &context, std::uint32_t ofProgram);

/// What is read of the images that members hold, as MemberInfo::imageChannels: by the class of the
/// object as the reader knows it, which may be of a derived class, and the member's name.
using ImageChannels = std::map<std::pair<std::string, std::string>, std::uint32_t>;
/// To be called before resolveSlots.
ImageChannels findImageChannels(const LinkContext &context);
/// The channels read of the images that a member of a class holds.
std::uint32_t channelsOf(const ImageChannels &channels, const typed::Class &info,
                         const std::string &member);

/// A method as a class of the program defines it: `@Checker.lookup`. Null if it does not.
mlir::func::FuncOp findMethod(const LinkContext &context, const LinkedClass &linked,
                              const std::string &method);

/// Describes the choice between classes in a call through a reference or from the runtime; there is
/// at least one class.
Finding describeDispatch(const std::string &subject,
                         const std::vector<const LinkedClass *> &classes,
                         const ir::SourcePlace &place, bool mayBeNone = false);

/// Fills `function` with a return of zeros.
void makeEmpty(mlir::func::FuncOp function);

/// Fills in the empty `function`, whose first argument is an object: it calls `method` of the
/// object's class, with the remaining arguments. For a class in `classes` that does not define the
/// method it does nothing and returns zeros; so it does for a null reference, if the object
/// `mayBeNone`. `subject` is that of the finding that describes it.
void buildDispatch(const LinkContext &context, mlir::func::FuncOp function,
                   const std::string &subject, const std::vector<const LinkedClass *> &classes,
                   const std::string &method, bool mayBeNone = false);

} // namespace rtsl::linking
