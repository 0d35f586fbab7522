//===- Reflect.h - describe classes to the runtime ------------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"
#include "codegen/link/Members.h"
#include "codegen/link/RequiredMembers.h"
#include "runtime/program/Program.h"
#include "sema/typed/TypedAst.h"

namespace rtsl {

/// The description of a class for the runtime: the layouts of its record and of the packed
/// arguments of its constructor. Offsets come from codegen/ir/Layout.h. `parameters` is the struct
/// of packed arguments; null: no constructor.
runtime::ClassInfo reflect(const typed::Class &info, ir::ClassOp record, ir::StructType parameters,
                           RequiredMembers &required);

/// The description of a type in scenes, with the sizes of the type that it was lowered to.
runtime::ValueType reflect(const Type *type, mlir::Type irType);

} // namespace rtsl
