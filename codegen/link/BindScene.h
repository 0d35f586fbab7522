//===- BindScene.h - facts about the objects of a scene -------------------===//
#pragma once

#include "codegen/link/LinkRequest.h"
#include "mlir/IR/BuiltinOps.h"
#include "runtime/program/Program.h"

namespace rtsl {

/// Keeps only the functions of a linked program that make the objects of a scene: constructors,
/// member defaults and bounds; with `withEmission` also those that rtsl_emitted_power calls.
void keepConstructors(mlir::ModuleOp ir, bool withEmission);

/// Records in a linked program which members are the same in all objects of its scene, and removes
/// the functions that made the objects. The pass `rtsl-bind-members` turns the records into
/// constants. The objects must have been made with a program that was linked from the same classes;
/// objects that no ray can reach are ignored. Items in LinkRequest::keep are treated as unknown.
/// Adds to `findings`, if given.
void bindScene(mlir::ModuleOp ir, const runtime::SceneFacts &scene, const LinkRequest &request = {},
               Findings *findings = nullptr);

/// Program::sceneNeeds of a program for this scene. Adds to `findings`, if given.
std::uint32_t graphNeeds(const runtime::SceneFacts &scene, const LinkRequest &request,
                         Findings *findings = nullptr);

} // namespace rtsl
