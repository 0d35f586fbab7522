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
// A local variable whose change is used somewhere is accompanied by a variable for the change; an
// assignment to the former by one to the latter. Functions are called in variants with parameters
// for the changes of their arguments: `fWithFootprint` has the value of f, which contains dFdx or
// dFdy, `fDFdx` and `fDFdy` are the changes of its value. Parameters that are written have `out`
// parameters for their changes in `fWithFootprint`. Changes begin with rt_HitPoint, rt_TextureUV,
// rt_TextureUVW, rt_ShadingNormal and the scratch members of materials: for the changes of `uv1`
// the class gets scratch members `uv1_dx` and `uv1_dy`, which are known where the surface is a
// mesh. Outside of materials, textures and the functions that these call, all changes are 0.
//
// These have changes of 0, too: what language/Derivatives.def lists as such, other members, and the
// results of functions that have other effects (draw random numbers or trace rays, for example), of
// functions with `out` parameters, and of dFdx and dFdy themselves.
//
//===----------------------------------------------------------------------===//
#pragma once

#include "sema/typed/TypedAst.h"

namespace rtsl {

/// Replaces all calls of dFdx and dFdy in a module without errors.
void replaceDerivatives(typed::Module &module);

} // namespace rtsl
