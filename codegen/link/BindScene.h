//===- BindScene.h - what the objects of a scene say of a program ---------===//
#pragma once

#include "codegen/link/LinkRequest.h"
#include "mlir/IR/BuiltinOps.h"
#include "runtime/program/Program.h"

namespace rtsl {

/// Keeps of a linked program what makes the objects of a scene: constructors, member defaults and
/// bounds.
void keepConstructors(mlir::ModuleOp ir);

/// Notes in a linked program what is the same in all objects of its scene, and takes out what made
/// them. The pass `rtsl-bind-members` makes constants of the notes. The objects must have been made
/// with a program that was linked from the same classes; those that no ray comes to are left out.
/// What LinkRequest::keep names is noted as if nothing were known of it. Adds to `findings`, if
/// given.
void bindScene(mlir::ModuleOp ir, const runtime::SceneFacts &scene, const LinkRequest &request = {},
               Findings *findings = nullptr);

/// Program::sceneNeeds of a program for this scene. Adds to `findings`, if given.
std::uint32_t graphNeeds(const runtime::SceneFacts &scene, const LinkRequest &request,
                         Findings *findings = nullptr);

} // namespace rtsl
