//===- Reflect.h - describe classes to the runtime ------------------------===//
#pragma once

#include "codegen/ir/Rtsl.h"
#include "codegen/link/Members.h"
#include "runtime/program/Program.h"
#include "sema/typed/TypedAst.h"

namespace rtsl {

/// What the runtime knows about a class: how its record and the packed arguments of its constructor
/// are laid out. Offsets come from codegen/ir/Layout.h. `parameters` is the struct of packed
/// arguments; null: no constructor.
runtime::ClassInfo reflect(const typed::Class &info, ir::ClassOp record, ir::StructType parameters);

/// A type as scenes see it, with the sizes of the type that it was lowered to.
runtime::ValueType reflect(const Type *type, mlir::Type irType);

} // namespace rtsl
