//===- BindTables.h - the tables of a small scene, in its program ---------===//
#pragma once

#include "codegen/link/LinkRequest.h"
#include "mlir/IR/BuiltinOps.h"
#include "runtime/program/Program.h"

namespace rtsl {

/// Records on a bound program the records, instances and emitters of its scene if they are few, and
/// whether rays test the instances without a tree (codegen/emit/SceneTables.h). Items in
/// LinkRequest::keep are treated as unknown. Adds to `findings`, if given.
void bindTables(mlir::ModuleOp ir, const runtime::SceneFacts &scene, const LinkRequest &request,
                Findings *findings = nullptr);

} // namespace rtsl
