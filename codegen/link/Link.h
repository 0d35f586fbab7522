//===- Link.h - from classes to a program ---------------------------------===//
//
// Lowering treats classes separately: a method called through a reference is a declared
// slot, an attribute has no offset yet. Linking uses the classes of a scene. In order, it
//   1. drops the classes that the scene has no objects of (DropUnusedClasses.cpp) and finds those
//      whose objects nothing refers to (UsedObjects.cpp), whose code is omitted although their
//      objects are made; removes code that runs only if a reference is set that the scene leaves
//      empty (EmptyReferences.cpp),
//   2. derives the error bounds of hits that rays leave (HitErrors.cpp),
//   3. resolves each slot to a switch over the remaining classes, or to a direct call if there is
//      one (ResolveSlots.cpp),
//   4. drops methods that are never run (DropUnreached.cpp) and outputs that are never read
//      (Outputs.cpp),
//   5. assigns offsets to attributes, matched by name and type between primitives and materials
//      (PlaceAttributes.cpp),
//   6. numbers the types of rays that carry a payload, and determines how to search for their hits
//      (RayTypes.cpp),
//   7. makes an entry point for each call of the runtime, and makes all other functions private
//      (MakeEntries.cpp),
//   8. determines the outputs of a hit that the program requires (FindNeeds.cpp).
// Items in LinkRequest::keep remain although the scene does not need them. Each step records what
// it omitted, and why. Without a scene, LinkModule.h runs the steps that omit nothing.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "codegen/ir/FloatingPoint.h"
#include "codegen/link/LinkRequest.h"
#include "frontend/diagnostics/Diagnostics.h"
#include "sema/typed/TypedAst.h"

#include "mlir/IR/BuiltinOps.h"

#include <string>
#include <vector>

namespace rtsl {

/// Links level 1 IR in place. Reports through `diagnostics` and returns false on errors. Fills in
/// `classes` and `needs` of `program` (without code addresses). `colorComponents` is the number
/// that the module was lowered with, `floatingPoint` the mode of its arithmetic. Adds to
/// `findings`, if given.
bool link(mlir::ModuleOp ir, const typed::Module &module, const LinkRequest &request,
          std::uint32_t colorComponents, Diagnostics &diagnostics, runtime::Program &program,
          Findings *findings = nullptr, FloatingPoint floatingPoint = FloatingPoint::Strict);

/// The functions of a linked program that are kept although they are not reached.
std::vector<std::string> keptFunctions(mlir::ModuleOp ir);

/// For a unit without a scene: slots become declared functions, attributes get provisional offsets.
void declareSlots(mlir::ModuleOp ir);

/// The symbols of functions in a linked program.
std::string initializeSymbol(const std::string &className); // member defaults
std::string constructSymbol(const std::string &className);  // constructor on packed arguments
std::string intersectSymbol(const std::string &className);  // `intersect` of a primitive

} // namespace rtsl
