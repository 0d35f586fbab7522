//===- Steps.h - the steps of linking, for Link.cpp -----------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"
#include "codegen/ir/SourcePlace.h"
#include "codegen/link/Items.h"
#include "codegen/link/Link.h"
#include "codegen/passes/errors/ElementaryErrors.h"
#include "mlir/Dialect/Func/IR/FuncOps.h"
#include "mlir/IR/SymbolTable.h"

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace rtsl::linking {

/// A class that objects of the program have.
struct LinkedClass {
  const typed::Class *info = nullptr;
  bool hasObjects = true; // without, it is there to be kept
  // an object of it may be met by a ray; otherwise its constructor alone is of use
  bool isUsed = true;
  ir::ClassOp record;
  std::uint32_t id = 0;      // from 1, in the order of the module
  ir::StructType parameters; // packed arguments of the constructor; null: it has none
};

/// A type of payload that some function of the program traces.
struct RayType {
  ir::StructType payload;
  std::uint32_t number = 0; // from 1, in the order in which they are mentioned
  // how hits are searched for: RTSL_FIRST_HIT, RTSL_ASK_ANY_HIT, RTSL_IN_ORDER
  std::uint32_t search = 0;

  std::string name() const { return payload.getName().str(); }
};

struct LinkContext {
  mlir::ModuleOp ir;
  const typed::Module &module;
  const LinkRequest &request;
  Diagnostics &diagnostics;
  Findings &findings; // what the steps leave out, and what not
  ElementaryErrors elementaryErrors;
  bool hasScene = true; // otherwise every class may have objects (LinkModule.h)
  std::vector<LinkedClass> classes = {};
  // of the functions of this name, to be noted if something runs them
  std::map<std::string, Finding> dispatches = {};
  std::vector<RayType> rayTypes = {};
  /// Of `ir`. Who adds or erases a function does it through this, so that every name is found at
  /// once.
  mlir::SymbolTable symbols = mlir::SymbolTable(ir);

  mlir::func::FuncOp function(llvm::StringRef name) const {
    return symbols.lookup<mlir::func::FuncOp>(name);
  }

  /// LinkRequest::without.
  bool isWithout(Item item, const std::string &subject) const {
    return request.without.count({item, subject}) != 0;
  }
};

/// Keeps the classes that are asked for: fills `context.classes` and erases the functions of the
/// others.
void dropUnusedClasses(LinkContext &context);

/// UsedObjects.cpp: finds out which objects of the scene something refers to: LinkedClass::isUsed.
void findUsedObjects(LinkContext &context);

/// Whether a method that rendering runs loops over lights. Slots have not been resolved.
bool asksForLights(const LinkContext &context);

/// Notes which classes the program has, once it is known which methods run.
void noteClasses(LinkContext &context);

/// Takes optional members that no object of the scene sets for empty, with all that is done only if
/// they are not.
void emptyReferences(LinkContext &context);

/// How far the elementary functions of a program are off.
ElementaryErrors elementaryErrorsOf(FloatingPoint floatingPoint);

/// HitErrors.cpp: bounds of the error of t for the primitives that rays leave.
void deriveHitErrors(LinkContext &context);

/// Erases the methods that nothing runs. Slots have been resolved.
void dropUnreached(LinkContext &context);

/// A function as an author would name it: "Painted.closestHit(Radiance)".
std::string shownName(mlir::func::FuncOp function);

/// Erases stores of state that nobody reads, and notes what is computed of hits and samples, for
/// whom.
void dropUnreadOutputs(LinkContext &context);

/// RTSL_NEEDS_* of what LinkRequest::without names.
std::uint32_t needsLeftOut(const LinkContext &context);

/// Sets the offset of every `rtsl.attribute`, and erases the stores of attributes that nobody of a
/// scene reads.
void placeAttributes(LinkContext &context);

/// The classes of the program.
using ClassesByName = std::map<std::string, const typed::Class *>;
ClassesByName classesOf(const LinkContext &context);
/// Null if there is none of this name.
const typed::Class *findClass(const ClassesByName &classes, const std::string &name);

/// The scratch member of this name that objects of the class have; null if there is none.
const typed::Member *findScratch(const typed::Class &info, const std::string &name);

/// How the functions begin that a call through a reference becomes: `@dispatch.rt_Texture.lookup`.
constexpr llvm::StringLiteral dispatchPrefix = "dispatch.";

/// A method that is called through a reference.
struct SlotCall {
  std::string base; // the class of the reference: "rt_Texture" or one of the user's
  std::string method;
};

/// Replaces every `rtsl.call_method` by a call of `@dispatch.<base>.<method>`. `define` is given
/// each such function once, without a body.
void replaceSlots(mlir::ModuleOp ir, mlir::SymbolTable &symbols,
                  llvm::function_ref<void(const SlotCall &, mlir::func::FuncOp)> define);

/// Whether objects of the class may stand where a reference to `base` (an rt_ class or one of the
/// user's) is expected.
bool derivesFrom(const typed::Class &info, llvm::StringRef base);

/// Gives every slot its dispatch function.
void resolveSlots(LinkContext &context);

/// Numbers the types of payloads that the module traces. Each trace may search for hits in any way.
std::vector<RayType> numberRayTypes(mlir::ModuleOp ir);

/// The same for a program, and finds out how hits are to be searched for. Warns where nobody of a
/// scene answers. Without a scene the types that methods answer are there too.
void resolveRayTypes(LinkContext &context);

/// The struct in the author's words; null if there is none.
const typed::Struct *structOf(const LinkContext &context, const RayType &type);

/// EndlessRays.cpp: warns where every material that answers a kind of rays sends another, whatever
/// it finds.
void warnOfEndlessRays(LinkContext &context);

/// Adds the entries of language/PayloadSlots.def.
void makePayloadSlots(LinkContext &context);

/// RtslInstance::anyHit of a material.
std::uint32_t anyHitTypes(const LinkContext &context, const LinkedClass &material);

/// Adds @rtsl_features.
void makeFeatures(LinkContext &context);

/// Numbers the prints of the module and says what stands in them.
std::vector<runtime::PrintFormat> numberPrints(mlir::ModuleOp ir);

/// Adds the entries of language/Slots.def and those that make objects; everything else becomes
/// private.
void makeEntries(LinkContext &context);

/// A function, and the rt_ class below which its class is: empty for a function of no class.
struct Reader {
  mlir::func::FuncOp function;
  llvm::StringRef root;
};
Reader readerOf(const mlir::SymbolTable &symbols, mlir::func::FuncOp function);
/// RTSL_NEEDS_*: what an operation of this function reads.
std::uint32_t needsOf(const Reader &reader, mlir::Operation *op);
/// What some function of the program reads, so that the runtime computes nothing else.
std::uint32_t findNeeds(const LinkContext &context);
/// ClassInfo::needs of each of the context's classes.
std::vector<std::uint32_t> findNeedsOfClasses(const LinkContext &context);

/// A method as a class of the program defines it: `@Checker.lookup`. Null if it does not.
mlir::func::FuncOp findMethod(const LinkContext &context, const LinkedClass &linked,
                              const std::string &method);

/// Says between which classes a call through a reference or from the runtime chooses; there is one
/// at least.
Finding describeDispatch(const std::string &subject,
                         const std::vector<const LinkedClass *> &classes,
                         const ir::SourcePlace &place, bool mayBeNone = false);

/// Fills `function` with a return of zeros.
void makeEmpty(mlir::func::FuncOp function);

/// Fills the empty `function`, whose first argument is an object of class or base `base`: it calls
/// `method` of whatever class the object has, with the remaining arguments. A class in `classes`
/// that does not define the method does nothing there and gives zeros; so does no object, if that
/// `mayBeNone`.
void buildDispatch(const LinkContext &context, mlir::func::FuncOp function,
                   const std::vector<const LinkedClass *> &classes, const std::string &method,
                   bool mayBeNone = false);

} // namespace rtsl::linking
