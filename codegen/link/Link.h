//===- Link.h - from classes to a program ---------------------------------===//
//
// Lowering leaves classes beside each other: a method called through a reference is a declared
// slot, an attribute has no place yet. Linking knows which classes a scene uses. In order, it
//   1. drops the classes that the scene has no objects of (DropUnusedClasses.cpp) and finds those
//      whose objects nothing refers to (UsedObjects.cpp), whose code is left out although their
//      objects are made; removes what runs only if a reference is set that the scene leaves empty
//      (EmptyReferences.cpp),
//   2. derives the error bounds of hits that rays leave (HitErrors.cpp),
//   3. resolves each slot to a switch over the classes that are there, or to a direct call if there
//      is one (ResolveSlots.cpp),
//   4. drops methods that nothing calls (DropUnreached.cpp) and results that nothing reads
//      (Outputs.cpp),
//   5. places attributes, matched by name and type between primitives and materials
//      (PlaceAttributes.cpp),
//   6. numbers the types of rays that carry a payload, and decides how their hits are searched for
//      (RayTypes.cpp),
//   7. makes an entry point for each call of the runtime's, and hides everything else
//      (MakeEntries.cpp),
//   8. finds out what of a hit the program reads (FindNeeds.cpp).
// What LinkRequest::keep names stays although the scene does not need it. Each step notes what it
// left out, and why. Without a scene, LinkModule.h runs the steps that leave nothing out.
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

/// Links level 1 IR in place. Reports through `diagnostics` and returns false on errors. Fills
/// `classes` and `needs` of `program` (without code addresses). `colorComponents` is what the
/// module was lowered with, `floatingPoint` what becomes of its arithmetic. Adds to `findings`, if
/// given.
bool link(mlir::ModuleOp ir, const typed::Module &module, const LinkRequest &request,
          std::uint32_t colorComponents, Diagnostics &diagnostics, runtime::Program &program,
          Findings *findings = nullptr, FloatingPoint floatingPoint = FloatingPoint::Strict);

/// The functions of a linked program that nothing runs and that were to be kept.
std::vector<std::string> keptFunctions(mlir::ModuleOp ir);

/// For a unit without a scene: slots become declared functions, attributes get provisional places.
void declareSlots(mlir::ModuleOp ir);

/// The symbols under which code of a linked program is found.
std::string initializeSymbol(const std::string &className); // member defaults
std::string constructSymbol(const std::string &className);  // constructor on packed arguments
std::string intersectSymbol(const std::string &className);  // `intersect` of a primitive

} // namespace rtsl
