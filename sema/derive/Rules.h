//===- Rules.h - the derivatives of the built-in functions ----------------===//
#pragma once

#include "sema/derive/Term.h"

namespace rtsl::derive {

/// Has the function a row in language/Derivatives.def?
bool hasRule(typed::Builtin function);

/// The change of the value of a call, from those of its arguments. `values` are the arguments.
Term derivative(const typed::BuiltinExpr &call, std::vector<Term> values, std::vector<Term> changes,
                TypeContext &types);

} // namespace rtsl::derive
