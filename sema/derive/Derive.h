//===- Derive.h - dFdx and dFdy -------------------------------------------===//
//
// `dFdx(e)` is the change of e along one axis of the footprint of the ray, `dFdy(e)` that along the
// other. They are found by automatic differentiation in forward mode (Wengert, "A Simple Automatic
// Derivative Evaluation Program", 1964), on the typed tree, so that everything after sees only
// ordinary expressions:
//
//     vec2 uv = rt_TextureUV * 4.0;           vec2 uv_dx = rt_dUVdx * 4.0;
//                                      ==>    vec2 uv = rt_TextureUV * 4.0;
//     float change = dFdx(uv.x);              float change = uv_dx.x;
//
// A local variable whose change is used somewhere gets a variable for it, an assignment to it one
// to that. Functions are called in variants with parameters for the changes of their arguments:
// `fWithFootprint` has the value of f, which contains dFdx or dFdy, `fDFdx` and `fDFdy` are the
// changes of its value. Parameters that are written have `out` parameters for their changes in
// `fWithFootprint`. Changes begin with rt_HitPoint, rt_TextureUV, rt_TextureUVW, rt_ShadingNormal
// and the scratch members of materials: for the changes of `uv1` the class gets scratch members
// `uv1_dx` and `uv1_dy`, which are known where the surface is a mesh. Elsewhere than in materials
// and textures, and functions called from there, all changes are 0.
//
// Changes of 0 as well have: what language/Derivatives.def says, other members, results of
// functions that have other effects (they draw random numbers, say, or trace rays), of those with
// `out` parameters, and of dFdx and dFdy themselves.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

namespace rtsl {

/// Replaces all calls of dFdx and dFdy in a module without errors.
void replaceDerivatives(typed::Module &module);

} // namespace rtsl
